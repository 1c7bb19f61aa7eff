# Maps of the fastest over size and fill: the paper's Figures 6 and 7, for libraries and for all.
import re
import textwrap
from itertools import groupby

import matplotlib.patheffects as effects
import matplotlib.pyplot as plt
import numpy
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from analysis.core.style import GREY, missing
from analysis.map import paper
from analysis.map.cells import map_cells
from analysis.map.compare import best

LINE = "#111111"
OPAQUE, PALE = 0.85, 0.4
BAND = (-19.0, -3.0)  # where cells of own fill stand, in % of the axis above
NOTHING = {"facecolor": "white", "edgecolor": "#c4c4c4", "hatch": "...", "linewidth": 0}
LETTERS = 46  # in a line of the legend
EDGE = {"edgecolor": "white", "linewidth": 1.0}


def draw(results, look, title, names, letters=13, line=2.1):
    """The map of some contenders. A cell has `letters` in a line of text, which is `line` % of the axis high."""
    cells = map_cells(results, names)
    count = len(columns(cells))
    figure, axes = plt.subplots(figsize=(max(5.0, 0.9 + 1.02 * count), 7.4))
    axes.set_title(title)
    if not any(cell.ranking for cell in cells):
        missing(axes, "nobody of these was timed")
        return figure
    found = crossings(results, cells)
    for place, (size, mine) in enumerate(columns(cells).items()):
        _column(axes, place - 0.5, mine, look, (letters, line))
        if size in found:
            fill, low, high = found[size]
            axes.fill_between([place - 0.5, place + 0.5], low, high, color=LINE, alpha=0.12, linewidth=0, zorder=3)
            axes.plot([place - 0.5, place + 0.5], [fill, fill], color=LINE, linewidth=1.6, zorder=4,
                      path_effects=[effects.withStroke(linewidth=3, foreground="white")])
    axes.axhline(0, color="#444444", linewidth=0.8)
    axes.set(xlim=(-0.5, count - 0.5), ylim=(BAND[0], 100))
    axes.set_yticks([sum(BAND) / 2, 0, 20, 40, 60, 80, 100], ["own\nfill", "0", "20", "40", "60", "80", "100"])
    axes.set_xticks(range(count), [f"{one:g}" for one in columns(cells)])
    axes.tick_params(axis="x", length=0, labelsize=9.0)
    axes.tick_params(axis="y", labelsize=9.0)
    axes.spines["bottom"].set_visible(False)
    axes.set_xlabel("variables n", fontsize=9.5)
    axes.set_ylabel("non-zeros of the tangent, % of n²", fontsize=9.5)
    _legend(axes, cells, look, names, found, paper.dense_pairs(results))
    return figure


def columns(cells):
    """{size: its cells by ascending fill}."""
    return {size: list(mine) for size, mine in groupby(cells, key=lambda cell: cell.variables)}


def bounds(fills, own):
    """Lower edge of each cell of artificial fill and the last one's upper edge, %: neighbours meet half-way, the first
    begins half-way to the own fill, the last ends half the last gap above. Nothing is claimed of fills beyond."""
    if not fills:
        return []
    places = [own, *fills] if own is not None else fills
    edges = [(low + high) / 2 for low, high in zip(places, places[1:])]
    gap = places[-1] - places[-2] if len(places) > 1 else 0.0
    return [*(edges if own is not None else [fills[0], *edges]), min(100.0, fills[-1] + gap / 2)]


def _column(axes, left, cells, look, room):
    """The cells of a size, and what was not measured."""
    natural = [cell for cell in cells if cell.fill_asked is None]
    filled = [cell for cell in cells if cell.fill_asked is not None]
    own = natural[0].fill_percent if natural else None
    edges = bounds([cell.fill_percent for cell in filled], own)
    axes.add_patch(Rectangle((left, 0), 1, 100, **NOTHING))
    if own is not None:  # below the own fill there is no tangent of this mechanism
        axes.add_patch(Rectangle((left, 0), 1, own, facecolor="white", linewidth=0))
        axes.plot([left, left + 1], [own, own], color=GREY, linewidth=1.2, zorder=5)
        _cell(axes, left, BAND[0], BAND[1] - BAND[0], natural[0], look, room)
    for cell, low, high in zip(filled, edges, edges[1:]):
        _cell(axes, left, low, high - low, cell, look, room)


