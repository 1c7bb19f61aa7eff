# All figures of the map: of the fastest over size and fill, the paper's Figures 6 and 7, for libraries and for all; Figure 4, sparse
# solvers of libraries over problem size, as ratios to the one of least time at each size, with intervals; Figure 5, the same over fill.
import re
from collections import Counter

import matplotlib.pyplot as plt
import numpy
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from analysis.core.gather import gather
from analysis.core.style import GREY, Look, legend, missing, number_axis
from analysis.core.text import bounded
from analysis.core.timing import EQUIVALENT
from analysis.map import paper
from analysis.map.cells import map_cells
from analysis.map.results import of

OPAQUE, PALE = 0.85, 0.4
BAND = (-19.0, -3.0)  # where cells of own fill stand, in % of the axis above
NOTHING = {"facecolor": "white", "edgecolor": "#c4c4c4", "hatch": "...", "linewidth": 0}
MARKS = {  # of what several machines say together: marker, whether it is full, words
    "decided": ("o", True, "one is among the best on all machines"), "several": ("o", False, "several are"), "differs": ("X", True, "none is")}
OUTCOMES = {"decided": "wins", "equivalent": "as fast in", "open": "may be in"}
PAPER_END = 160  # variables, right end of the paper's axis
FIGURE_5 = 100   # variables of the paper's
LEADERS = 1.5    # ratio at which the upper panel ends
DODGE = 0.6      # width over which the contenders of a size are spread
FOLLOWERS = 7    # ratio at which the panel over fill ends
SHIFT = 0.25     # % of n², of the next contender over fill


def draw(tables, view, agreed={}):
    """`agreed`: {layer: {scene: verdict}} of study/merge."""
    results, look = of(tables, view), Look(view.registry)
    pair = "".join(results.samples().blas.mode()[:1]) or "none"  # that of most: other pairs are in no layer
    return {"f7_map": fastest(results, look, f"Figure 7: fastest library over size and fill; BLAS pair: {pair}", results.layer("libraries"),
                              agreed=agreed.get("libraries", {})),
            "map_all": fastest(results, look, f"Fastest of all, code of our own included; BLAS pair: {pair}", results.layer("all"), agreed=agreed.get("all", {})),
            "f4_sparse_solvers": sparse(results, look), "f5_fill": over_fill(results, look)}


def fastest(results, look, title, names, letters=13, line=2.2, agreed={}):
    """The map of some contenders. A cell has `letters` in a line of text, which is `line` % of the axis high. `agreed`: {scene: verdict}
    of study/merge, of those that several machines were compared on."""
    cells = map_cells(results, names)
    sizes = gather((cell.variables, cell) for cell in cells)
    figure, axes = plt.subplots(figsize=(max(5.0, 0.9 + 1.02 * len(sizes)), 7.4))
    axes.set_title(title)
    if not any(cell.ranking for cell in cells):
        return missing("nobody of these was timed", axes)
    for place, mine in enumerate(sizes.values()):
        _column(axes, place - 0.5, mine, look, (letters, line, list(results.variants)), agreed)
    axes.axhline(0, color="#444444", linewidth=0.8)
    axes.set(xlim=(-0.5, len(sizes) - 0.5), ylim=(BAND[0], 100))
    axes.set_yticks([sum(BAND) / 2, 0, 20, 40, 60, 80, 100], ["own\nfill", "0", "20", "40", "60", "80", "100"])
    axes.set_xticks(range(len(sizes)), [f"{one:g}" for one in sizes])
    axes.tick_params(axis="x", length=0, labelsize=9.0)
    axes.tick_params(axis="y", labelsize=9.0)
    axes.spines["bottom"].set_visible(False)
    axes.set_xlabel("variables n", fontsize=9.5)
    axes.set_ylabel("non-zeros of the tangent, % of n²", fontsize=9.5)
    _legend(axes, cells, look, names, {*agreed.values()})
    return figure


