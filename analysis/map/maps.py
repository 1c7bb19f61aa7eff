# Maps of the fastest over size and fill: the paper's Figures 6 and 7, for libraries and for all.
import matplotlib.patheffects as effects
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from analysis.core.style import missing
from analysis.map import paper
from analysis.map.cells import map_cells
from analysis.map.compare import best, crossing_interval
from analysis.map.grid import EDGE, columns, draw_grid, handles

LINE = "#111111"
OPAQUE, PALE = 0.85, 0.4


def draw(results, look, title, names, smallest=0, largest=float("inf")):
    """The map of some contenders, of the sizes from `smallest` to `largest` variables."""
    cells = [cell for cell in map_cells(results, names) if smallest <= cell.variables <= largest]
    count = len(columns(cells))
    figure, axes = plt.subplots(figsize=(max(5.0, 0.9 + 1.02 * count), 7.4))
    axes.set_title(title)
    if not any(cell.ranking for cell in cells):
        missing(axes, "nobody of these was timed")
        return figure
    draw_grid(axes, cells, lambda axes, x, y, height, cell: _cell(axes, x, y, height, cell, look))
    found = crossings(results, cells)
    _line(axes, found, list(columns(cells)))
    _legend(axes, cells, look, names, found, paper.dense_pairs(results))
    return figure


def _cell(axes, x, y, height, cell, look):
    """A winner is opaque; those that are as fast stand in stripes of their colours; open cells are pale and hatched."""
    names = cell.winners
    if not names:
        axes.add_patch(Rectangle((x, y), 1, height, facecolor="white", **EDGE))
        axes.text(x + 0.5, y + height / 2, "nobody", ha="center", va="center", fontsize=6.5)
        return
    shown = names if cell.settled else names[:2]
    axes.add_patch(Rectangle((x, y), 1, height, facecolor="white", linewidth=0))
    for place, name in enumerate(shown):
        axes.add_patch(Rectangle((x + place / len(shown), y), 1 / len(shown), height, linewidth=0,
                                 facecolor=look.colour(name), alpha=OPAQUE if cell.decided or cell.settled else PALE))
    axes.add_patch(Rectangle((x, y), 1, height, facecolor="none", **EDGE))
    if not (cell.decided or cell.settled):
        axes.add_patch(Rectangle((x, y), 1, height, facecolor="none", edgecolor="#555555", linewidth=0, hatch="////"))
    _text(axes, x + 0.5, y + height / 2, height, cell)


def _text(axes, x, y, height, cell):
    folder, _, variant = cell.ranking.winner.partition("/")
    lines = [f"{folder}/", variant, _margin(cell)]
    room = int(height / 2.1)
    text = "\n".join(lines if room >= 3 else [variant, lines[2]] if room == 2 else [f"{variant} {lines[2]}"])
    axes.text(x, y, text, ha="center", va="center", fontsize=min(6.6, 3.1 * height), linespacing=1.05, zorder=6,
              bbox={"boxstyle": "round,pad=0.12", "facecolor": "white", "alpha": 0.82, "linewidth": 0})


def _margin(cell):
    """"1.32×": how far the second is behind; "= 2 more" that are as fast; "? 3 more" that may be."""
    if cell.ranking.second is None:
        return "alone"
    if cell.decided:
        value = cell.ranking.margin.value
        return f"{value:.2f}×" if value < 9.95 else f"{value:.0f}×"
    return f"{'=' if cell.settled else '?'} {len(cell.winners) - 1} more"


def crossings(results, cells):
    """{size: (fill, low, high)}: from where the best dense of the paper's is faster than the best sparse library; only
    where that happens between the fills that were timed."""
    found = {}
    for size, mine in columns(cells).items():
        ratios = [best(results, cell.scene, paper.dense(results), paper.sparse(results, others=True)) for cell in mine]
        known = [(cell.fill_percent, ratio) for cell, ratio in zip(mine, ratios) if ratio]
        if len(known) > 1:
            fills = [fill for fill, _ in known]
            fill, low, high = crossing_interval(fills, [ratio for _, ratio in known])
            if fills[0] < fill < fills[-1]:
                found[size] = (fill, max(low, fills[0]), min(high, fills[-1]))
    return found


def _line(axes, found, sizes):
    for size, (fill, low, high) in found.items():
        place = sizes.index(size)
        axes.fill_between([place - 0.5, place + 0.5], low, high, color=LINE, alpha=0.12, linewidth=0, zorder=3)
        axes.plot([place - 0.5, place + 0.5], [fill, fill], color=LINE, linewidth=1.6, zorder=4,
                  path_effects=[effects.withStroke(linewidth=3, foreground="white")])


def _legend(axes, cells, look, names, crossed, pairs):
    wins = {name: [sum(cell.decided and cell.ranking.winner == name for cell in cells),
                   sum(not cell.decided and cell.settled and name in cell.winners for cell in cells),
                   sum(not cell.settled and not cell.decided and name in cell.winners for cell in cells)] for name in names}
    words = ("wins {}", "as fast in {}", "may be in {}")
    shown = [Patch(facecolor=look.colour(name), alpha=OPAQUE, label=f"{name}: " + ", ".join(
        word.format(count) for word, count in zip(words, wins[name]) if count)) for name in names if any(wins[name])]
    shown += [Patch(facecolor="#dddddd", edgecolor="#555555", hatch="////", linewidth=0,
                    label="open: two of those that may be the fastest")]
    shown += handles()
    if crossed:
        shown.append(Line2D([], [], color=LINE, linewidth=1.6, label=f"best of the paper's dense kind (on {pairs})\novertakes best sparse library; 95 % band"))
    shown += [Patch(facecolor="none", label=text) for text in ("1.32×: the second behind the winner", "= 2 more: as fast, within 5 %",
                                                              "? 2 more: may be as fast")]
    axes.legend(handles=shown, loc="upper left", bbox_to_anchor=(1.01, 1.01), fontsize=8)
