# The map of real mechanisms: who is fastest, by family and size; and how far ahead code without a library is.
import matplotlib.pyplot as plt
import numpy
from matplotlib.patches import Patch, Rectangle

from analysis.core.style import Look, missing
from analysis.core.text import number

WIDTH, HEIGHT = 0.3, 0.34  # of a field: in decades of n, in rows


def draw(tables, view):
    return {"map": real_map(tables["winners"], tables["scenes"], Look(view.registry), view.context.get("cpu_model", ""))}


def real_map(winners, scenes, look, machine):
    """A field a mechanism: the fastest library, split among those that are as fast, hatched where that is not known.
    Below it the fastest code of our own, with how many times faster than that library it is."""
    rows = winners[(winners.layer == "libraries") & (winners.winner != "") & winners.variables.notna()]
    families = list(dict.fromkeys(winners.family))
    figure, axes = plt.subplots(figsize=(10.5, 0.62 * max(1, len(families)) + 1.6))
    if rows.empty:
        missing(axes, "nobody was timed")
        return figure
    shown = {}
    for row in rows.itertuples():
        place, at = families.index(row.family), numpy.log10(row.variables)
        members = row.equivalent.split()  # the winner first
        for k, name in enumerate(members):
            shown.setdefault(name, look.colour(name))
            axes.add_patch(Rectangle((at - WIDTH / 2 + k * WIDTH / len(members), place - HEIGHT / 2), WIDTH / len(members), HEIGHT,
                                     facecolor=look.colour(name), edgecolor="white", linewidth=0.8,
                                     hatch="" if row.settled or row.decided else "////"))
        axes.text(at, place - HEIGHT / 2 - 0.03, f"{number(row.step_us)} µs", ha="center", va="bottom", fontsize=7.5)
        lead = _lead(winners, scenes, row.scene)
        axes.text(at, place + HEIGHT / 2 + 0.02, lead, ha="center", va="top", fontsize=7.5, color="#333333")
    axes.set_xlim(numpy.log10(rows.variables.min()) - WIDTH, numpy.log10(rows.variables.max()) + WIDTH)
    ticks = [power for power in range(1, 6) if axes.get_xlim()[0] <= power <= axes.get_xlim()[1]]
    axes.set_xticks(ticks, [f"{10**power}" for power in ticks])
    axes.set_xlabel("variables n")
    axes.set_yticks(range(len(families)), families)
    axes.set_ylim(len(families) - 0.35, -0.65)
    axes.tick_params(axis="y", length=0)
    axes.set_title(f"Fastest library on real mechanisms, {machine}")
    axes.legend(handles=[*(Patch(facecolor=colour, label=name) for name, colour in shown.items()),
                         Patch(facecolor="white", edgecolor="#444444", hatch="////", label="not decided")],
                loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=8.5)
    return figure


def _lead(winners, scenes, scene):
    """"fronts 2.1×": the fastest of all where it is no library, over the fastest library."""
    best = winners[(winners.layer == "all") & (winners.scene == scene)].iloc[0].winner
    row = scenes[(scenes.scene == scene) & (scenes.implementation == best)]
    if row.empty or not row.to_rival.iloc[0] < 1:
        return ""
    return f"{best.partition('/')[2]} {number(1 / row.to_rival.iloc[0], 2)}×"
