# Figure 5: time against tangent fill at about 100 variables, and where the fastest dense overtakes.
#
# Times are per Newton pass: stretches of different fills have different lengths, and the shorter one
# is, the more of its steps lie at the singular position, where a step takes more passes.
import matplotlib.pyplot as plt
import numpy

from analysis import paper
from analysis.compare import best_ratio, crossing_interval, fastest
from analysis.marks import draw_crosses, draw_hollow, footnote, lost, reasons
from analysis.statistics import median
from analysis.style import Look, figure_main, legend, missing, number_axis

PAPER_SIZE = 100  # variables
PILOT_PASSES = 2  # a step: a pilot begins at the start, far from the singular position
DENSE_LINE = {"color": "black", "linewidth": 2.4, "linestyle": "-", "marker": "", "zorder": 1.5}


def chosen_size(results):
    """The measured size nearest the paper's among those with at least half as many fills as the
    size that has most of them; None if no size has three."""
    fills = results.samples().groupby("variables").fill_percent.nunique()
    enough = fills[fills >= max(3, fills.max() / 2)] if len(fills) else fills
    return min(enough.index, key=lambda size: (abs(size - PAPER_SIZE), -size), default=None)


def crossings(results, size):
    """{sparse name: {"fill", "low", "high", "first", "last"}}: the tangent fill, %, from which the
    fastest dense of each fill is faster; -inf or inf if from before the first or not up to the
    last fill at which both are timed."""
    samples, found = at_size(results, size), {}
    for name in paper.sparse(results):
        ratios = {fill: best_ratio(cell, paper.dense(results), [name])
                  for fill, cell in samples.groupby("fill_percent")}
        series = {fill: ratio for fill, ratio in ratios.items() if ratio}
        if series:
            fills = list(series)
            fill, low, high = crossing_interval(fills, list(series.values()))
            found[name] = {"fill": fill, "low": low, "high": high, "first": fills[0],
                           "last": fills[-1]}
    return found


def at_size(results, size):
    """Samples of one size; `step_us` is the time of one pass here."""
    samples = results.samples()
    mine = samples[samples.variables == size]
    return mine.assign(step_us=mine.step_us * mine.stretch_steps / mine.passes)


def draw(results):
    size, look = chosen_size(results), Look(results)
    if size is None:
        figure, axes = plt.subplots(figsize=(8.4, 3))
        axes.set_title("Figure 5: time against tangent fill")
        missing(axes, "no size was timed at three or more fills")
        footnote(figure, reasons(lost(results.tidy[results.tidy.fill_asked.notna()])), 0.0)
        return figure
    found = crossings(results, size)
    figure, (axes, below) = plt.subplots(
        2, 1, figsize=(8.4, 5.4 + 0.21 * max(3, len(found))), sharex=True,
        gridspec_kw={"hspace": 0.14, "height_ratios": [5, 0.3 + 0.21 * max(3, len(found))]})
    instead = "" if size == PAPER_SIZE else f" (nearest measured to the paper's {PAPER_SIZE})"
    axes.set_title(f"Figure 5: time against tangent fill, n = {size:g}{instead}")
    cells = _times(axes, results, size, look)
    if found:
        _crossings(below, found, look)
    else:
        missing(below, "no fill has both a sparse and a dense time")
    below.set_xlabel("non-zeros of the tangent, % of n²")
    footnote(figure, _notes(results, size, cells), 0.02)
    return figure


def _times(axes, results, size, look):
    samples = at_size(results, size)
    for name in paper.sparse(results):
        mine = samples[samples.implementation == name].groupby("fill_percent").step_us
        if len(mine):
            middle = mine.agg(median)
            axes.fill_between(middle.index, mine.min(), mine.max(), color=look.colour(name),
                              alpha=0.2, linewidth=0)
            axes.plot(middle.index, middle, label=name, **look.line(name))
    _dense(axes, samples, paper.dense(results))
    tidy = results.tidy
    cells = lost(tidy[(tidy.variables == size)
                      & tidy.implementation.isin(paper.sparse(results) + paper.dense(results))])
    shares = cells.assign(fill_percent=cells.fill_percent.fillna(100 * cells.fill_asked),
                          pilot_step_us=cells.pilot_step_us / PILOT_PASSES)
    drawn = shares[shares.implementation.isin(paper.sparse(results))]
    draw_hollow(axes, drawn, look.line, "fill_percent")
    draw_crosses(axes, drawn, look.line, "fill_percent")
    axes.set(yscale="log", ylabel="time per step ÷ passes per step, µs")
    number_axis(axes.yaxis)
    axes.grid(True, which="major")
    legend(axes)
    return shares


def _dense(axes, samples, names):
    """The fastest dense of every fill as one line; the legend says which ones it consists of."""
    winners = {fill: fastest(cell, names) for fill, cell in samples.groupby("fill_percent")}
    winners = {fill: name for fill, name in winners.items() if name}
    if winners:
        cells = {fill: samples[(samples.fill_percent == fill) & (samples.implementation == name)]
                 .step_us for fill, name in winners.items()}
        axes.fill_between(list(cells), [cell.min() for cell in cells.values()],
                          [cell.max() for cell in cells.values()], color="black", alpha=0.15,
                          linewidth=0)
        who = "\n".join(dict.fromkeys(f"   {name}" for name in winners.values()))
        axes.plot(list(cells), [median(cell) for cell in cells.values()],
                  label=f"fastest dense:\n{who}", **DENSE_LINE)


def _crossings(axes, found, look):
    order = sorted(found, key=lambda name: found[name]["fill"])
    for place, name in enumerate(order):
        row = found[name]
        left, right = row["first"], row["last"]
        low, high = numpy.clip([row["low"], row["high"]], left, right)
        axes.plot([left, right], [place, place], color="#e6e6e6", linewidth=5, zorder=0.5,
                  solid_capstyle="butt")
        if numpy.isfinite(row["fill"]):
            axes.plot([low, high], [place, place], color=look.colour(name), linewidth=3.5,
                      alpha=0.45, solid_capstyle="butt")
            axes.plot(row["fill"], place, **look.line(name) | {"linestyle": "none"})
        axes.text(1.01, place, outcome(row), transform=axes.get_yaxis_transform(), va="center",
                  fontsize=8.5)
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


def _notes(results, size, cells):
    notes = ["lines: medians; bands: fastest to slowest sample; grey bars: fills at which both are "
             "timed, coloured: where the 95 % interval of the ratio includes 1",
             "a pass is one Newton iteration with its share of the projections; pilots are taken "
             f"to need {PILOT_PASSES} a step",
             "crossings are interpolated between measured fills, log ratio over fill"]
    tidy = results.tidy
    below = tidy[(tidy.status == "not-reached") & (tidy.variables == size)].fill_asked
    if len(below):
        shares = ", ".join(f"{100 * fill:.0f} %" for fill in sorted(below.unique()))
        notes.append(f"below the mechanism's own fill, not reached: {shares}")
    return notes + reasons(cells, lambda row: f"{row.fill_percent:.0f}", "{} %")


if __name__ == "__main__":
    figure_main(draw)
