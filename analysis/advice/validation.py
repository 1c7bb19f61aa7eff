# How good the advice is: its exact errors over what was asked, its time over the best that was found.
import matplotlib.pyplot as plt
from matplotlib.ticker import NullLocator

from analysis.advice.figure import write  # noqa: F401 (both figures are written the same way)
from analysis.style import MARKERS, SPARSE


def verdict(table, most):
    """(whether all held, a sentence)."""
    missed = table[~table.meets]
    slow = table[~(table.ratio <= most)]
    worst = table.ratio.max()
    held = missed.empty and slow.empty
    failed = table[~table.meets | ~(table.ratio <= most)]
    named = [f"{row.scene} at {row.error:g} m" for row in failed.itertuples()]
    return held, (f"{len(table) - len(missed)} of {len(table)} advised runs are as accurate as asked; "
                  f"{len(table) - len(slow)} take at most {most:g} times the best found, the slowest "
                  f"{worst:.2f}"
                  + ("" if held else f"; not so: {', '.join(named)}"))


def draw(table, most):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.5, 4.2), constrained_layout=True)
    scenes = list(dict.fromkeys(table.scene))
    for place, scene in enumerate(scenes):
        rows = table[table.scene == scene].sort_values("error")
        look = {"color": SPARSE[place], "marker": MARKERS[place], "markersize": 6}
        left.plot(rows.error, rows.exact / rows.error, label=scene, **look)
        left.plot(rows.error, rows.estimate / rows.error, linestyle="none", markerfacecolor="white",
                  **{key: value for key, value in look.items()})
        right.plot(rows.error, rows.ratio, label=scene, **look)
        right.vlines(rows.error, rows.advised_low / rows.best_us_per_second,
                     rows.advised_high / rows.best_us_per_second, color=SPARSE[place], linewidth=0.8)
    left.plot([], [], "o", markerfacecolor="white", markeredgecolor="#777777", label="estimate")
    left.axhline(1.0, color="black", linewidth=1.0)
    right.axhline(most, color="black", linewidth=1.0)
    right.axhline(1.0, color="#777777", linewidth=0.8)
    left.set_ylabel("error of the advised run ÷ asked error")
    left.set_title("Is it as accurate as asked? (below 1)")
    right.set_ylabel("time of the advised run ÷ best found")
    right.set_title(f"Is it as fast as can be? (at most {most:g})")
    left.set_ylim(bottom=0)
    right.set_ylim(0, max(1.6, 1.1 * table.ratio.max(skipna=True)))
    for axes in (left, right):
        axes.set_xscale("log")
        axes.invert_xaxis()
        axes.set_xticks(sorted(set(table.error)), [f"{error:g}" for error in sorted(set(table.error))])
        axes.xaxis.set_minor_locator(NullLocator())
        axes.set_xlabel("asked error E, m")
        axes.grid(True, axis="y")
    handles, _ = left.get_legend_handles_labels()
    figure.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=len(handles), fontsize=8.5)
    return figure
