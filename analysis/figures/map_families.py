# The map of fastest implementations again, for those only that a reader may or would use.
import matplotlib.pyplot as plt
from matplotlib.patches import Patch

from analysis import paper
from analysis.maps import map_cells
from analysis.maps_drawing import (DECIDED, KEY, crossing_handle, draw_crossings, draw_winners,
                                   region_handles)
from analysis.style import Look, figure_main, missing

MANY = 10  # columns from which the panels stand below one another


def families(results):
    """{title: names}, in the order of the panels."""
    variants = {name: results.variants[name] for name in results.implementations}

    def those(condition):
        return [name for name, variant in variants.items() if condition(variant)]
    return {"all implementations": list(variants),
            "solvers from libraries, without the starting and unoptimised versions":
                those(_from_library),
            "for symmetric tangents only": those(lambda variant: not variant.get("unsymmetric")),
            "those that take unsymmetric tangents":
                those(lambda variant: bool(variant.get("unsymmetric")))}


def _from_library(variant):
    library = (variant.get("library") or "none").lower()
    baseline = paper.starting(variant["folder"]) or variant["folder"] == paper.NOT_OPTIMISED
    return library != "none" and not baseline


def draw(results):
    look, groups = Look(results), families(results)
    cells = {title: map_cells(results, names) for title, names in groups.items()}
    count = len({cell.variables for of_group in cells.values() for cell in of_group})
    across = 1 if count > MANY else 2
    down = -(-len(groups) // across)
    figure, panels = plt.subplots(down, across, squeeze=False, layout="constrained",
                                  figsize=(across * max(4.4, 0.8 + 0.62 * count), 3.9 * down))
    figure.suptitle("Fastest implementation over size and fill, family by family", x=0.01,
                    ha="left")
    dense = {name: bool(variant.get("dense")) for name, variant in results.variants.items()}
    crossed = False
    for axes, (title, names) in zip(panels.flat, groups.items()):
        _panel(axes, title, names, cells[title], look)
        crossed |= draw_crossings(axes, cells[title], dense)
    _legend(figure, cells, look, results.implementations, crossed)
    return figure


def _panel(axes, title, names, cells, look):
    axes.set_title(f"{title} ({len(names)})", fontsize=9.5)
    if not names:
        missing(axes, "nobody of this family is in these results")
        return
    if not cells:
        missing(axes, "no cell was measured")
        return
    draw_winners(axes, cells, look, small=True)
    axes.set_xlabel("variables n", fontsize=8.5)
    axes.set_ylabel("non-zeros in the tangent, %", fontsize=8.5)
    axes.tick_params(labelsize=8)
    if len(names) == 1:
        axes.text(0.5, 0.97, f"one member only, {names[0]}: nothing is compared", zorder=8,
                  transform=axes.transAxes, ha="center", va="top", fontsize=8.5,
                  bbox={"facecolor": "white", "linewidth": 0, "alpha": 0.9})


def _legend(figure, cells, look, names, crossed):
    ranked = [cell.ranking for of_group in cells.values() for cell in of_group if cell.ranking]
    shown = {name for ranking in ranked for name in (ranking.winner, ranking.second)}
    handles = [Patch(facecolor=look.colour(name), alpha=DECIDED,
                     label=f"{look.letter(name)}  {name}") for name in names if name in shown]
    handles += region_handles() + [crossing_handle(crossed)]
    handles += [Patch(facecolor="none", label=line) for line in KEY.splitlines()]
    wide = figure.get_figwidth()
    figure.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0),
                  ncol=max(1, int(wide / 2.9)), fontsize=8.5)


if __name__ == "__main__":
    figure_main(draw)
