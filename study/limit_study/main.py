# study/limit: how far each implementation's step is from the limit, and where its time goes.
import argparse
import os

from study.pipeline.builds import build
from study.pipeline.contenders import from_json
from study.pipeline.errors import StudyError
from study.pipeline.layout import read_run, write_csv
from study.pipeline.options import loops, positive, report, results
from study.pipeline.prepare import (need_modules, only_one, only_one_measuring, select, set_up,
                                    registry, start_named, writable)
from study.pipeline.progress import Teller

LOOPS = (2, 5, 10, 24, 40, 79, 160, 499)


def limit(arguments):
    parser = argparse.ArgumentParser(
        prog="study/limit", description="The step of every implementation beside that of code "
        "written for the N-four-bar alone and beside the lower bounds of its arithmetic "
        "(harness/limit), and what each phase takes of it. Writes bounds.csv, steps.csv, figures "
        "and limit.html; about half an hour.")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME",
                        help="only these implementations (folder or folder/variant)")
    parser.add_argument("--loops", nargs="+", type=loops, default=LOOPS, metavar="N",
                        help=f"sizes ({' '.join(map(str, LOOPS))})")
    parser.add_argument("--instructions", action="store_true", help="also count the instructions of a "
                        "step up to N = 40 with Valgrind, in a build of their own")
    parser.add_argument("--rounds", type=loops, default=5, metavar="R",
                        help="processes a cell, in turn over all implementations (5)")
    parser.add_argument("--time-limit", type=positive, default=60.0, metavar="S",
                        help="for one process (60 s); what takes longer is kept as a timeout")
    parser.add_argument("--results", metavar="DIR", help="results directory (results/local/limit)")
    parser.add_argument("--stored", action="store_true",
                        help="figures and page again from stored tables, without running anything")
    options = parser.parse_args(arguments)
    layout = results(options, "limit", "steps.csv")
    writable(layout.results)
    with only_one(layout):
        if "MBS_PROGRAM" not in os.environ and not options.stored:
            set_up(layout)
        need_modules("yaml", "pandas", "matplotlib", "jinja2")
        if not options.stored:
            with only_one_measuring():
                _run(layout, options)
        from analysis.limit.report import write  # it needs the modules
        report(layout, "limit", write)
    return 0


def _run(layout, options):
    import pandas
    from study.limit_study import instructions, measure
    if options.instructions:
        _prepare_counting(layout, instructions)
    start_named(layout, "limit", select(registry(), options.only),
                {"rounds": options.rounds, "time_limit": options.time_limit})
    run = read_run(layout)
    contenders = [measure.LIMIT, *(one for one in from_json(run["contenders"]).values()
                                   if one.ranked and not one.missing)]
    tell, rows = Teller(), []
    for number, size in enumerate(options.loops, start=1):
        def told(what, at=f"N = {size}: size {number} of {len(options.loops)}"):
            tell(f"{at}, {what}")
        found = measure.size(layout, contenders, size, options.rounds, options.time_limit, told)
        for one, row in zip(contenders, found):
            if options.instructions and size <= instructions.MOST_LOOPS and row["status"] == "ok":
                told(f"instructions of {one.name}")
                row["instructions"] = instructions.count(layout, one, size, 5 * options.time_limit)
        rows += found
    told("bounds")
    bounds = measure.bounds(layout, options.loops)
    tell.end()
    write_csv(layout.results / "bounds.csv", pandas.DataFrame(bounds))
    write_csv(layout.results / "steps.csv", pandas.DataFrame(rows))


def _prepare_counting(layout, instructions):
    if instructions.why_not():
        raise StudyError(f"--instructions: {instructions.why_not()}")
    if "MBS_PROGRAM" in os.environ:
        return
    tell = Teller()
    with open(layout.log, "a", encoding="utf-8") as log:
        broken = build(instructions.BUILD, log, tell)
    tell.end()
    if broken:
        raise StudyError(f"--instructions: {broken}")
