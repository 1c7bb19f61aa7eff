# The price of a simple choice: how much is lost everywhere by always using one implementation.
from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.patches import Rectangle

from analysis.core.style import GREY, missing

WORST = 50.0       # ratio at which the colours end
COLOURS = plt.get_cmap("Purples")
DARK = 8.0         # ratio from which numbers are white
ROUGH = "#E69F00"  # frame of a pilot's ratio


@dataclass(frozen=True)
class Regret:
    """Time of one implementation over the best of each cell."""
    name: str
    ratios: dict       # {scene: ratio}
    rough: frozenset   # scenes whose ratio is a pilot's
    failed: frozenset  # scenes

    @property
    def mean(self):
        """Geometric mean over the cells that have a ratio; infinite if there is none."""
        known = list(self.ratios.values())
        return float(numpy.exp(numpy.mean(numpy.log(known)))) if known else numpy.inf

    @property
    def worst(self):
        return max(self.ratios.values(), default=numpy.inf)

    @property
    def where(self):
        """The scene of the worst ratio; "" if there is none."""
        return max(self.ratios, key=self.ratios.get, default="")


def regrets(results, cells, names):
    """One Regret a name, the lowest geometric mean first; after all others those that fail in some cell or lack a ratio
    in one, as nobody can always use them."""
    found = [_regret(results, name, [cell for cell in cells if cell.ranking]) for name in names]
    return sorted(found, key=lambda one: (bool(one.failed), -len(one.ratios), one.mean))


def _regret(results, name, cells):
    ratios, rough, failed = {}, set(), set()
    for cell in cells:
        rows = results.rows(cell.scene)
        pilots = rows[rows.implementation.isin([name, cell.ranking.winner])].groupby("implementation").pilot_us.first()
        if name in cell.ranking.ratios:
            ratios[cell.scene] = cell.ranking.ratios[name].value
        elif name in cell.failed:
            failed.add(cell.scene)
        elif pilots.notna().sum() == 2:
            ratios[cell.scene] = float(pilots[name] / pilots[cell.ranking.winner])
            rough.add(cell.scene)
    return Regret(name, ratios, frozenset(rough), frozenset(failed))


def draw(results, cells, names):
    """A row an implementation, a column a cell."""
    found = regrets(results, cells, names)
    cells = [cell for cell in cells if cell.ranking]
    figure, axes = plt.subplots(figsize=(3.0 + 0.34 * len(cells), 2.2 + 0.27 * len(found)))
    axes.set_title("Time lost by always using one library: its time over the best library's in each cell")
    if not cells:
        missing(axes, "nobody was timed")
        return figure
    norm = LogNorm(1, WORST)
    for down, one in enumerate(found):
        for across, cell in enumerate(cells):
            _square(axes, across, down, one, cell.scene, norm)
    sizes = [cell.variables for cell in cells]
    for place, (before, after) in enumerate(zip(sizes, sizes[1:]), start=1):
        if before != after:
            axes.axvline(place, color="#444444", linewidth=1)
    axes.set(xlim=(0, len(cells)), ylim=(len(found), 0))
    axes.set_xticks([place + 0.5 for place in range(len(cells))], [_fill(cell) for cell in cells], fontsize=7, rotation=90)
    axes.set_yticks([place + 0.5 for place in range(len(found))], [_label(one, len(cells)) for one in found], fontsize=8)
    axes.tick_params(length=0)
    top = axes.secondary_xaxis("top")
    middle = {size: numpy.mean([place + 0.5 for place, one in enumerate(sizes) if one == size]) for size in sizes}
    top.set_xticks(list(middle.values()), [f"{size:g}" for size in middle], fontsize=8)
    top.tick_params(length=0)
    axes.set_xlabel("above: variables n; below: non-zeros of the tangent, %\nbehind names: geometric mean and worst\n"
                    "framed ~: too slow, by its pilot; ✕: failed or disagrees; –: nothing known", fontsize=7.5, color=GREY)
    bar = figure.colorbar(ScalarMappable(norm, COLOURS), ax=axes, extend="max", pad=0.01, fraction=0.02)
    ticks = [1, 1.5, 2, 3, 5, 10, 20, 50]
    bar.set_ticks(ticks, labels=[f"{tick:g}×" for tick in ticks], fontsize=7.5)
    bar.minorticks_off()
    return figure


def _fill(cell):
    return f"own {cell.fill_percent:.0f}" if cell.fill_asked is None else f"{cell.fill_percent:.0f}"


def _label(one, count):
    if not one.ratios:
        return f"{one.name}   –"
    return f"{one.name}   {short(one.mean)}×, {short(one.worst)}×" + (f", {len(one.ratios)} of {count}" * (len(one.ratios) < count))


def _square(axes, across, down, one, scene, norm):
    ratio = one.ratios.get(scene)
    axes.add_patch(Rectangle((across, down), 1, 1, linewidth=0.5, edgecolor="white",
                             facecolor="#f2f2f2" if ratio is None else COLOURS(norm(ratio))))
    if scene in one.rough:
        axes.add_patch(Rectangle((across + 0.06, down + 0.06), 0.88, 0.88, facecolor="none", linewidth=1, edgecolor=ROUGH))
    text = "✕" if scene in one.failed else "–" if ratio is None else ("~" if scene in one.rough else "") + short(ratio)
    axes.text(across + 0.5, down + 0.52, text, ha="center", va="center", fontsize=6,
              color="white" if ratio and ratio >= DARK else "black")


def short(ratio):
    """Few characters: 1.04, 2.3, 15."""
    return f"{ratio:.{2 if ratio < 1.995 else 1 if ratio < 9.95 else 0}f}"
