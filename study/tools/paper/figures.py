# The paper's figures: the study's own, at print size; and one of its own, real mechanisms with intervals.
import importlib

import matplotlib
import matplotlib.pyplot as plt
from matplotlib.gridspec import GridSpec
from matplotlib.text import Text
from matplotlib.ticker import LogLocator

from analysis.accuracy import work_figure
from analysis.core.style import GREY, SPARSE, Look, nothing
from analysis.core.text import bounded, number
from analysis.map import phases_figure
from study.tools.paper import numbers
from study.tools.paper.numbers import DENSE, HYBRID, led, profiled, real_mechanisms

TEXT = 6.69      # inches, width of the paper's text
SCALE = 0.78     # of letters and lines on paper: what figures have at 9.5 is 7.4 points
NAMED = 6        # libraries of the figure of mechanisms with marks of their own
END = 2.0        # ratio at which it ends
PHASES_OF = (DENSE, HYBRID, "csc_cholmod/supernodal", "csc_cholmod/simplicial", "csc_ldl/uplooking", "eigen_sparse/ldlt", "csc_klu/refactor",
             "compiled_ldl/fronts")
NOTHING = "Not measured in this set."
MARKS = ("o", "s", "^", "D", "v", "P")


def figures(known):
    """{name: figure}, each as wide as the paper's text"""
    matplotlib.rcParams["figure.max_open_warning"] = 0  # all of some parts, of which few are taken
    drawn = {part: importlib.import_module(f"analysis.{part}.figures").draw(known.tables(part), known.view(part)) for part in (
        "families", "map", "stability", "realtime", "engines")}
    found = {"mechanisms": (mechanisms(known), 6.3), "held": (drawn["families"]["held"], 2.2), "own_fill": (lower_notes(drawn["map"]["f4_sparse_solvers"]), 4.2),
             "map": (drawn["map"]["f7_map"], 4.6), "phases": (phases(known), None), "work": (work(known), 5.2),
             "window": (drawn["stability"].get("penalty-double") or nothing(NOTHING), 2.9), "steps": (drawn["realtime"]["steps"], 5.0),
             "own": (own(drawn["families"]["map"]), 2.6), "engines": (engines(drawn["engines"]["regular"]), 3.2)}
    return {name: fit(figure, height, known.context["cpu_model"]) for name, (figure, height) in found.items()}


def work(known):
    """Error against time of the largest four-bar, of libraries alone."""
    tables = known.tables("accuracy")
    rows = tables["points"][tables["points"].loops.notna() & tables["points"].fill_asked.isna() & tables["points"].library.fillna(False).astype(bool)]
    if rows.empty:
        return nothing(NOTHING)
    mine = rows[rows.loops == rows.loops.max()]
    won = tables["winners"][(tables["winners"].subject == mine.subject.iloc[0]) & tables["winners"].fill_asked.isna()]
    figure = work_figure.draw(mine, won, Look(known.registry), "largest of position, m", f"n = {mine.variables.max():.0f}, libraries")
    figure.delaxes(figure.axes[1])  # of all, own code included
    legend = figure.axes[0].get_legend()
    if legend:
        legend.set_bbox_to_anchor((0.5, -0.17))
    figure.set_layout_engine("none")  # which would count the legend to the axes
    return alone(figure)


def alone(figure):
    """With the one panel that is left over its whole width."""
    figure.axes[0].set_subplotspec(GridSpec(1, 1, figure=figure)[0])
    return figure


def own(figure):
    """Of the map of mechanisms the panel of our own code."""
    if len(figure.axes) > 1:
        figure.delaxes(figure.axes[0])
        libraries, families = figure.legends
        below(figure, families, 5)
        libraries.remove()
    for axes in figure.axes:
        axes.set_title("", loc="left")
    return alone(figure)


def lower_notes(figure):
    """Notes further below, as axes are lower on paper."""
    for text in figure.texts:
        text.set_y(text.get_position()[1] - 0.04)
    return figure


def below(figure, legend, columns):
    """A legend below the axes instead of beside them."""
    entries = legend.legendHandles, [text.get_text() for text in legend.get_texts()]
    legend.remove()
    figure.legend(*entries, loc="upper center", bbox_to_anchor=(0.5, -0.03), ncols=columns, fontsize=9)


