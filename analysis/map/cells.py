# Cells of the maps: who is fastest in a scene, in each layer.
from collections import namedtuple

import pandas

from analysis.core import timing
from analysis.map.timed import layers


class Cell(namedtuple("Cell", "scene variables fill_asked fill_percent ranking excluded failed")):
    """One scene as a map shows it. `fill_asked`: share, None: the mechanism's own; `fill_percent`: as measured; `ranking`: None where nobody
    could be timed; `excluded`: names of those who were too slow."""
    # Alone, one wins only if no rival failed: of those nothing is known; the excluded ones it has beaten.
    decided = property(lambda self: bool(self.ranking and self.ranking.decided and (self.ranking.second or not self.failed)))
    settled = property(lambda self: bool(self.ranking and self.ranking.settled and (self.ranking.second or not self.failed)))
    outcome = property(lambda self: "decided" if self.decided else "equivalent" if self.settled else "open")

    @property
    def winners(self):
        """Who may be called the fastest: the winner, or all that are as fast, or also those that are open."""
        if self.ranking is None or self.decided:
            return (self.ranking.winner,) if self.ranking else ()
        return tuple(name for name in self.ranking.ratios if name in (*self.ranking.equivalent, *self.ranking.open))


def map_cells(results, names):
    """Cells by size, then fill, of these contenders alone."""
    rows = results.timing[(results.timing.scene != "") & results.timing.fill_percent.notna()]
    scenes = rows[["scene", "variables", "fill_asked", "fill_percent"]].drop_duplicates("scene")
    return [Cell(one.scene, one.variables, None if pandas.isna(one.fill_asked) else one.fill_asked, one.fill_percent,
                 results.rank(one.scene, names), *results.lost(one.scene, names))
            for one in scenes.sort_values(["variables", "fill_percent"], kind="stable").itertuples()]


def table(results):
    """Fills that were added where the winner changes are asked, too."""
    return timing.holm([_row(results, cell, layer) for layer in layers(results.registry)
                        for cell in map_cells(results, results.layer(layer))], "layer")


def _row(results, cell, layer):
    ranking = cell.ranking
    row = {"scene": cell.scene, "layer": layer, "variables": cell.variables, "fill_asked": cell.fill_asked,
           "fill_percent": cell.fill_percent, "decided": cell.decided, "settled": cell.settled,
           "excluded": " ".join(cell.excluded), "failed": " ".join(cell.failed)}
    rows = results.rows(cell.scene)
    if ranking is None:
        return row | {"record": next(iter(rows.record), "")}
    mine = rows[(rows.implementation == ranking.winner) & (rows.status == "ok")]
    both = ranking.second, ranking.winner
    within = timing.within(results.paired(cell.scene).of(*both), *both) if ranking.second else ()
    return row | {"winner": ranking.winner, "second": ranking.second, "margin": ranking.margin.value, "low": ranking.margin.low,
                  "high": ranking.margin.high, "chance": ranking.chance, "holm": False, "equivalent": " ".join(ranking.equivalent), "open": " ".join(ranking.open),
                  "inside": " ".join(ranking.inside), "processes": len(mine), "record": " ".join(mine.record)} | dict(zip(("within_low", "within_high"), within))
