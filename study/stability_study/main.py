# study/stability: the outcome of the N-four-bar over (step, penalty): table, figures and page.
from multiprocessing.pool import ThreadPool

from study.pipeline.carrier import carry_out, layout_of
from study.pipeline.contenders import from_json
from study.pipeline.errors import StudyError
from study.pipeline.layout import read_run, write_csv
from study.pipeline.options import Parser, add_results, loops, need_steps, positive
from study.pipeline.prepare import registry, start_named
from study.pipeline.progress import Teller

LOOPS, LARGE = (1, 2, 5, 10, 20, 40, 80), (200, 500)
STEPS = tuple(1.25e-3 * 2.0**power for power in range(-3, 4))
PENALTIES = tuple(10.0**power for power in range(13))
IMPLEMENTATIONS = {"double": "csc_klu/refactor", "single": "compiled_ldl/fronts"}
AT_ONCE = 2


def stability(arguments):
    parser = Parser(
        prog="study/stability", description="Which penalty factors and steps simulate the N-four-bar "
        "well, in each scheme and precision. Writes stability.csv, figures and stability.html; "
        "about two minutes, with --all five.")
    parser.add_argument("--loops", nargs="+", type=loops, metavar="N",
                        help=f"numbers of loops ({' '.join(map(str, LOOPS))})")
    parser.add_argument("--all", action="store_true",
                        help=f"the default loops and {' '.join(map(str, LARGE))}")
    parser.add_argument("--long", action="store_true",
                        help="also whole runs of 20 s, up to N = 2000, in every scheme: long.csv")
    parser.add_argument("--implementation", metavar="NAME", help="folder/variant for all runs "
                        f"({IMPLEMENTATIONS['double']}; {IMPLEMENTATIONS['single']} in single "
                        "precision); what it does not serve is left out")
    parser.add_argument("--steps", nargs="+", type=positive, default=STEPS, metavar="S",
                        help="in seconds (1.25e-3 times powers of 2 from 1/8 to 8)")
    parser.add_argument("--penalties", nargs="+", type=positive, default=PENALTIES, metavar="B",
                        help="values of alpha step^2 / 4, in kg/m^2 (1e0 to 1e12, decades)")
    parser.add_argument("--duration", type=positive, default=2.0, metavar="S",
                        help="simulated time (2 s: past two singular positions)")
    parser.add_argument("--time-limit", type=positive, default=120.0, metavar="S",
                        help="for one run (120 s); what takes longer is kept as a timeout")
    add_results(parser, "stability")
    options = parser.parse_args(arguments)
    if options.all and options.loops:
        raise StudyError("--all and --loops exclude each other")
    return carry_out(layout_of(options, "stability", "stability.csv"), options, "stability", _run, timed=False)


def _run(layout, options):
    import pandas
    from study.stability_study import grid, long
    variants = _variants(registry())
    served = _served(variants, options.implementation)
    loops = sorted(set(options.loops or LOOPS + (LARGE if options.all else ())))
    steps, penalties = sorted(set(options.steps)), sorted(set(options.penalties))
    need_steps(options.duration, steps)
    windows = grid.windows(loops, steps, IMPLEMENTATIONS)  # refuses what `mbs` would refuse
    start_named(layout, "stability", list(dict.fromkeys(served.values())),
                {"duration": options.duration, "time_limit": options.time_limit})
    run = read_run(layout)
    contenders = from_json(run["contenders"])
    cells = [grid.Cell(count, scheme, precision, contenders[name], step, penalty)
             for count in loops for (scheme, precision), name in served.items()
             if not variants[name]["dense"] or count <= grid.DENSE_LOOPS
             for step in steps for penalty in [grid.AUTOMATIC, *penalties]]
    if not cells:
        raise StudyError(f"dense implementations run up to N = {grid.DENSE_LOOPS} only: no run is left")
    tell, found = Teller(), {}
    with ThreadPool(AT_ONCE) as pool:  # interrupted, it drops what has not begun
        records = pool.imap(lambda cell: grid.run(cell, layout, run["contexts"], options.duration,
                                                  options.time_limit), cells)
        for number, (cell, record) in enumerate(zip(cells, records), start=1):
            found[cell] = record
            tell(f"N = {cell.loops}; {cell.scheme}; {cell.precision}: run {number} of {len(cells)}",
                 number / len(cells))
    tell.end()
    write_csv(layout.results / "windows.csv", pandas.DataFrame(windows))
    write_csv(layout.results / "stability.csv", pandas.DataFrame(
        [grid.row(cell, record, layout, options.duration) for cell, record in found.items()]))
    if options.long:
        name = served["penalty", "double"]
        cells = long.cells(contenders[name], variants[name].get("settings", []))
        _long(cells, layout, run["contexts"], options.time_limit)


def _long(cells, layout, contexts, seconds):
    import pandas
    from study.stability_study import long
    tell, rows = Teller(), []
    with ThreadPool(AT_ONCE) as pool:
        records = pool.imap(lambda cell: long.record(cell, layout, contexts, seconds), cells)
        for number, (cell, record) in enumerate(zip(cells, records), start=1):
            rows.append(long.judged(cell, record, layout))
            tell(f"20 s; {cell.scheme}; N = {cell.loops}: run {number} of {len(cells)}", number / len(cells))
    tell.end()
    write_csv(layout.results / "long.csv", pandas.DataFrame(rows))


def _variants(known):
    """{name: what `mbs list --json` says of it}, of those that are available."""
    return {variant["name"]: variant for entry in known["implementations"] if entry["available"]
            for variant in entry["variants"]}


def _served(variants, implementation):
    """{(scheme, precision): implementation} of the default implementations or of the one named."""
    served = {}
    for precision, default in IMPLEMENTATIONS.items():
        name = implementation or default
        if name not in variants:
            raise StudyError(f"unknown or unavailable implementation '{name}'; known: "
                             f"{', '.join(variants)}")
        settings = {"penalty", "double", *variants[name].get("settings", [])}
        served |= {(scheme, precision): name for scheme in ("penalty", "saddle-point")
                   if {scheme, precision} <= settings}
    return served
