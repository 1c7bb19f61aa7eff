# The picture of study/merge: whom to take on each mechanism, and where that depends on the machine.
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from analysis.core.style import Look, number_axis


def mechanisms(agreed, features, registry):
    """A mark a mechanism, by size and non-zeros a column of its factor, in the colour of the library that loses least on the machine where it
    is worst; hatched where no library is among the best on all machines. `features`: rows of families/mechanisms.csv by scene."""
    look, shown = Look(registry), {}
    figure, axes = plt.subplots(figsize=(8.6, 5.4))
    for one in filter(lambda one: one.robust, agreed):
        known, colour = features.loc[one.question.scene], look.colour(one.robust)
        shown[one.robust] = colour
        differs = one.verdict == "differs"
        axes.scatter(known.n, known.per_column, s=70, facecolor="white" if differs else colour, edgecolor=colour, hatch="/////" if differs else None)
    for axis in (axes.xaxis, axes.yaxis):
        number_axis(axis)
    axes.set(xlabel="variables n", ylabel="non-zeros a column of the factor L (AMD's order)", title="The library that loses least on the machine where it is worst")
    axes.grid(True, which="major")
    axes.set_axisbelow(True)
    handles = [Line2D([], [], marker="o", linestyle="none", markersize=8, color=colour, label=name) for name, colour in sorted(shown.items())]
    hatched = Patch(facecolor="white", edgecolor="#444444", hatch="/////", label="depends on the machine")
    axes.legend(handles=[*handles, hatched], loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=8.5)
    return figure
