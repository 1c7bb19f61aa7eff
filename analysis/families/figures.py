# The map of real mechanisms, libraries first and code of our own beside; the rule on families that were left out.
from itertools import cycle

import matplotlib.pyplot as plt
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.path import Path

from analysis.core.style import ALTERNATIVES, GREY, MARKERS, Look, missing, number_axis
from analysis.core.text import number
from analysis.families.rule import WITHIN
from analysis.families.tables import SCHEMES

DECIDES = "per_column"  # beside n, the number that tells mechanisms apart; the page shows what each tells alone
FORMS = (*((4, 1, 0) if mark == "h" else mark for mark in MARKERS), "h", (8, 1, 0), Path.unit_circle_righthalf())  # of families
FILLS = ("full", "none", "left")  # of marks of code of our own, who is the fastest most often first


def draw(tables, view, agreed={}):
    return {"map": real_map(tables, Look(view.registry), view.registry, agreed.get("libraries", {})), "held": held_figure(tables["held"])}


def best_form(winners):
    """Winners among libraries in the paper's form of the step, or in the saddle-point form where that has none."""
    rows = winners[(winners.layer == "libraries") & (winners.winner != "")]
    return rows.sort_values("scheme", kind="stable").drop_duplicates("scene")  # SCHEMES are in the order of the alphabet


def real_map(tables, look, registry, agreed={}):
    """Left: a mark a mechanism, in the colour of its fastest library; a second colour inside is another that is as fast; empty
    inside: not decided. Right: how many times faster the fastest code of our own is. `agreed`: {scene: verdict} of study/merge."""
    mechanisms, winners, scenes = (tables[name] for name in ("mechanisms", "winners", "scenes"))
    figure, (left, right) = plt.subplots(1, 2, figsize=(13.5, 5.6), gridspec_kw={"width_ratios": [1.25, 1.0], "wspace": 0.16})
    rows = best_form(winners)
    if rows.empty or mechanisms[DECIDES].isna().all():
        return missing("nobody was timed", left, right)
    rows = rows.merge(mechanisms[["scene", "n", DECIDES]], on="scene")
    marks = {family: FORMS[place % len(FORMS)] for place, family in enumerate(dict.fromkeys(rows.family))}
    shown = {}
    for row in rows.itertuples():
        members = row.equivalent.split()
        shown |= {name: look.colour(name) for name in members}
        left.plot(row.n, getattr(row, DECIDES), marker=marks[row.family], markersize=10.5, markeredgewidth=2.6, markeredgecolor=look.colour(members[0]),
                  markerfacecolor=look.colour(members[1] if len(members) > 1 else members[0]) if row.settled else "white", linestyle="none")
        if agreed.get(row.scene) == "differs":
            left.scatter(row.n, getattr(row, DECIDES), s=200, marker="s", facecolor="none", edgecolor="#444444", linewidth=0, hatch="/////", zorder=3)
    _scales(left, rows.n, rows[DECIDES], "non-zeros a column of the factor L (AMD's order)")
    left.set_title("Fastest library, by size and sparsity of the factor")
    _lead(right, rows, scenes, look, marks, registry)
    colours = [Patch(facecolor=colour, label=name) for name, colour in shown.items()]
    forms = [Line2D([], [], marker=mark, linestyle="none", color="#444444", label=family) for family, mark in marks.items()]
    empty = Line2D([], [], marker="o", linestyle="none", markerfacecolor="white", markeredgecolor="#444444", label="not decided")
    hatched = [Patch(facecolor="white", edgecolor="#444444", hatch="/////", label="depends on the machine")] if "differs" in rows.scene.map(agreed).values else []
    figure.legend(handles=[*colours, empty, *hatched], loc="upper left", bbox_to_anchor=(0.905, 0.9), fontsize=8.5, title="edge: fastest; inside: as fast",
                  title_fontsize=8.5, alignment="left")
    figure.legend(handles=forms, loc="upper left", bbox_to_anchor=(0.905, 0.58), fontsize=8.5, title="family", title_fontsize=8.5, alignment="left")
    return figure