def bounds(fills, own):
    """Lower edge of each cell of artificial fill and the last one's upper edge, %: neighbours meet half-way, the first
    begins half-way to the own fill, the last ends half the last gap above. Nothing is claimed of fills beyond."""
    if not fills:
        return []
    places = [own, *fills] if own is not None else fills
    edges = [(low + high) / 2 for low, high in zip(places, places[1:])]
    gap = places[-1] - places[-2] if len(places) > 1 else 0.0
    return [*(edges if own is not None else [fills[0], *edges]), min(100.0, fills[-1] + gap / 2)]


def _column(axes, left, cells, look, room, agreed):
    """The cells of a size, and what was not measured."""
    natural = [cell for cell in cells if cell.fill_asked is None]
    filled = [cell for cell in cells if cell.fill_asked is not None]
    own = natural[0].fill_percent if natural else None
    edges = bounds([cell.fill_percent for cell in filled], own)
    axes.add_patch(Rectangle((left, 0), 1, 100, **NOTHING))
    if own is not None:  # below the own fill there is no tangent of this mechanism
        axes.add_patch(Rectangle((left, 0), 1, own, facecolor="white", linewidth=0))
        axes.plot([left, left + 1], [own, own], color=GREY, linewidth=1.2, zorder=5)
        _cell(axes, left, BAND[0], BAND[1] - BAND[0], natural[0], look, room, agreed)
    for cell, low, high in zip(filled, edges, edges[1:]):
        _cell(axes, left, low, high - low, cell, look, room, agreed)


def _shown(cell):
    """Names whose colours a cell has."""
    return cell.winners if cell.settled else cell.winners[:2]


def _cell(axes, x, y, height, cell, look, room, agreed):
    """Nothing where nobody was timed. A winner is opaque; those that are as fast stand in stripes of their colours; open cells are pale and hatched."""
    if not (shown := _shown(cell)):
        return
    axes.add_patch(Rectangle((x, y), 1, height, facecolor="white", linewidth=0))
    for place, name in enumerate(shown):
        axes.add_patch(Rectangle((x + place / len(shown), y), 1 / len(shown), height, linewidth=0,
                                 facecolor=look.colour(name), alpha=PALE if cell.outcome == "open" else OPAQUE))
    axes.add_patch(Rectangle((x, y), 1, height, facecolor="none", edgecolor="white", linewidth=1.0))
    if cell.outcome == "open":
        axes.add_patch(Rectangle((x, y), 1, height, facecolor="none", edgecolor="#555555", linewidth=0, hatch="////"))
    letters, line, known = room
    names = [broken(one, letters) for one in (cell.ranking.winner, shorter(cell.ranking.winner, known))]
    if said := next((one for one in (*([*name, _margin(cell)] for name in names), *names) if len(one) * line <= height), None):
        axes.text(x + 0.47, y + height / 2, "\n".join(said), ha="center", va="center", fontsize=6.6, linespacing=1.1, zorder=6,
                  bbox={"boxstyle": "square,pad=0.05", "facecolor": "white", "alpha": 0.82, "linewidth": 0})
    if agreed.get(cell.scene) in MARKS:
        marker, full, _ = MARKS[agreed[cell.scene]]
        axes.plot(x + 0.93, y + height - 0.45 * line, marker, markersize=4, color="black", markerfacecolor="black" if full else "white",
                  markeredgewidth=0.7, zorder=7)


def shorter(name, names):
    """A name without the first parts of its folder, as long as it is the end of no other one: "cholmod/supernodal"."""
    folder, _, variant = name.partition("/")
    words = folder.split("_")
    ends = ("_".join(words[first:]) + f"/{variant}" for first in reversed(range(len(words))))
    return next((end for end in ends if not any(other != name and other.endswith(end) for other in names)), name)


def broken(name, letters):
    """A name in lines of at most so many letters: ["csc_ldl/", "uplooking"]."""
    lines = [""]
    for piece in re.findall(r"[^_/]+[_/]?", name):
        if lines[-1] and len(lines[-1] + piece) > letters:
            lines.append("")
        lines[-1] += piece
    return lines


def _margin(cell):
    """"1.32×": how far the second is behind; "= 2 more" that are as fast; "? 3 more" that may be."""
    if cell.ranking.second is None:
        return "alone"
    if cell.decided:
        value = cell.ranking.margin.value
        return f"{value:.2f}×" if value < 9.95 else f"{value:.0f}×"
    return f"{'=' if cell.settled else '?'} {len(cell.winners) - 1} more"


