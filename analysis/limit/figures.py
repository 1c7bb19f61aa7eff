# Step time over size between the limit's bounds and the implementations; steps split by phase; leads scene by scene.
import matplotlib.pyplot as plt
import numpy
from matplotlib.patches import Patch

from analysis.core.style import ALTERNATIVES, GREY, MARKERS, Look, below, legend, line_each, missing, nothing, number_axis, panels, size_ticks
from analysis.core.text import number
from analysis.limit.held import wanted
from analysis.limit.tables import KINDS, LIMIT

BOUNDS = {"latency_ns": ("bound: dependent operations", "--"),
          "memory_ns": ("bound: memory traffic", "-."),
          "arithmetic_ns": ("bound: rate of arithmetic", ":")}
LIMIT_LABEL = "limit: code for the N-four-bar alone"
MUCH = 2  # times the fastest library's time, where its panel ends
WHOLE = 0.99  # of a step in "other": it has no phases
PHASES = {  # colour, hatch, words; any two stay apart in grey, by one of the first two
    "evaluation": ("#cfe3f2", "", "evaluation (Φ, Φq, f)"), "assembly": ("#3578b0", "", "tangent assembly"),
    "factorization": ("#08306b", "", "factorization"), "solve": ("#e6a141", "", "solves"),
    "projection": ("#f6dcae", "////", "projections (rhs)"), "other": ("#ffffff", "....", "other")}
EDGE = {"edgecolor": "#444444", "linewidth": 0}  # the colour of hatches; in PDF those of no edge are lost


def draw(tables, view):
    own = {name.partition("/")[0] for name in view.registry.own}
    rows = everyone(tables["steps"])
    profiled = rows[rows.other_us.notna()]
    names = leaders(profiled, own) if len(profiled) else []
    many = profiled[profiled.implementation.isin(names)].groupby("loops").size() > len(names) / 3
    sizes = sorted(many.index[many])
    shown = sizes if len(sizes) <= 3 else [sizes[round(k * (len(sizes) - 1) / 2)] for k in range(3)]
    return {"over_size": over_size(tables["bounds"], rows, Look(view.registry), own),
            "by_phase": by_phase({f"N-four-bar, n = {2 * loops + 2:.0f}": profiled[profiled.loops == loops] for loops in shown}, names),
            "ahead": ahead(tables["leads"])}


def everyone(steps):
    """Rows of the penalty form that have a multiple of the limit code's step."""
    return steps[(steps.form == "penalty") & (steps.status == "ok") & steps.multiple.notna()]


def leaders(rows, own=()):
    """The variant of each folder with the least geometric mean multiple over the sizes that most of its folder's
    variants have; in the order of that mean. Of folders in `own` all variants."""
    rows = rows[rows.implementation != LIMIT].assign(log=lambda rows: numpy.log(rows.multiple))
    found = rows.groupby("implementation").agg(mean=("log", "mean"), rows=("log", "size"), sizes=("loops", "nunique"))
    found["folder"] = found.index.str.split("/").str[0]
    found = found[(found.rows == found.groupby("folder").sizes.transform("max")) | found.folder.isin(own)].sort_values("mean", kind="stable")
    return list(found.index[~found.folder.duplicated() | found.folder.isin(own)])


def over_size(bounds, rows, look, own):
    """Above: µs a step; then multiples of the limit code, and libraries over the fastest one, with intervals. `own`: as leaders() has it."""
    figure, three = plt.subplots(3, 1, sharex=True, figsize=(8.6, 10.8), gridspec_kw={"hspace": 0.08, "height_ratios": [1.5, 1, 1]})
    times, multiples, behind = three
    if rows.empty:
        return missing("no size was timed", *three)
    sizes = sorted(rows.variables.unique())
    bounds = bounds[bounds.status == "done"].sort_values("variables")
    for column, (label, dash) in BOUNDS.items():
        times.plot(bounds.variables, bounds[column] / 1e3, dash, color=GREY, label=label)
    if len(bounds):
        times.fill_between(bounds.variables, bounds.bound_ns / 1e3, times.get_ylim()[0], color=GREY, alpha=0.12, linewidth=0)
    for name in [LIMIT, *leaders(rows, own)]:
        mine = rows[rows.implementation == name].set_index("variables").reindex(sizes)  # lines break where a size is missing
        style = ({"color": "black", "linewidth": 2.2, "marker": "o", "markersize": 4.5} if name == LIMIT else look.line(name))
        times.plot(sizes, mine.step_us, **style, label=LIMIT_LABEL if name == LIMIT else name)
        times.fill_between(sizes, mine.low_us, mine.high_us, color=style["color"], alpha=0.15, linewidth=0)
        for axes, what in ((multiples, "multiple"), (behind, "to_rival"))[:1 if name.partition("/")[0] in {"limit", *own} else 2]:
            axes.plot(sizes, mine[what], **style)
            known = mine[mine[f"{what}_high"] < numpy.inf].reindex(sizes)
            axes.fill_between(sizes, known[f"{what}_low"], known[f"{what}_high"], color=style["color"], alpha=0.15, linewidth=0)
    times.set(title="N-four-bar, penalty form: the best variant of each library, and all code of our own", ylabel="time per step, µs")
    multiples.set_ylabel("multiple of the limit code")
    behind.set(ylabel="÷ the fastest library", ylim=(0.97, MUCH))
    for axes, unit in ((times, ""), (multiples, "×"), (behind, "×")):
        number_axis(axes.yaxis, unit)
        axes.grid(True, which="major")
    size_ticks(behind, sizes)
    behind.set_xlim(rows.variables.min() / 1.3, rows.variables.max() * 1.3)
    legend(times, order=[*(label for label, _ in BOUNDS.values()), LIMIT_LABEL, *leaders(rows, own)].index)
    return figure


