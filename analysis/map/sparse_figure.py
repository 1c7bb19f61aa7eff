# Figure 4: sparse solvers of libraries over problem size, as ratios to the one of least time at each size, with intervals.
import matplotlib.pyplot as plt
import numpy

from analysis.core.style import legend, missing, number_axis
from analysis.core.timing import EQUIVALENT
from analysis.map import paper
from analysis.map.cells import map_cells
from analysis.map.compare import versus
from analysis.map.marks import footnote, side_by_side

PAPER_END = 160  # variables, right end of the paper's axis
LEADERS = 1.5    # ratio at which the upper panel ends


def ratios(results):
    """{name: {size: Versus to the one of least time}}; None for that one itself."""
    found, names = {}, paper.sparse(results, others=True)
    for size in results.sizes:
        scene = results.natural(size)
        best = results.fastest(scene, names)
        for name in names if best else ():
            one = versus(results, scene, name, best)
            if one or name == best:
                found.setdefault(name, {})[size] = one
    return found


def draw(results, look):
    found, sizes = ratios(results), results.sizes
    figure, panels = plt.subplots(2, 1, figsize=(max(8.0, 1.1 * len(sizes)), 8.4), sharex=True,
                                  gridspec_kw={"hspace": 0.08, "height_ratios": [1.2, 1]})
    panels[0].set_title("Figure 4: sparse solvers of libraries at the four-bar's own fill")
    if not found:
        for axes in panels:
            missing(axes, "no sparse library was timed at its own fill")
        return figure
    beyond = [place for place, size in enumerate(sizes) if size > PAPER_END]
    for axes in panels:
        side_by_side(axes, found, sizes, look)
        for place in numpy.arange(0.5, len(sizes) - 1):
            axes.axvline(place, color="#e4e4e4", linewidth=0.8, zorder=0)
        if beyond:
            axes.axvspan(beyond[0] - 0.5, len(sizes) - 0.5, color="#f3f3f3", zorder=-1)
        axes.set_ylabel("time ÷ the least at that size")
    panels[0].set(xlabel="", ylim=(0.96, LEADERS))
    number_axis(panels[1].yaxis, "×")
    outcomes = {cell.variables: "" if cell.decided else "as fast" if cell.settled else "open"
                for cell in map_cells(results, list(found)) if cell.fill_asked is None}
    panels[1].set_xticks(range(len(sizes)), [f"{size:g}\n{outcomes.get(size, '')}" for size in sizes])
    legend(panels[0], order=list(found).index)
    footnote(figure, [f"above: those within {LEADERS:g} times the least time; bars: 95 % interval over processes, none of a single one; "
                      "grey: beyond the paper's sizes",
                      f"open: not shown who of these is fastest; as fast: several are, to {100 * EQUIVALENT - 100:.0f} %; who is not "
                      "there was not timed (reasons: table of failures)"], 0.03)
    return figure
