# Draws maps over size and fill: equal columns labelled n, cells around their own fill.
import matplotlib.patheffects as effects
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from analysis.crossover import crossings
from analysis.maps import cell_bounds
from analysis.style import GREY

UNREACHED = "#e9e9e9"
UNMEASURED = {"facecolor": "white", "edgecolor": "#bbbbbb", "hatch": "...", "linewidth": 0}
REFINED = {"cell": "•", "samples": "+"}
LINE = "#111111"
DECIDED, UNDECIDED = 0.85, 0.35  # opacity


def columns(cells):
    """{size: its cells by ascending fill}."""
    found = {}
    for cell in cells:
        found.setdefault(cell.variables, []).append(cell)
    return found


def draw_grid(axes, cells, draw_cell, small=False):
    """Axes, unreached and unmeasured regions; draw_cell(axes, (x, y), height, cell) for each cell,
    (x, y) its lower left corner, its width 1."""
    by_size = columns(cells)
    for column, mine in enumerate(by_size.values()):
        bounds = cell_bounds([cell.fill_percent for cell in mine])
        left = column - 0.5
        axes.add_patch(Rectangle((left, bounds[-1]), 1, 100 - bounds[-1], **UNMEASURED))
        below = Rectangle((left, 0), 1, bounds[0], facecolor=UNREACHED, linewidth=0)
        if mine[0].fill_asked is not None:  # the mechanism's own fill was not measured
            below.set(**UNMEASURED)
        axes.add_patch(below)
        if bounds[0] > 12 and mine[0].fill_asked is None:
            axes.text(column, bounds[0] / 2, "not\nreached", ha="center", va="center",
                      fontsize=5.5 if small else 8, color=GREY)
        for cell, low, high in zip(mine, bounds, bounds[1:]):
            draw_cell(axes, (left, low), high - low, cell)
    axes.set(xlim=(-0.5, len(by_size) - 0.5), ylim=(0, 100))
    axes.set_xticks(range(len(by_size)), [f"{size:g}" for size in by_size])
    axes.tick_params(axis="x", length=0)


def draw_winners(axes, cells, look, small=False):
    """A map of winners: colour, letters of winner and second, margin, losses, hatches."""
    def draw_cell(axes, corner, height, cell):
        _colour(axes, corner, height, cell.ranking, look)
        _texts(axes, corner, height, cell, look, small)
    draw_grid(axes, cells, draw_cell, small)


def _colour(axes, corner, height, ranking, look):
    decided = ranking is not None and ranking.decided
    axes.add_patch(Rectangle(corner, 1, height, edgecolor="white", linewidth=0.8,
                             facecolor=look.colour(ranking.winner) if ranking else "white",
                             alpha=DECIDED if decided else UNDECIDED))
    if not decided:
        axes.add_patch(Rectangle(corner, 1, height, facecolor="none", edgecolor="#555555",
                                 linewidth=0, hatch="////"))


def cell_text(ranking, look):
    """"A 1.32× C": winner, second / winner, second."""
    if ranking is None:
        return "none"
    winner = look.letter(ranking.winner)
    if ranking.second is None:
        return f"{winner} alone"
    return f"{winner} {times(ranking.margin)}× {look.letter(ranking.second)}"


def times(ratio):
    """Three digits, no more."""
    return f"{ratio:.2f}" if ratio < 9.95 else f"{ratio:.0f}"


def losses(cell):
    counts = (("▲", len(cell.excluded)), ("✕", len(cell.failed)))
    return " ".join(f"{mark}{count}" for mark, count in counts if count)


