# What a reader should choose: the fastest library by size, dense or sparse by fill, the price of one choice.
import math

import numpy

from analysis.map import paper
from analysis.map.cells import map_cells


def by_size(results, names):
    """Neighbouring sizes with the same outcome at their own fill: [{"first", "last", "names", "kind", "margins"}];
    kind: "decided" (one name), "equivalent" or "open", without names "few" (of too few processes for an interval) or "none" (nobody was timed);
    margins: of the second behind the winner."""
    groups = []
    for cell in (one for one in map_cells(results, names) if one.fill_asked is None):
        known = cell.ranking and not (cell.ranking.second and cell.ranking.margin.high == math.inf)
        found = {"names": sorted(cell.winners), "kind": cell.outcome} if known else {"names": [], "kind": "few" if cell.ranking else "none"}
        if not groups or groups[-1] | found != groups[-1]:
            groups.append(found | {"first": cell.variables, "margins": []})
        groups[-1]["last"] = cell.variables
        groups[-1]["margins"] += [cell.ranking.margin.value] if known else []  # not a number of who is alone
    return groups


def dense_from(results):
    """Sizes with filled scenes: [{"variables", "from", "last_sparse", "between"}]; fills in %: "from" is the first of those at and above which the
    best dense library is faster than the best sparse one (None: at none), "last_sparse" the last fill with another outcome (None: at none),
    "between" the first and last fill at which dense is faster if it is not up to the last one (or None)."""
    rows, dense, sparse = [], paper.dense(results), paper.sparse(results, others=True)
    cells = map_cells(results, [*dense, *sparse])
    for size in sorted({one.variables for one in cells if one.fill_asked is not None} & {one.variables for one in cells if one.ranking}):
        found = [(cell.fill_percent, results.best(cell.scene, dense, sparse)) for cell in cells if cell.variables == size and cell.ranking]
        faster = [bool(ratio and ratio.high < 1) for _, ratio in found]
        start = len(found) - next((place for place, one in enumerate(reversed(faster)) if not one), len(found))
        ahead = [fill for (fill, _), one in zip(found, faster) if one]
        rows.append({"variables": size, "from": found[start][0] if start < len(found) else None,
                     "last_sparse": found[start - 1][0] if start else None,
                     "between": (ahead[0], ahead[-1]) if ahead and start == len(found) else None})
    return rows


def prices(results, names):
    """The price of always using one: [{"implementation", "mean", "worst", "where", "cells", "of", "rough", "failed"}] of times over the best of each
    cell, the lowest geometric mean first; after all others those that fail in some cell or lack a ratio in one, as nobody can always use them."""
    rows, cells = [], [cell for cell in map_cells(results, names) if cell.ranking]
    pilots = {cell.scene: results.rows(cell.scene).groupby("implementation").pilot_us.first() for cell in cells}
    for name in names:
        ratios = {cell.scene: cell.ranking.ratios[name].value for cell in cells if name in cell.ranking.ratios}
        failed = [cell.scene for cell in cells if name in cell.failed and cell.scene not in ratios]
        rough = {cell.scene: pilots[cell.scene].get(name) / pilots[cell.scene].get(cell.ranking.winner) for cell in cells
                 if cell.scene not in (*ratios, *failed) and pilots[cell.scene].reindex([name, cell.ranking.winner]).notna().all()}
        if known := ratios | rough:
            where = max(known, key=known.get)
            rows.append({"implementation": name, "mean": float(numpy.exp(numpy.mean(numpy.log(list(known.values()))))), "worst": known[where],
                         "where": where, "cells": len(known), "of": len(cells), "rough": len(rough), "failed": len(failed)})
    return sorted(rows, key=lambda row: (row["failed"] > 0, -row["cells"], row["mean"]))


def settled(table, layer):
    """{"cells", "decided", "holm", "equivalent", "open", "alone"}: how many cells of a layer were timed, and how they ended."""
    rows = table[(table.layer == layer) & (table.winner != "")]
    decided, settled, holm = (rows[name].fillna(False).astype(bool) for name in ("decided", "settled", "holm"))
    return {"cells": len(rows), "decided": int(decided.sum()), "holm": int(holm.sum()), "equivalent": int((settled & ~decided).sum()),
            "open": int((~settled & ~decided).sum()), "alone": int((rows.inside == rows.winner).sum())}
