# Ratios of two settings' times, with intervals, over size: forms (saddle-point) and precisions (mixed, single).
import matplotlib.pyplot as plt

from analysis.accuracy.pairs import same_class
from analysis.core.style import number_axis, size_ticks


def draw(rows, look, title, goal):
    """The time of the second setting over the first one's; hollow where the error class is another."""
    kinds = list(dict.fromkeys(zip(rows["first"], rows["second"])))
    figure, panels = plt.subplots(1, len(kinds), figsize=(3.4 * len(kinds) + 2.8, 4.2), sharey=True,
                                  squeeze=False, constrained_layout=True)
    for axes, (first, second) in zip(panels[0], kinds):
        mine = rows[(rows["first"] == first) & (rows["second"] == second)]
        for name, one in mine.groupby("implementation", sort=False):
            _series(axes, one.sort_values("variables"), look.line(name), name)
        axes.axhline(1, color="black", linewidth=0.8)
        if goal:
            axes.axhline(1 / goal, color="black", linewidth=0.8, linestyle=(0, (4, 2)))
            axes.annotate(f"{goal:g} times faster", (0.99, 1 / goal), fontsize=8, ha="right", va="top",
                          xycoords=("axes fraction", "data"), xytext=(0, -2), textcoords="offset points")
        axes.grid(True, axis="y")
        size_ticks(axes, sorted(rows.variables.unique()))
        axes.set_title(f"{second} / {first}")
    number_axis(panels[0][0].yaxis)
    panels[0][0].set_ylabel("ratio of times of a step")
    handles = {label: handle for axes in panels[0] for handle, label in zip(*axes.get_legend_handles_labels())}
    panels[0][-1].legend(handles.values(), handles.keys(), loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=8.5)
    figure.suptitle(title, x=0.01, ha="left", fontsize=12)
    return figure


def _series(axes, rows, line, label):
    axes.plot(rows.variables, rows.ratio, **line | {"marker": "", "alpha": 0.6}, label=label)
    axes.vlines(rows.variables, rows.low, rows.high, color=line["color"], linewidth=1.4)
    same = same_class(rows)
    for chosen, face in ((rows[same], line["color"]), (rows[~same], "white")):
        axes.plot(chosen.variables, chosen.ratio, linestyle="none", marker=line["marker"],
                  color=line["color"], markerfacecolor=face, markersize=6.5)