def _texts(axes, corner, height, cell, look, small):
    """Winner in the middle, its losses below or behind, refinement at the left."""
    marks, line = losses(cell), 3.4 if small else 1.9  # line: half a line's height, %
    two_lines = marks and height > 3.4 * line
    text = cell_text(cell.ranking, look)
    if marks and not two_lines:
        text += " " + marks.replace(" ", "")
    widest = 8.5 if len(text) < 11 else 7.0 if len(text) < 13 else 5.8
    size = min(0.7 * widest if small else widest, height * (2.0 if small else 3.4))
    x, y = corner[0] + 0.5, corner[1] + height / 2
    plate = {"boxstyle": "round,pad=0.1", "facecolor": "white", "alpha": 0.75, "linewidth": 0}
    if size >= 3.5:
        axes.text(x, y + (line / 2 if two_lines else 0), text, ha="center", va="center",
                  fontsize=size, color="black", zorder=6, bbox=plate)
        if two_lines:
            axes.text(x, y - line, marks, ha="center", va="center", color="#222222", zorder=6,
                      fontsize=4.8 if small else 6, bbox=plate | {"boxstyle": "round,pad=0.05"})
    if cell.refined:
        axes.text(corner[0] + 0.01, y, REFINED[cell.refined], ha="left", va="center",
                  fontsize=min(6, 2.5 * height), color="#222222", zorder=7)


def draw_crossings(axes, cells, dense):
    """The line at which the best dense overtakes the best sparse, joined over neighbours; whether
    there is one anywhere."""
    sizes = list(columns(cells))
    found = [(sizes.index(c.variables), c) for c in crossings(cells, dense)]
    run = []
    for place, crossing in found + [(None, None)]:
        if run and (crossing is None or place != run[-1][0] + 1):
            _line(axes, run)
            run = []
        run.append((place, crossing))
    return bool(found)


def _line(axes, run):
    """One line through the middles of its columns, level to the outer edges of the end ones."""
    x = [run[0][0] - 0.5, *(place for place, _ in run), run[-1][0] + 0.5]
    crossed = [run[0][1], *(crossing for _, crossing in run), run[-1][1]]
    axes.fill_between(x, [c.low for c in crossed], [c.high for c in crossed], color=LINE,
                      alpha=0.28, linewidth=0, zorder=3)
    axes.plot(x, [c.fill for c in crossed], color=LINE, linewidth=1.6, zorder=4,
              path_effects=[effects.withStroke(linewidth=3, foreground="white")])


def winner_handles(cells, look, names):
    """Legend entries: who wins how many cells, then who is second somewhere, then the others."""
    ranked = [cell.ranking for cell in cells if cell.ranking]
    wins = {name: [r.decided for r in ranked if r.winner == name] for name in names}
    seconds = {r.second for r in ranked}
    handles = [Patch(facecolor=look.colour(name), alpha=DECIDED,
                     label=f"{look.letter(name)}  {name}: {_count(wins[name])}")
               for name in names if wins[name]]
    handles += [Patch(facecolor="none", edgecolor=look.colour(name),
                      label=f"{look.letter(name)}  {name}: second at best")
                for name in names if not wins[name] and name in seconds]
    return handles


def _count(decided):
    cells = "cell" if len(decided) == 1 else "cells"
    hatched = f" ({len(decided) - sum(decided)} undecided)" if not all(decided) else ""
    return f"first in {len(decided)} {cells}{hatched}"


def never(cells, look, names):
    """Text that names whoever is nowhere first or second; empty if there is nobody."""
    shown = {n for cell in cells if cell.ranking for n in (cell.ranking.winner,
                                                          cell.ranking.second)}
    return "\n".join(f"    {name}" for name in names if name not in shown)


def region_handles():
    return [Patch(facecolor="#cccccc", hatch="////", edgecolor="#555555", linewidth=0,
                  label="undecided (colour: lower median)"),
            Patch(facecolor=UNREACHED, label="not reached: below the mechanism's own fill"),
            Patch(**UNMEASURED, label="not measured")]


def crossing_handle(crossed):
    line = {"color": LINE, "linewidth": 1.6} if crossed else {"linestyle": "none"}
    label = ("best dense overtakes best sparse; 95 % band" if crossed else
             "(no fill from which dense is faster)")
    return Line2D([], [], label=label, **line)


KEY = ("A 1.32× C  winner, time of second / winner, second\n▲k  k excluded as too slow\n"
       "✕k  k failed or disagree\n•  cell added by refinement   +  samples added")
