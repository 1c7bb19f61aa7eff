# Figure 5: time against tangent fill at about 100 variables, and where the fastest dense overtakes.
import matplotlib.pyplot as plt
import numpy

from analysis.core.style import legend, missing, nothing, number_axis
from analysis.map import paper
from analysis.map.compare import best, crossing_interval
from analysis.map.marks import NOTE, draw_lost, footnote, lost

PAPER_SIZE = 100  # variables
DENSE_LINE = {"color": "black", "linewidth": 2.4, "linestyle": "-", "marker": "", "zorder": 1.5}


def chosen_size(results):
    """The measured size nearest the paper's among those with at least half as many fills as the size that has most of
    them; None if no size has three."""
    fills = results.samples().groupby("variables").scene.nunique()
    enough = fills[fills >= max(3, fills.max() / 2)] if len(fills) else fills
    return min(enough.index, key=lambda size: (abs(size - PAPER_SIZE), -size), default=None)


def scenes(results, size):
    """{fill, %: scene} of a size, ascending."""
    samples = results.samples()
    found = samples[samples.variables == size].groupby("scene").fill_percent.first().sort_values()
    return {fill: scene for scene, fill in found.items()}


def crossings(results, size):
    """{sparse name: {"fill", "low", "high", "first", "last"}}: the tangent fill, %, from which the fastest dense of each
    fill is faster; -inf or inf if from before the first or not up to the last fill at which both are timed."""
    found = {}
    for name in paper.sparse(results, others=True):
        ratios = {fill: best(results, scene, paper.dense(results), [name]) for fill, scene in scenes(results, size).items()}
        series = {fill: ratio for fill, ratio in ratios.items() if ratio}
        if series:
            fill, low, high = crossing_interval(list(series), list(series.values()))
            found[name] = {"fill": fill, "low": low, "high": high, "first": min(series), "last": max(series)}
    return found


def draw(results, look):
    size = chosen_size(results)
    if size is None:
        return nothing("no size was timed at three or more fills", (8.4, 3), "Figure 5: time against tangent fill")
    found = crossings(results, size)
    figure, (axes, below) = plt.subplots(2, 1, figsize=(8.4, 5.4 + 0.21 * max(3, len(found))), sharex=True, gridspec_kw={
        "hspace": 0.14, "height_ratios": [5, 0.3 + 0.21 * max(3, len(found))]})
    axes.set_title(f"Figure 5: time against tangent fill, n = {size:g}")
    _times(axes, results, size, look)
    if found:
        _crossings(below, found, look)
    else:
        missing(below, "no fill has both a sparse and a dense time")
    below.set_xlabel("non-zeros of the tangent, % of n²")
    footnote(figure, ["lines: medians over processes; grey bars: fills at which both are timed, coloured: where the 95 % "
                      "interval of the ratio includes 1", "crossings are interpolated between measured fills, log ratio over "
                      "fill", f"dense: the best one timed; pairs of BLAS and LAPACK: {paper.dense_pairs(results)}", NOTE], 0.02)
    return figure


def _times(axes, results, size, look):
    places = scenes(results, size)
    times = {fill: results.medians(scene) for fill, scene in places.items()}
    for name in paper.sparse(results, others=True):
        mine = {fill: known[name] for fill, known in times.items() if name in known}
        if mine:
            axes.plot(list(mine), list(mine.values()), label=name, **look.line(name))
    winners = {fill: results.fastest(scene, paper.dense(results)) for fill, scene in places.items()}
    winners = {fill: name for fill, name in winners.items() if name}
    if winners:
        who = "\n".join(dict.fromkeys(f"   {name}" for name in winners.values()))
        axes.plot(list(winners), [times[fill][name] for fill, name in winners.items()], label=f"fastest dense:\n{who}", **DENSE_LINE)
    rows = results.timing
    draw_lost(axes, lost(rows[(rows.variables == size) & rows.implementation.isin(paper.sparse(results, others=True))]), look.line, "fill_percent")
    axes.set(yscale="log", ylabel="time per step, µs")
    number_axis(axes.yaxis)
    axes.grid(True, which="major")
    legend(axes)


def _crossings(axes, found, look):
    order = sorted(found, key=lambda name: found[name]["fill"])
    for place, name in enumerate(order):
        row = found[name]
        left, right = row["first"], row["last"]
        low, high = numpy.clip([row["low"], row["high"]], left, right)
        axes.plot([left, right], [place, place], color="#e6e6e6", linewidth=5, zorder=0.5, solid_capstyle="butt")
        if numpy.isfinite(row["fill"]):
            axes.plot([low, high], [place, place], color=look.colour(name), linewidth=3.5, alpha=0.45, solid_capstyle="butt")
            axes.plot(row["fill"], place, **look.line(name) | {"linestyle": "none"})
        axes.text(1.01, place, outcome(row), transform=axes.get_yaxis_transform(), va="center", fontsize=8.5)
    axes.set_yticks(range(len(order)), order, fontsize=8.5)
    axes.set_ylim(len(order) - 0.4, -0.6)
    axes.set_title("fill from which the fastest dense is faster", fontsize=9.5, pad=5)
    axes.grid(True, axis="x", which="major")
    axes.tick_params(axis="y", length=0)


def outcome(row):
    """The crossing of one solver in words."""
    if row["fill"] == numpy.inf:
        doubt = "" if row["low"] == numpy.inf else f", undecided from {row['low']:.0f} %"
        return f"faster than dense at every fill timed, to {row['last']:.0f} %{doubt}"
    if row["fill"] == -numpy.inf:
        doubt = "" if row["high"] == -numpy.inf else ", undecided at first"
        return f"slower than dense from the lowest fill timed, {row['first']:.0f} %{doubt}"
    low = f"{row['low']:.1f}" if numpy.isfinite(row["low"]) else f"below {row['first']:.0f}"
    high = f"{row['high']:.1f}" if numpy.isfinite(row["high"]) else f"above {row['last']:.0f}"
    return f"{row['fill']:.1f} % (95 %: {low} to {high})"
