# The report: one self-contained HTML page from the tidy tables and the figures.
import base64
import sys
from collections import Counter
from pathlib import Path

from analysis import bounds, page, paper, summary, tables
from analysis.claims import claims
from analysis.figures.t2_operations import table as table2
from analysis.loader import TableError, load
from analysis.text import interval

CAPTIONS = {  # in the order of the page
    "t1_phases": "Table 1. Share of a step's time by phase: the paper's starting versions, ours, "
                 "and the fastest of today. Ticks of the processor's counter booked by phase in "
                 "extra profiled stretches, apart from the timed ones.",
    "t2_operations": "Table 2. The three operations alone, without and with symbolic "
                     "preprocessing, over problem size; bars are 95 % intervals.",
    "f2_dense_pairs": "Figure 2. Dense versions on pairs of BLAS and LAPACK against the starting "
                      "dense version, at the mechanism's own fill.",
    "f4_sparse_solvers": "Figure 4. Sparse solvers over problem size at the mechanism's own fill: "
                         "to 160 variables as in the paper, and beyond. Up to "
                         f"{tables.LAST_CENTRED} variables the stretch is centred on the first "
                         "singular position, above it ends before (crossing it multiplies "
                         "rounding there).",
    "f5_fill": "Figure 5. Time of a step over the tangent's fill near 100 variables: every sparse "
               "solver and the fastest dense version; crossings with their intervals.",
    "f6_map": "Figure 6. Best implementation over size and fill, 10 to 100 variables. A winner is "
              "declared only if the 95 % interval of its ratio to the second excludes 1. Fills above the "
              "lowest cell of a column are artificial, and harder on sparse solvers than those of a "
              "mechanism.",
    "f7_map": "Figure 7. The same over all sizes. Here too fills above the lowest cells are artificial.",
    "map_families": "The same map from the viewpoint of families of implementations.",
    "regret_map": "What is lost by always using one implementation: its time over the best time "
                  "of each cell.",
}
SECTIONS = {"maps": ("f6_map", "f7_map", "map_families", "regret_map"),
            "solvers": ("f4_sparse_solvers", "f5_fill", "f2_dense_pairs"),
            "operations": ("t1_phases", "t2_operations")}


def figures(folder):
    """Every figure of the results directory, the known ones first, embedded."""
    found = {path.stem: path for path in sorted((folder / "figures").glob("*.svg"))}
    order = [name for name in CAPTIONS if name in found] + [n for n in found if n not in CAPTIONS]
    return {name: {"caption": CAPTIONS.get(name, name.replace("_", " ")),
                   "data": base64.b64encode(found[name].read_bytes()).decode()} for name in order}


def beside(folder):
    """{title: relative link} of the pages of other studies whose results lie beside `folder`."""
    pages = sorted(path for path in folder.resolve().parent.glob("*/*.html")
                   if path.parent.name == path.stem)
    return {path.stem.capitalize(): f"../{path.stem}/{path.name}" for path in pages}


def render(folder):
    results = load(folder)
    ledger = claims(results)
    return page.template(Path(__file__).parent / "report.html.j2", interval=interval).render(
        beside=beside(folder), context=results.context, run=results.run, registry=results.registry,
        figures=figures(folder), sections=SECTIONS, times=tables.step_times(results),
        by_size=summary.by_size(results), dense_from=summary.dense_from(results),
        prices=summary.prices(results), overhead=tables.overhead(results), ledger=ledger,
        verdict_counts=Counter(row["verdict"] for row in ledger), table2=table2(results),
        operations=paper.OPERATIONS, pairs=tables.blas_pairs(results),
        builds=tables.builds(results), stages=tables.stages(results),
        verdicts=tables.verdicts(results), checks=tables.checks(results),
        accuracy=tables.accuracy(results), losses=tables.losses(results),
        not_reached=tables.not_reached(results), must_hold=bounds.must_hold(results),
        before_singular=tables.BEFORE_SINGULAR, samples=len(results.samples()),
        cells=results.samples().groupby(["scene", "implementation"]).ngroups)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(f"usage: {sys.argv[0]} RESULTS_DIR OUTPUT.html")
    try:
        text = render(Path(sys.argv[1]))
    except TableError as error:
        sys.exit(f"error: {error}")
    Path(sys.argv[2]).write_text(text, encoding="utf-8")
