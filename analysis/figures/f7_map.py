# The paper's Figure 7: the fastest implementation over all sizes, to 1000 variables and beyond.
import matplotlib.pyplot as plt

from analysis.maps import map_cells
from analysis.maps_drawing import (KEY, crossing_handle, draw_crossings, draw_winners, never,
                                   region_handles, winner_handles)
from analysis.style import GREY, Look, figure_main, missing


def draw(results):
    return draw_map(results, "Fastest implementation over size and fill, all sizes")


def draw_map(results, title, smallest=0, largest=float("inf")):
    """The map of the sizes from `smallest` to `largest` variables."""
    look, names = Look(results), results.implementations
    cells = [cell for cell in map_cells(results) if smallest <= cell.variables <= largest]
    count = len({cell.variables for cell in cells})
    figure, axes = plt.subplots(figsize=(max(5.0, 1.0 + (1.0 if count < 9 else 0.85) * count), 7.0))
    axes.set_title(title)
    if not cells:
        missing(axes, "no cell of these sizes was measured")
        return figure
    draw_winners(axes, cells, look)
    dense = {name: bool(variant.get("dense")) for name, variant in results.variants.items()}
    crossed = draw_crossings(axes, cells, dense)
    axes.set(xlabel="variables n", ylabel="non-zeros in the tangent matrix, % of n²")
    _legend(axes, cells, look, names, crossed)
    return figure


def _legend(axes, cells, look, names, crossed):
    handles = winner_handles(cells, look, names) + region_handles() + [crossing_handle(crossed)]
    axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.01, 1.01), fontsize=8.5)
    nowhere = never(cells, look, names)
    text = KEY + (f"\n\nnowhere first or second:\n{nowhere}" if nowhere else "")
    axes.text(1.03, 0.0, text, transform=axes.transAxes, fontsize=7.5, color=GREY, va="bottom")


if __name__ == "__main__":
    figure_main(draw)