def _legend(axes, cells, look, names, verdicts):
    counts = {name: Counter(cell.outcome for cell in cells if name in cell.winners) for name in names}
    drawn = {name for cell in cells for name in _shown(cell)}
    shown = [Patch(facecolor=look.colour(name), alpha=OPAQUE, label=f"{name}: " + ", ".join(
        f"{words} {counts[name][outcome]}" for outcome, words in OUTCOMES.items() if counts[name][outcome])) for name in names if name in drawn]
    more = sum(bool(counts[name]) and name not in drawn for name in names)
    shown += [Patch(facecolor="none", label=f"{more} more may be the fastest of an open cell")] if more else []
    shown += [Patch(facecolor="#dddddd", edgecolor="#555555", hatch="////", linewidth=0, label="open: two of those that may be the fastest"),
              Patch(**NOTHING, label="not measured"), Patch(facecolor="white", edgecolor=GREY, label="white: below the own fill (line)")]
    shown += [Patch(facecolor="none", label=text) for text in ("1.32×: the second behind the winner", "= 2 more: as fast, within 5 %",
                                                              "? 2 more: may be as fast")]
    shown += [Line2D([], [], linestyle="none", marker=marker, color="black", markerfacecolor="black" if full else "white", markersize=5, label=words)
              for verdict, (marker, full, words) in MARKS.items() if verdict in verdicts]
    axes.legend(handles=shown, loc="upper left", bbox_to_anchor=(1.01, 1.01), fontsize=8)


def sparse(results, look):
    names, sizes = paper.sparse(results, others=True), results.sizes
    found = {}  # {name: {size: Versus to the one of least time}}; None for that one itself
    for size in sizes:
        scene = results.natural(size)
        best = results.fastest(scene, names)
        for name in names if best else ():
            one = results.versus(scene, name, best)
            if one or name == best:
                found.setdefault(name, {})[size] = one
    figure, panels = plt.subplots(2, 1, figsize=(max(8.0, 1.1 * len(sizes)), 8.4), sharex=True,
                                  gridspec_kw={"hspace": 0.08, "height_ratios": [1.2, 1]})
    panels[0].set_title("Figure 4: sparse solvers of libraries at the four-bar's own fill")
    if not found:
        return missing("no sparse library was timed at its own fill", *panels)
    beyond = [place for place, size in enumerate(sizes) if size > PAPER_END]
    for axes in panels:
        for number, (name, series) in enumerate(found.items()):  # side by side at their size
            places = [sizes.index(size) + DODGE * ((number + 0.5) / len(found) - 0.5) for size in series]
            known = [(place, one) for place, one in zip(places, series.values()) if one and bounded(one.low, one.high)]
            axes.plot(places, [one.value if one else 1.0 for one in series.values()], label=name, **look.line(name) | {"linestyle": "none"})
            axes.vlines([place for place, _ in known], [one.low for _, one in known], [one.high for _, one in known],
                        color=look.colour(name), linewidth=2.2, alpha=0.6)
        axes.axhline(1, color="#444444", linewidth=0.8)
        axes.set(xlim=(-0.5, len(sizes) - 0.5), ylabel="time ÷ the least at that size")
        axes.grid(True, axis="y", which="major")
        for place in numpy.arange(0.5, len(sizes) - 1):
            axes.axvline(place, color="#e4e4e4", linewidth=0.8, zorder=0)
        if beyond:
            axes.axvspan(beyond[0] - 0.5, len(sizes) - 0.5, color="#f3f3f3", zorder=-1)
    panels[0].set(ylim=(0.96, LEADERS))
    panels[1].set_xlabel("variables n, own fill")
    number_axis(panels[1].yaxis, "×")
    outcomes = {cell.variables: {"decided": "", "equivalent": "as fast", "open": "open"}[cell.outcome]
                for cell in map_cells(results, list(found)) if cell.fill_asked is None}
    panels[1].set_xticks(range(len(sizes)), [f"{size:g}\n{outcomes.get(size, '')}" for size in sizes])
    legend(panels[0], order=list(found).index)
    notes = (f"above: those within {LEADERS:g} times the least time; bars: 95 % interval over processes, none of a single one; "
             "grey: beyond the paper's sizes\n"
             f"open: not shown who of these is fastest; as fast: several are, to {100 * EQUIVALENT - 100:.0f} %; who is not "
             "there was not timed (reasons: table of failures)")
    figure.text(figure.subplotpars.left, 0.03, notes, fontsize=7.5, color=GREY, va="top", linespacing=1.35)
    return figure


