# Cells of the maps over size and fill: who wins where, and where measuring more would tell more.
from dataclasses import dataclass, field
from itertools import chain, zip_longest
from math import ceil, log

import pandas

from analysis.loader import FAILURES
from analysis.statistics import CONFIDENCE, Ranking, by_round, rank, ratio_interval

BAND = 5.0             # height of a column's cell that is the only one, %
CLOSEST = 0.04         # fills nearer than this have no cell put between them, share
MOST_ADDITIONS = 3     # times that samples are added to one cell


@dataclass(frozen=True)
class MapCell:
    """One scene as a map shows it. `ranking` is None if no implementation could be timed there."""
    variables: float
    fill_percent: float         # as measured, or as asked where nothing could run
    fill_asked: float | None    # share; None: the mechanism's own fill
    scene: str
    ranking: Ranking | None
    excluded: tuple             # names, in the registry's order
    failed: tuple
    refined: str                # "cell": added by the refinement; "samples": it added samples; ""
    rounds: int
    rows: pandas.DataFrame = field(compare=False, repr=False)  # timing rows of those ranked

    @property
    def samples(self):
        return self.rows[self.rows.status == "ok"]

    @property
    def times(self):
        """{name: µs a step}, fastest first."""
        return paired_times(self.samples)


def map_cells(results, names=None):
    """Cells by size, then fill, of all ranked contenders or of `names` alone, whose failures and
    exclusions are then the only ones that count. Scenes that are not reached are left out."""
    names = results.implementations if names is None else list(names)
    timing = _reached(results.tidy)
    cells = []
    for size, rows in timing.groupby("variables"):
        scenes = dict(list(rows.groupby("scene")))
        cells += [_cell(size, fill, scene, scenes[scene], names)
                  for scene, fill in scene_fills(rows).items()]
    return cells


def not_reached(results):
    """[(variables, share asked)] of the scenes below the mechanism's own fill."""
    rows = results.tidy[results.tidy.status == "not-reached"]
    pairs = rows[["variables", "fill_asked"]].drop_duplicates()
    return sorted(pairs.itertuples(index=False, name=None))


def _reached(tidy):
    return tidy[(tidy.kind == "timing") & (tidy.status != "not-reached") & (tidy.scene != "")]


def _cell(size, fill, scene, rows, names):
    asked = rows.fill_asked.iloc[0]
    mine = rows[rows.implementation.isin(names)]
    failed = set(mine[mine.status.isin(FAILURES)].implementation)
    excluded = set(mine[mine.status == "excluded"].implementation) - failed
    stages = set(mine.stage)
    refined = "" if "refined" not in stages else "samples" if "grid" in stages else "cell"
    return MapCell(float(size), float(fill), None if pandas.isna(asked) else float(asked), scene,
                   paired_rank(mine[mine.status == "ok"], rivals_failed=bool(failed)),
                   tuple(name for name in names if name in excluded),
                   tuple(name for name in names if name in failed), refined,
                   mine["round"].nunique(), mine)


def paired_times(samples):
    """{name: median step_us}, fastest first. Where the refinement measured some implementations in
    more rounds than others, their medians are of different times: then each is its ratio, over the
    rounds in common, to the fastest of those with most rounds, times that one's median."""
    medians = samples.groupby("implementation").step_us.median()
    rounds = samples.groupby("implementation")["round"].agg(frozenset)
    if rounds.nunique() > 1:
        most = rounds[rounds.map(len) == rounds.map(len).max()].index
        reference = medians[most].idxmin()
        for name in medians.index:
            common = samples[samples["round"].isin(rounds[name] & rounds[reference])]
            of_common = common.groupby("implementation").step_us.median()
            if name in of_common.index:
                medians[name] = medians[reference] * of_common[name] / of_common[reference]
    return dict(medians.sort_values(kind="stable"))


def paired_rank(samples, rivals_failed=False):
    """As statistics.rank, which it is where all were measured in the same rounds; else the fastest
    two of `paired_times`, compared over the rounds that they have in common. A cell that was sampled
    again because it was undecided has to be surer: looking again and again would decide by chance."""
    leaders = list(paired_times(samples))[:2]
    if samples.groupby("implementation")["round"].agg(frozenset).nunique() > 1:
        mine = samples[samples.implementation.isin(leaders)]
        shared = mine.groupby("round").implementation.nunique() == len(leaders)
        samples = mine[mine["round"].isin(shared.index[shared])]
    again = set(samples.get("stage", ())) == {"grid", "refined"}
    confidence = 1 - (1 - CONFIDENCE) / (1 + MOST_ADDITIONS) if again else CONFIDENCE
    return rank(samples, rivals_failed, confidence)


