# Error against time of one subject: a panel for libraries, one for all. The front is the thick line; the series on it
# or close to it have names, colours by setting and markers by implementation, the others are grey.
import matplotlib.pyplot as plt
import numpy
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator

from analysis.accuracy import names
from analysis.accuracy.points import NOT_JUDGED
from analysis.accuracy.winners import LAYERS, meeting, met
from analysis.core.outcomes import FINISHED
from analysis.core.pareto import near
from analysis.core.style import GREY, missing, number_axis

CLOSE = 1.25  # times the front's time at its error
MOST = 8      # named series of a panel
GAP = 2.6     # times the shorter of two steps
RINGED = "fastest for a required error (dashed)"
RING = {"marker": "o", "markersize": 13, "markerfacecolor": "none", "markeredgecolor": "black", "markeredgewidth": 1.3}
TITLES = {"libraries": "libraries", "all": "libraries and code without one"}


def name(subject):
    return "work-" + subject.replace(":", "-").replace(" ", "-").lower()


def draw(rows, won, look, unit, title):
    """The figure of one subject's points at its own fill. `won`: its rows of winners.csv, which are ringed."""
    figure, panels = plt.subplots(1, 2, figsize=(13, 6), sharex=True, sharey=True, constrained_layout=True)
    drawn = False
    for axes, layer in zip(panels, LAYERS):
        mine = rows[rows.library.astype(bool)] if layer == "libraries" else rows
        axes.set_title(TITLES[layer])
        if meeting(mine, numpy.inf).empty:
            missing(axes, "nobody finished and was timed")
            continue
        drawn = True
        _panel(axes, mine, mine[mine[f"front_{layer}"].astype(bool)], met(won[won.layer == layer]), look)
        axes.set(xscale="log", yscale="log", xlabel="computation for a simulated second, s")
        axes.grid(True)
    if drawn:
        first = next(axes for axes in panels if axes.axison)
        first.set_ylabel(f"error, {unit}")
        for axis in (first.xaxis, first.yaxis):
            number_axis(axis)
        if numpy.ptp(numpy.log10(first.get_xlim())) > 1.5:
            first.xaxis.set_major_locator(LogLocator())
    figure.suptitle(title, x=0.01, ha="left", fontsize=12)
    return figure


def named(rows, front):
    """[(implementation, setting)] with a colour and a name: those on the front, then those closest to it."""
    close = meeting(rows, numpy.inf)
    close = close.loc[[index for index in near(close, CLOSE) if index in close.index]]
    counts = close.groupby(["implementation", "setting"]).size()
    on_front = front.groupby(["implementation", "setting"]).size()
    order = sorted(counts.index, key=lambda key: (-on_front.get(key, 0), -counts[key], key))
    return order[:MOST]


def _panel(axes, rows, front, won, look):
    chosen = named(rows, front)
    done = rows[rows.status.isin((*FINISHED, NOT_JUDGED)) & rows.time.notna() & rows.error.notna()]
    for key, mine in done.groupby(["implementation", "setting"], sort=False):
        mine = mine.sort_values("step")
        if key not in chosen:
            axes.plot(mine.time, mine.error, color="#c4c8ce", linewidth=0.7, marker=".", markersize=3, zorder=1)
    handles, colours = [], names.colours(key[1] for key in chosen)
    for key in chosen:
        mine = meeting(rows[(rows.implementation == key[0]) & (rows.setting == key[1])], numpy.inf).sort_values("step")
        line = {"color": colours[key[1]], "linewidth": 1.5, "linestyle": look.dash(key[0]), "marker": look.marker(key[0]),
                "markersize": 8 if look.marker(key[0]) in "*PX" else 6, "markeredgecolor": "white", "markeredgewidth": 0.5}
        # What lies between two steps that were timed is not known: no line there.
        gaps = mine.step / mine.step.shift(1) > GAP
        pieces = [one for _, one in mine.groupby(gaps.cumsum())]
        for piece in pieces:
            axes.plot(piece.time, piece.error, **line, zorder=4)
        axes.hlines(mine.error, mine.time_low, mine.time_high, color=line["color"], linewidth=1.0, zorder=3)
        below = mine[mine.at_most.fillna(False).astype(bool)]
        axes.plot(below.time, below.error, linestyle="none", marker="v", markersize=10, markerfacecolor="none",
                  markeredgecolor=line["color"], zorder=4)
        handles.append(Line2D([], [], **line, label=f"{key[0]}, {key[1]}"))
    front = front.sort_values("time")
    axes.plot(front.time, front.error, color="black", linewidth=4, alpha=0.22, zorder=2, drawstyle="steps-post")
    handles += [Line2D([], [], color="black", alpha=0.22, linewidth=4, label="front"),
                Line2D([], [], color="#c4c8ce", marker=".", linewidth=0.7, label="others")]
    for required in won.required:
        axes.axhline(required, color="black", linewidth=0.8, linestyle=(0, (2, 2)), zorder=1.5)
    axes.plot(won.time, won.error, linestyle="none", zorder=5, **RING)
    if len(won):
        handles.append(Line2D([], [], linestyle=(0, (2, 2)), linewidth=0.8, color="black",
                              **RING, label=RINGED))
    if front.at_most.fillna(False).any():
        handles.append(Line2D([], [], color=GREY, marker="v", markerfacecolor="none", linestyle="none",
                              label="below the reference's own error"))
    axes.legend(handles=handles, fontsize=8.5, loc="upper center", bbox_to_anchor=(0.5, -0.11), ncols=2)
