# What each piece of modelling costs and buys: time ratio and error, beside the plain model.
import matplotlib.pyplot as plt
import numpy

from analysis.scenes.tables import PLAIN, costs
from analysis.style import GREY, missing

COLOURS = {0: "#0072B2", 1: "#009E73", 2: "#D55E00", 3: "#CC79A7"}


def draw(modelling):
    rows = costs(modelling)
    sizes = sorted({row["loops"] for row in rows})
    if not rows:
        figure, axes = plt.subplots(figsize=(8, 2))
        missing(axes, "modelling was not measured")
        return figure
    names = list(dict.fromkeys(row["implementation"] for row in rows))
    cases = [case for case in dict.fromkeys(row["case"] for row in rows)]
    order = [PLAIN] + [case for case in cases if case != PLAIN]
    figure, panels = plt.subplots(1, 2 * len(sizes), figsize=(4.1 * 2 * len(sizes) * 0.72, 0.42 *
                                  len(order) + 1.3), sharey=True, constrained_layout=True)
    for place, loops in enumerate(sizes):
        time_axes, error_axes = panels[2 * place], panels[2 * place + 1]
        of_size = {(row["implementation"], row["case"]): row for row in rows
                   if row["loops"] == loops}
        for number, name in enumerate(names):
            offset = (number - (len(names) - 1) / 2) * 0.22
            for line, case in enumerate(order):
                row = of_size.get((name, case))
                if row is None:
                    continue
                if row["status"] != "ok":
                    time_axes.annotate(row["status"], (1, line + offset), (6, 0), va="center",
                                       textcoords="offset points", fontsize=7,
                                       color=COLOURS[number % len(COLOURS)])
                    continue
                at, colour = line + offset, COLOURS[number % len(COLOURS)]
                whole = row["piece"] == "output"
                ratio, low, high = row["run"] if whole else row["step"]
                time_axes.plot([low, high], [at, at], color=colour, linewidth=1.2, alpha=0.6)
                time_axes.plot(ratio, at, "D" if whole else "o", color=colour, markersize=5,
                               label=name if line == 0 else None)
                if numpy.isfinite(row["error"]):
                    error_axes.plot(row["error"], at, "o", color=colour, markersize=5)
        variables = of_size[names[0], PLAIN]["variables"]
        time_axes.set_title(f"N = {loops}, n = {variables}: time")
        time_axes.set_xlabel("ratio to plain")
        time_axes.axvline(1, color=GREY, linewidth=0.8)
        time_axes.set_xscale("log")
        ticks = [t for t in (0.5, 0.7, 1, 1.5, 2, 3, 5, 7, 10, 20)
                 if time_axes.get_xlim()[0] <= t <= time_axes.get_xlim()[1]]
        time_axes.set_xticks(ticks, [f"{t:g}" for t in ticks])
        time_axes.minorticks_off()
        error_axes.set_title("error")
        error_axes.set_xlabel("largest position error of B0, m")
        error_axes.set_xscale("log")
        for axes in (time_axes, error_axes):
            axes.grid(axis="x")
            axes.set_axisbelow(True)
            axes.set_ylim(len(order) - 0.5, -0.5)
    panels[0].set_yticks(range(len(order)), order)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="upper center",
                  bbox_to_anchor=(0.5, 0.0), ncols=len(names), fontsize=9)
    return figure
