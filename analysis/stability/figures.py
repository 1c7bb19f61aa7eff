# Maps: one a scheme and precision, a panel a size; outcome and error over step and penalty factor.
import matplotlib.pyplot as plt
import numpy
from matplotlib.colors import LogNorm
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import NullLocator

from analysis.core.style import GREY, missing

HATCHES = {"not-converged": ("#ffffff", "////"), "diverged": ("#e4e4e4", ""),
           "wrong-branch": ("#ffffff", "xxxx"), "timeout": ("#ffffff", "----"),
           "other failure": ("#ffffff", "++++")}
DRAWN = ("ok", "degraded")           # these have a colour
ERRORS = LogNorm(1e-6, 1e-1)
COLOURS = plt.get_cmap("viridis_r")
PAPER = (1.25e-3, 1e8)               # step (s), penalty factor
LINES = {  # of windows.csv and, "automatic", of the runs that asked for it
    "lower": {"color": "#D55E00", "linestyle": (0, (5, 1.5)), "label": "estimated lower end"},
    "upper": {"color": "#D55E00", "linestyle": (0, (1, 1)), "label": "estimated upper end"},
    "automatic": {"color": "black", "linestyle": "-", "label": "automatic α"}}


def draw(tables, view):
    maps = tables["maps"][tables["maps"].status != "dropped"]
    return {f"{scheme}-{precision}": one_map(maps, tables["windows"], scheme, precision)
            for scheme, precision in dict.fromkeys(zip(maps.scheme, maps.precision))}


def one_map(table, windows, scheme, precision):
    """The figure of the rows of one scheme and precision."""
    rows = table[(table.scheme == scheme) & (table.precision == precision)]
    sizes = sorted(rows.loops.unique())
    columns = min(len(sizes), 3 if len(sizes) in (3, 5, 6, 9) else 4)
    figure, panels = plt.subplots(-(-len(sizes) // columns), columns, sharex=True, sharey=True,
                                  squeeze=False, constrained_layout=True,
                                  figsize=(3.1 * columns + 1.2, 3.5 * -(-len(sizes) // columns) + 0.9))
    for axes in panels.flat[len(sizes):]:
        missing(axes, "")
    used = set()
    for place, (axes, loops) in enumerate(zip(panels.flat, sizes)):
        used |= _panel(axes, rows[rows.loops == loops])
        _lines(axes, rows[rows.loops == loops],
               windows[(windows.loops == loops) & (windows.precision == precision)],
               # The estimates of the upper end hold for the penalty form.
               ("lower", "upper") if scheme == "penalty" else ("lower",))
        axes.set_title(f"N = {loops:.0f}, n = {2 * loops + 2:.0f}")
        if place + columns >= len(sizes):
            axes.set_xlabel("step Δt, ms")
            axes.tick_params(labelbottom=True)
    for axes in panels[:, 0]:
        axes.set_ylabel("penalty factor α, kg/(m² s²)")
    mesh = plt.cm.ScalarMappable(ERRORS, COLOURS)
    figure.colorbar(mesh, ax=panels, extend="min", fraction=0.03, pad=0.02,
                    label="largest position error, m")
    figure.legend(handles=_legend(used, panels.flat[0]), loc="upper center", bbox_to_anchor=(0.5, 0.0),
                  ncols=4, fontsize=9)
    figure.suptitle(f"{scheme} form, {precision} precision: {rows.implementation.iloc[0]}",
                    x=0.01, ha="left", fontsize=12)
    return figure


def category(status):
    """How an outcome is drawn: its own status, or "other failure"."""
    return status if status in (*DRAWN, *HATCHES) else "other failure"


def _panel(axes, rows):
    """Draws the cells; returns the categories that occur."""
    grid = rows[rows.penalty_asked != "auto"]
    steps, scaled = (numpy.sort(grid[key].unique()) for key in ("step", "alpha_dt2_4"))
    step_edges, scaled_edges = _edges(steps), _edges(scaled)
    used = set()
    for row in grid.itertuples():
        left, right = step_edges[numpy.searchsorted(steps, row.step):][:2]
        bottom, top = scaled_edges[numpy.searchsorted(scaled, row.alpha_dt2_4):][:2]
        corners = [(step, 4 * beta / step**2) for step, beta in (
            (left, bottom), (right, bottom), (right, top), (left, top))]
        kind = category(row.status)
        used.add(kind)
        if kind in DRAWN:
            look = {"facecolor": COLOURS(ERRORS(row.position_error_max)), "edgecolor": "white"}
        else:
            colour, hatch = HATCHES[kind]
            look = {"facecolor": colour, "hatch": hatch, "edgecolor": "#888888" if hatch else "white"}
        axes.fill(*zip(*corners), linewidth=0.3, **look)
    degraded = grid[grid.status == "degraded"]
    axes.plot(degraded.step, degraded.penalty, "o", markersize=2.5, markerfacecolor="white",
              markeredgecolor="black", markeredgewidth=0.5)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(step_edges[0], step_edges[-1])
    axes.set_ylim(4 * scaled_edges[0] / step_edges[-1]**2, 4 * scaled_edges[-1] / step_edges[0]**2)
    ticks = steps[::-1][::2][::-1]
    axes.set_xticks(ticks, [f"{1e3 * step:.3g}" for step in ticks])
    axes.xaxis.set_minor_locator(NullLocator())
    return used


def _edges(values):
    """Boundaries between logarithmic values; half a decade around a single one."""
    logs = numpy.log10(values)
    middle = (logs[1:] + logs[:-1]) / 2
    first, last = ((middle[0], middle[-1]) if len(logs) > 1 else (logs[0] + 0.25, logs[0] - 0.25))
    return 10 ** numpy.concatenate([[2 * logs[0] - first], middle, [2 * logs[-1] - last]])


def _lines(axes, rows, windows, ends):
    windows = windows.sort_values("step")
    for name in ends:
        axes.plot(windows.step, windows[name], linewidth=1.6, **LINES[name])
    automatic = rows[rows.penalty_asked == "auto"].sort_values("step")
    axes.plot(automatic.step, automatic.penalty, linewidth=1.2, **LINES["automatic"])
    good = automatic.status == "ok"
    axes.plot(automatic.step[good], automatic.penalty[good], "k.", label="automatic α is ok")
    axes.plot(automatic.step[~good], automatic.penalty[~good], "kX", markersize=7,
              markeredgecolor="white", markeredgewidth=0.6, label="automatic α is not ok")
    axes.plot(*PAPER, "*", color="#CC79A7", markersize=11, markeredgecolor="black",
              markeredgewidth=0.6, linestyle="none", label="the paper's setting")


def _legend(used, axes):
    patches = [Patch(facecolor=colour, hatch=hatch, edgecolor=GREY, label=name)
               for name, (colour, hatch) in HATCHES.items() if name in used]
    if "degraded" in used:
        patches.insert(0, Line2D([], [], marker="o", linestyle="none", markersize=4,
                                 markerfacecolor="white", markeredgecolor="black", label="degraded"))
    return [*axes.get_legend_handles_labels()[0], *patches]
