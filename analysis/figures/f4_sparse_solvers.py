# Figure 4: sparse solvers over problem size, to 160 variables as in the paper and over all sizes.
import matplotlib.pyplot as plt

from analysis import paper
from analysis.compare import fastest, medians_over_size, natural, ratio
from analysis.marks import draw_crosses, draw_hollow, footnote, lost, natural_cells, reasons
from analysis.style import Look, figure_main, missing, number_axis, size_ticks
from analysis.tables import BEFORE_SINGULAR, LAST_CENTRED

PAPER_END = 160  # variables, right end of the paper's axis
OFF_SCALE = 6.0  # on the paper's linear axes, times of more than this times the fastest leave it


def ratios(results):
    """{name: [Ratio to the fastest sparse implementation of the size]} over sizes."""
    found = {}
    for _, samples in natural(results).groupby("variables"):
        best = fastest(samples, paper.sparse(results))
        for name in paper.sparse(results) if best else []:
            to_best = ratio(samples, name, best)
            if to_best:
                found.setdefault(name, []).append(to_best)
    return found


def draw(results):
    look, found = Look(results), ratios(results)
    figure, panels = plt.subplots(2, 2, figsize=(10.6, 7.6), sharex="col",
                                  gridspec_kw={"hspace": 0.1, "wspace": 0.2,
                                               "width_ratios": [1, 1.25]})
    panels[0, 0].set_title("Figure 4: sparse solvers over problem size, natural fill")
    names = paper.sparse(results)
    lost_cells = lost(natural_cells(results, names))
    if not found:
        for axes in panels.flat:
            missing(axes, "no sparse implementation was timed at natural fill")
        footnote(figure, reasons(lost_cells), 0.03)
        return figure
    samples = natural(results)
    for column, end in enumerate((PAPER_END, float("inf"))):
        of_column = samples[samples.variables <= end]
        cells = lost_cells[~(lost_cells.variables > end)]
        _times(panels[0, column], of_column, cells, names, look)
        _ratios(panels[1, column], found, cells, of_column, look)
        sizes = sorted(of_column.variables.unique())
        size_ticks(panels[1, column], sizes, log=column == 1)
    leaving = _paper_scale(panels[0, 0], samples, names)
    panels[0, 0].set_ylabel("time per step, µs")
    panels[1, 0].set_ylabel("time ÷ that of the fastest sparse")
    panels[0, 1].set_yscale("log")
    number_axis(panels[0, 1].yaxis)
    _legend(panels[0, 1], found, samples, look)
    notes = ["points: medians; bands: fastest to slowest sample; bars: 95 % interval of the ratio"]
    if leaving:
        notes.append(f"beyond the top of the linear axes, see right: {', '.join(leaving)}")
    if samples.variables.max() > LAST_CENTRED:
        notes.append(BEFORE_SINGULAR)
    gone = [entry for entry in results.registry if not entry.get("available", True)]
    notes += [f"✕ {entry['folder']} is unavailable: {entry['reason']}" for entry in gone]
    footnote(figure, notes + reasons(lost_cells), 0.03)
    return figure


def _times(axes, samples, cells, names, look):
    for name in names:
        mine = samples[samples.implementation == name].groupby("variables").step_us
        middle = medians_over_size(samples, name)
        if len(middle):
            axes.fill_between(middle.index, mine.min(), mine.max(), color=look.colour(name),
                              alpha=0.2, linewidth=0)
            axes.plot(middle.index, middle, label=name, **look.line(name))
    draw_hollow(axes, cells, look.line)
    draw_crosses(axes, cells, look.line)
    axes.grid(True, which="major")


def _paper_scale(axes, samples, names):
    """Linear axes as the paper's. Returns the slow ones, which leave them at the top."""
    within = samples[(samples.variables <= PAPER_END) & samples.implementation.isin(names)]
    if within.empty:
        return []
    last = within[within.variables == within.variables.max()]
    medians = last.groupby("implementation").step_us.median()
    shown = medians[medians <= OFF_SCALE * medians.min()]
    axes.set_ylim(0, 1.08 * shown.max())
    return [name for name in names if name in medians.index and name not in shown.index]


def _ratios(axes, found, cells, samples, look):
    best = {}
    sizes = set(samples.variables)
    for name, series in found.items():
        mine = [ratio for ratio in series if ratio.size in sizes]
        axes.plot([ratio.size for ratio in mine], [ratio.value for ratio in mine],
                  **look.line(name))
        axes.vlines([ratio.size for ratio in mine], [ratio.low for ratio in mine],
                    [ratio.high for ratio in mine], color=look.colour(name), linewidth=3.5,
                    alpha=0.35)
        best |= {ratio.size: ratio.fast for ratio in mine}
    medians = samples.groupby(["variables", "implementation"]).step_us.median()
    draw_hollow(axes, cells, look.line,
                scale=lambda row: row.variables in best
                and medians[row.variables, best[row.variables]])
    draw_crosses(axes, cells, look.line)
    axes.set_yscale("log")
    number_axis(axes.yaxis, "×")
    axes.grid(True, which="major")


def _legend(axes, found, samples, look):
    """By increasing efficiency as in the paper, with the ratios at two sizes."""
    small = max((n for n in samples.variables if n <= PAPER_END), default=None)
    sizes = [small] if small else []
    large = samples.variables.max()
    sizes += [large] if large != small else []

    def value(name, size):
        return next((ratio.value for ratio in found[name] if ratio.size == size), None)

    def text(name):
        values = (value(name, size) for size in sizes)
        return "   ".join("–" if v is None else f"{v:.2f}×" for v in values)
    order = sorted(found, key=lambda name: -(value(name, sizes[0]) or float("inf")))
    lines = {line.get_label(): line for line in axes.get_lines()}
    labels = [f"{name}   {text(name)}" for name in order]
    title = "by increasing efficiency; ratio to the\nfastest sparse at n = " + " and ".join(
        f"{size:g}" for size in sizes)
    axes.legend([lines[name] for name in order], labels, title=title, title_fontsize=8.5,
                fontsize=8.5, loc="upper left", bbox_to_anchor=(1.01, 1.0), alignment="left")


if __name__ == "__main__":
    figure_main(draw)
