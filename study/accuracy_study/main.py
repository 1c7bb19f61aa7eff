# study/accuracy: error against time of every implementation and setting: tables, figures and page.
import argparse
import os

from study.pipeline.options import loops, positive, report, results
from study.pipeline.prepare import (need_modules, only_one, only_one_measuring, registry, set_up,
                                    writable)

PARTS = ("work", "regions", "pairs")


def accuracy(arguments):
    options = _parser().parse_args(arguments)
    layout = results(options, "accuracy", "work.csv")
    need_modules("yaml", "pandas", "matplotlib", "jinja2", "scipy")
    from study.accuracy_study import stages  # it needs the modules
    if options.dry_run:
        print(stages.sentence(stages.choose(options, registry())))
        return 0
    writable(layout.results)
    with only_one(layout):
        if not options.stored:
            with only_one_measuring():
                if "MBS_PROGRAM" not in os.environ:
                    set_up(layout)
                stages.run(layout, options)
        from analysis.accuracy.report import write  # it needs the modules
        report(layout, "accuracy", write)
    return 0


def _parser():
    parser = argparse.ArgumentParser(
        prog="study/accuracy", description="Which implementation and setting (study/settings.yaml) "
        "reaches which error in which time, on the N-four-bar and the standard problems. Writes tables, "
        "figures and accuracy.html; how long it may take is said first.")
    parser.add_argument("--loops", nargs="+", type=loops, metavar="N",
                        help="sizes of the N-four-bar (each part has its own, 2 to 1000)")
    parser.add_argument("--problems", nargs="+", metavar="NAME",
                        help="only these standard problems (study/scenes --help lists them); none: none")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME",
                        help="only these implementations (folder or folder/variant)")
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=PARTS, metavar="PART",
                        help="work (error against time), regions (who is fastest for a required "
                        "error), pairs (forms and precisions side by side); all")
    parser.add_argument("--duration", type=positive, default=5.0, metavar="S",
                        help="simulated time of the N-four-bar (5 s: past five singular positions)")
    parser.add_argument("--time-limit", type=positive, default=4.0, metavar="S",
                        help="a run that is predicted to take longer is not run (4 s)")
    parser.add_argument("--results", metavar="DIR", help="results directory (results/local/accuracy)")
    parser.add_argument("--dry-run", action="store_true", help="say what would run and how long")
    parser.add_argument("--stored", action="store_true",
                        help="figures and page again from stored tables, without running anything")
    return parser
