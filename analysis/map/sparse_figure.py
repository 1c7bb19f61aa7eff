# Figure 4: sparse solvers of libraries over problem size, as ratios to the one of least time at each size, with intervals.
import matplotlib.pyplot as plt
import numpy

from analysis.core.style import GREY, legend, missing, number_axis
from analysis.core.text import bounded
from analysis.core.timing import EQUIVALENT
from analysis.map import paper
from analysis.map.cells import map_cells
from analysis.map.compare import versus

PAPER_END = 160  # variables, right end of the paper's axis
LEADERS = 1.5    # ratio at which the upper panel ends
DODGE = 0.6      # width over which the contenders of a size are spread


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
        _side_by_side(axes, found, sizes, look)
        for place in numpy.arange(0.5, len(sizes) - 1):
            axes.axvline(place, color="#e4e4e4", linewidth=0.8, zorder=0)
        if beyond:
            axes.axvspan(beyond[0] - 0.5, len(sizes) - 0.5, color="#f3f3f3", zorder=-1)
        axes.set_ylabel("time ÷ the least at that size")
    panels[0].set(ylim=(0.96, LEADERS))
    panels[1].set_xlabel("variables n, own fill")
    number_axis(panels[1].yaxis, "×")
    outcomes = {cell.variables: {"decided": "", "equivalent": "as fast", "open": "open"}[cell.outcome]
                for cell in map_cells(results, list(found)) if cell.fill_asked is None}
    panels[1].set_xticks(range(len(sizes)), [f"{size:g}\n{outcomes.get(size, '')}" for size in sizes])
    legend(panels[0], order=list(found).index)
    notes = (f"above: those within {LEADERS:g} times the least time; bars: 95 % interval over processes, none of a single one; "
             "grey: beyond the paper's sizes\n"
             f"open: not shown who of these is fastest; as fast: several are, to {100 * EQUIVALENT - 100:.0f} %; who is not "
             "there was not timed (reasons: table of failures)")
    figure.text(figure.subplotpars.left, 0.03, notes, fontsize=7.5, color=GREY, va="top", linespacing=1.35)
    return figure


def _side_by_side(axes, found, sizes, look):
    """Marks and intervals of `ratios` at their places among `sizes`."""
    for number, (name, series) in enumerate(found.items()):
        shift = DODGE * ((number + 0.5) / len(found) - 0.5)
        places = [sizes.index(size) + shift for size in series]
        known = [(place, one) for place, one in zip(places, series.values()) if one and bounded(one.low, one.high)]
        axes.plot(places, [one.value if one else 1.0 for one in series.values()], label=name, **look.line(name) | {"linestyle": "none"})
        axes.vlines([place for place, _ in known], [one.low for _, one in known], [one.high for _, one in known],
                    color=look.colour(name), linewidth=2.2, alpha=0.6)
    axes.axhline(1, color="#444444", linewidth=0.8)
    axes.set(xlim=(-0.5, len(sizes) - 0.5))
    axes.grid(True, axis="y", which="major")
