# Step time over size between the limit's bounds and the implementations; steps split by phase.
from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy

from analysis.loader import PHASES
from analysis.style import GREY, Look, legend, number_axis, size_ticks
from analysis.text import number

LIMIT = "limit/limit"
BOUNDS = {"latency_ns": ("bound: dependent operations", "--"),
          "memory_ns": ("bound: memory traffic", "-."),
          "arithmetic_ns": ("bound: rate of arithmetic", ":")}
COLOURS = {"evaluation": "#56B4E9", "assembly": "#009E73", "factorization": "#0072B2",
           "solve": "#E69F00", "projection": "#CC79A7", "other": "#999999"}


def timed(steps):
    """Rows with a time, and how many times that of the limit code of their size it is."""
    rows = steps[steps.status == "ok"].copy()
    limits = rows[rows.implementation == LIMIT].set_index("loops").step_us
    rows["multiple"] = rows.step_us / rows.loops.map(limits)
    return rows[rows.multiple.notna()]


def leaders(steps, own=()):
    """The variant of each folder with the least geometric mean multiple over the sizes that most of its
    folder's variants have; in the order of that mean. Of folders in `own` all variants."""
    rows = timed(steps)
    rows = rows[rows.implementation != LIMIT]
    rows = rows.assign(folder=rows.implementation.str.split("/").str[0], log=numpy.log(rows.multiple))
    chosen = []
    for folder, mine in rows.groupby("folder"):
        most = mine.groupby("implementation").loops.nunique().max()
        whole = mine.groupby("implementation").filter(lambda one, most=most: len(one) == most)
        means = (mine if folder in own else whole).groupby("implementation").log.mean()
        chosen += [(means[name], name) for name in (means.index if folder in own else [means.idxmin()])]
    return [name for _, name in sorted(chosen)]


def over_size(bounds, steps, registry, own=()):
    """Above: µs a step; below: multiples of the limit code. `own`: as leaders() has it."""
    look = Look(SimpleNamespace(registry=registry, tidy=SimpleNamespace(blas=[], build=[])))
    rows, bounds = timed(steps), bounds.sort_values("variables")
    figure, (times, multiples) = plt.subplots(2, 1, sharex=True, figsize=(8.6, 8.4),
                                              gridspec_kw={"hspace": 0.08, "height_ratios": [1.5, 1]})
    for column, (label, dash) in BOUNDS.items():
        times.plot(bounds.variables, bounds[column] / 1e3, dash, color=GREY, label=label)
    times.fill_between(bounds.variables, bounds.bound_ns / 1e3, times.get_ylim()[0], color=GREY,
                       alpha=0.12, linewidth=0)
    for name in [LIMIT, *leaders(steps, own)]:
        mine = rows[rows.implementation == name].sort_values("variables")
        style = ({"color": "black", "linewidth": 2.2, "marker": "o", "markersize": 4.5}
                 if name == LIMIT else look.line(name))
        times.plot(mine.variables, mine.step_us, **style,
                   label="limit: code for the N-four-bar alone" if name == LIMIT else name)
        times.fill_between(mine.variables, mine.low_us, mine.high_us, color=style["color"],
                           alpha=0.15, linewidth=0)
        multiples.plot(mine.variables, mine.multiple, **style)
    times.set_title("A step's time between what is needed and what is taken")
    times.set_ylabel("time per step, µs")
    multiples.set_ylabel("multiple of the limit code")
    for axes, unit in ((times, ""), (multiples, "×")):
        axes.set_yscale("log")
        number_axis(axes.yaxis, unit)
        axes.grid(True, which="major")
    size_ticks(multiples, sorted(rows.variables.unique()))
    legend(times)
    return figure


