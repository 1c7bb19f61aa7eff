# Error against time for a simulated second: each engine's Pareto front beside ours, a panel a subject.
import numpy
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator

from analysis.core.outcomes import FINISHED, finished, pareto
from analysis.core.style import GREY, MARKERS, below, nothing, panels
from analysis.engines.equal_error import SIDES, of_side
from analysis.engines.runs import NATIVE
from analysis.engines.subjects import subject_of

COLOURS = {"simbody": "#0072B2", "mujoco": "#D55E00", "ode": "#009E73", "bullet": "#CC79A7", "dart": "#56B4E9", "ida": "#B8860B"}
NAMES = {"simbody": "Simbody", "mujoco": "MuJoCo", "ode": "Open Dynamics Engine", "bullet": "Bullet", "dart": "DART", "ida": "SUNDIALS IDA"}
LINES = {"chains": {"color": "black", "linewidth": 2.2}, "fronts": {"color": "black", "linewidth": 1.4, "linestyle": (0, (4, 1.5))},
         "library": {"color": "#5B3A9E", "linewidth": 1.8}, "paper": {"color": "#8A8A00", "linewidth": 1.4, "linestyle": (0, (1, 1))}}
HEADROOM = 0.16  # share of the height that runs which lost the motion have for themselves
NOT_MADE = ("unavailable", "not-reached", "dropped")


def draw(tables, view):
    subjects = [subject_of(name) for name in dict.fromkeys(tables["ours"].subject)]
    return {name: one_figure(tables, [one for one in subjects if one.regular == regular], view.registry.own)
            for name, regular in (("singular", False), ("regular", True))}


def one_figure(tables, subjects, own):
    if not subjects:
        return nothing("Not measured.")
    engines, ours = tables["engines"], tables["ours"].rename(columns={"implementation": "name"})
    figure, grid = panels(len(subjects), 2 if len(subjects) == 4 else 3, 5.2, 4.1, "Error against time: engines and ours",
                          "computation for a simulated second, s", "largest position error, m")
    for axes, subject in zip(grid, subjects):
        _panel(axes, engines[engines.subject == subject.name], ours[ours.subject == subject.name], own)
        axes.set(title=subject.title, xscale="log", yscale="log")
        axes.grid(True)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(LogLocator(numticks=15))
    low, high = numpy.log10(grid[0].get_ylim())  # which all share
    grid[0].set_ylim(10**low, 10**(high + HEADROOM * (high - low)))
    below(figure, 4, [*_key(engines.engine.unique())])
    return figure


def _panel(axes, engines, ours, own):
    for engine, rows in engines[~engines.engine.str.endswith(NATIVE)].groupby("engine", sort=False):
        place, (colour, marker) = place_of(engine), look(engine)
        done = finished(rows)
        axes.plot(done.time, done.error, linestyle="none", marker=marker, markersize=3, color=colour, alpha=0.3, markeredgewidth=0)
        front = rows.loc[pareto(rows)]
        axes.plot(front.time, front.error, color=colour, marker=marker, markersize=5.5, linewidth=1.6, markeredgecolor="white", markeredgewidth=0.6)
        lost = rows[~rows.status.isin((*FINISHED, *NOT_MADE)) & (rows.time > 0)]
        # A share of the height each, so that engines do not cover each other's crosses.
        axes.plot(lost.time, numpy.full(len(lost), 0.985 - 0.025 * place), "x", color=colour, markersize=4,
                  transform=axes.get_xaxis_transform(), clip_on=False, in_layout=False)
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
    yield from (Line2D([], [], label=f"ours: {SIDES[side]}", **line) for side, line in LINES.items())
    for engine in sorted((one for one in engines if not one.endswith(NATIVE)), key=place_of):
        colour, marker = look(engine)
        yield Line2D([], [], color=colour, marker=marker, label=f"{title(engine)}: Pareto front")
    yield Line2D([], [], color=GREY, marker="o", markersize=3, alpha=0.4, linestyle="none", label="other runs of an engine")
    yield Line2D([], [], color=GREY, marker="x", linestyle="none", label="upper edge: lost the motion")
