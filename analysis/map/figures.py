# All figures of the map.
from analysis.core.style import Look
from analysis.core.timing import TWIN
from analysis.map import dense_figure, fill_figure, maps, phases_figure, sparse_figure
from analysis.map.results import of


def draw(tables, view):
    results = of(tables, view)
    look = Look(results.registry, [name for name in results.tidy.implementation.unique() if "+" in name and not name.endswith(TWIN)])
    libraries, everyone = results.layer("libraries"), results.layer("all")
    return {"f6_map": maps.draw(results, look, "Figure 6: fastest library, 10 to 100 variables", libraries, 10, 100),
            "f7_map": maps.draw(results, look, "Figure 7: fastest library, all sizes", libraries),
            "map_all": maps.draw(results, look, "Fastest of all, code of our own included", everyone),
            "f4_sparse_solvers": sparse_figure.draw(results, look), "f5_fill": fill_figure.draw(results, look),
            "f2_dense_pairs": dense_figure.draw(results, look), "t1_phases": phases_figure.draw(results)}
