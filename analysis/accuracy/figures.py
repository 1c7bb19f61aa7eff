# The figures of accuracy: error against time of each subject, the regions of required errors.
#
# Error against time: a column for libraries, one for all. The front is the thick line; the series on it or close to it have names, colours
# and dashes by setting, markers by implementation; the others are grey. Below, as those lie on each other: their time over the least of
# them at the same error. Regions: who meets a required error in the least time, over size and fill: a panel for libraries, one for all.
import matplotlib.pyplot as plt
import numpy
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import LogLocator

from analysis.accuracy.points import NOT_JUDGED
from analysis.accuracy.winners import LAYERS, NOBODY, NOT_TIMED, meeting, met
from analysis.core.outcomes import FINISHED, near
from analysis.core.style import ALTERNATIVES, DASHES, Look, missing, number_axis
from analysis.core.text import number, step

CLOSE = 1.25  # times the front's time at its error
MOST = 8      # named series of a panel
SHOWN = 2.5   # times the least, at which the lower panels end at most
GAP = 2.6     # times the shorter of two steps
OTHERS = {"color": "#c4c8ce", "linewidth": 0.7, "marker": ".", "markersize": 3, "zorder": 1}
RINGED = "fastest for a required error (dashed)"
RING = {"marker": "o", "markersize": 13, "markerfacecolor": "none", "markeredgecolor": "black", "markeredgewidth": 1.3, "clip_on": False}
TITLES = {"libraries": "libraries", "all": "libraries and code without one"}
STRONG, WEAK = 0.95, 0.45  # a winner that is decided or has its equals named; one that is open
NONE = {"facecolor": "white", "edgecolor": "#bbbbbb", "hatch": "...", "linewidth": 0}


def draw(tables, view):
    look, found, (points, winners) = Look(view.registry), {}, (tables[name] for name in ("points", "winners"))
    about = tables["references"].drop_duplicates("subject").set_index("subject")
    for subject, rows in points[points.fill_asked.isna()].groupby("subject", sort=False):
        one = about.loc[subject]
        found[name_of(subject)] = work(
            rows, winners[winners.fill_asked.isna() & (winners.subject == subject)], look,
            "largest of position, m" if one.unit == "m" else "root mean square, relative",
            f"{one.title}, n = {rows.variables.max():.0f}, {one.duration:g} s")
    if winners.loops.notna().any():
        found["regions"] = regions(winners[winners.loops.notna()], look)
    return found


def name_of(subject):
    return "work-" + subject.replace(":", "-").replace(" ", "-").lower()


def work(rows, won, look, unit, title):
    """The figure of one subject's points at its own fill. `won`: its rows of winners.csv, which are ringed."""
    figure, (panels, below) = plt.subplots(2, 2, figsize=(13, 9), sharex="row", sharey="row", height_ratios=[1.7, 1],
                                            gridspec_kw={"left": 0.06, "right": 0.99, "top": 0.92, "bottom": 0.05, "wspace": 0.03, "hspace": 0.17})
    for axes, ratios, layer in zip(panels, below, LAYERS):
        mine = rows[rows.library.astype(bool)] if layer == "libraries" else rows
        axes.set_title(TITLES[layer])
        if meeting(mine, numpy.inf).empty:
            missing("nobody finished and was timed", axes)
            missing("", ratios)
            continue
        front = mine[mine[f"front_{layer}"].astype(bool)]
        series = _series(mine, front, look)
        _panel(axes, mine, series, front, met(won[won.layer == layer]))
        _ratios(ratios, series)
        ratios.set_xlabel(f"error, {unit}")
        ratios.legend(*axes.get_legend_handles_labels(), fontsize=8.5, loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=2)
        axes.set_xlabel("computation for a simulated second, s")
        axes.grid(True)
    for first, lower in [pair for pair in zip(panels, below) if pair[0].axison][:1]:  # which all others share their axes with
        first.set_ylabel(f"error, {unit}")
        lower.set(yscale="log", ylabel="time ÷ the least at that error")
        lower.set_ylim(0.95, min(lower.get_ylim()[1], SHOWN))
        number_axis(lower.yaxis, "×")
        for axis in (lower.xaxis, first.xaxis, first.yaxis):
            number_axis(axis)
        lower.invert_xaxis()
        if numpy.ptp(numpy.log10(first.get_xlim())) > 1.5:
            first.xaxis.set_major_locator(LogLocator())
    figure.suptitle(title, x=0.01, ha="left", fontsize=12)
    return figure


def _series(rows, front, look):
    """{(implementation, setting): (keywords of `plot`, its points in pieces)} of each named series: what lies between two steps that were
    timed is not known, and has no line. Those on the front are named, then those closest to it."""
    timed = meeting(rows, numpy.inf)
    close, every = timed.loc[near(timed, CLOSE)], dict(list(timed.sort_values("step", kind="stable").groupby(["implementation", "setting"])))
    counts, on_front = (some.groupby(["implementation", "setting"]).size() for some in (close, front))
    chosen, found = sorted(counts.index, key=lambda key: (-on_front.get(key, 0), -counts[key], key))[:MOST], {}
    settings = list(dict.fromkeys(setting for _, setting in chosen))
    for name, setting in chosen:
        mine, place = every[name, setting], settings.index(setting)
        colour, dash = ALTERNATIVES[place % len(ALTERNATIVES)], DASHES[place % len(DASHES)]
        line = look.line(name) | {"color": colour, "markerfacecolor": colour, "linestyle": dash}
        found[name, setting] = line, [one for _, one in mine.groupby((mine.step / mine.step.shift(1) > GAP).cumsum())]
    return found