def by_phase(steps, own=()):
    """A panel a size (at most three that most were timed at): the share of each phase in a step of each of the
    leaders(), beside the step in multiples of the limit code."""
    rows, names = timed(steps), leaders(steps, own)
    many = rows[rows.implementation.isin(names)].groupby("loops").size() > len(names) / 2
    sizes = sorted(many.index[many])
    shown = sizes if len(sizes) <= 3 else [sizes[round(k * (len(sizes) - 1) / 2)] for k in range(3)]
    figure, panels = plt.subplots(1, len(shown), sharey=True, squeeze=False, constrained_layout=True,
                                  figsize=(3.9 * len(shown) + 1.8, 0.36 * len(names) + 1.5))
    for axes, loops in zip(panels[0], shown):
        of_size = rows[rows.loops == loops].set_index("implementation")
        for place, name in enumerate(names):
            if name not in of_size.index:
                axes.text(0.3, place, "not timed", va="center", fontsize=8, color=GREY,
                          transform=axes.get_yaxis_transform())
                continue
            row, left = of_size.loc[name], 0.0
            for phase in PHASES:
                width = row[f"{phase}_us"] / row.step_us
                axes.barh(place, width, 0.62, left=left, color=COLOURS[phase])
                left += width
            axes.text(1, place, f" {number(row.multiple)}×, {number(row.step_us)} µs", va="center", fontsize=8)
        axes.set_xlim(0, 1.55)
        axes.set_xticks([0, 0.5, 1], ["0", "50 %", "100 %"])
        axes.set_title(f"n = {2 * loops + 2}, limit {number(of_size.step_us[LIMIT])} µs")
        axes.set_xlabel("share of the step")
        axes.set_yticks(range(len(names)), names)
        axes.set_ylim(len(names) - 0.4, -0.6)
    figure.legend(handles=[plt.Rectangle((0, 0), 1, 1, color=colour, label=phase)
                           for phase, colour in COLOURS.items()],
                  loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=6)
    return figure


def ahead(leads, scenes, wanted):
    """Bars a scene: how many times faster than the fastest with a library each of `leads`
    ({implementation: Series by scene}) is; a mark where it is to be: `wanted(scene, dimension, filled)`."""
    about = scenes.groupby("scene", sort=False)[["variables", "dimension", "filled"]].first()
    order = about.sort_values(["filled", "dimension"], kind="stable").index
    names = [scene.removeprefix("harness/scenes/").removesuffix(".json") for scene in order]
    height = 0.8 / len(leads)
    figure, axes = plt.subplots(figsize=(8.6, 0.34 * len(order) + 1.6), constrained_layout=True)
    for row, (name, lead) in enumerate(leads.items()):
        places = [place + (row - (len(leads) - 1) / 2) * height for place in range(len(order))]
        values = [lead.get(scene, float("nan")) for scene in order]
        axes.barh(places, [value - 1 for value in values], height, left=1, label=name,
                  color=list(COLOURS.values())[row * 2 + 2])
        for place, value in zip(places, values):
            text = f" {value:.3g}×" if value == value else " not timed"
            axes.text(max(value, 1) if value == value else 1, place, text, va="center", fontsize=7)
    axes.plot([wanted(row.Index, row.dimension, row.filled) for row in about.loc[order].itertuples()],
              range(len(order)), linestyle="none", marker="|", markersize=13, markeredgewidth=2,
              color="black", label="at least")
    axes.axvline(1, color=GREY, linewidth=1)
    axes.set_xscale("log")
    number_axis(axes.xaxis, "×")
    axes.margins(x=0.12)
    axes.set_yticks(range(len(order)), [f"{name} (n = {about.variables[scene]}, "
                                        f"{'filled' if about.filled[scene] else str(about.dimension[scene]) + 'D'})"
                                        for name, scene in zip(names, order)], fontsize=8)
    axes.set_ylim(len(order) - 0.4, -0.6)
    axes.set_xlabel("time of the fastest with a library ÷ own time")
    axes.set_title("How far ahead of libraries")
    axes.legend(loc="lower right", frameon=True)
    return figure