def _cell(axes, x, y, height, cell, look, room):
    """Nothing where nobody was timed. A winner is opaque; those that are as fast stand in stripes of their colours; open cells are pale and hatched."""
    names = cell.winners
    if not names:
        return
    shown = names if cell.settled else names[:2]
    axes.add_patch(Rectangle((x, y), 1, height, facecolor="white", linewidth=0))
    for place, name in enumerate(shown):
        axes.add_patch(Rectangle((x + place / len(shown), y), 1 / len(shown), height, linewidth=0,
                                 facecolor=look.colour(name), alpha=OPAQUE if cell.decided or cell.settled else PALE))
    axes.add_patch(Rectangle((x, y), 1, height, facecolor="none", **EDGE))
    if not (cell.decided or cell.settled):
        axes.add_patch(Rectangle((x, y), 1, height, facecolor="none", edgecolor="#555555", linewidth=0, hatch="////"))
    _text(axes, x + 0.5, y + height / 2, height, cell, room)


def _text(axes, x, y, height, cell, room):
    letters, line = room
    name, lines = broken(cell.ranking.winner, letters), int(height / line)
    short = [*broken(cell.ranking.winner.partition("/")[2], letters), _margin(cell)]
    fitting = next((one for one in ([*name, _margin(cell)], short) if len(one) <= lines), [" ".join(short)])
    axes.text(x, y, "\n".join(fitting), ha="center", va="center", fontsize=min(6.6, 6.5 * height / line), linespacing=1.15, zorder=6,
              bbox={"boxstyle": "round,pad=0.12", "facecolor": "white", "alpha": 0.82, "linewidth": 0})


def broken(name, letters):
    """A name in lines of at most so many letters: ["csc_ldl/", "uplooking"]."""
    lines = [""]
    for piece in re.findall(r"[^_/]+[_/]?", name):
        if lines[-1] and len(lines[-1] + piece) > letters:
            lines.append("")
        lines[-1] += piece
    return lines


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
            fill, low, high = (crossing(fills, [getattr(ratio, end) for _, ratio in known]) for end in ("value", "low", "high"))
            if fills[0] < fill < fills[-1]:
                found[size] = (fill, max(low, fills[0]), min(high, fills[-1]))
    return found


def crossing(places, values):
    """Where `values` (ratios) first fall below 1, log values interpolated over `places`; -inf if they are below from
    the start, inf if nowhere."""
    with numpy.errstate(divide="ignore"):  # of a single process an interval reaches from 0 to infinity
        logs = numpy.log(values)
    if logs[0] < 0:
        return -numpy.inf
    for left, right, before, after in zip(places, places[1:], logs, logs[1:]):
        if after < 0:
            return left + (right - left) * before / (before - after)
    return numpy.inf


def _legend(axes, cells, look, names, crossed, pairs):
    wins = {name: [sum(cell.decided and cell.ranking.winner == name for cell in cells),
                   sum(not cell.decided and cell.settled and name in cell.winners for cell in cells),
                   sum(not cell.settled and not cell.decided and name in cell.winners for cell in cells)] for name in names}
    words = ("wins {}", "as fast in {}", "may be in {}")
    drawn = {name for cell in cells for name in (cell.winners if cell.settled else cell.winners[:2])}
    shown = [Patch(facecolor=look.colour(name), alpha=OPAQUE, label=f"{name}: " + ", ".join(
        word.format(count) for word, count in zip(words, wins[name]) if count)) for name in names if name in drawn]
    more = sum(any(wins[name]) and name not in drawn for name in names)
    shown += [Patch(facecolor="none", label=f"{more} more may be the fastest of an open cell")] if more else []
    shown += [Patch(facecolor="#dddddd", edgecolor="#555555", hatch="////", linewidth=0,
                    label="open: two of those that may be the fastest")]
    shown += [Patch(**NOTHING, label="not measured"), Patch(facecolor="white", edgecolor=GREY, label="white: below the own fill (line)")]
    if crossed:
        shown.append(Line2D([], [], color=LINE, linewidth=1.6, label=textwrap.fill(
            f"best of the paper's dense kind (on {pairs}) overtakes best sparse library; 95 % band", LETTERS)))
    shown += [Patch(facecolor="none", label=text) for text in ("1.32×: the second behind the winner", "= 2 more: as fast, within 5 %",
                                                              "? 2 more: may be as fast")]
    axes.legend(handles=shown, loc="upper left", bbox_to_anchor=(1.01, 1.01), fontsize=8)
