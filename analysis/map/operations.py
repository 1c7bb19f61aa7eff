# Table 2: the operations alone, not optimised against optimised.
from analysis.core.timing import rank, ratio
from analysis.map import paper
from analysis.map.compare import Versus, operations


def table(results):
    """Rows of Table 2: [{"operation", "variables", "slow", "fast", "slow_us", "fast_us", "ratio", "paper"}], a row for each
    operation, size and variant that is not optimised, against the fastest optimised variant there that stores as much:
    both halves of the symmetric matrices, as those for unsymmetric solvers do, or one."""
    rows = []
    for operation, (_, _, quoted) in paper.TABLE2.items():
        for (size, _), cell in operations(results, operation).groupby(["variables", "scene"]):
            times = cell.groupby("implementation").step_us.median()
            for slow in not_optimised(results):
                ranking = rank(cell, _alike(results, slow))
                found = ranking and ratio(cell, slow, ranking.winner)
                if found and found.value == found.value:
                    fast = ranking.winner
                    record = cell[cell.implementation == slow].record.iloc[0]
                    rows.append({"operation": operation, "variables": size, "slow": slow, "fast": fast,
                                 "slow_us": times[slow], "fast_us": times[fast], "paper": quoted,
                                 "ratio": Versus(found.value, found.low, found.high, slow, fast, size, 0.0, record)})
    return rows


def not_optimised(results):
    return [name for name in results.variants if name.split("/")[0] == paper.NOT_OPTIMISED]


def _alike(results, name):
    both_halves = results.variants[name].get("unsymmetric", False)
    return [other for other in paper.sparse(results) if results.variants[other].get("unsymmetric", False) == both_halves]
