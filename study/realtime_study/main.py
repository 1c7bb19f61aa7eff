# study/realtime: steps against their deadline: distributions, and the largest scene in real time.
import argparse
import math
import os
from pathlib import Path

from study.pipeline.contenders import from_json
from study.pipeline.errors import StudyError
from study.pipeline.layout import Layout, ROOT, read_run, write_csv
from study.pipeline.prepare import (need_modules, only_one, only_one_measuring, registry, select,
                                    set_up, start_named, writable)
from study.pipeline.progress import Teller

LOOPS = (10, 40)
STEPS = (1e-3, 1e-4)
SCHEMES = ("penalty", "saddle-point")


def realtime(arguments):
    parser = argparse.ArgumentParser(
        prog="study/realtime", description="Steps against the deadline that real time sets them, "
        "their own length: the distribution of their times over 20 s, misses, and the largest "
        "N-four-bar that each implementation simulates in real time. Writes steps.csv, largest.csv, "
        "figures and realtime.html; about 25 minutes.")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME",
                        help="only these implementations (folder or folder/variant)")
    parser.add_argument("--loops", nargs="+", type=_loops, default=LOOPS, metavar="N",
                        help="sizes whose distributions are shown (10 40)")
    parser.add_argument("--steps", nargs="+", type=_positive, default=STEPS, metavar="S",
                        help="in seconds (1e-3 1e-4)")
    parser.add_argument("--duration", type=_positive, default=20.0, metavar="S",
                        help="simulated time of a distribution (20 s)")
    parser.add_argument("--results", metavar="DIR", help="results directory (results/local/realtime)")
    parser.add_argument("--stored", action="store_true",
                        help="figures and page again from stored tables, without running anything")
    options = parser.parse_args(arguments)
    layout = Layout(Path(options.results).absolute() if options.results
                    else ROOT / "results" / "local" / "realtime")
    if options.stored and not (layout.results / "steps.csv").exists():
        raise StudyError(f"{layout.results} holds no results (no steps.csv)")
    writable(layout.results)
    with only_one(layout):
        if "MBS_PROGRAM" not in os.environ and not options.stored:
            set_up(layout)
        need_modules("yaml", "pandas", "matplotlib", "jinja2")
        if not options.stored:
            with only_one_measuring():
                _run(layout, options)
        from analysis.loader import TableError  # they need the modules
        from analysis.realtime.report import write
        try:
            write(layout.results)
        except TableError as error:
            raise StudyError(str(error)) from error
    print(f"report: {layout.results / 'realtime.html'}")
    return 0


def _positive(text):
    value = float(text)
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is not a positive number")
    return float(f"{value:g}")  # as it is passed on


def _loops(text):
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text} is not a number of loops (1, 2, ...)")
    return int(text)


def _run(layout, options):
    import pandas
    from study.realtime_study.search import Case, largest, step_row
    known = registry()
    start_named(layout, "realtime", select(known, options.only), {"duration": options.duration})
    run = read_run(layout)
    served = {variant["name"]: variant.get("settings", []) for entry in known["implementations"]
              if entry["available"] for variant in entry["variants"]}
    cases = [Case(one, scheme, step) for step in options.steps
             for one in from_json(run["contenders"]).values() if one.ranked and not one.missing
             for scheme in SCHEMES if scheme == "penalty" or scheme in served[one.variant]]
    tell, rows, found = Teller(), [], []
    for number, case in enumerate(cases, start=1):
        def told(what, at=f"{case.step:g} s; {case.contender.name}; {case.scheme}"):
            tell(f"{at}: {number} of {len(cases)}, {what}")
        for loops in options.loops:
            told(f"N = {loops}")
            rows.append(step_row(case, loops, layout, run["contexts"], options.duration))
        found.append(largest(case, layout, run["contexts"], told))
    tell.end()
    write_csv(layout.results / "steps.csv", pandas.DataFrame(rows))
    write_csv(layout.results / "largest.csv", pandas.DataFrame(found))
