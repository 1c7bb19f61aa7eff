# Step time over size between the limit's bounds and the implementations; steps split by phase; leads scene by scene.
import matplotlib.pyplot as plt
import numpy
from matplotlib.ticker import NullLocator

from analysis.core.phases import FILLS, LABELS, bar
from analysis.core.style import ALTERNATIVES, GREY, MARKERS, Look, legend, line_each, missing, number_axis, size_ticks
from analysis.core.text import number
from analysis.core.timing import PHASES
from analysis.limit.held import wanted
from analysis.limit.tables import KINDS, LIMIT

BOUNDS = {"latency_ns": ("bound: dependent operations", "--"),
          "memory_ns": ("bound: memory traffic", "-."),
          "arithmetic_ns": ("bound: rate of arithmetic", ":")}
LIMIT_LABEL = "limit: code for the N-four-bar alone"
WHOLE = 0.99  # of a step in "other": it has no phases


def draw(tables, view):
    own = {name.partition("/")[0] for name in view.registry.own}
    rows = everyone(tables["steps"])
    return {"over_size": over_size(tables["bounds"], rows, Look(view.registry), own), "by_phase": by_phase(rows, own),
            "ahead": ahead(tables["leads"])}


def everyone(steps):
    """Rows of the penalty form that have a multiple of the limit code's step."""
    return steps[(steps.form == "penalty") & (steps.status == "ok") & steps.multiple.notna()]


def leaders(rows, own=()):
    """The variant of each folder with the least geometric mean multiple over the sizes that most of its folder's
    variants have; in the order of that mean. Of folders in `own` all variants."""
    rows = rows[rows.implementation != LIMIT]
    rows = rows.assign(folder=rows.implementation.str.partition("/")[0], log=numpy.log(rows.multiple))
    chosen = []
    for folder, mine in rows.groupby("folder"):
        most = mine.groupby("implementation").loops.nunique().max()
        whole = mine.groupby("implementation").filter(lambda one, most=most: len(one) == most)
        means = (mine if folder in own else whole).groupby("implementation").log.mean()
        chosen += [(means[name], name) for name in (means.index if folder in own else [means.idxmin()])]
    return [name for _, name in sorted(chosen)]


def over_size(bounds, rows, look, own):
    """Above: µs a step; below: multiples of the limit code, with their intervals. `own`: as leaders() has it."""
    figure, (times, multiples) = plt.subplots(2, 1, sharex=True, figsize=(8.6, 8.4),
                                              gridspec_kw={"hspace": 0.08, "height_ratios": [1.5, 1]})
    if rows.empty:
        missing(times, "no size was timed")
        missing(multiples, "")
        return figure
    bounds = bounds[bounds.status == "done"].sort_values("variables")
    for column, (label, dash) in BOUNDS.items():
        times.plot(bounds.variables, bounds[column] / 1e3, dash, color=GREY, label=label)
    if len(bounds):
        times.fill_between(bounds.variables, bounds.bound_ns / 1e3, times.get_ylim()[0], color=GREY, alpha=0.12, linewidth=0)
    for name in [LIMIT, *leaders(rows, own)]:
        mine = rows[rows.implementation == name].sort_values("variables")
        style = ({"color": "black", "linewidth": 2.2, "marker": "o", "markersize": 4.5} if name == LIMIT else look.line(name))
        times.plot(mine.variables, mine.step_us, **style, label=LIMIT_LABEL if name == LIMIT else name)
        times.fill_between(mine.variables, mine.low_us, mine.high_us, color=style["color"], alpha=0.15, linewidth=0)
        multiples.plot(mine.variables, mine.multiple, **style)
        known = mine[(mine.multiple_low > 0) & (mine.multiple_high < numpy.inf)]
        multiples.fill_between(known.variables, known.multiple_low, known.multiple_high, color=style["color"], alpha=0.15,
                               linewidth=0)
    times.set_title("N-four-bar, penalty form: a step between what is needed and what is taken")
    times.set_ylabel("time per step, µs")
    multiples.set_ylabel("multiple of the limit code")
    for axes, unit in ((times, ""), (multiples, "×")):
        number_axis(axes.yaxis, unit)
        axes.grid(True, which="major")
    size_ticks(multiples, sorted(rows.variables.unique()))
    multiples.set_xlim(rows.variables.min() / 1.3, rows.variables.max() * 1.3)
    legend(times, order=[*(label for label, _ in BOUNDS.values()), LIMIT_LABEL, *leaders(rows, own)].index)
    return figure


