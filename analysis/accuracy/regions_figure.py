# The region map for each required error: who meets it in the least time, over size and fill.
import matplotlib.pyplot as plt
from matplotlib.patches import Patch, Rectangle

from analysis.accuracy import names
from analysis.maps_drawing import DECIDED, UNDECIDED

NOBODY = {"facecolor": "white", "edgecolor": "#bbbbbb", "hatch": "...", "linewidth": 0}
SHORT = {"every-step": "every\nstep", "saddle every-step": "saddle\nevery step"}


def draw(winners, look):
    """The figure of winners.csv: a panel for each required error."""
    errors = sorted(winners.required.unique(), reverse=True)
    sizes = sorted(winners.variables.unique())
    levels = sorted(winners.fill_asked.dropna().unique())
    columns = min(3, len(errors))
    figure, panels = plt.subplots(-(-len(errors) // columns), columns, squeeze=False,
                                  figsize=(1.5 + columns * (1.1 + 0.78 * len(sizes)),
                                           -(-len(errors) // columns) * (1.2 + 0.85 * (len(levels) + 1))),
                                  constrained_layout=True)
    for axes, error in zip(panels.flat, errors):
        _panel(axes, winners[winners.required == error], sizes, levels, look)
        axes.set_title(f"error at most {error:g} m")
    for axes in panels[:, 0]:
        axes.set_ylabel("fill of the tangent")
    rest = panels.flat[len(errors):]
    for axes in rest:
        axes.set_axis_off()
    place = {"loc": "center left", "bbox_to_anchor": (0.0, 0.5)} if len(rest) else {
        "loc": "upper center", "bbox_to_anchor": (0.5, -0.25)}
    (rest[0] if len(rest) else panels.flat[-1]).legend(handles=_legend(winners, look), fontsize=9, **place)
    return figure


def _panel(axes, rows, sizes, levels, look):
    for row in rows.itertuples():
        x = sizes.index(row.variables)
        y = 0 if row.fill_asked != row.fill_asked else 1 + levels.index(row.fill_asked)
        nobody = row.implementation == "nobody"
        fill = NOBODY if nobody else {
            "edgecolor": "white", "linewidth": 1.2, "facecolor": look.colour(row.implementation),
            "alpha": DECIDED if row.decided else UNDECIDED}
        axes.add_patch(Rectangle((x, y), 1, 1, **fill))
        if not nobody and not row.decided:
            axes.add_patch(Rectangle((x, y), 1, 1, facecolor="none", edgecolor="#555555",
                                     linewidth=0, hatch="////"))
        text = "nobody" if nobody else (
            f"{SHORT.get(row.setting, row.setting.replace(' ', chr(10)))}\n{names.step(row.step)}")
        axes.text(x + 0.5, y + 0.5, text, ha="center", va="center", fontsize=6.6, linespacing=1.15,
                  color="#777777" if nobody else "black", zorder=6,
                  bbox={"boxstyle": "round,pad=0.15", "facecolor": "white", "linewidth": 0,
                        "alpha": 1.0 if nobody else 0.72})
    axes.set(xlim=(0, len(sizes)), ylim=(0, len(levels) + 1), xlabel="variables n")
    axes.set_xticks([place + 0.5 for place in range(len(sizes))], [f"{size:g}" for size in sizes])
    axes.set_yticks([place + 0.5 for place in range(len(levels) + 1)],
                    ["own", *(f"{level:.0%}" for level in levels)])
    axes.tick_params(length=0)


def _legend(winners, look):
    won = winners[winners.implementation != "nobody"].implementation.value_counts()
    handles = [Patch(facecolor=look.colour(name), alpha=DECIDED, label=f"{name}: {count}")
               for name, count in won.items()]
    return [*handles, Patch(facecolor="#cccccc", hatch="////", edgecolor="#555555", linewidth=0,
                            label="undecided: the interval includes 1"),
            Patch(**NOBODY, label="nobody meets the error"),
            Patch(facecolor="white", edgecolor="#bbbbbb", label="below the mechanism's own fill")]
