# The grid of a map over size and fill: equal columns, a band of their own for the mechanism's own fills.
from itertools import groupby

from matplotlib.patches import Patch, Rectangle

from analysis.core.style import GREY

BAND = (-19.0, -3.0)  # where cells of own fill stand, in % of the axis above
NOTHING = {"facecolor": "white", "edgecolor": "#c4c4c4", "hatch": "...", "linewidth": 0}
EDGE = {"edgecolor": "white", "linewidth": 1.0}


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
    first = edges[:1] if own is not None else [fills[0]]
    gap = places[-1] - places[-2] if len(places) > 1 else 0.0
    return [*first, *edges[len(first) if own is not None else 0:], min(100.0, fills[-1] + gap / 2)]


def draw_grid(axes, cells, draw_cell):
    """Axes and what was not measured; draw_cell(axes, x, y, height, cell) for each cell: its lower left corner, its
    width is 1."""
    found = columns(cells)
    for place, mine in enumerate(found.values()):
        left = place - 0.5
        natural = [cell for cell in mine if cell.fill_asked is None]
        filled = [cell for cell in mine if cell.fill_asked is not None]
        own = natural[0].fill_percent if natural else None
        edges = bounds([cell.fill_percent for cell in filled], own)
        axes.add_patch(Rectangle((left, 0), 1, 100, **NOTHING))
        if own is not None:  # below the own fill there is no tangent of this mechanism
            axes.add_patch(Rectangle((left, 0), 1, own, facecolor="white", linewidth=0))
            axes.plot([left, left + 1], [own, own], color=GREY, linewidth=1.2, zorder=5)
            draw_cell(axes, left, BAND[0], BAND[1] - BAND[0], natural[0])
        for cell, low, high in zip(filled, edges, edges[1:]):
            draw_cell(axes, left, low, high - low, cell)
    axes.axhline(0, color="#444444", linewidth=0.8)
    axes.set(xlim=(-0.5, len(found) - 0.5), ylim=(BAND[0], 100))
    axes.set_yticks([sum(BAND) / 2, 0, 20, 40, 60, 80, 100], ["own\nfill", "0", "20", "40", "60", "80", "100"])
    axes.set_xticks(range(len(found)), [f"{one:g}" for one in found])
    axes.tick_params(axis="x", length=0, labelsize=9.0)
    axes.tick_params(axis="y", labelsize=9.0)
    axes.spines["bottom"].set_visible(False)
    axes.set_xlabel("variables n", fontsize=9.5)
    axes.set_ylabel("non-zeros of the tangent, % of n²", fontsize=9.5)


def handles():
    """Legend entries of what the grid itself shows."""
    return [Patch(**NOTHING, label="not measured"),
            Patch(facecolor="white", edgecolor=GREY, label="white: below the own fill (line)")]
