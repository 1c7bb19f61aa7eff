# The battery as matrices: a row a cell, a column who ends alike in a setting, colour the outcome.
import math
from textwrap import wrap

import matplotlib.pyplot as plt
from matplotlib.colors import Normalize
from matplotlib.patches import Patch, Rectangle

from analysis.core.style import GREY, LETTERS
from analysis.extremes.battery import groups, kind, ran
from analysis.extremes.cells import FORMS

SHADES, DIGITS = plt.get_cmap("Greens"), Normalize(-16, -2)  # of what is ok or plausible, by the exponent of the true error
SILENT = "#D00000"
LOOKS = {  # kind: (colour, hatch, words)
    "silent": (SILENT, "", "silently wrong: ok or plausible beyond its class"), "ok": (SHADES(0.4), "", "ok or plausible"),
    "unjudged": (SHADES(0.1), "////", "ok or plausible, not judged"),
    "degraded": ("#F2C14E", "", ""), "not-converged": ("#E69F00", "////", ""), "wrong-branch": ("#CC79A7", "", ""),
    "diverged": ("#9a9a9a", "", ""), "timeout": ("#56B4E9", "", ""), "crashed": ("#5B3A9E", "", ""),
    "out-of-memory": ("#8C4A1F", "", ""), "refused": ("#e9edf3", "....", ""), "unsupported": ("#ffffff", "xxxx", ""),
    "excluded": ("#ffffff", "", "left out: too large for dense ones"), "dropped": ("#ffffff", "--", "left out: budget"),
    "other": ("#ffffff", "++++", "other failure")}
WIDE, HIGH = 0.34, 0.2  # inches a square
LEFT = 2.6              # inches left of the squares
FEW = 14                # columns, up to which the cells stand in two blocks


def figures(table):
    """{name: figure}: the two forms in every cell, the other settings in theirs."""
    forms = table.setting.isin([form.name for form in FORMS])
    return {name: draw(rows, what) for name, rows, what in (("battery", table[forms], "The two forms at the extremes"), (
        "battery-settings", table[~forms], "Other settings at the extremes")) if len(ran(rows))}


def draw(table, what):
    """The figure of rows of battery.csv; `what` they are."""
    columns = [(setting, names, rows) for setting, found in groups(table).items() for names, rows in found]
    several = [names for names in dict.fromkeys(names for _, names, _ in columns) if len(names) > 1]
    labels = {names: f"{LETTERS[several.index(names)]}: {len(names)} alike" if names in several else names[0] for _, names, _ in columns}
    blocks = _blocks(list(dict.fromkeys(zip(table.axis, table.value))), 2 if len(columns) <= FEW else 1)
    settings = [setting for setting, _, _ in columns]
    upright = [setting for setting in settings if not _level(setting, settings)]
    wide, high = LEFT + WIDE * len(columns) + 0.2, HIGH * max(max(block.values()) + 1 for block in blocks)
    key = [line for names in several for line in
           wrap(f"{labels[names]}: {', '.join(names)}", round(wide * len(blocks) * 12), subsequent_indent="    ")]
    head = 0.075 * max(map(len, labels.values()), default=0)  # inches
    above, below = 0.8 + head + 0.075 * max(map(len, upright), default=0), 0.16 * len(key) + 0.9
    figure = plt.figure(figsize=(wide * len(blocks), high + above + below))
    used, across, up = set(), figure.get_figwidth(), figure.get_figheight()
    for number, block in enumerate(blocks):
        tall = max(block.values()) + 1
        axes = figure.add_axes(((wide * number + LEFT) / across, (below + high - HIGH * tall) / up,
                                WIDE * len(columns) / across, HIGH * tall / up))
        used |= {_square(axes, x, y, worst([found[cell] for found in rows]))
                 for x, (_, _, rows) in enumerate(columns) for cell, y in block.items() if cell in rows[0]}
        _frame(axes, [labels[names] for _, names, _ in columns], settings, block, head)
    figure.text(0.1 / across, 1 - 0.1 / up, f"{what}: {title(table)}", fontsize=13, va="top", color=SILENT if table.silent.any() else "black")
    figure.text(0.1 / across, (0.16 * len(key) + 0.1) / up, "\n".join(key), fontsize=8, va="top", linespacing=1.4)
    figure.legend(handles=[Patch(facecolor=colour, hatch=hatch, edgecolor=GREY, label=words or name)
                           for name, (colour, hatch, words) in LOOKS.items() if name in used],
                  loc="lower left", bbox_to_anchor=(0.05 / across, (0.16 * len(key) + 0.15) / up), fontsize=8,
                  ncols=max(3, round(across / 1.7)), title_fontsize=8, alignment="left",
                  title="number and shade: exponent of the largest true error, in lengths of a link; ≤: no larger than that of the truth")
    return figure


