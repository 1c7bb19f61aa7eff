# Ratios of two settings' times, with intervals, over size: forms (saddle-point) and precisions (mixed, single).
import matplotlib.pyplot as plt

from analysis.style import legend, number_axis, size_ticks

GAIN = 1.2  # the speed-up that is asked of lower precision


def draw(table, look, title, goal=None):
    """The time of the second setting over the first one's; hollow where the error class is another."""
    kinds = list(dict.fromkeys(zip(table["first"], table["second"])))
    figure, panels = plt.subplots(1, len(kinds), figsize=(4.2 * len(kinds) + 2.6, 4.2), sharey=True,
                                  squeeze=False, constrained_layout=True)
    for axes, (first, second) in zip(panels[0], kinds):
        rows = table[(table["first"] == first) & (table["second"] == second) & table.ratio.notna()]
        for name, mine in rows.groupby("implementation", sort=False):
            _series(axes, mine.assign(ratio=1 / mine.ratio, low=1 / mine.high, high=1 / mine.low),
                    look.line(name), name)
        axes.axhline(1, color="black", linewidth=0.8)
        if goal:
            axes.axhline(1 / goal, color="black", linewidth=0.8, linestyle=(0, (4, 2)))
            axes.annotate(f"{goal:g} times faster", (0.99, 1 / goal), fontsize=8, ha="right", va="top",
                          xycoords=("axes fraction", "data"), xytext=(0, -2), textcoords="offset points")
        axes.set_yscale("log")
        axes.grid(True, axis="y")
        size_ticks(axes, sorted(rows.variables.unique()))
        axes.set_title(f"{second} / {first}")
    number_axis(panels[0][0].yaxis)
    panels[0][0].set_ylabel("ratio of times of a step")
    legend(panels[0][-1])
    figure.suptitle(title, x=0.01, ha="left", fontsize=12)
    return figure


def _series(axes, rows, line, label):
    axes.plot(rows.variables, rows.ratio, **line | {"marker": "", "alpha": 0.6}, label=label)
    axes.vlines(rows.variables, rows.low, rows.high, color=line["color"], linewidth=1.4)
    same = same_class(rows)
    for chosen, face in ((rows[same], line["color"]), (rows[~same], "white")):
        axes.plot(chosen.variables, chosen.ratio, linestyle="none", marker=line["marker"],
                  color=line["color"], markerfacecolor=face, markersize=6.5)


def gains(table, goal=GAIN):
    """Rows in which the second setting is at least `goal` times faster with the same error class, by the lower
    end of the interval."""
    return table[same_class(table) & (table.low >= goal)]


def same_class(table):
    """Whether both errors are known and in the same class."""
    return (table.first_class == table.second_class) & table.first_class.notna()
