# Time per step against number of variables, natural fill, every implementation, with the spread.
import matplotlib.pyplot as plt
from matplotlib.ticker import FuncFormatter, NullFormatter

from analysis.style import GREY, Look, figure_main
from analysis.loader import NULL
from analysis.statistics import median


def draw(results):
    look = Look(results)
    figure, axes = plt.subplots(figsize=(7.6, 4.9))
    samples = results.samples(natural_only=True)
    for name in results.implementations:
        mine = samples[samples.implementation == name].groupby("variables").step_us
        if not len(mine):
            axes.plot([], [], color=look.colour(name), marker=look.marker(name), linestyle="none",
                      markerfacecolor="white", label=f"{name} (not timed)")
            continue
        middle = mine.agg(median)
        axes.fill_between(middle.index, mine.min(), mine.max(), color=look.colour(name), alpha=0.22,
                          linewidth=0)
        axes.plot(middle.index, middle, color=look.colour(name), linestyle=look.dash(name),
                  marker=look.marker(name), markersize=5.5, markeredgecolor="white",
                  markeredgewidth=0.6, linewidth=1.5, label=name)
    _excluded(axes, results, look)
    axes.set(xscale="log", yscale="log")
    _null(axes, results)
    _axes(axes, results)
    return figure


def _excluded(axes, results, look):
    """Cells that were not timed because a pilot was far too slow: the pilot's own time, open."""
    tidy = results.tidy
    cells = tidy[(tidy.status == "excluded") & tidy.fill_asked.isna() & tidy.pilot_step_us.notna()]
    for row in cells.itertuples():
        axes.plot(row.variables, row.pilot_step_us, linestyle="none", markerfacecolor="white",
                  marker=look.marker(row.implementation), color=look.colour(row.implementation),
                  markersize=6)
    if len(cells):
        axes.plot([], [], linestyle="none", marker="o", markerfacecolor="white", color=GREY,
                  label="excluded as too slow (pilot)")


def _null(axes, results):
    """The harness's own cost: a line if it is near the data, else a note, to keep the scale."""
    tidy = results.tidy
    null = tidy[(tidy.implementation == NULL) & (tidy.status == "ok")]
    middle = null.groupby("variables").step_us.agg(median)
    if middle.empty:
        return
    if middle.max() > axes.get_ylim()[0] / 10:
        axes.plot(middle.index, middle, color=GREY, linestyle=":", linewidth=1.4, marker=".",
                  label="harness overhead (null)")
    else:
        axes.annotate(f"↓ harness overhead (null control): {middle.min():.2g} to "
                      f"{middle.max():.2g} µs, below this axis", (0.99, 0.02),
                      xycoords="axes fraction", ha="right", fontsize=8.5, color=GREY)


def _axes(axes, results):
    sizes = sorted(results.tidy.variables.dropna().unique())
    axes.set(xlabel="variables n", ylabel="time per step, µs",
             title="Time per step, natural fill")
    axes.set_xticks(sizes, [f"{size:g}" for size in sizes])
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.xaxis.set_tick_params(which="minor", length=0)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.grid(True, which="major")
    axes.margins(x=0.04)
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=9)
    axes.annotate("median of all samples; band: fastest to slowest sample", (1, -0.16),
                  xycoords="axes fraction", ha="right", fontsize=8, color=GREY)


if __name__ == "__main__":
    figure_main(draw)
