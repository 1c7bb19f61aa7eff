# The battery as matrices: a row a cell, a column an implementation and setting, colour the outcome.
import math

import matplotlib.pyplot as plt
from matplotlib.colors import Normalize
from matplotlib.patches import Patch, Rectangle

from analysis.accuracy.front import GOOD
from analysis.extremes.numbers import FORMS, ran
from analysis.style import GREY

SHADES, DIGITS = plt.get_cmap("Greens"), Normalize(-16, -2)  # of what is ok or plausible, by the exponent of the true error
LOOKS = {  # (colour, hatch)
    "degraded": ("#F2C14E", ""), "not-converged": ("#E69F00", "////"), "wrong-branch": ("#CC79A7", ""),
    "diverged": ("#9a9a9a", ""), "timeout": ("#56B4E9", ""), "crashed": ("#5B3A9E", ""),
    "out-of-memory": ("#8C4A1F", ""), "refused": ("#e9edf3", "...."), "unsupported": ("#ffffff", "xxxx"),
    "not run": ("#ffffff", "")}
OTHER = ("#ffffff", "++++")
SILENT, UNJUDGED = "#D00000", "ok or plausible, not judged"
WORDS = {"ok": "ok or plausible", "silent": "silently wrong: ok or plausible beyond its class"}
NARROW, UPRIGHT = 6, 2.3  # the name of a setting with fewer columns is upright and takes so many inches


def figures(table):
    """(name, figure) of battery.csv: the two forms in every cell, the other settings in theirs."""
    forms = table.setting.isin(FORMS)
    for name, rows in (("battery", table[forms]), ("battery-settings", table[~forms])):
        if len(rows):
            yield name, draw(rows)


def draw(table):
    settings = list(dict.fromkeys(table.setting))
    columns = list(dict.fromkeys(zip(table.setting, table.implementation)))
    columns.sort(key=lambda column: settings.index(column[0]))
    cells = list(dict.fromkeys(zip(table.axis, table.value)))
    places = _places(cells)
    wide, high = len(columns), max(places.values()) + 1
    figure, axes = plt.subplots(figsize=(0.34 * wide + 3.2, 0.2 * high + 2.4))
    used = {_draw_cell(axes, columns.index((row.setting, row.implementation)),
                       places[row.axis, row.value], row) for row in table.itertuples()}
    axes.set_xlim(0, wide)
    axes.set_ylim(high, 0)
    axes.set_xticks([x + 0.5 for x in range(wide)], [name for _, name in columns], rotation=90, fontsize=8)
    axes.xaxis.tick_top()
    axes.set_yticks([places[cell] + 0.5 for cell in cells], [value for _, value in cells], fontsize=8)
    axes.tick_params(length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)
    _groups(axes, columns, cells, places)
    axes.annotate(title(table), (0, 1), xycoords="axes fraction", xytext=(-165, 160), textcoords="offset points",
                  fontsize=13, color=SILENT if table.silent.any() else "black")  # above the longest name
    upright = table.groupby("setting").implementation.nunique().min() < NARROW
    below = (UPRIGHT if upright else 0.25) / (figure.get_figheight() * axes.get_position().height)
    axes.legend(handles=_legend(used), loc="upper center", bbox_to_anchor=(0.4, -below), ncols=5, fontsize=8.5,
                title="number and shade: exponent of the true error, in lengths of a link; ≤: no larger than that of the truth", title_fontsize=8.5)
    return figure


def title(table):
    silent = int(table.silent.sum())
    return f"{silent} silent wrong{'' if silent == 1 else 's'} in {len(ran(table))} runs"


def kind(row):
    """What a cell is drawn as."""
    if row.silent:
        return "silent"
    if row.status in GOOD:
        return "ok" if row.true_error == row.true_error else UNJUDGED
    return row.status if row.status in LOOKS else "other failure"


def _places(cells):
    """{cell: its row}, axes apart by half a row."""
    places, at, last = {}, 0.0, cells[0][0]
    for cell in cells:
        at += 0.6 if cell[0] != last else 0.0
        places[cell], at, last = at, at + 1, cell[0]
    return places


def _draw_cell(axes, x, y, row):
    what = kind(row)
    bound = row.true_error <= row.truth_error  # nothing is shown below what the truth itself is good for
    power = _power(row.truth_error if bound else row.true_error)
    if what == "ok":
        colour, hatch = SHADES(0.08 + 0.6 * DIGITS(power)), ""
    else:
        colour, hatch = {"silent": (SILENT, ""), UNJUDGED: (SHADES(0.1), "////")}.get(what) or \
            LOOKS.get(what, OTHER)
    axes.add_patch(Rectangle((x, y), 1, 1, facecolor=colour, hatch=hatch, linewidth=0.4,
                             edgecolor="#b5b5b5" if hatch or what == "not run" else "white"))
    if what in ("ok", "silent", "degraded"):
        shown = f"{'≤' * bound}{power:d}".replace("-", "−")
        axes.text(x + 0.5, y + 0.53, shown, ha="center", va="center", fontsize=6.5,
                  color="white" if what == "silent" else "black")
    return what


def _power(error):
    if not error == error:
        return 0
    return math.floor(math.log10(max(error, 1e-17))) if error < 1e99 else 99


def _groups(axes, columns, cells, places):
    for setting in dict.fromkeys(setting for setting, _ in columns):
        own = [x for x, (its, _) in enumerate(columns) if its == setting]
        axes.text(own[0] + 0.1, axes.get_ylim()[0] + 0.3, setting, va="top", fontsize=9,
                  rotation=90 if len(own) < NARROW else 0)
        axes.axvline(own[0], color="black", linewidth=0.8)
    for axis in dict.fromkeys(axis for axis, _ in cells):
        first = min(places[cell] for cell in cells if cell[0] == axis)
        axes.annotate(axis, (0, first + 0.5), xytext=(-165, 0), textcoords="offset points",
                      va="center", fontsize=9, fontweight="bold", annotation_clip=False)


def _legend(used):
    looks = {"silent": (SILENT, ""), "ok": (SHADES(0.4), ""), UNJUDGED: (SHADES(0.1), "////"), **LOOKS,
             "other failure": OTHER}
    return [Patch(facecolor=colour, hatch=hatch, edgecolor=GREY,
                  label=WORDS.get(name, name))
            for name, (colour, hatch) in looks.items() if name in used]