def _panel(axes, rows, series, front, won):
    done = rows[rows.status.isin((*FINISHED, NOT_JUDGED)) & rows.time.notna() & rows.error.notna()].sort_values("step")
    others = [numpy.empty((0, 2))]  # a line with gaps: hundreds of lines would take seconds
    points = done[["time", "error"]].to_numpy()
    for key, places in done.groupby(["implementation", "setting"], sort=False).indices.items():
        if key not in series:
            others += [points[places], [[numpy.nan, numpy.nan]]]
    for (name, setting), (line, pieces) in series.items():
        axes.plot([], [], **line, label=f"{name}, {setting}")
        for piece in pieces:
            axes.plot(piece.time, piece.error, **line, zorder=4)
            axes.hlines(piece.error, piece.time_low, piece.time_high, color=line["color"], linewidth=1.0, zorder=3)
    front = front.sort_values("time")
    axes.plot(front.time, front.error, color="black", linewidth=4, alpha=0.22, zorder=2, drawstyle="steps-post", label="front")
    axes.plot(*numpy.concatenate(others).T, **OTHERS, label="others")
    for required in won.required:
        axes.axhline(required, color="black", linewidth=0.8, linestyle=(0, (5, 3)), zorder=1.5)
    axes.plot(won.time, won.error, linestyle="none", zorder=5, **RING, label=RINGED if len(won) else None)


def _ratios(axes, series):
    """Time of each named series over the least of all at its error, between its points on logarithms; bars from the least to the
    largest of its processes."""
    every = [(line, piece.sort_values("error")) for line, pieces in series.values() for piece in pieces]
    errors = numpy.unique([error for _, piece in every for error in piece.error])
    times = [numpy.exp(numpy.interp(numpy.log(errors), numpy.log(piece.error), numpy.log(piece.time), numpy.nan, numpy.nan)) for _, piece in every]
    best = numpy.nanmin(times, axis=0)
    for (line, piece), mine in zip(every, times):
        there = best[numpy.searchsorted(errors, piece.error)]
        axes.plot(errors, mine / best, **line | {"marker": ""}, zorder=4)
        axes.plot(piece.error, piece.time / there, **line | {"linestyle": "none"}, zorder=5)
        axes.vlines(piece.error, piece.time_low / there, piece.time_high / there, color=line["color"], linewidth=1.0, zorder=3)
    axes.grid(True)


def regions(winners, look):
    errors = sorted(winners.required.unique())
    scenes = winners.drop_duplicates("scene").sort_values(["variables", "fill_asked"], na_position="first")
    figure, panels = plt.subplots(len(LAYERS), 1, squeeze=False, constrained_layout=True,
                                  figsize=(2.6 + 1.02 * max(len(scenes), 5), len(LAYERS) * (1.3 + 0.52 * len(errors))))
    for axes, layer in zip(panels.flat, LAYERS):
        rows = winners[winners.layer == layer]
        for row in rows.itertuples():
            _cell(axes, row, list(scenes.scene).index(row.scene), errors.index(row.required), look)
        axes.set(xlim=(0, len(scenes)), ylim=(0, len(errors)), ylabel="error at most", title=f"N-four-bar, fastest of {TITLES[layer]}")
        axes.set_xticks([place + 0.5 for place in range(len(scenes))], [
            f"n = {one.variables:.0f}\n" + ("own fill" if one.fill_asked != one.fill_asked else f"fill {one.fill_asked:.0%}")
            for one in scenes.itertuples()])
        axes.set_yticks([place + 0.5 for place in range(len(errors))], [f"{number(error)} m" for error in errors])
        axes.tick_params(length=0)
        axes.legend(handles=[*_legend(rows, look)], loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8.5)
    return figure


def _cell(axes, row, x, y, look):
    if row.implementation in (NOBODY, NOT_TIMED):
        axes.add_patch(Rectangle((x, y), 1, 1, **NONE))
        text, colour = row.implementation, "#777777"
    else:
        axes.add_patch(Rectangle((x, y), 1, 1, edgecolor="white", linewidth=1.2, facecolor=look.colour(row.implementation),
                                 alpha=STRONG if row.settled else WEAK))
        if not row.settled:
            axes.add_patch(Rectangle((x, y), 1, 1, facecolor="none", edgecolor="#555555", linewidth=0, hatch="////"))
        others = f"  ≈{len(row.equivalent.split('; '))}" if row.equivalent else ""
        text, colour = f"{row.setting}\n{step(row.step)}{others}", "black"
    axes.text(x + 0.5, y + 0.5, text, ha="center", va="center", fontsize=6.8, linespacing=1.2, color=colour, zorder=6,
              bbox={"boxstyle": "round,pad=0.15", "facecolor": "white", "linewidth": 0, "alpha": 0.78})


def _legend(rows, look):
    won = met(rows).implementation.value_counts()
    yield from (Patch(facecolor=look.colour(name), alpha=STRONG, label=f"{name}: {count}") for name, count in won.items())
    if (~rows.settled).any():
        yield Patch(facecolor="#cccccc", hatch="////", edgecolor="#555555", linewidth=0, label="open")
    if (rows.equivalent != "").any():
        yield Patch(facecolor="none", label="≈1: one other is as fast")
    for kind, text in ((NOBODY, "nobody: no run meets the error"), (NOT_TIMED, "not timed: too long, or dropped")):
        if (rows.implementation == kind).any():
            yield Patch(**NONE, label=text)
