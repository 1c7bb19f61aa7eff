# Do two runs of one map agree? Winners of the cells that both decided, and all margins.
import sys
from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy
from matplotlib.patches import Patch, Rectangle

from analysis.loader import TableError, load
from analysis.maps import MapCell, map_cells
from analysis.maps_drawing import cell_text, draw_grid
from analysis.style import Look, missing, save

AGREE, DIFFER, OPEN = "#8fc7b5", "#d1495b", "#e3e3e3"
LABELS = {AGREE: "decided in both, same winner", DIFFER: "decided in both, other winner",
          OPEN: "undecided in one run or both"}


@dataclass(frozen=True)
class Pair:
    """One scene in two runs."""
    first: MapCell
    second: MapCell

    @property
    def decided(self):
        """By both runs."""
        return all(cell.ranking is not None and cell.ranking.decided
                   for cell in (self.first, self.second))

    @property
    def agrees(self):
        return self.decided and self.first.ranking.winner == self.second.ranking.winner

    @property
    def colour(self):
        return AGREE if self.agrees else DIFFER if self.decided else OPEN


def shared_maps(first, second):
    """The cells of both runs, of the implementations that both of them have."""
    names = [name for name in first.implementations if name in second.implementations]
    return map_cells(first, names), map_cells(second, names)


def pairs(first, second):
    """{scene: Pair} of the cells that both maps have."""
    others = {cell.scene: cell for cell in second}
    return {cell.scene: Pair(cell, others[cell.scene]) for cell in first if cell.scene in others}


def summary(common):
    """Lines that say how many cells both decided alike, and which they did not."""
    decided = [pair for pair in common.values() if pair.decided]
    agreed = sum(pair.agrees for pair in decided)
    share = f"{100 * agreed / len(decided):.1f} %" if decided else "no share"
    lines = [f"{len(common)} common cells, {len(decided)} decided in both, {agreed} of them with "
             f"the same winner: {share}"]
    lines += [f"{scene}: {_outcome(pair.first.ranking)} | {_outcome(pair.second.ranking)}"
              for scene, pair in common.items() if pair.decided and not pair.agrees]
    return lines


def _outcome(ranking):
    if ranking.second is None:
        return f"{ranking.winner} alone"
    return (f"{ranking.winner} {ranking.margin:.3f} times ahead of {ranking.second} "
            f"({ranking.low:.3f} to {ranking.high:.3f})")


def time_ratios(common):
    """[(time in the first run, second / first)] of every implementation in every common cell."""
    found = []
    for pair in common.values():
        first, second = pair.first.times, pair.second.times
        found += [(first[name], second[name] / first[name]) for name in first if name in second]
    return numpy.array(found).reshape(-1, 2)


def differences(first, second):
    """Lines that say in what the two runs cannot be compared."""
    alone = sorted(set(first.implementations) ^ set(second.implementations))
    lines = [f"left out, in one run only: {', '.join(alone)}"] if alone else []
    scenes = [{cell.scene for cell in map_cells(results)} for results in (first, second)]
    if scenes[0] != scenes[1]:
        lines.append(f"cells in one run only: {len(scenes[0] - scenes[1])} in the first, "
                     f"{len(scenes[1] - scenes[0])} in the second")
    if set(first.tidy.machine) != set(second.tidy.machine):
        lines.append("the runs are of different machines")
    return lines


def draw(look, first, second):
    """`first`, `second`: the maps of the two runs."""
    common = pairs(first, second)
    count = len({pair.first.variables for pair in common.values()})
    width = max(3.6, 0.6 + 0.66 * count)
    figure, panels = plt.subplots(1, 3, figsize=(2 * width + 4.2, 5.2), layout="constrained",
                                  width_ratios=(width, width, 4.0))
    figure.suptitle("Two runs of one map: " + summary(common)[0], x=0.01, ha="left", fontsize=10.5)
    if not common:
        for axes in panels:
            missing(axes, "the runs have no cell in common")
        return figure
    _panel(panels[0], [pair.first for pair in common.values()], common, look, "first run")
    _panel(panels[1], [pair.second for pair in common.values()], common, look, "second run")
    _scatter(panels[2], time_ratios(common))
    _legend(figure, common, look)
    return figure


def _panel(axes, cells, common, look, title):
    def draw_cell(axes, corner, height, cell):
        axes.add_patch(Rectangle(corner, 1, height, facecolor=common[cell.scene].colour,
                                 edgecolor="white"))
        size = min(6.5, 2.2 * height)
        undecided = cell.ranking is None or not cell.ranking.decided
        if undecided:
            axes.add_patch(Rectangle(corner, 1, height, facecolor="none", hatch="////",
                                     edgecolor="#999999", linewidth=0))
        if size >= 3.5:
            axes.text(corner[0] + 0.5, corner[1] + height / 2, cell_text(cell.ranking, look),
                      ha="center", va="center", fontsize=size,
                      bbox={"boxstyle": "round,pad=0.08", "facecolor": "white", "alpha": 0.6,
                            "linewidth": 0})
    draw_grid(axes, cells, draw_cell, small=True)
    axes.set_title(title, fontsize=9.5)
    axes.set(xlabel="variables n", ylabel="non-zeros in the tangent, %")
    axes.tick_params(labelsize=8)


def _scatter(axes, ratios):
    axes.set_title("median time, second / first run", fontsize=9.5)
    if not len(ratios):
        missing(axes, "nothing was timed in both runs")
        return
    low, middle, high = numpy.percentile(ratios[:, 1], [2.5, 50, 97.5])
    axes.axhspan(low, high, color="#dddddd", zorder=0)
    axes.axhline(1, color="#444444", linewidth=0.8)
    axes.scatter(*ratios.T, s=9, color="#0072B2", alpha=0.6, linewidth=0)
    axes.set(xscale="log", xlabel="time per step in the first run, µs")
    axes.text(0.03, 0.98, f"median {middle:.3f}; 95 % in {low:.3f} to {high:.3f} (grey)",
              transform=axes.transAxes, va="top", fontsize=8)
    axes.margins(y=0.12)


def _legend(figure, common, look):
    rankings = [cell.ranking for pair in common.values() for cell in (pair.first, pair.second)
                if cell.ranking]
    shown = {name for ranking in rankings for name in (ranking.winner, ranking.second)}
    handles = [Patch(facecolor=colour, label=label) for colour, label in LABELS.items()]
    handles.append(Patch(facecolor="white", edgecolor="#999999", hatch="////", linewidth=0,
                         label="undecided in this run"))
    handles += [Patch(facecolor="none", label=f"{look.letter(name)}  {name}")
                for name in look.place if name in shown]
    figure.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), fontsize=8,
                  ncol=max(1, int(figure.get_figwidth() / 2.6)))


def main(arguments):
    if len(arguments) < 3:
        sys.exit("usage: python3 -m analysis.repeat RESULTS_A RESULTS_B OUTPUT.svg [OUTPUT.png]")
    try:
        first, second = (load(folder) for folder in arguments[:2])
    except TableError as error:
        sys.exit(f"error: {error}")
    maps = shared_maps(first, second)
    print("\n".join(summary(pairs(*maps)) + differences(first, second)))
    figure = draw(Look(first), *maps)
    for output in arguments[2:]:
        save(figure, output)
    plt.close(figure)


if __name__ == "__main__":
    main(sys.argv[1:])
