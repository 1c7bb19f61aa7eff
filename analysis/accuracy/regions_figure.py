# Who meets a required error in the least time, over size and fill: a panel for libraries, one for all.
import matplotlib.pyplot as plt
from matplotlib.patches import Patch, Rectangle

from analysis.accuracy.winners import LAYERS, NOBODY, NOT_TIMED, met
from analysis.accuracy.work_figure import TITLES
from analysis.core.text import number, step

STRONG, WEAK = 0.95, 0.45  # a winner that is decided or has its equals named; one that is open
NONE = {"facecolor": "white", "edgecolor": "#bbbbbb", "hatch": "...", "linewidth": 0}


def draw(winners, look):
    errors = sorted(winners.required.unique())
    scenes = winners.drop_duplicates("scene").sort_values(["variables", "fill_asked"], na_position="first")
    figure, panels = plt.subplots(len(LAYERS), 1, squeeze=False, constrained_layout=True,
                                  figsize=(2.6 + 1.02 * max(len(scenes), 5), len(LAYERS) * (1.3 + 0.52 * len(errors))))
    for axes, layer in zip(panels.flat, LAYERS):
        rows = winners[winners.layer == layer]
        for row in rows.itertuples():
            _cell(axes, row, list(scenes.scene).index(row.scene), errors.index(row.required), look)
        axes.set(xlim=(0, len(scenes)), ylim=(0, len(errors)))
        axes.set_xticks([place + 0.5 for place in range(len(scenes))], [
            f"n = {one.variables:.0f}\n" + ("own fill" if one.fill_asked != one.fill_asked else f"fill {one.fill_asked:.0%}")
            for one in scenes.itertuples()])
        axes.set_yticks([place + 0.5 for place in range(len(errors))], [f"{number(error)} m" for error in errors])
        axes.set_ylabel("error at most")
        axes.tick_params(length=0)
        axes.set_title(f"N-four-bar, fastest of {TITLES[layer]}")
        axes.legend(handles=_legend(rows, look), loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8.5)
    return figure


def _cell(axes, row, x, y, look):
    if row.implementation in (NOBODY, NOT_TIMED):
        axes.add_patch(Rectangle((x, y), 1, 1, **NONE))
        text, colour = row.implementation, "#777777"
    else:
        settled = bool(row.settled)
        axes.add_patch(Rectangle((x, y), 1, 1, edgecolor="white", linewidth=1.2, facecolor=look.colour(row.implementation),
                                 alpha=STRONG if settled else WEAK))
        if not settled:
            axes.add_patch(Rectangle((x, y), 1, 1, facecolor="none", edgecolor="#555555", linewidth=0, hatch="////"))
        others = len(row.equivalent.split("; ")) if row.equivalent else 0
        text = f"{row.setting}\n{step(row.step)}" + (f"  ≈{others}" if others else "")
        colour = "black"
    axes.text(x + 0.5, y + 0.5, text, ha="center", va="center", fontsize=6.8, linespacing=1.2, color=colour, zorder=6,
              bbox={"boxstyle": "round,pad=0.15", "facecolor": "white", "linewidth": 0, "alpha": 0.78})


def _legend(rows, look):
    won = met(rows).implementation.value_counts()
    handles = [Patch(facecolor=look.colour(name), alpha=STRONG, label=f"{name}: {count}") for name, count in won.items()]
    if (rows.settled == False).any():  # noqa: E712 (a nullable flag)
        handles.append(Patch(facecolor="#cccccc", hatch="////", edgecolor="#555555", linewidth=0, label="open"))
    if (rows.equivalent != "").any():
        handles.append(Patch(facecolor="none", label="≈1: one other is as fast"))
    for kind, text in ((NOBODY, "nobody: no run meets the error"), (NOT_TIMED, "not timed: too long, or dropped")):
        if (rows.implementation == kind).any():
            handles.append(Patch(**NONE, label=text))
    return handles
