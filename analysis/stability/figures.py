# Maps: one a scheme and precision, a panel a size; outcome and error over step and penalty factor.
import matplotlib.pyplot as plt
import numpy
from matplotlib.colors import ListedColormap, LogNorm
from matplotlib.patches import Patch

from analysis.core.style import GREY, below, panels

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
    rows = table[(table.scheme == scheme) & (table.precision == precision)]
    sizes = sorted(rows.loops.unique())
    figure, grid = panels(len(sizes), 3 if len(sizes) in (3, 5, 6, 9) else 4, 3.1, 3.5,
                          f"{scheme} form, {precision} precision: {rows.implementation.iloc[0]}", "step Δt, ms", "penalty factor α, kg/(m² s²)")
    for axes, loops in zip(grid, sizes):
        _panel(axes, rows[rows.loops == loops])
        _lines(axes, rows[rows.loops == loops], windows[(windows.loops == loops) & (windows.precision == precision)],
               ("lower", "upper") if scheme == "penalty" else ("lower",))  # estimates of the upper end hold for that form
        axes.set_title(f"N = {loops:.0f}, n = {2 * loops + 2:.0f}")
    asked = rows[rows.penalty_asked != "auto"]  # of all sizes: panels share their axes, and of the largest some may be missing
    steps, scaled = (_edges(numpy.unique(asked[name])) for name in ("step", "alpha_dt2_4"))
    ticks = numpy.unique(asked.step)[::-1][::2][::-1]
    for axes in grid[:len(sizes)]:
        axes.set(xlim=steps[[0, -1]], ylim=(4 * scaled[0] / steps[-1]**2, 4 * scaled[-1] / steps[0]**2))
        axes.set_xticks(ticks, [f"{1e3 * step:.3g}" for step in ticks])
    figure.colorbar(plt.cm.ScalarMappable(ERRORS, COLOURS), ax=grid, extend="min", fraction=0.03, pad=0.02, label="largest position error, m")
    used = set(rows[rows.penalty_asked != "auto"].status.map(category))
    below(figure, 4, [Patch(facecolor=colour, hatch=hatch, edgecolor=GREY, label=name) for name, (colour, hatch) in HATCHES.items() if name in used])
    return figure


def category(status):
    """How an outcome is drawn: its own status, or "other failure"."""
    return status if status in (*DRAWN, *HATCHES) else "other failure"


def _panel(axes, rows):
    """Draws the cells: a mesh that slants, as its rows are those of one alpha step^2 / 4."""
    grid = rows[rows.penalty_asked != "auto"]
    cells = grid.assign(kind=grid.status.map(category)).pivot(index="alpha_dt2_4", columns="step", values=["position_error_max", "kind"])
    errors, kinds = cells.position_error_max.astype(float), cells.kind
    steps, scaled = numpy.meshgrid(_edges(errors.columns), _edges(errors.index))
    mesh = steps, 4 * scaled / steps**2
    axes.pcolormesh(*mesh, errors.where(kinds.isin(DRAWN)), norm=ERRORS, cmap=COLOURS, edgecolor="white", linewidth=0.3)
    for kind, (colour, hatch) in HATCHES.items():
        if kind in set(kinds.values.flat):
            axes.pcolor(*mesh, errors.mask(kinds == kind, 1.0).where(kinds == kind), cmap=ListedColormap([colour]), hatch=hatch,
                        edgecolor="#888888" if hatch else "white", linewidth=0.3)
    degraded = grid[grid.status == "degraded"]
    axes.plot(degraded.step, degraded.penalty, "o", markersize=2.5, markerfacecolor="white",
              markeredgecolor="black", markeredgewidth=0.5, label="degraded" if len(degraded) else None)
    axes.set(xscale="log", yscale="log")


def _edges(values):
    """Boundaries between logarithmic values; half a decade around a single one."""
    logs = numpy.log10(values)
    middle = (logs[1:] + logs[:-1]) / 2
    first, last = (middle[0], middle[-1]) if len(logs) > 1 else (logs[0] + 0.25, logs[0] - 0.25)
    return 10 ** numpy.concatenate([[2 * logs[0] - first], middle, [2 * logs[-1] - last]])


def _lines(axes, rows, windows, ends):
    windows = windows.sort_values("step")
    for name in ends:
        axes.plot(windows.step, windows[name], linewidth=1.6, **LINES[name])
    automatic = rows[rows.penalty_asked == "auto"].sort_values("step")
    axes.plot(automatic.step, automatic.penalty, linewidth=1.2, **LINES["automatic"])
    good = automatic.status == "ok"
    axes.plot(automatic.step[good], automatic.penalty[good], "k.", label="automatic α is ok")
    axes.plot(automatic.step[~good], automatic.penalty[~good], "kX", markersize=7, markeredgecolor="white", markeredgewidth=0.6,
              label="automatic α is not ok")
    axes.plot(*PAPER, "*", color="#CC79A7", markersize=11, markeredgecolor="black", markeredgewidth=0.6, linestyle="none",
              label="the setting of 2008")
