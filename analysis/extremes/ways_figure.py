# Ways out: for each way and folder the region, cell by cell, and what its steps cost.
from textwrap import fill

import matplotlib.pyplot as plt
from matplotlib.patches import Patch, Rectangle

from analysis.extremes.battery_figure import LOOKS, SILENT
from analysis.extremes.ways import NOT_SERVED, factor, folders, not_served, share

COLOURS = {"safe": "#009E73", "silent": SILENT, "degraded": LOOKS["degraded"][0], "lost": "#c4c4c4",
           "not run": "#ffffff"}
WORDS = {"safe": "safe: ok or plausible, and right", "silent": "silently wrong", "lost": "did not get through",
         "not run": "not served, refused or left out"}
GAP, BLOCK = 3.4, 4.4  # between groups of columns; height of a way


def draw(ways, cost):
    """The figure of ways.csv and ways_cost.csv."""
    names, own = list(dict.fromkeys(ways.way)), folders(ways)
    figure, panels = plt.subplots(1, len(own), squeeze=False, sharey=True, constrained_layout=True,
                                  figsize=(5.0 * len(own) + 1.4, 0.78 * len(names) + 1.9))
    used, groups = set(), _groups(ways)
    for axes, folder in zip(panels.flat, own):
        rows = ways[ways.folder == folder]
        for place, way in enumerate(names):
            used |= _region(axes, rows[rows.way == way], groups, BLOCK * place)
            _remark(axes, rows[rows.way == way], cost[(cost.folder == folder) & (cost.way == way)], groups, BLOCK * place)
        _frame(axes, folder, names, groups)
    figure.suptitle("Where each way out is safe, and the time of a step over that of α auto", x=0.01, ha="left", fontsize=13)
    figure.legend(handles=[Patch(facecolor=colour, edgecolor="#999999", label=WORDS.get(name, name))
                           for name, colour in COLOURS.items() if name in used],
                  loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=5, fontsize=9)
    return figure


def _groups(ways):
    """[(axis, values, sizes, left edge)]: the blocks of cells side by side."""
    found, left = [], 0.0
    for axis in dict.fromkeys(ways.axis[ways.axis != ""]):
        rows = ways[ways.axis == axis]
        values, sizes = sorted(rows.value.unique()), sorted(rows.loops.unique())
        found.append((axis, values, sizes, left))
        left += len(values) + GAP
    return found


def _what(row):
    if row.safe or row.silent:
        return "safe" if row.safe else "silent"
    if row.status in (*NOT_SERVED, "dropped"):
        return "not run"
    return "degraded" if row.status == "degraded" else "lost"


def _region(axes, rows, groups, top):
    used = set()
    for axis, values, sizes, left in groups:
        high = 3 / len(sizes)
        for row in rows[rows.axis == axis].itertuples():
            what = _what(row)
            used.add(what)
            axes.add_patch(Rectangle((left + values.index(row.value), top + high * sizes.index(row.loops)), 1, high,
                                     facecolor=COLOURS[what], linewidth=0.6,
                                     edgecolor="#aaaaaa" if what == "not run" else "white"))
    return used


def _remark(axes, rows, cost, groups, top):
    if not_served(rows):
        axes.text(groups[0][3] if groups else 0, top + 1.5, fill(not_served(rows), 48), va="center", fontsize=8.5, color="#666666")
        return
    right = groups[-1][3] + len(groups[-1][1]) + 0.5
    times = [f"N = {one.loops:g}: {factor(one)}" for one in cost.itertuples()]
    axes.text(right, top + 1.5, "\n".join(["{} of {} safe".format(*share(rows)), *times]), va="center", fontsize=8.5)


def _frame(axes, folder, names, groups):
    bottom = BLOCK * len(names) - (BLOCK - 3)
    axes.set_title(folder)
    axes.set_xlim(-0.3, (groups[-1][3] + len(groups[-1][1]) if groups else 10) + 12)
    axes.set_ylim(bottom + 0.1, -0.4)
    axes.set_yticks([BLOCK * place + 1.5 for place in range(len(names))], names)
    ticks = [(left + 0.5 + i * (len(values) - 1), f"{1e3 * value:g} ms" if axis == "step" else f"{value:.0e}")
             for axis, values, _, left in groups for i, value in enumerate((values[0], values[-1]))]
    axes.set_xticks([x for x, _ in ticks], [text.replace("e+0", "e") for _, text in ticks], fontsize=8.5)
    for axis, values, sizes, left in groups:
        label = {"step": f"Δt; rows N = {', '.join(f'{n:g}' for n in sizes)}"}.get(axis, axis.replace(" ", "\n"))
        axes.annotate(label, (left + len(values) / 2, bottom), xytext=(0, -20), textcoords="offset points", ha="center",
                      va="top", fontsize=8.5, annotation_clip=False)
    axes.spines[:].set_visible(False)
    axes.tick_params(length=0)
