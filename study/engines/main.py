# study/run --engines: the N-four-bar in other engines beside ours: tables, figures and page.
import argparse
import os

from study.pipeline.options import loops, positive, report, results
from study.pipeline.prepare import need_modules, only_one, only_one_measuring, set_up, writable


def engines(arguments):
    options = _parser().parse_args(arguments)
    layout = results(options, "engines", "engines.csv")
    need_modules("yaml", "pandas", "matplotlib", "jinja2", "scipy")
    from study.engines import programs, stages  # they need the modules
    if options.dry_run:
        print(stages.sentence(*stages.choose(options)))
        return 0
    writable(layout.results)
    with only_one(layout):
        if not options.stored:
            with only_one_measuring():
                if "MBS_PROGRAM" not in os.environ:
                    set_up(layout)
                    programs.set_up()
                stages.run(layout, options)
        from analysis.engines.report import write  # it needs the modules
        report(layout, "engines", write)
    return 0


def _parser():
    parser = argparse.ArgumentParser(
        prog="study/run --engines", description="Error against time of Simbody, MuJoCo, Open Dynamics Engine and "
        "Bullet beside ours (settings: study/engines/settings.yaml and study/settings.yaml), on the N-four-bar and "
        "on scenes without singular positions. Writes tables, figures and engines.html; how long it may take is "
        "said first.")
    parser.add_argument("--engines", nargs="*", default=[], metavar="ENGINE",
                        help="only these: simbody, mujoco, ode, bullet")
    parser.add_argument("--loops", nargs="+", type=loops, metavar="N",
                        help="sizes of the N-four-bar (1 2 5 10 20 40)")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME",
                        help="only these implementations of ours (folder or folder/variant)")
    parser.add_argument("--duration", type=positive, default=5.0, metavar="S",
                        help="simulated time of the N-four-bar (5 s: past five singular positions)")
    parser.add_argument("--time-limit", type=positive, default=4.0, metavar="S",
                        help="a run that is predicted to take longer is not run (4 s)")
    parser.add_argument("--results", metavar="DIR", help="results directory (results/local/engines)")
    parser.add_argument("--dry-run", action="store_true", help="say what would run and how long")
    parser.add_argument("--stored", action="store_true",
                        help="figures and page again from stored tables, without running anything")
    return parser
