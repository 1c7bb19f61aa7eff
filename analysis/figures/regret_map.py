# The price of a simple choice, drawn: one panel an implementation.
import matplotlib.pyplot as plt
import numpy
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.patches import Rectangle

from analysis.maps import map_cells
from analysis.maps_drawing import columns, draw_grid
from analysis.regret import regrets
from analysis.style import GREY, Look, figure_main, missing

WORST = 50.0       # ratio at which the colours end
COLOURS = plt.get_cmap("Purples")
DARK = 10.0        # ratio from which numbers are white
ROUGH = "#E69F00"  # frame of a pilot's ratio
NARROW = 10        # columns from which two panels stand beside one another, not three


def draw(results):
    look, cells = Look(results), map_cells(results)
    found = regrets(results, cells)
    count = len(columns(cells))
    across = min(max(1, len(found)), 2 if count > NARROW else 3)
    down = max(1, -(-len(found) // across))
    figure, panels = plt.subplots(down, across, squeeze=False, layout="constrained",
                                  figsize=(across * max(3.6, 0.6 + 0.44 * count),
                                           (3.2 if count > NARROW else 2.75) * down))
    figure.suptitle("Time lost by always using one implementation: its time over the best of each "
                    "cell", x=0.01, ha="left")
    norm = LogNorm(1, WORST)
    for axes, regret in zip(panels.flat, found):
        _panel(axes, cells, regret, look, norm)
    for axes in panels.flat[len(found):]:
        axes.set_axis_off()
    if not found or not cells:
        missing(panels[0, 0], "no implementation was measured")
        return figure
    _key(figure, panels, norm)
    return figure


def _panel(axes, cells, regret, look, norm):
    def draw_cell(axes, corner, height, cell):
        text, ratio = _text(cell.scene, regret), regret.ratios.get(cell.scene, numpy.nan)
        known = numpy.isfinite(ratio)
        axes.add_patch(Rectangle(corner, 1, height, linewidth=0.5, edgecolor="white",
                                 facecolor=COLOURS(norm(ratio)) if known else "white"))
        if cell.scene in regret.failed:
            axes.add_patch(Rectangle(corner, 1, height, facecolor="none", linewidth=0,
                                     edgecolor="#999999", hatch="////"))
        if cell.scene in regret.rough:
            axes.add_patch(Rectangle(corner, 1, height, facecolor="none", linewidth=1.2,
                                     edgecolor=ROUGH, zorder=4))
        size = min(6.5, 1.8 * height)
        if size >= 3.5:
            axes.text(corner[0] + 0.5, corner[1] + height / 2, text, ha="center", va="center",
                      fontsize=size, color="white" if known and ratio >= DARK else "black")
    draw_grid(axes, cells, draw_cell, small=True)
    axes.tick_params(labelsize=7)
    axes.set_title(_title(regret, look, len(cells)), fontsize=8.5, pad=4)


def _text(scene, regret):
    if scene in regret.failed:
        return "✕"
    ratio = regret.ratios.get(scene)
    if ratio is None:
        return "–"
    if not numpy.isfinite(ratio):
        return "▲"
    return ("~" if scene in regret.rough else "") + short(ratio)


def short(ratio):
    """Few characters: 1.04, 2.3, 15."""
    return f"{ratio:.{2 if ratio < 1.995 else 1 if ratio < 9.95 else 0}f}"


def _title(regret, look, count):
    """Letter, name, geometric mean, worst, and where the name has no number."""
    head = f"{look.letter(regret.name)}  {regret.name}"
    known = sum(numpy.isfinite(ratio) for ratio in regret.ratios.values())
    if not known:
        return f"{head}\nno cell timed" + (f", ✕ {len(regret.failed)}" * bool(regret.failed))
    text = f"{head}\nmean {short(regret.mean)}×, worst {short(regret.worst)}×"
    text += f", ▲ {len(regret.rough)}" * bool(regret.rough)
    text += f", ✕ {len(regret.failed)}" * bool(regret.failed)
    return text + (f"; {known} of {count} cells" if known < count else "")


def _key(figure, panels, norm):
    figure.supxlabel("variables n", fontsize=9)
    figure.supylabel("non-zeros in the tangent matrix, % of n²", fontsize=9)
    bar = figure.colorbar(ScalarMappable(norm, COLOURS), ax=panels, location="bottom", shrink=0.5,
                          aspect=45, extend="max", pad=0.01)
    ticks = [1, 1.5, 2, 3, 5, 10, 20, 50]
    bar.set_ticks(ticks, labels=[f"{tick:g}×" for tick in ticks])
    bar.minorticks_off()
    bar.set_label("time / best time of the cell;  framed ~ : excluded as too slow (▲), roughly, "
                  "by its pilot run;  hatched ✕ : failed or disagrees;  – : not measured\n"
                  "mean: geometric, over all cells with a number; last in order: those that "
                  "fail somewhere, or are too slow to be tried", fontsize=8, color=GREY)


if __name__ == "__main__":
    figure_main(draw)
