# Which implementation is fastest over variables and fill: winner, margin, undecided and unreached.
import matplotlib.pyplot as plt
from matplotlib.patches import Patch, Rectangle

from analysis.style import GREY, Look, figure_main
from analysis.loader import FAILURES, NULL
from analysis.statistics import rank

UNREACHED = "#e9e9e9"
UNMEASURED = {"facecolor": "white", "edgecolor": "#bbbbbb", "hatch": "...", "linewidth": 0}
BAND = 5.0  # height of a column's cell that is the only one, %


def draw(results):
    look, tidy = Look(results), results.tidy
    tidy = tidy[tidy.kind == "timing"]
    sizes = sorted(tidy.variables.dropna().unique())
    figure, axes = plt.subplots(figsize=(max(6.4, 1.1 + 1.0 * len(sizes)), 5.6))
    shown = []
    for column, size in enumerate(sizes):
        shown += _column(axes, column, tidy[tidy.variables == size], look)
    axes.set(xlim=(-0.5, len(sizes) - 0.5), ylim=(0, 100), xlabel="variables n",
             ylabel="non-zeros in the tangent matrix, %",
             title="Fastest implementation over size and fill")
    axes.set_xticks(range(len(sizes)), [f"{size:g}" for size in sizes])
    axes.tick_params(axis="x", length=0)
    _legend(axes, [name for name in results.implementations if name in shown], look)
    return figure


def _column(axes, column, rows, look):
    """Cells of one size, each around its own fill; winners in order."""
    reached = rows[rows.status != "not-reached"]
    fills = scene_fills(reached)
    bounds = cell_bounds(list(fills))
    axes.add_patch(Rectangle((column - 0.5, bounds[-1]), 1, 100 - bounds[-1], **UNMEASURED))
    axes.add_patch(Rectangle((column - 0.5, 0), 1, bounds[0], facecolor=UNREACHED, linewidth=0))
    if bounds[0] > 6:
        axes.text(column, bounds[0] / 2, "not\nreached" if bounds[0] > 12 else "not reached",
                  ha="center", va="center", fontsize=8, color=GREY)
    winners = []
    for scene, low, high in zip(fills.index, bounds, bounds[1:]):
        cell = reached[(reached.scene == scene) & (reached.implementation != NULL)]
        winners += _cell(axes, (column - 0.5, low), high - low, cell, look)
    return winners


def scene_fills(rows):
    """Percent by scene, ascending: as measured, or as asked where nothing of a scene could run.
    The null control counts: it has the natural scene's fill even if every pilot failed."""
    by_scene = rows.groupby("scene")
    fills = by_scene.fill_percent.median().fillna(100 * by_scene.fill_asked.median())
    return fills.dropna().sort_values()


def cell_bounds(fills):
    """Lower edge of each cell and the last one's upper edge, for ascending `fills` in percent: the
    first begins at its own fill, neighbours meet half-way, the last ends half the last gap above
    its own fill; a fill alone has a thin band. Nothing is claimed of fills beyond."""
    if not fills:
        return [0.0]
    edges = [(low + high) / 2 for low, high in zip(fills, fills[1:])]
    above = (fills[-1] - fills[-2]) / 2 if edges else BAND
    return [fills[0], *edges, min(100.0, fills[-1] + above)]


def _cell(axes, corner, height, rows, look):
    failed = rows[rows.status.isin(FAILURES)].implementation.nunique()
    ranking = rank(rows[rows.status == "ok"], rivals_failed=failed > 0)
    colour = look.colour(ranking.winner) if ranking else "white"
    decided = ranking is not None and ranking.decided
    axes.add_patch(Rectangle(corner, 1, height, facecolor=colour, edgecolor="white", linewidth=1.2,
                             alpha=0.85 if decided else 0.35))
    if not decided:
        axes.add_patch(Rectangle(corner, 1, height, facecolor="none", edgecolor="#555555",
                                 linewidth=0, hatch="////"))
    if ranking is None:
        text = "none"
    elif ranking.second is None:
        text = "alone"
    else:
        text = f"{ranking.margin:.2f}×" if ranking.margin < 9.95 else f"{ranking.margin:.0f}×"
    text = f"{look.letter(ranking.winner)} {text}" if ranking else text
    marks = _marks(rows, failed)
    centre = (corner[0] + 0.5, corner[1] + height / 2)
    axes.text(*centre, text + (f"  {marks}" if marks else ""), ha="center", va="center",
              fontsize=8.5 if height > 5 else 7, color="black",
              bbox={"boxstyle": "round,pad=0.15", "facecolor": "white", "alpha": 0.72,
                    "linewidth": 0} if height > 3.5 else None)
    return [ranking.winner] if ranking else []


def _marks(rows, failed):
    excluded = rows[rows.status == "excluded"].implementation.nunique()
    return " ".join([f"▲{excluded}"] * bool(excluded) + [f"✕{failed}"] * bool(failed))


def _legend(axes, names, look):
    handles = [Patch(facecolor=look.colour(name), alpha=0.85, label=f"{look.letter(name)}  {name}")
               for name in names]
    handles += [Patch(facecolor="#eeeeee", hatch="////", edgecolor="#555555", linewidth=0,
                      label="undecided (colour: lower median)"),
                Patch(facecolor=UNREACHED, label="below the mechanism's own fill"),
                Patch(**UNMEASURED, label="not measured")]
    axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=9)
    axes.text(1.03, 0.0, "A 1.32×  winner, and second / winner\n▲k  k excluded as too slow\n"
              "✕k  k failed or disagree", transform=axes.transAxes, fontsize=8, color=GREY,
              va="bottom")


if __name__ == "__main__":
    figure_main(draw)
