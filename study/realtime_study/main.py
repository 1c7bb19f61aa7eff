# study/realtime: steps against their deadline: distributions, and the largest scene in real time.
from study.pipeline.carrier import carry_out, layout_of
from study.pipeline.contenders import from_json
from study.pipeline.layout import read_run, write_csv
from study.pipeline.options import Parser, add_only, add_results, loops, need_steps, positive
from study.pipeline.prepare import registry, select, start_named
from study.pipeline.progress import Teller

LOOPS = (10, 40)
STEPS = (1e-3, 1e-4)
SCHEMES = ("penalty", "saddle-point")


def realtime(arguments):
    parser = Parser(
        prog="study/realtime", description="Steps against the deadline that real time sets them, "
        "their own length: the distribution of their times over 20 s, misses, and the largest "
        "N-four-bar that each implementation simulates in real time. Writes steps.csv, largest.csv, "
        "figures and realtime.html; about 35 minutes.")
    add_only(parser)
    parser.add_argument("--loops", nargs="+", type=loops, default=LOOPS, metavar="N",
                        help="sizes whose distributions are shown (10 40)")
    parser.add_argument("--steps", nargs="+", type=positive, default=STEPS, metavar="S",
                        help="in seconds (1e-3 1e-4)")
    parser.add_argument("--duration", type=positive, default=20.0, metavar="S",
                        help="simulated time of a distribution (20 s)")
    add_results(parser, "realtime")
    options = parser.parse_args(arguments)
    return carry_out(layout_of(options, "realtime", "steps.csv"), options, "realtime", _run)


def _run(layout, options):
    import pandas
    from study.realtime_study.search import AGAIN, PILOT, REPEATS, Case, largest, step_row
    need_steps(options.duration, options.steps)
    known = registry()
    start_named(layout, "realtime", select(known, options.only), {
        "duration": options.duration, "repeats": REPEATS, "again": AGAIN, "pilot": PILOT})
    run = read_run(layout)
    served = {variant["name"]: variant.get("settings", []) for entry in known["implementations"]
              if entry["available"] for variant in entry["variants"]}
    cases = [Case(one, scheme, step) for step in options.steps
             for one in from_json(run["contenders"]).values() if one.ranked and not one.missing
             for scheme in SCHEMES if scheme == "penalty" or scheme in served[one.variant]]
    tell, rows, found = Teller(), [], []
    for number, case in enumerate(cases, start=1):
        def told(what, at=f"{case.step:g} s; {case.contender.name}; {case.scheme}"):
            tell(f"{at}: {what}; case {number} of {len(cases)}", (number - 1) / len(cases))
        for size in options.loops:
            told(f"N = {size}")
            rows.append(step_row(case, size, layout, run["contexts"], options.duration))
        found.append(largest(case, layout, run["contexts"], told))
    tell.end()
    write_csv(layout.results / "steps.csv", pandas.DataFrame(rows))
    write_csv(layout.results / "largest.csv", pandas.DataFrame(found))
