# study/extremes: the battery of extremes, ways out, stale pivots and the growth of roundoff.
import argparse

from study.pipeline.carrier import carry_out, layout_of
from study.pipeline.contenders import from_json
from study.pipeline.layout import read_run, write_csv
from study.pipeline.options import Parser, add_only, add_results, positive
from study.pipeline.prepare import registry, start_named
from study.pipeline.progress import Teller

PARTS = {"battery": "every implementation at the extremes, against the true motion",
         "ways": "how far each way out extends the safe region, at what cost",
         "pivots": "kept pivots on matrices that change violently",
         "roundoff": "difference from the long-double reference over 20 s"}
TIMED = {"ways", "pivots"}
NEEDED = {"battery": "CONTROLS", "roundoff": "CONTROLS", "pivots": "STALE_PIVOTS"}  # of tools.py, beside `mbs`


def extremes(arguments):
    parser = Parser(
        prog="study/extremes", description="Numerical stability at the extremes. Writes tables, figures "
        "and extremes.html; about ten minutes.", formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="parts:\n" + "\n".join(f"  {name:9} {what}" for name, what in PARTS.items()))
    parser.add_argument("--parts", nargs="+", choices=list(PARTS), default=list(PARTS), metavar="PART",
                        help=f"only these parts ({' '.join(PARTS)})")
    add_only(parser)
    parser.add_argument("--time-limit", type=positive, default=60.0, metavar="S",
                        help="for one run (60 s); what takes longer is kept as a timeout")
    add_results(parser, "extremes")
    options = parser.parse_args(arguments)
    return carry_out(layout_of(options, "extremes", "run.json"), options, "extremes", _run, timed=bool(TIMED & set(options.parts)))


def _run(layout, options):
    from study.extremes_study import battery, pivots, roundoff, tools, ways
    for part in (part for part in options.parts if part in NEEDED):
        tools.built(getattr(tools, NEEDED[part]))
    start_named(layout, "extremes", options.only, {"time_limit": options.time_limit})
    run = read_run(layout)
    settings = {variant["name"]: variant for entry in registry()["implementations"]
                if entry["available"] for variant in entry["variants"]}
    contenders = [one for one in from_json(run["contenders"]).values() if one.ranked and not one.missing]
    study = tools.Study(layout, contenders, settings, run["contexts"], options.time_limit, Teller())
    parts = {"battery": battery.run, "ways": ways.run, "pivots": pivots.run, "roundoff": roundoff.run}
    for name in (name for name in PARTS if name in options.parts):
        for table, rows in parts[name](study).items():
            write_csv(layout.results / f"{table}.csv", rows)
        study.tell.end()