def by_phase(rows, own):
    """A panel a size (at most three that many were timed at): the share of each phase in a step of each of the
    leaders(), beside the step in multiples of the limit code."""
    rows = rows[rows.other_us.notna()]
    names = leaders(rows, own) if len(rows) else []
    many = rows[rows.implementation.isin(names)].groupby("loops").size() > len(names) / 3
    sizes = sorted(many.index[many])
    shown = sizes if len(sizes) <= 3 else [sizes[round(k * (len(sizes) - 1) / 2)] for k in range(3)]
    figure, panels = plt.subplots(1, max(1, len(shown)), sharey=True, squeeze=False, constrained_layout=True,
                                  figsize=(3.9 * max(1, len(shown)) + 1.8, 0.36 * len(names) + 1.5))
    if not shown:
        missing(panels[0][0], "no phases were timed")
        return figure
    for axes, loops in zip(panels[0], shown):
        of_size = rows[rows.loops == loops].set_index("implementation")
        for place, name in enumerate(names):
            row = of_size.loc[name] if name in of_size.index else None
            if row is None or row.other_us > WHOLE * row.step_us:
                axes.text(2, place, "not timed" if row is None else "all in the same sweeps", va="center", fontsize=8)
            else:
                bar(axes, place, [(phase, 100 * row[f"{phase}_us"] / row.step_us) for phase in PHASES], FILLS, False)
            if row is not None:
                axes.text(100, place, f" {number(row.multiple)}×, {number(row.step_us)} µs", va="center", fontsize=8)
        axes.set(xlim=(0, 160), xticks=[0, 50, 100], xlabel="share of the step, %")
        axes.set_title(f"N-four-bar, n = {2 * loops + 2:.0f}; limit {number(of_size.step_us[LIMIT])} µs")
        line_each(axes, names)
    figure.legend(handles=[plt.Rectangle((0, 0), 1, 1, color=FILLS[phase], label=LABELS[phase]) for phase in PHASES],
                  loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=len(PHASES) if len(shown) > 1 else 3)
    return figure


def ahead(leads):
    """A line a scene: how many times faster than the fastest library each variant is, with its interval; a mark where
    it is to be at least. Scenes of which nothing was timed are counted."""
    asked = leads[leads.kind.isin(KINDS)]
    rows = asked[asked.scene.isin(asked.scene[asked.status == "ok"])]
    about = rows.drop_duplicates("scene").assign(order=rows.kind.map({kind: place for place, kind in enumerate(KINDS)}))
    about = about.sort_values(["order", "dimension", "variables", "scene"], kind="stable").reset_index(drop=True)
    names = list(dict.fromkeys(rows.implementation))
    figure, axes = plt.subplots(figsize=(8.6, 0.36 * len(about) + 1.8), constrained_layout=True)
    if rows.empty:
        missing(axes, "no scene was timed with code of our own and a library beside it")
        return figure
    for number_of, name in enumerate(names):
        shift, label = (number_of - (len(names) - 1) / 2) * 0.36, name
        colour, marker = ALTERNATIVES[number_of % len(ALTERNATIVES)], MARKERS[number_of]
        for place, scene in enumerate(about.scene):
            for row in rows[(rows.scene == scene) & (rows.implementation == name)].itertuples():
                if row.status == "ok":
                    if row.high < numpy.inf:
                        axes.plot([row.low, row.high], [place + shift] * 2, color=colour, linewidth=1.6, alpha=0.6)
                    axes.plot(row.lead, place + shift, marker, color=colour, markersize=5.5, linestyle="none", label=label)
                    axes.annotate(f"{number(row.lead)}×", (max(row.lead, row.high if row.high < numpy.inf else 0), place + shift),
                                  (5, 0), textcoords="offset points", va="center", fontsize=7, color=colour, zorder=4,
                                  bbox={"boxstyle": "round,pad=0.1", "facecolor": "white", "alpha": 0.8, "linewidth": 0})
                    label = None
                elif row.status != "unsupported":
                    axes.annotate(f"{name.partition('/')[2]}: {row.status}", (1, place + shift), (5, 0), va="center", fontsize=7,
                                  textcoords="offset points", color=colour)
    axes.plot([wanted(row.kind, row.dimension) for row in about.itertuples()], range(len(about)), linestyle="none", marker="|",
              markersize=15, markeredgewidth=2, color="black", label="at least")
    axes.axvline(1, color=GREY, linewidth=1)
    axes.margins(x=0.1)
    number_axis(axes.xaxis, "×")
    axes.yaxis.set_minor_locator(NullLocator())
    line_each(axes, [f"{row.scene.rpartition('/')[2].removesuffix('.json')} ({row.kind}, n = {row.variables:.0f}, "
                     f"{row.dimension:.0f}D)" for row in about.itertuples()], fontsize=8)
    axes.set_xlabel("time of the fastest library ÷ own time")
    left = asked.scene.nunique() - len(about)
    axes.set_title("How far ahead of libraries" + (f"; {left} more scenes were not timed" if left else ""))
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=8.5)
    return figure
