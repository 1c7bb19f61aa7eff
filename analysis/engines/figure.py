# Error against time per simulated second: each engine's Pareto front beside ours, a panel for each subject.
import matplotlib.pyplot as plt
import numpy
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullFormatter

from analysis.accuracy.front import FINISHED, finished, pareto
from analysis.engines.equal_error import of_scope
from analysis.style import GREY, MARKERS

COLOURS = {"simbody": "#0072B2", "mujoco": "#D55E00", "ode": "#009E73", "bullet": "#CC79A7"}
NAMES = {"simbody": "Simbody", "mujoco": "MuJoCo", "ode": "Open Dynamics Engine", "bullet": "Bullet"}
OURS = {"all": {"color": "black", "linewidth": 2.4, "label": "ours, every scheme and setting"},
        "paper": {"color": "black", "linewidth": 1.5, "linestyle": (0, (4, 1.5)),
                  "label": "ours, the paper's scheme alone"}}


def draw(engines, ours, titles):
    """The figure of the subjects in `titles` ({subject: title}), from rows of engines.csv and work.csv."""
    columns = 4 if len(titles) in (4, 7, 8) else min(3, len(titles))  # no panel is alone in its line
    lines = -(-len(titles) // columns)
    figure, panels = plt.subplots(lines, columns, figsize=(min(5.2 * columns, 17.5), 4.1 * lines + 0.7), squeeze=False,
                                  sharex=True, sharey=True)
    figure.subplots_adjust(wspace=0.06, hspace=0.2)
    for axes in panels.flat[len(titles):]:
        axes.set_axis_off()
    for axes, (subject, title) in zip(panels.flat, titles.items()):
        _panel(axes, engines[engines.subject == subject], ours[ours.subject == subject])
        axes.set_title(title)
    for axes in panels.flat[:len(titles)]:
        axes.set(xscale="log", yscale="log")
        axes.grid(True)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(LogLocator(numticks=15))
            axis.set_minor_formatter(NullFormatter())
        axes.tick_params(labelbottom=True)
    for axes in panels[:, 0]:
        axes.set_ylabel("largest position error, m")
    for axes in panels.flat[max(0, len(titles) - columns):len(titles)]:  # the lowest of each column
        axes.set_xlabel("computation for a simulated second, s")
    _key(figure, engines.engine.unique(), lines)
    return figure


def _panel(axes, engines, ours):
    for place, (engine, rows) in enumerate(engines.groupby("engine", sort=False)):
        colour, marker = look(engine, place)
        done = finished(rows)
        axes.plot(done.time, done.error, linestyle="none", marker=marker, markersize=3, color=colour, alpha=0.3,
                  markeredgewidth=0)
        front = rows.loc[pareto(rows)]
        axes.plot(front.time, front.error, color=colour, marker=marker, markersize=5.5, linewidth=1.6,
                  markeredgecolor="white", markeredgewidth=0.6)
        lost = rows[~rows.status.isin((*FINISHED, "not-run", "unavailable")) & (rows.time > 0)]
        # A share of the height each, so that engines do not cover each other's crosses.
        axes.plot(lost.time, numpy.full(len(lost), 0.985 - 0.025 * place), "x", color=colour, markersize=4,
                  transform=axes.get_xaxis_transform(), clip_on=False)
    for scope, line in OURS.items():
        rows = of_scope(ours, scope)
        front = rows.loc[pareto(rows)]
        axes.plot(front.time, front.error, **line)


def look(engine, place):
    return COLOURS.get(engine, GREY), MARKERS[place % len(MARKERS)]


def _key(figure, engines, lines):
    entries = [Line2D([], [], **line) for line in OURS.values()]
    for place, engine in enumerate(engines):
        colour, marker = look(engine, place)
        entries.append(Line2D([], [], color=colour, marker=marker, label=f"{NAMES.get(engine, engine)}: Pareto front"))
    entries += [Line2D([], [], color=GREY, marker="o", markersize=3, alpha=0.4, linestyle="none",
                       label="other runs of an engine"),
                Line2D([], [], color=GREY, marker="x", linestyle="none",
                       label="upper edge: lost the motion (status in engines.csv)")]
    figure.legend(handles=entries, loc="upper center", bbox_to_anchor=(0.5, 0.1 - 0.1 / lines), ncols=4,
                  fontsize=9, handlelength=2.4)
