# Comparisons within a scene that figures and claims share, and sentences that say where the time of a step goes.
from dataclasses import dataclass

import numpy

from analysis.core.statistics import phase_shares
from analysis.core.text import number
from analysis.map.results import with_samples
from analysis.map.tidy import PHASES

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


def operations(results, operation):
    """Rows of an operation of Table 2 that was timed; `step_us` is the time of a call here."""
    tidy = results.tidy
    rows = tidy[(tidy.kind == "operations") & (tidy.status == "ok") & (tidy.operation == operation)]
    return with_samples(rows).assign(step_us=rows.operation_us)


def profiled(results, name=None, size=None):
    """Rows of the profiled processes, of one contender and size if they are given."""
    tidy = results.tidy
    rows = tidy[(tidy.kind == "phases") & (tidy.status == "ok") & tidy.implementation.isin(list(results.variants))]
    rows = rows if name is None else rows[rows.implementation == name]
    return rows if size is None else rows[rows.variables == size]


def group_shares(rows, groups):
    """{group: share} of one contender's profiled rows."""
    shares = phase_shares(rows, PHASES)
    return {group: sum(shares[phase] for phase in phases) for group, phases in groups.items()}


def share_interval(rows, phases):
    """(share, low, high) of `phases` together: mean over the profiled processes with Student's interval."""
    from scipy import stats
    shares = (rows[[f"phase_{phase}" for phase in phases]].sum(axis=1)
              / rows[[f"phase_{phase}" for phase in PHASES]].sum(axis=1))
    middle = float(shares.mean())
    if len(shares) < 2:
        return middle, 0.0, 1.0
    half = stats.t.ppf(0.975, len(shares) - 1) * float(shares.std(ddof=1)) / len(shares) ** 0.5
    return middle, middle - half, middle + half


def step_us(results, name, size):
    """Median time of a step at natural fill; NaN if it was not timed."""
    return results.medians(results.natural(size)).get(name, numpy.nan)


def phase_times(results, name, size):
    """{phase: µs a step}: shares of the profiled processes times the median of the timed ones; empty if one of them is
    missing."""
    rows, total = profiled(results, name, size), step_us(results, name, size)
    if not len(rows) or total != total:
        return {}
    return {phase: share * total for phase, share in phase_shares(rows, PHASES).items()}


def split(results, name, size):
    """"X takes 14.2 µs a step at n = 22, of which assembly 45 %, factorization 30 %, ..."."""
    times, total = phase_times(results, name, size), step_us(results, name, size)
    text = f"{name} takes {number(total)} µs a step at n = {size:g}"
    if not times:
        return f"{text} (not profiled at this size)."
    largest = sorted(times, key=times.get, reverse=True)[:3]
    return f"{text}, of which " + ", ".join(f"{phase} {100 * times[phase] / total:.0f} %" for phase in largest) + "."


def difference(results, slow, fast, size):
    """Which two phases make up most of the difference between two contenders."""
    slow_us, fast_us = (step_us(results, name, size) for name in (slow, fast))
    text = f"{slow} {number(slow_us)} µs a step at n = {size:g}, {fast} {number(fast_us)} µs"
    before, after = (phase_times(results, name, size) for name in (slow, fast))
    if not before or not after:
        return f"{text} (phases not profiled for both at this size)."
    apart = {phase: before[phase] - after[phase] for phase in PHASES}
    sign = 1 if slow_us >= fast_us else -1
    largest = sorted(PHASES, key=lambda phase: -sign * apart[phase])[:2]
    parts = " and ".join(f"{phase} ({number(before[phase])} against {number(after[phase])} µs)" for phase in largest)
    return f"{text}; most of the difference lies in {parts}."
