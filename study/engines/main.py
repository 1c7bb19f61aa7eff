# study/run --engines: the N-four-bar in other engines beside ours: tables, figures and page.
import contextlib

from study.pipeline.carrier import carry_out, layout_of
from study.pipeline.options import Parser, add_only, add_results, loops, positive
from study.pipeline.prepare import need_modules


def engines(arguments):
    options = _parser().parse_args(arguments)
    _need_known(options.engines)
    layout = layout_of(options, "engines", "engines.csv")
    if options.dry_run:
        need_modules()
        from study.engines import stages  # it needs them
        print(stages.sentence(*stages.choose(options)))
        return 0
    return carry_out(layout, options, "engines", _run, more_set_up=_build)


def _need_known(names):
    """StudyError if an engine is unknown: said before set-up, which takes minutes, where the list can be read."""
    with contextlib.suppress(ImportError):
        from study.engines import settings
        settings.need_known(names)


def _build():
    from study.engines import programs  # it needs modules that set-up may have installed
    programs.set_up()


def _run(layout, options):
    from study.engines import stages
    stages.run(layout, options)


def _parser():
    parser = Parser(
        prog="study/run --engines", description="Error against time of Simbody, MuJoCo, Open Dynamics Engine and "
        "Bullet beside ours (settings: study/engines/settings.yaml and study/settings.yaml), on the N-four-bar and "
        "on scenes without singular positions. Writes tables, figures and engines.html; how long it may take is "
        "said first.")
    parser.add_argument("--engines", nargs="*", default=[], metavar="ENGINE",
                        help="only these: simbody, mujoco, ode, bullet")
    parser.add_argument("--loops", nargs="+", type=loops, metavar="N",
                        help="sizes of the N-four-bar (1 2 5 10 20 40)")
    add_only(parser, "these implementations of ours")
    parser.add_argument("--duration", type=positive, default=5.0, metavar="S",
                        help="simulated time of the N-four-bar (5 s: past five singular positions)")
    parser.add_argument("--time-limit", type=positive, default=4.0, metavar="S",
                        help="a run that is predicted to take longer is not run (4 s)")
    add_results(parser, "engines")
    parser.add_argument("--dry-run", action="store_true", help="say what would run and how long")
    return parser