def by_phase(shown, names):
    """A panel for the rows under each title: the share of each phase in a step of each of `names`, beside the step, in multiples of the limit code, too,
    where these are known."""
    if not shown:
        return nothing("no phases were timed")
    figure, grid = panels(len(shown), len(shown), 3.9, 0.36 * len(names) + 0.6, "What a step consists of: libraries and code of our own")
    for axes, (title, rows) in zip(grid, shown.items()):
        rows = rows.set_index("implementation")
        for place, name in enumerate(names):
            row = rows.loc[name] if name in rows.index else None
            if row is None or row.other_us > WHOLE * row.step_us:
                axes.text(2, place, "not timed" if row is None else "all in the same sweeps", va="center", fontsize=8)
            else:
                _bar(axes, place, row)
            if row is not None:
                multiple = f"{number(row.multiple)}× limit, " if row.get("multiple", 0) > 0 else ""
                axes.text(100, place, f" {multiple}{number(row.step_us)} µs", va="center", fontsize=8)
        axes.set(xlim=(0, 165), xticks=[0, 50, 100], xlabel="share of the step, %", title=title)
        line_each(axes, names)
    below(figure, len(PHASES) if len(shown) > 1 else 3, [
        Patch(facecolor=colour, hatch=hatch, **EDGE, label=words) for colour, hatch, words in PHASES.values()])
    return figure


def _bar(axes, place, row):
    left = 0.0
    for phase, (colour, hatch, _) in PHASES.items():
        share = 100 * row[f"{phase}_us"] / row.step_us
        axes.barh(place, share, left=left, height=0.8, facecolor=colour, hatch=hatch, **EDGE)
        if share >= 3.5:
            axes.text(left + share / 2, place, f"{share:.0f}", ha="center", va="center", fontsize=7.5,
                      color="white" if phase in ("assembly", "factorization") else "#222222",
                      bbox={"boxstyle": "square,pad=0.1", "facecolor": colour, "linewidth": 0} if hatch else None)
        left += share


def ahead(leads):
    """A line a scene: how many times faster than the fastest library each variant is, with its interval; a mark where
    it is to be at least. Scenes of which nothing was timed are counted."""
    asked = leads[leads.kind.isin(KINDS)]
    rows = asked[asked.scene.isin(asked.scene[asked.status == "ok"])]
    if rows.empty:
        return nothing("no scene was timed with code of our own and a library beside it")
    about = rows.drop_duplicates("scene").assign(order=rows.kind.map(list(KINDS).index))
    about = about.sort_values(["order", "dimension", "variables", "scene"], kind="stable").reset_index(drop=True)
    names = list(dict.fromkeys(rows.implementation))
    figure, axes = plt.subplots(figsize=(8.6, 0.36 * len(about) + 1.8), constrained_layout=True)
    for place, name in enumerate(names):
        colour, mine = ALTERNATIVES[place % len(ALTERNATIVES)], rows[rows.implementation == name]
        mine = mine.assign(y=mine.scene.map(dict(zip(about.scene, about.index))) + (place - (len(names) - 1) / 2) * 0.36,
                           low=mine.low.where(mine.high < numpy.inf), high=mine.high.where(mine.high < numpy.inf))
        axes.hlines(mine.y, mine.low, mine.high, color=colour, linewidth=1.6, alpha=0.6)
        axes.plot(mine.lead, mine.y, MARKERS[place], color=colour, markersize=5.5, linestyle="none", label=name)
        for row in mine[mine.status != "unsupported"].itertuples():
            text, x = ((f"{number(row.lead)}×", numpy.nanmax([row.lead, row.high])) if row.status == "ok" else
                       (f"{name.partition('/')[2]}: {row.status}", 1))
            axes.annotate(text, (x, row.y), (5, 0), textcoords="offset points", va="center", fontsize=7, color=colour, zorder=4,
                          bbox={"boxstyle": "round,pad=0.1", "facecolor": "white", "alpha": 0.8, "linewidth": 0})
    axes.plot([wanted(row.kind, row.dimension) for row in about.itertuples()], range(len(about)), linestyle="none", marker="|",
              markersize=15, markeredgewidth=2, color="black", label="at least")
    axes.axvline(1, color=GREY, linewidth=1)
    axes.margins(x=0.1)
    number_axis(axes.xaxis, "×")
    line_each(axes, [f"{row.scene.rpartition('/')[2].removesuffix('.json')} ({row.kind}, n = {row.variables:.0f}, "
                     f"{row.dimension:.0f}D)" for row in about.itertuples()], fontsize=8)
    left = asked.scene.nunique() - len(about)
    axes.set(xlabel="time of the fastest library ÷ own time",
             title="Code of our own: how many times as fast as the fastest library" + (f"; {left} more scenes were not timed" if left else ""))
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=8.5)
    return figure
