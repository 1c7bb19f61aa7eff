# The paper's figures: the study's own, at print size; and one of its own, real mechanisms with intervals.
import matplotlib.pyplot as plt
from matplotlib.gridspec import GridSpec
from matplotlib.text import Text
from matplotlib.ticker import LogLocator

from analysis.accuracy import figures as accuracy
from analysis.accuracy.winners import met
from analysis.core.style import GREY, Look, nothing
from analysis.core.text import bounded
from analysis.engines import figures as engine_figures
from analysis.families import figures as families
from analysis.limit import figures as limit
from analysis.map import figures as maps
from analysis.realtime import figures as realtime
from analysis.stability import figures as stability
from study.tools.paper.numbers import DENSE, HYBRID, filled_by_phase, led, profiled, real_mechanisms

TEXT = 6.69      # inches, width of the paper's text
SCALE = 0.78     # of letters and lines on paper: what figures have at 9.5 is 7.4 points
LEAST = 6        # points that a letter has on paper
END = 1.5        # ratio at which it ends
FRONT = 3        # points that make a front
STEPS = 14       # implementations of the figure of steps
PHASES_OF = (DENSE, HYBRID, "csc_cholmod/supernodal", "csc_cholmod/simplicial", "csc_ldl/uplooking", "eigen_sparse/ldlt", "csc_klu/refactor",
             "compiled_ldl/fronts")
NOTHING = "Not measured in this set."
MARKS = ("o", "s", "^", "D", "v", "P", "X", "*")  # of the libraries that lead on most mechanisms


def own_fill(known):
    figure = maps.sparse(known.results, Look(known.registry))
    plt.setp(figure.texts, text="")  # which the caption says
    plt.setp(figure.axes, title="", ylabel="time ÷ the least")
    return figure


def size_and_fill(known):
    """The map, its legend below: cells are as wide as paper allows. Marks: what the compared sets say together."""
    figure = maps.fastest(known.results, Look(known.registry), "", known.results.layer("libraries"), letters=9, line=3.1, agreed=known.on_the_map)
    if legend := figure.axes[0].get_legend():
        below(figure, legend, 3, 0.02, 7.2)
    return figure


def work(known):
    """Error against time of a four-bar, of libraries alone: the largest of which a front was timed."""
    tables = known.tables("accuracy")
    rows = tables["points"].loc[lambda rows: rows.loops.notna() & rows.fill_asked.isna() & rows.library.fillna(False).astype(bool)]
    if rows.empty:
        return nothing(NOTHING)
    fronts = rows.groupby("loops").front_libraries.sum()
    mine = rows[rows.loops == max(fronts.index[fronts >= FRONT], default=rows.loops.max())]
    won = tables["winners"].loc[lambda rows: (rows.subject == mine.subject.iloc[0]) & rows.fill_asked.isna()]
    figure = accuracy.work(mine, won, Look(known.registry), "largest of position, m", "")
    front, _, ratios, _ = figure.axes  # the others are of all, own code included
    shown = (front,) if met(won).empty else (front, ratios)  # without a winner there is nothing to be over
    for axes in [one for one in figure.axes if one not in shown]:
        figure.delaxes(axes)
    figure.set_layout_engine("none")  # which would count the legend to the axes
    for axes, place in zip(shown, GridSpec(1, len(shown), figure=figure, wspace=0.3)):
        axes.set_subplotspec(place)
    front.set_title(f"n = {mine.variables.max():.0f}")
    if ratios.get_legend():
        below(figure, ratios.get_legend(), 3, -0.04)
    return figure


