# Time and error of each way of modelling, beside the plain model.
import matplotlib.pyplot as plt
import numpy

from analysis.core.style import ALTERNATIVES, GREY, MARKERS, line_each, nothing, number_axis


def draw(tables, view):
    return {"modelling": modelling(tables["modelling"])}


def modelling(table):
    """Two panels a size: the time of a step as a ratio with its interval, and the error of the motion."""
    sizes, names = sorted(table.loops.unique()), list(dict.fromkeys(table.implementation))
    cases = list(dict.fromkeys(table.case))
    if not cases:
        return nothing("modelling was not measured", (8, 2))
    figure, panels = plt.subplots(1, 2 * len(sizes), sharey=True, squeeze=False, constrained_layout=True,
                                  figsize=(3.2 * 2 * len(sizes) + 1.6, 0.42 * len(cases) + 1.5))
    for place, loops in enumerate(sizes):
        time_axes, error_axes = panels[0][2 * place:2 * place + 2]
        for number, name in enumerate(names):
            colour, marker = ALTERNATIVES[number % len(ALTERNATIVES)], MARKERS[number]
            for line, case in enumerate(cases):
                at = line + (number - (len(names) - 1) / 2) * 0.24
                for row in table[(table.loops == loops) & (table.implementation == name) & (table.case == case)].itertuples():
                    if numpy.isfinite(row.ratio):
                        ends = [end for end in (row.ratio_low, row.ratio_high) if 0 < end < numpy.inf]
                        time_axes.plot(ends, [at] * len(ends), color=colour, linewidth=1.2, alpha=0.6)
                        time_axes.plot(row.ratio, at, marker, color=colour, markersize=5, label=name if line == 0 else None)
                    if numpy.isfinite(row.position_error):
                        error_axes.plot(row.position_error, at, marker, color=colour, markersize=5)
                    else:
                        error_axes.annotate(row.status, (0.03, at), xycoords=error_axes.get_yaxis_transform(), va="center",
                                            fontsize=7, color=colour)
        variables = table[table.loops == loops].variables.min()
        time_axes.set_title(f"N = {loops:.0f}, n = {variables:.0f}: time")
        time_axes.set_xlabel("time of a step, ratio to plain")
        time_axes.axvline(1, color=GREY, linewidth=0.8)
        error_axes.set_title("error")
        error_axes.set_xlabel("largest position error of B0, m")
        for axes in (time_axes, error_axes):
            axes.set_xscale("log")
            line_each(axes, cases)
        number_axis(time_axes.xaxis, "×")
    handles = {label: handle for row in panels[0] for handle, label in zip(*row.get_legend_handles_labels())}
    figure.legend(handles.values(), handles.keys(), loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=len(names), fontsize=9)
    return figure
