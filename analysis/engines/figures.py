# Error against time for a simulated second: each engine's Pareto front beside ours, a panel a subject.
import matplotlib.pyplot as plt
import numpy
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullFormatter

from analysis.core.outcomes import FINISHED, finished, pareto
from analysis.core.style import GREY, MARKERS, nothing
from analysis.engines.equal_error import SIDES, of_side
from analysis.engines.runs import NATIVE
from analysis.engines.subjects import subject_of

COLOURS = {"simbody": "#0072B2", "mujoco": "#D55E00", "ode": "#009E73", "bullet": "#CC79A7", "dart": "#56B4E9", "ida": "#B8860B"}
NAMES = {"simbody": "Simbody", "mujoco": "MuJoCo", "ode": "Open Dynamics Engine", "bullet": "Bullet", "dart": "DART",
         "ida": "SUNDIALS IDA"}
LINES = {"chains": {"color": "black", "linewidth": 2.2}, "fronts": {"color": "black", "linewidth": 1.4, "linestyle": (0, (4, 1.5))},
         "library": {"color": "#5B3A9E", "linewidth": 1.8}, "paper": {"color": "#8A8A00", "linewidth": 1.4, "linestyle": (0, (1, 1))}}
HEADROOM = 0.16  # share of the height that runs which lost the motion have for themselves
NOT_MADE = ("unavailable", "not-reached", "dropped")


def draw(tables, view):
    subjects = [subject_of(name) for name in dict.fromkeys(tables["ours"].subject)]
    return {name: panels(tables, [one for one in subjects if one.regular == regular], view.registry.own)
            for name, regular in (("singular", False), ("regular", True))}


def panels(tables, subjects, own):
    """The figure of some subjects."""
    if not subjects:
        return nothing("Not measured.")
    engines, ours = tables["engines"], tables["ours"].rename(columns={"implementation": "name"})
    columns = 2 if len(subjects) == 4 else min(3, len(subjects))
    lines = -(-len(subjects) // columns)
    figure, grid = plt.subplots(lines, columns, figsize=(5.2 * columns + 0.8, 4.1 * lines + 0.9), squeeze=False,
                                sharex=True, sharey=True)
    figure.subplots_adjust(left=0.12 / columns + 0.02, right=0.98, wspace=0.06, hspace=0.2)
    for axes in grid.flat[len(subjects):]:
        axes.set_axis_off()
    for place, (axes, subject) in enumerate(zip(grid.flat, subjects)):
        _panel(axes, engines[engines.subject == subject.name], ours[ours.subject == subject.name], own)
        axes.set_title(subject.title)
        axes.set(xscale="log", yscale="log")
        axes.grid(True)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(LogLocator(numticks=15))
            axis.set_minor_formatter(NullFormatter())
        if place + columns >= len(subjects):
            axes.tick_params(labelbottom=True)
            axes.set_xlabel("computation for a simulated second, s")
    low, high = numpy.log10(grid[0, 0].get_ylim())  # which all share
    grid[0, 0].set_ylim(10**low, 10**(high + HEADROOM * (high - low)))
    for axes in grid[:, 0]:
        axes.set_ylabel("largest position error, m")
    figure.legend(handles=_key(engines.engine.unique()), loc="upper center", bbox_to_anchor=(0.5, 0.1 - 0.1 / lines),
                  ncols=min(4, columns + 1), fontsize=9, handlelength=2.4)
    figure.suptitle("Error against time: engines and ours", x=0.01, y=0.97 + 0.01 * lines, ha="left", fontsize=12)
    return figure


def _panel(axes, engines, ours, own):
    for engine, rows in engines[~engines.engine.str.endswith(NATIVE)].groupby("engine", sort=False):
        place, (colour, marker) = place_of(engine), look(engine)
        done = finished(rows)
        axes.plot(done.time, done.error, linestyle="none", marker=marker, markersize=3, color=colour, alpha=0.3,
                  markeredgewidth=0)
        front = rows.loc[pareto(rows)]
        axes.plot(front.time, front.error, color=colour, marker=marker, markersize=5.5, linewidth=1.6,
                  markeredgecolor="white", markeredgewidth=0.6)
        lost = rows[~rows.status.isin((*FINISHED, *NOT_MADE)) & (rows.time > 0)]
        # A share of the height each, so that engines do not cover each other's crosses.
        axes.plot(lost.time, numpy.full(len(lost), 0.985 - 0.025 * place), "x", color=colour, markersize=4,
                  transform=axes.get_xaxis_transform(), clip_on=False)
    for side, line in LINES.items():
        rows = of_side(ours, side, own)
        front = rows.loc[pareto(rows)]
        axes.plot(front.time, front.error, **line)


def look(engine):
    return COLOURS.get(engine, GREY), MARKERS[place_of(engine) % len(MARKERS)]


def place_of(engine):
    """The same in every panel, whoever takes part in it."""
    return list(COLOURS).index(engine) if engine in COLOURS else len(COLOURS)


def title(engine):
    """ "Open Dynamics Engine, with our flags" """
    return NAMES.get(engine.removesuffix(NATIVE), engine) + (", with our flags" if engine.endswith(NATIVE) else "")


def _key(engines):
    entries = [Line2D([], [], label=f"ours: {SIDES[side]}", **line) for side, line in LINES.items()]
    for engine in sorted((one for one in engines if not one.endswith(NATIVE)), key=place_of):
        colour, marker = look(engine)
        entries.append(Line2D([], [], color=colour, marker=marker, label=f"{title(engine)}: Pareto front"))
    return [*entries, Line2D([], [], color=GREY, marker="o", markersize=3, alpha=0.4, linestyle="none",
                             label="other runs of an engine"),
            Line2D([], [], color=GREY, marker="x", linestyle="none", label="upper edge: lost the motion")]
