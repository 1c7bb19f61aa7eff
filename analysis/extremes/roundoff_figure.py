# Growth of roundoff: difference from the long-double reference over time, a panel a size.
import matplotlib.pyplot as plt

from analysis.core.style import Look, missing
from analysis.extremes.motions import Chain, singular_times
from analysis.extremes.roundoff import DURATION, FLOOR


def draw(growth, registry, scheme):
    """The figure of the rows of growth.csv that are of `scheme`."""
    rows = growth[growth.scheme == scheme]
    sizes, look = sorted(rows.loops.unique()), Look(registry)
    columns = min(len(sizes), 2)
    lines = -(-len(sizes) // columns)
    figure, panels = plt.subplots(lines, columns, sharex=True, sharey=True, squeeze=False,
                                  constrained_layout=True, figsize=(5.2 * columns + 0.4, 3.2 * lines + 1))
    for axes in panels.flat[len(sizes):]:
        missing(axes, "")
    handles = {}
    for axes, loops in zip(panels.flat, sizes):
        for t in singular_times(Chain(int(loops)), DURATION):
            axes.axvline(t, color="#bbbbbb", linewidth=0.6, zorder=0)
        for name, line in rows[rows.loops == loops].groupby("implementation", sort=False):
            shown = line[line.difference > FLOOR]
            [handles[name]] = axes.plot(shown.t, shown.difference, color=look.colour(name), linewidth=0.9,
                                        linestyle=look.dash(name), label=name)
        axes.set_yscale("log")
        axes.set_title(f"N = {loops:g}")
        axes.grid(True, axis="y")
    for axes in panels[-1]:
        axes.set_xlabel("t, s (grey: singular positions)")
    for axes in panels[:, 0]:
        axes.set_ylabel("distance of a point, m")
    figure.legend(handles=[handles[name] for name in look.place if name in handles], loc="upper center",
                  bbox_to_anchor=(0.5, 0.0), ncols=4, fontsize=8)
    figure.suptitle(f"Difference from the long-double reference, {scheme} form", x=0.01, ha="left")
    return figure
