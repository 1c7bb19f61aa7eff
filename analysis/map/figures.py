# All figures of the map.
from analysis.core.style import Look
from analysis.map import maps, sparse_figure
from analysis.map.results import of


def draw(tables, view):
    results, look = of(tables, view), Look(view.registry)
    return {"f7_map": maps.draw(results, look, "Figure 7: fastest library over size and fill", results.layer("libraries")),
            "map_all": maps.draw(results, look, "Fastest of all, code of our own included", results.layer("all")),
            "f4_sparse_solvers": sparse_figure.draw(results, look)}
