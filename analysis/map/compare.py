# Comparisons within a scene that figures and claims share.
from dataclasses import dataclass

COVERED = 82  # variables that a run has to reach to speak of the paper's figures of 10 to 160


@dataclass(frozen=True)
class Versus:
    """Time of `slow` over that of `fast`, with its interval, and where it was taken."""
    value: float
    low: float
    high: float
    slow: str
    fast: str
    size: float
    fill: float  # percent
    record: str


def versus(results, scene, slow, fast):
    """Versus of two contenders; None if they cannot be compared."""
    found = None if None in (slow, fast) or slow == fast else results.ratio(scene, slow, fast)
    if found is None:
        return None
    rows = results.rows(scene)
    record = next(iter(rows[(rows.implementation == slow) & (rows.status == "ok")].record), "")
    return Versus(found.value, found.low, found.high, slow, fast, float(rows.variables.iloc[0]),
                  float(rows.fill_percent.iloc[0]), record)


def best(results, scene, slow, fast):
    """Versus of the fastest of the names `slow` and the fastest of the names `fast`."""
    return versus(results, scene, results.fastest(scene, slow), results.fastest(scene, fast))


def over_sizes(results, slow, fast, low=0, high=float("inf"), reaching=0):
    """[Versus] of the best of two groups at natural fill, by size; none if they do not reach so many variables."""
    found = [best(results, results.natural(size), slow, fast) for size in results.sizes if low <= size <= high]
    found = [one for one in found if one]
    return found if found and found[-1].size >= reaching else []