def phases(known):
    """What a step of some variants consists of, and how long it takes, at the largest size that was timed phase by phase."""
    rows = profiled(known).set_index("implementation")
    if rows.empty:
        return nothing(NOTHING)
    names = [name for name in PHASES_OF if name in rows.index]
    figure, axes = plt.subplots(figsize=(8.4, 0.6 + 0.25 * len(names)))
    for place, name in enumerate(names):
        phases_figure.bar(axes, place, [(phase, 100 * share) for phase, share in numbers.phases(rows.loc[name]).items()], phases_figure.FILLS, False)
        axes.text(101, place, f"{number(rows.step_us[name])} µs", va="center", fontsize=7.5)
    axes.set_yticks(range(len(names)), names, fontsize=8.5)
    axes.set(xlim=(0, 108), ylim=(len(names) - 0.4, -0.6), xlabel=f"n = {rows.variables.max():g}: share of the time of a step, %")
    axes.set_xticks(range(0, 101, 20))
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    phases_figure.legend(axes, phases_figure.FILLS, phases_figure.LABELS)
    return figure


def engines(figure):
    """With a narrower legend, fewer ticks and one name of the time axis."""
    if not figure.legends:
        return figure
    below(figure, figure.legends[0], 3)
    panels = [axes for axes in figure.axes if axes.axison]
    for axes in panels:
        axes.xaxis.set_major_locator(LogLocator(numticks=5))
        if axes is not panels[len(panels) // 2]:
            axes.set_xlabel("")
    return figure


def mechanisms(known):
    """A line a mechanism at its own fill: each library's time over that of the fastest, with its interval. Libraries that lead
    nowhere are grey; whoever is beyond the end stands at the edge."""
    rows = known.tables("families")["scenes"]
    mine = real_mechanisms(known).sort_values("variables")
    if mine.empty:
        return nothing(NOTHING)
    rows = rows[(rows.status == "ok") & rows.implementation.isin(known.registry.libraries)].merge(mine[["scene", "scheme"]], on=["scene", "scheme"])
    chosen = list(led(mine))[:NAMED]
    figure, axes = plt.subplots(figsize=(8.4, 1.4 + min(7.2, 0.2 * len(mine))))
    places = {scene: place for place, scene in enumerate(mine.scene)}
    for name, group in rows.groupby("implementation", sort=False):
        y = group.scene.map(places) + (0.7 / len(chosen) * (chosen.index(name) - (len(chosen) - 1) / 2) if name in chosen else 0)
        inside = group[group.to_rival <= END]
        if name not in chosen:
            axes.plot(inside.to_rival, y[inside.index], "|", color="#9a9a9a", markersize=6, zorder=1)
            continue
        colour, mark = SPARSE[2 + chosen.index(name)], MARKS[chosen.index(name)]
        axes.plot(inside.to_rival, y[inside.index], mark, color=colour, markersize=5, label=name, markerfacecolor=colour if mark in "os^" else "white")
        for row in inside.itertuples():
            if bounded(row.to_rival_low, row.to_rival_high):
                axes.plot([row.to_rival_low, min(row.to_rival_high, END)], [y[row.Index]] * 2, color=colour, linewidth=1.3, alpha=0.7)
    axes.axvline(1, color=GREY, linewidth=0.9)
    axes.axvspan(1, 1.05, color="#eeeeee", zorder=0)
    for place in range(len(mine)):
        axes.axhline(place + 0.5, color="#e6e6e6", linewidth=0.6, zorder=0)
    axes.set(xlim=(0.93, END), ylim=(len(mine) - 0.4, -0.6), xlabel="time ÷ that of the fastest library; grey band: as fast, to 5 %")
    marks = {True: "", False: "  open"}
    said = mine.decided.fillna(False).astype(bool) | mine.settled.fillna(False).astype(bool)
    axes.set_yticks(range(len(mine)), [f"{row.scene}, n = {row.variables:.0f}{marks[one]}" for row, one in zip(mine.itertuples(), said)], fontsize=7.3)
    axes.plot([], [], "|", color="#9a9a9a", markersize=6, label="other libraries")
    axes.legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=4, fontsize=8.5)
    return figure


def fit(figure, height=None, machine=""):
    """Makes a figure as wide as the text, and its letters and lines as small as paper allows. `height`, inches; None: as it is. Titles
    that name the machine go: the caption says what it is."""
    if figure._suptitle:
        figure._suptitle.set_text("")
    for axes in figure.axes:
        if machine and machine in axes.get_title(loc="left"):
            axes.set_title("", loc="left")
    for text in figure.findobj(Text):
        text.set_fontsize(SCALE * text.get_fontsize())
    for line in figure.findobj(plt.Line2D):
        line.set_linewidth(SCALE * line.get_linewidth())
    for _ in range(2):  # what stands beside the axes keeps its width
        box = figure.get_tightbbox(figure.canvas.get_renderer())
        wide, high = figure.get_size_inches()
        figure.set_size_inches(max(2.5, wide + TEXT - box.width), high + (height - box.height if height else 0))
    return figure
