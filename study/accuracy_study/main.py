# study/accuracy: error against time of every implementation and setting: tables, figures and page.
from study.pipeline.carrier import carry_out, layout_of
from study.pipeline.options import Parser, add_only, add_results, loops, positive
from study.pipeline.prepare import need_modules, registry

PARTS = ("work", "regions", "pairs")


def accuracy(arguments):
    options = _parser().parse_args(arguments)
    layout = layout_of(options, "accuracy", "work.csv")
    if options.dry_run:
        need_modules()
        from study.accuracy_study import stages  # it needs them
        print(stages.sentence(stages.choose(options, registry())))
        return 0
    return carry_out(layout, options, "accuracy", _run)


def _run(layout, options):
    from study.accuracy_study import stages  # it needs modules that set-up may have installed
    stages.run(layout, options)


def _parser():
    parser = Parser(
        prog="study/accuracy", description="Which implementation and setting (study/settings.yaml) "
        "reaches which error in which time, on the N-four-bar and the standard problems. Writes tables, "
        "figures and accuracy.html; how long it may take is said first.")
    parser.add_argument("--loops", nargs="+", type=loops, metavar="N",
                        help="sizes of the N-four-bar (each part has its own, 2 to 1000)")
    parser.add_argument("--problems", nargs="+", metavar="NAME",
                        help="only these standard problems (study/scenes --help lists them); none: none")
    add_only(parser)
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=PARTS, metavar="PART",
                        help="work (error against time), regions (who is fastest for a required "
                        "error), pairs (forms and precisions side by side); all")
    parser.add_argument("--duration", type=positive, default=5.0, metavar="S",
                        help="simulated time of the N-four-bar (5 s: past five singular positions)")
    parser.add_argument("--time-limit", type=positive, default=4.0, metavar="S",
                        help="a run that is predicted to take longer is not run (4 s)")
    add_results(parser, "accuracy")
    parser.add_argument("--dry-run", action="store_true", help="say what would run and how long")
    return parser
