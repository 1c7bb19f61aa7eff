# study/limit: how far each implementation's step is from the limit, and where its time goes.
import argparse
import os

from study.pipeline.builds import build
from study.pipeline.carrier import carry_out, layout_of
from study.pipeline.contenders import from_json, own
from study.pipeline.errors import StudyError
from study.pipeline.layout import read_run, write_csv
from study.pipeline.options import Parser, add_only, add_results, loops, positive, rounds
from study.pipeline.prepare import registry, select, start_named
from study.pipeline.progress import Teller

LOOPS = (2, 5, 10, 24, 40, 79, 160, 499, 1999)
PARTS = ("sizes", "growth", "scenes", "batches")

EPILOG = """parts:
  sizes     every implementation on the N-four-bar, and its bounds; code without a library to 20 000 variables
  growth    code without a library from 100 to 20 000 variables in the saddle-point form
  scenes    the standard problems, the examples and fills of 100 variables: own code against libraries
  batches   simulations side by side against each alone
"""


def limit(arguments):
    parser = Parser(
        prog="study/limit", description="The step of every implementation beside that of code "
        "written for the N-four-bar alone and beside the lower bounds of its arithmetic "
        "(harness/limit), and what each phase takes of it; how far ahead of libraries code without "
        "any is, scene by scene; many lanes side by side. Writes bounds.csv, steps.csv, growth.csv, "
        "scenes.csv, batches.csv, figures and limit.html; about half an hour.", epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=PARTS, metavar="PART",
                        help=f"only these parts ({' '.join(PARTS)})")
    add_only(parser)
    parser.add_argument("--loops", nargs="+", type=loops, default=LOOPS, metavar="N",
                        help=f"sizes of the part of that name ({' '.join(map(str, LOOPS))})")
    parser.add_argument("--instructions", action="store_true", help="also count the instructions of a "
                        "step up to N = 40 with Valgrind, in a build of their own")
    parser.add_argument("--rounds", type=rounds, default=5, metavar="R",
                        help="processes a cell, in turn over all implementations (5); of batches three times as many")
    parser.add_argument("--time-limit", type=positive, default=20.0, metavar="S",
                        help="for one timed process (20 s); what takes longer is kept as a timeout, "
                        "and not tried at larger sizes")
    add_results(parser, "limit")
    options = parser.parse_args(arguments)
    options.loops = tuple(dict.fromkeys(options.loops))
    return carry_out(layout_of(options, "limit", "implementations.json"), options, "limit", _run)


def _run(layout, options):
    import pandas
    from study.limit_study import instructions, lead, measure
    if options.instructions:
        _prepare_counting(layout, instructions)
    start_named(layout, "limit", select(registry(), options.only),
                {"rounds": options.rounds, "time_limit": options.time_limit})
    run = read_run(layout)
    contenders = [one for one in from_json(run["contenders"]).values()
                  if one.ranked and not one.missing]
    mine, tell = own(registry()), Teller()
    if "sizes" in options.parts:
        rows = _sizes(layout, options, contenders, mine, tell)
        tell("bounds")
        bounds = measure.bounds(layout, options.loops)
        write_csv(layout.results / "bounds.csv", pandas.DataFrame(bounds))
        write_csv(layout.results / "steps.csv", pandas.DataFrame(rows))
    if "growth" in options.parts:
        rows, here = [], [one for one in contenders if one.name in mine]
        for number, size in enumerate(lead.LARGE, start=1):
            rows += measure.growth(layout, here, size, options.rounds, options.time_limit,
                                   _telling(tell, f"N = {size}, saddle-point form: size {number} of {len(lead.LARGE)}"))
        write_csv(layout.results / "growth.csv", pandas.DataFrame(rows, columns=None if rows else ["implementation"]))
    if "scenes" in options.parts:
        rows, scenes = [], lead.scenes()
        for number, scene in enumerate(scenes, start=1):
            rows += lead.rows(layout, contenders, mine, scene, options.rounds, options.time_limit,
                              _telling(tell, f"{scene}: scene {number} of {len(scenes)}",
                                       (number - 1) / len(scenes)))
        write_csv(layout.results / "scenes.csv", pandas.DataFrame(rows))
    if "batches" in options.parts:
        rows = lead.batches(layout, contenders, options.rounds, options.time_limit, tell)
        write_csv(layout.results / "batches.csv", pandas.DataFrame(rows))
    tell.end()


def _sizes(layout, options, contenders, mine, tell):
    """Rows of steps.csv. Who was not timed at one size is not tried at a larger one."""
    from study.limit_study import instructions, lead, measure
    rows, lost = [], set()
    sizes = sorted({*options.loops, *(lead.LARGE if options.loops == LOOPS else ())})
    for number, size in enumerate(sizes, start=1):
        told = _telling(tell, f"N = {size}: size {number} of {len(sizes)}")
        here = [one for one in (measure.LIMIT, *contenders)
                if one.name not in lost and (size in options.loops or one.name in mine
                                             or one is measure.LIMIT)]
        found = measure.size(layout, here, size, options.rounds, options.time_limit, told)
        lost |= {row["implementation"] for row in found if row["status"] != "ok"}
        for one, row in zip(here, found):
            if options.instructions and size <= instructions.MOST_LOOPS and row["status"] == "ok":
                told(f"instructions of {one.name}")
                row["instructions"] = instructions.count(layout, one, size, 5 * options.time_limit)
        rows += found
    return rows


def _telling(tell, where, share=None):
    return lambda what: tell(f"{where}, {what}", share)


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