def title(table):
    silent = int(table.silent.sum())
    return f"{silent or 'no'} silent wrong{'s' * (silent > 1)} in {len(ran(table))} runs"


def worst(rows):
    """Of rows that are alike the one with the largest error; none is larger than one that is not known."""
    return max(rows, key=lambda row: math.inf if row.true_error != row.true_error else row.true_error)


def _blocks(cells, count):
    """[{cell: its row}]: the cells below each other, axes apart by half a row; in `count` blocks side by side."""
    axes = list(dict.fromkeys(axis for axis, _ in cells))
    cut = min(range(1, len(axes) + 1), default=1, key=lambda at: abs(
        sum(axis in axes[:at] for axis, _ in cells) - len(cells) / count))
    found = []
    for some in (axes[:cut], axes[cut:]):
        rows = [cell for cell in cells if cell[0] in some]
        found.append({cell: place + 0.6 * some.index(cell[0]) for place, cell in enumerate(rows)})
    return [block for block in found if block]


def _level(setting, settings):
    """Whether its name has room above its columns."""
    return settings.count(setting) * WIDE > 0.08 * len(setting)


def _square(axes, x, y, row):
    what = kind(row)
    bound = row.true_error <= row.truth_error  # nothing is shown below what the truth itself is good for
    power = _power(row.truth_error if bound else row.true_error)
    what = what if what in LOOKS else "other"
    colour, hatch, _ = LOOKS[what]
    axes.add_patch(Rectangle((x, y), 1, 1, facecolor=SHADES(0.08 + 0.6 * DIGITS(power)) if what == "ok" else colour,
                             hatch=hatch, linewidth=0.4, edgecolor="#b5b5b5" if hatch or what == "excluded" else "white"))
    if what in ("ok", "silent", "degraded"):
        axes.text(x + 0.5, y + 0.53, f"{'≤' * bound}{power:d}".replace("-", "−"), ha="center", va="center", fontsize=6.5,
                  color="white" if what == "silent" else "black")
    return what


def _power(error):
    if not error == error:
        return 0
    return math.floor(math.log10(max(error, 1e-17))) if error < 1e99 else 99


def _frame(axes, labels, settings, block, head):
    axes.set_xlim(0, len(labels))
    axes.set_ylim(max(block.values()) + 1, 0)
    axes.set_xticks([x + 0.5 for x in range(len(labels))], labels, fontsize=8, rotation=90)
    axes.xaxis.tick_top()
    axes.set_yticks([y + 0.5 for y in block.values()], [value for _, value in block], fontsize=8)
    axes.tick_params(length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)
    for setting in dict.fromkeys(settings):
        first, level = settings.index(setting), _level(setting, settings)
        axes.annotate(setting, (first + (0.1 if level else settings.count(setting) / 2), 0), xytext=(0, 72 * head + 8),
                      textcoords="offset points", va="bottom", ha="left" if level else "center", fontsize=9,
                      rotation=0 if level else 90, annotation_clip=False)
        axes.axvline(first, color="black", linewidth=0.8)
    for axis in dict.fromkeys(axis for axis, _ in block):
        first = min(y for cell, y in block.items() if cell[0] == axis)
        axes.annotate(axis, (0, first + 0.5), xytext=(-72 * LEFT + 8, 0), textcoords="offset points", va="center",
                      fontsize=9, fontweight="bold", annotation_clip=False)
