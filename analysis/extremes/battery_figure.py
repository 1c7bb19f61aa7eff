# The extreme cells as a matrix: a row a cell, a column a setting, colour the worst outcome over the implementations.
import math

import matplotlib.pyplot as plt
from matplotlib.colors import Normalize
from matplotlib.patches import Patch, Polygon, Rectangle

from analysis.core.style import GREY, nothing
from analysis.extremes.battery import NOT_RUN, kind, ran

SHADES, DIGITS = plt.get_cmap("Greens"), Normalize(-16, -2)  # of what is ok or plausible, by the exponent of the true error
SILENT = "#D00000"
LOOKS = {  # kind, the worst first: (colour, hatch, words)
    "silent": (SILENT, "", "silently wrong"), "other": ("#ffffff", "++++", "other failure"), "crashed": ("#5B3A9E", "", ""),
    "out-of-memory": ("#8C4A1F", "", ""), "timeout": ("#56B4E9", "", ""), "diverged": ("#9a9a9a", "", ""), "wrong-branch": ("#CC79A7", "", ""),
    "not-converged": ("#E69F00", "////", ""), "degraded": ("#F2C14E", "", ""), "unjudged": (SHADES(0.1), "////", "ok or plausible, not judged"),
    "ok": (SHADES(0.4), "", "ok or plausible"), "refused": ("#e9edf3", "....", "")}
SQUARE, LEFT, ABOVE = 0.24, 2.7, 1.9  # inches: of a square, left of them, above them


def draw(table):
    """The figure of extreme cells' rows of battery.csv; cells and settings of which nothing was run are counted."""
    asked, table = table, table[~table.status.isin(NOT_RUN) | (table.status == "refused")]
    if table.empty:
        return nothing("Nothing was run at the extremes.")
    left = [asked[name].drop_duplicates().shape[0] - table[name].drop_duplicates().shape[0] for name in (["axis", "value"], ["setting"])]
    cells, settings = list(dict.fromkeys(zip(table.axis, table.value))), list(dict.fromkeys(table.setting))
    axes_of = list(dict.fromkeys(axis for axis, _ in cells))
    up = {cell: place + 0.6 * axes_of.index(cell[0]) for place, cell in enumerate(cells)}
    wide, high = SQUARE * len(settings), SQUARE * (max(up.values()) + 1)
    figure = plt.figure(figsize=(LEFT + wide + 2.9, ABOVE + high + 0.2))
    across, tall = figure.get_size_inches()
    axes = figure.add_axes((LEFT / across, 0.2 / tall, wide / across, high / tall))
    axes.set(xlim=(0, len(settings)), ylim=(max(up.values()) + 1, 0))
    used = {_square(axes, settings.index(setting), up[axis, value], rows) for (axis, value, setting), rows in table.groupby(
        ["axis", "value", "setting"], sort=False)}
    axes.set_xticks([x + 0.5 for x in range(len(settings))], settings, fontsize=8, rotation=90)
    axes.xaxis.tick_top()
    axes.set_yticks([y + 0.5 for y in up.values()], [value for _, value in cells], fontsize=8)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    for axis in axes_of:
        first = next(y for cell, y in up.items() if cell[0] == axis)
        axes.annotate(axis, (0, first + 0.5), xytext=(-72 * LEFT + 8, 0), textcoords="offset points", va="center", fontsize=9,
                      fontweight="bold", annotation_clip=False)
    wrong = int((table.verdict == "silently wrong").sum())
    figure.suptitle(f"{wrong or 'No'} silent wrong{'s' * (wrong > 1)} in {len(ran(table))} runs at the extremes"
                    + (f"\nnot run: {left[0]} cells, {left[1]} settings" if any(left) else ""), x=0.02, y=1 - 0.1 / tall, ha="left",
                    va="top", fontsize=13, color=SILENT if wrong else "black")
    axes.legend(handles=[Patch(facecolor=colour, hatch=hatch, edgecolor=GREY, label=words or name) for name, (colour, hatch, words) in LOOKS.items()
                         if name in used], loc="upper left", bbox_to_anchor=(1.02, 1), fontsize=8)
    return figure


def _square(axes, x, y, rows):
    """Draws the worst of the rows of a cell and setting; a notch where implementations end differently. Its kind."""
    kinds = [kind(row) if kind(row) in LOOKS else "other" for row in rows.itertuples()]
    what = min(kinds, key=list(LOOKS).index)
    colour, hatch, _ = LOOKS[what]
    errors = rows.true_error.clip(lower=rows.truth_error)
    power = math.floor(math.log10(min(max(errors.max(), 1e-17), 1e99))) if errors.notna().any() else None
    shade = SHADES(0.08 + 0.6 * DIGITS(power)) if what == "ok" else colour
    axes.add_patch(Rectangle((x, y), 1, 1, facecolor=shade, hatch=hatch, linewidth=0.4, edgecolor="#b5b5b5" if hatch else "white"))
    if len(set(kinds)) > 1:
        axes.add_patch(Polygon([(x + 0.6, y), (x + 1, y), (x + 1, y + 0.4)], facecolor="black", linewidth=0))
    if what in ("ok", "silent", "degraded") and power is not None:
        axes.text(x + 0.48, y + 0.55, f"{power:d}".replace("-", "−"), ha="center", va="center", fontsize=6.5,
                  color="white" if what == "silent" else "black")
    return what