def window(known):
    """Of the smallest, a middle and the largest size."""
    tables = known.tables("stability")
    rows = tables["maps"].loc[lambda rows: (rows.status != "dropped") & (rows.scheme == "penalty") & (rows.precision == "double")]
    if not (sizes := sorted(rows.loops.unique())):
        return nothing(NOTHING)
    return stability.one_map(rows[rows.loops.isin([sizes[0], sizes[len(sizes) // 2], sizes[-1]])], tables["windows"], "penalty", "double")


def steps(known):
    """Of the larger size, in the penalty form: the fastest of whom there are times."""
    tables = known.tables("realtime")
    rows = tables["steps"].loc[lambda rows: rows.scheme == "penalty"]
    rows = rows[rows.loops == rows.loops[rows.median_us.notna()].max()]
    return realtime.distributions(rows[rows.implementation.isin(realtime.order(rows)[:STEPS])] if len(rows) else rows, tables["machine"])


def own(known):
    """Of the map of mechanisms the panel of our own code."""
    figure = families.real_map(known.tables("families"), Look(known.registry), known.registry)
    if len(figure.axes) > 1:
        figure.delaxes(figure.axes[0])
        colours, forms = figure.legends
        below(figure, forms, 5)
        colours.remove()
    plt.setp(figure.axes, title="", ylabel="times as fast")
    figure.axes[0].set_subplotspec(GridSpec(1, 1, figure=figure)[0])  # the panel that is left has the whole width
    return figure


def below(figure, legend, columns, y=-0.03, size=9):
    """A legend below the axes instead of beside them."""
    entries = legend.legendHandles, [text.get_text() for text in legend.get_texts()]
    legend.remove()
    figure.legend(*entries, loc="upper center", bbox_to_anchor=(0.5, y), ncols=columns, fontsize=size, columnspacing=1.0, handlelength=1.8)


def phases(known):
    """What a step of some variants consists of: at the own fill, and at the first fills beyond it, each at the largest size that was timed phase by
    phase."""
    own, rows = profiled(known), filled_by_phase(known)
    shown = {f"n = {size:.0f}, own fill": own for size in own.variables.unique()}
    for fill, mine in list(rows[rows.variables == rows.variables.max()].groupby("fill_asked"))[:2]:
        shown[f"n = {mine.variables.iloc[0]:.0f}, {100 * fill:.0f} % filled"] = mine
    names = [name for name in PHASES_OF if any(name in set(mine.implementation) for mine in shown.values())]
    figure = limit.by_phase(shown, names)
    plt.setp(figure.axes, xlim=(0, 160 if len(shown) > 1 else 130))
    return figure


def engines(known):
    """With a narrower legend and fewer ticks."""
    figure = engine_figures.draw(known.tables("engines"), known.view("engines"))["regular"]
    for axes in figure.axes if figure.legends else ():
        axes.xaxis.set_major_locator(LogLocator(numticks=5))
    if figure.legends:
        below(figure, figure.legends[0], 3)
    return figure


def mechanisms(known):
    """A line a mechanism at its own fill: each library's time over that of the fastest, with its interval. Those that lead
    on no or few are grey; who takes more than the end of the axis is not drawn."""
    rows = known.tables("families")["scenes"]
    mine = real_mechanisms(known).sort_values("variables")
    if mine.empty:
        return nothing(NOTHING)
    rows = rows[(rows.status == "ok") & rows.implementation.isin(known.registry.libraries)].merge(mine[["scene", "scheme"]], on=["scene", "scheme"])
    chosen = list(led(mine))[:len(MARKS)]
    half = -(-len(mine) // 2)
    figure, panels = plt.subplots(1, 2, figsize=(8.4, 1.2 + 0.16 * half), gridspec_kw={"wspace": 0.85})
    for axes, some in zip(panels, (mine[:half], mine[half:])):
        _mechanisms(axes, some, rows[rows.scene.isin(some.scene)], chosen, Look(known.registry))
    panels[0].plot([], [], "|", color="#9a9a9a", markersize=6, label="other libraries")
    entries = {label: handle for axes in panels for handle, label in zip(*axes.get_legend_handles_labels())}
    figure.legend(entries.values(), entries, loc="lower center", bbox_to_anchor=(0.42, 0.89), ncols=4, fontsize=8.5)
    return figure


def _mechanisms(axes, mine, rows, chosen, look):
    places = {scene: place for place, scene in enumerate(mine.scene)}
    for name, group in rows.groupby("implementation", sort=False):
        y = group.scene.map(places) + (0.7 / len(chosen) * (chosen.index(name) - (len(chosen) - 1) / 2) if name in chosen else 0)
        inside = group[group.to_rival <= END]
        if name not in chosen:
            axes.plot(inside.to_rival, y[inside.index], "|", color="#9a9a9a", markersize=6, zorder=1)
            continue
        colour, mark = look.colour(name), MARKS[chosen.index(name)]
        axes.plot(inside.to_rival, y[inside.index], mark, color=colour, markersize=4.5, label=name, markerfacecolor=colour if mark in "os^" else "white")
        for row in inside.itertuples():
            if bounded(row.to_rival_low, row.to_rival_high):
                axes.plot([row.to_rival_low, min(row.to_rival_high, END)], [y[row.Index]] * 2, color=colour, linewidth=1.3, alpha=0.7)
    axes.axvline(1, color=GREY, linewidth=0.9)
    axes.axvspan(1, 1.05, color="#eeeeee", zorder=0)
    for place in range(len(mine)):
        axes.axhline(place + 0.5, color="#e6e6e6", linewidth=0.6, zorder=0)
    axes.set(xlim=(0.93, END), ylim=(len(mine) - 0.4, -0.6), xlabel="time ÷ that of the fastest library")
    labels = [f"{row.scene} ({row.variables:.0f}){'' if said else ' ?'}" for row, said in zip(mine.itertuples(), mine.settled.fillna(False))]
    axes.set_yticks(range(len(mine)), labels, fontsize=7.0)


def fit(figure, height):
    """Makes a figure as wide as the text, and its letters and lines as small as paper allows. `height`: inches. The title of all of it goes:
    the caption says what it is."""
    if figure._suptitle:
        figure._suptitle.remove()
        figure._suptitle = None
    for text in figure.findobj(Text):
        text.set_fontsize(max(LEAST, SCALE * text.get_fontsize()))
    for line in figure.findobj(plt.Line2D):
        line.set_linewidth(SCALE * line.get_linewidth())
    for _ in range(8):  # what stands beside the axes keeps its width
        if figure.get_layout_engine():
            figure.get_layout_engine().execute(figure)
        box = figure.get_tightbbox(figure.canvas.get_renderer())
        if max(abs(TEXT - box.width), abs(height - box.height)) < 0.02:
            break
        wide, high = figure.get_size_inches()
        figure.set_size_inches(max(2.5, wide + TEXT - box.width), high + height - box.height)
    return figure


# name: (what draws it, height in inches)
DRAWN = {"mechanisms": (mechanisms, 4.3), "held": (lambda known: families.held_figure(known.tables("families")["held"]), 2.0),
         "own_fill": (own_fill, 3.5), "map": (size_and_fill, 4.8), "phases": (phases, 2.2), "work": (work, 3.0), "window": (window, 2.4),
         "steps": (steps, 2.9), "own": (own, 2.5), "engines": (engines, 3.5)}