def scene_fills(rows):
    """Percent by scene, ascending: as measured, or as asked where nothing of a scene could run.
    The null control counts: it has the natural scene's fill even if every pilot failed."""
    by_scene = rows.groupby("scene")
    fills = by_scene.fill_percent.median().fillna(100 * by_scene.fill_asked.median())
    return fills.dropna().sort_values(kind="stable")


def cell_bounds(fills):
    """Lower edge of each cell and the last one's upper edge, for ascending `fills` in percent: the
    first begins at its own fill, neighbours meet half-way, the last ends half the last gap above
    its own fill; a fill alone has a thin band above it (below 100 % if there is no room). Nothing
    is claimed of fills beyond."""
    if not fills:
        return [0.0]
    if len(fills) == 1:
        return [min(fills[0], 100 - BAND / 2), min(100.0, fills[0] + BAND)]
    edges = [(low + high) / 2 for low, high in zip(fills, fills[1:])]
    return [fills[0], *edges, min(100.0, fills[-1] + (fills[-1] - fills[-2]) / 2)]


def refinement_candidates(results, rounds_added=None):
    """What would tell most if it were measured next, most useful first, as dictionaries:

    {"kind": "cell", "variables", "fill" (share), "why"}: half-way between two neighbouring fills
    of one size that different implementations win; the widest gaps first.
    {"kind": "samples", "scene", "variables", "fill" (share or None), "implementations", "why"}:
    more rounds for an undecided cell's leaders; those nearest to a decision first.

    The two kinds alternate. `rounds_added`: rounds that answering one "samples" adds to a cell (as
    many as the grid has, if None); after MOST_ADDITIONS of them a cell is left undecided.
    """
    cells = map_cells(results)
    pairs = zip_longest(_new_cells(cells), _more_samples(results, cells, rounds_added))
    return [candidate for candidate in chain.from_iterable(pairs) if candidate]


def _new_cells(cells):
    found = []
    for low, high in zip(cells, cells[1:]):
        gap = round((high.fill_percent - low.fill_percent) / 100, 6)
        fill = round((high.fill_percent + low.fill_percent) / 200, 2)
        if (low.variables != high.variables or gap < CLOSEST or not (low.ranking and high.ranking)
                or low.ranking.winner == high.ranking.winner):
            continue
        unsure = 2 - low.ranking.decided - high.ranking.decided
        why = (f"{low.ranking.winner} leads at {low.fill_percent:.3g} %, "
               f"{high.ranking.winner} at {high.fill_percent:.3g} %")
        found.append(((unsure, -gap, low.variables, fill),
                      {"kind": "cell", "variables": int(low.variables), "fill": fill, "why": why}))
    return [candidate for _, candidate in sorted(found, key=lambda pair: pair[0])]


def _more_samples(results, cells, rounds_added):
    tidy = results.tidy
    grid = tidy[(tidy.kind == "timing") & (tidy.stage == "grid")]["round"].nunique()
    batch = max(1, rounds_added or grid)
    found = []
    for cell in cells:
        additions = max(0, ceil((cell.rounds - grid) / batch))
        ranking = cell.ranking
        if (ranking is None or ranking.second is None or ranking.decided
                or additions >= MOST_ADDITIONS):
            continue
        why = (f"{ranking.winner} leads {ranking.second} by {ranking.margin:.3f}, "
               f"interval {ranking.low:.3f} to {ranking.high:.3f}")
        found.append(((additions, -_nearness(ranking), cell.variables, cell.fill_percent),
                      {"kind": "samples", "scene": cell.scene, "variables": int(cell.variables),
                       "fill": cell.fill_asked, "implementations": _leaders(cell), "why": why}))
    return [candidate for _, candidate in sorted(found, key=lambda pair: pair[0])]


def _nearness(ranking):
    """Log margin over the interval's lower half width: 1 is decided, 0 a tie. The rounds that a
    decision needs grow as 1 / nearness²."""
    if not ranking.low < ranking.margin:
        return 0.0
    return log(ranking.margin) / (log(ranking.margin) - log(ranking.low))


def _leaders(cell):
    """Winner, second and everyone whose interval of ratios to the winner includes 1."""
    rounds = {name: by_round(rows) for name, rows in cell.samples.groupby("implementation")}
    winner, second, *others = cell.times
    return [winner, second] + [name for name in others if not
                               ratio_interval(rounds[name], rounds[winner])[1] > 1.0]