def fastest_own(scenes, registry):
    """The row of the fastest code of our own on each mechanism, in the form that `best_form` takes."""
    own = scenes[scenes.implementation.isin(registry.own) & (scenes.status == "ok") & (scenes.verdict == "agrees") & scenes.to_rival.notna()]
    return own.sort_values(["scheme", "to_rival"]).drop_duplicates("scene")


def _lead(axes, rows, scenes, look, marks, registry):
    """Times faster than the fastest library, by size: the fastest code of our own on each mechanism."""
    fastest = fastest_own(scenes, registry).merge(rows[["scene", "scheme", "n"]], on=["scene", "scheme"])
    if fastest.empty:
        return missing("no code of our own was timed", axes)
    insides = dict(zip(fastest.implementation.value_counts().index, cycle(FILLS)))
    for row in fastest.itertuples():
        if row.to_rival_low > 0:  # on top, as most are shorter than their mark
            axes.plot([row.n, row.n], [1 / row.to_rival_high, 1 / row.to_rival_low], "_-", color="black", linewidth=0.9, markersize=4.5, zorder=3)
        axes.plot(row.n, 1 / row.to_rival, marker=marks[row.family], markersize=7.5, color=look.colour(row.implementation), linestyle="none",
                  fillstyle=insides[row.implementation], markerfacecoloralt="white")
    axes.axhline(1.0, color=GREY, linewidth=0.9)
    _scales(axes, fastest.n, 1 / fastest.to_rival, "times as fast as the fastest library")
    low, top = axes.get_ylim()
    axes.set_ylim(low, top * (top / low) ** 0.2)  # room for the legend, above all marks
    axes.set_title("Fastest code of our own, which is no library; 95 % intervals")
    axes.legend(handles=[Line2D([], [], marker="o", markersize=7.5, color=look.colour(name), linestyle="none", fillstyle=fill, markerfacecoloralt="white",
                                label=name) for name, fill in insides.items()], loc="upper left", fontsize=8.5, frameon=True, framealpha=0.85, edgecolor="none")


def _scales(axes, n, values, label):
    for axis, found in ((axes.xaxis, n), (axes.yaxis, values)):
        low, high = float(min(found)), float(max(found))
        room = (high / low) ** 0.05 if high > low else 1.5
        (axes.set_xlim if axis is axes.xaxis else axes.set_ylim)(low / room, high * room)
        number_axis(axis)
    axes.set(xlabel="variables n", ylabel=label)
    axes.grid(True, which="major")
    axes.set_axisbelow(True)


def held_figure(held):
    figure, (left, right) = plt.subplots(1, 2, figsize=(11.5, 4.6), gridspec_kw={"wspace": 0.25})
    rows = held[held.step_us.notna() & held.predicted_us.notna()] if len(held) else held
    if rows.empty:
        return missing("too few mechanisms for a rule", left, right)
    for scheme, mark, colour in zip(SCHEMES, ("o", "^"), ALTERNATIVES):
        some = rows[rows.scheme == scheme]
        left.plot(some.step_us, some.predicted_us / some.step_us, mark, color=colour, markersize=5.5, label=scheme, linestyle="none")
        right.plot(some.variables, 100 * some.loss, mark, color=colour, markersize=5.5, label=scheme, linestyle="none")
    for bound in (1 / WITHIN, WITHIN):
        left.axhline(bound, color=GREY, linewidth=0.9, linestyle="--")
    for axis in (left.xaxis, left.yaxis, right.xaxis):
        number_axis(axis)
    left.set(xlabel="measured step, µs", ylabel="predicted ÷ measured", title=f"Time of a step; dashed: within {number(WITHIN)} times")
    right.set(xlabel="variables n", ylabel="loss of the choice, %", title="Time lost by the chosen library")
    right.legend(fontsize=8.5, loc="upper left")
    figure.suptitle("Each family predicted by the others; the choice is among libraries", x=0.01, ha="left", fontsize=10)
    return figure
