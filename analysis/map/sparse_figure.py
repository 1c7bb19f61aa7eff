# Figure 4: sparse solvers of libraries over problem size, as ratios to the one of least time at each size, with intervals.
import matplotlib.pyplot as plt
import numpy

from analysis.core.style import legend, missing, number_axis
from analysis.core.text import bounded
from analysis.core.timing import EQUIVALENT
from analysis.map import paper
from analysis.map.cells import map_cells
from analysis.map.compare import versus
from analysis.map.marks import NOTE, draw_lost, footnote, lost

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
    order = list(found)
    for axes in panels:
        for name, series in found.items():
            shift = DODGE * ((order.index(name) + 0.5) / len(order) - 0.5)
            places = [sizes.index(size) + shift for size in series]
            values = [one.value if one else 1.0 for one in series.values()]
            known = [(place, one) for place, one in zip(places, series.values()) if one and bounded(one.low, one.high)]
            style = look.line(name)
            axes.plot(places, values, label=name, **style | {"linestyle": "none"})
            axes.vlines([place for place, _ in known], [one.low for _, one in known], [one.high for _, one in known],
                        color=style["color"], linewidth=2.2, alpha=0.6)
        axes.axhline(1, color="#444444", linewidth=0.8)
        for place in numpy.arange(0.5, len(sizes) - 1):
            axes.axvline(place, color="#e4e4e4", linewidth=0.8, zorder=0)
        axes.grid(True, axis="y", which="major")
        axes.set_ylabel("time ÷ the least at that size")
    panels[0].set_ylim(0.96, LEADERS)
    panels[1].set_yscale("log")
    outcomes = {cell.variables: "" if cell.decided else "as fast" if cell.settled else "open"
                for cell in map_cells(results, order) if cell.fill_asked is None}
    cells = lost(results.timing[results.timing.fill_asked.isna() & results.timing.implementation.isin(order)])
    times = {size: results.rows(results.natural(size)).groupby("implementation").pilot_us.first() for size in sizes}
    best = {size: results.fastest(results.natural(size), order) for size in sizes}
    cells = cells[cells.variables.isin(sizes)].assign(place=[sizes.index(one) for one in cells.variables if one in sizes])
    draw_lost(panels[1], cells, look.line, "place", lambda row: times[row.variables].get(best[row.variables]))
    number_axis(panels[1].yaxis, "×")
    panels[1].set_xticks(range(len(sizes)), [f"{size:g}\n{outcomes.get(size, '')}" for size in sizes])
    panels[1].set(xlabel="variables n", xlim=(-0.5, len(sizes) - 0.5))
    beyond = [place for place, size in enumerate(sizes) if size > PAPER_END]
    if beyond:
        for axes in panels:
            axes.axvspan(beyond[0] - 0.5, len(sizes) - 0.5, color="#f3f3f3", zorder=-1)
    legend(panels[0], order=order.index)
    footnote(figure, [f"above: those within {LEADERS:g} times the least time; bars: 95 % interval over processes, none of a single one; "
                      "grey: beyond the paper's sizes",
                      f"open: not shown who of these is fastest; as fast: several are, to {100 * EQUIVALENT - 100:.0f} %", NOTE], 0.03)
    return figure