def over_fill(results, look):
    """Above: µs a pass; below: over the least time at that fill. Lines break where a fill was not timed."""
    samples = results.samples().assign(us=lambda rows: rows.step_us * rows.steps / rows.passes)
    fills = samples.groupby("variables").fill_percent.nunique()
    size = min(fills.index[fills > 2], key=lambda one: abs(one - FIGURE_5), default=None)
    figure, (times, ratios) = plt.subplots(2, 1, figsize=(8.4, 8.4), sharex=True, gridspec_kw={"hspace": 0.08})
    if size is None:
        return missing("no size was timed at three fills or more", times, ratios)
    samples = samples[samples.variables == size]
    scenes = samples.groupby("fill_percent").scene.first()
    us = samples.groupby(["implementation", "fill_percent"]).us.agg(["median", "min", "max"])
    sparse_ones = [name for name in paper.sparse(results, others=True) if name in us.index]
    hybrid = [name for name in results.layer("libraries") if name.startswith("hybrid_dense/")]
    groups = (("dense", paper.dense(results), "-"), ("sparse evaluation, dense solver", hybrid, "--"))
    lines = {name: (dict.fromkeys(us.loc[name].index, name), look.line(name)) for name in sparse_ones}  # {label: ({fill: who}, keywords)}
    for who, those, dash in groups:
        led = {fill: name for fill, scene in scenes.items() if (name := results.fastest(scene, those))}
        style = {"color": "black", "linestyle": dash, "linewidth": 2.2, "zorder": 1.5}
        lines[f"{who}, the fastest: {', '.join(dict.fromkeys(led.values()))}"] = led, style
    best = {fill: results.fastest(scene, sum((those for _, those, _ in groups), sparse_ones)) for fill, scene in scenes.items()}
    for place, (label, (led, style)) in enumerate(lines.items()):
        rows = us.reindex([(led.get(fill), fill) for fill in scenes.index])
        times.plot(scenes.index, rows["median"], label=label, **style)
        times.vlines(scenes.index, rows["min"], rows["max"], color=style["color"], linewidth=2.2, alpha=0.6)
        at = scenes.index + SHIFT * (place - len(lines) / 2)
        found = [results.versus(scene, led.get(fill), best[fill]) for fill, scene in scenes.items()]
        alone = [1.0 if led.get(fill, "") == best[fill] else numpy.nan for fill in scenes.index]
        ratios.plot(at, [one.value if one else value for one, value in zip(found, alone)], **style)
        for x, one in zip(at, found):
            if one and bounded(one.low, one.high):
                ratios.vlines(x, one.low, one.high, color=style["color"], linewidth=2.2, alpha=0.6)
    times.set(title=f"Figure 5: sparse solvers of libraries over fill, and the fastest dense ones, n = {size:g}", ylabel="time of a pass, µs")
    ratios.set(xlabel="non-zeros of the tangent, % of n²", ylabel="time ÷ the least at that fill", ylim=(0.93, FOLLOWERS))
    number_axis(times.yaxis)
    number_axis(ratios.yaxis, "×")
    for axes in (times, ratios):
        axes.grid(True, which="major")
    legend(times, order=list(lines).index)
    notes = (f"above: median of processes; bars: least to largest. Below: those within {FOLLOWERS:g} times the least time, side by side; bars: 95 % "
             "interval.\nWho is not there was not timed (reasons: table of failures)")
    figure.text(figure.subplotpars.left, 0.04, notes, fontsize=7.5, color=GREY, va="top")
    return figure
