# Comparisons of cells that figures, tables and claims share: who is fastest, and ratios of cells.
from dataclasses import dataclass

import numpy

from analysis.loader import PHASES
from analysis.statistics import (CONFIDENCE, REPLICATES, SEED, by_round, median, phase_shares,
                                 ratio_interval)


@dataclass(frozen=True)
class Ratio:
    """median(slow) / median(fast) with its interval, and between what and where it was taken."""
    value: float
    low: float
    high: float
    slow: str
    fast: str
    scene: str
    size: float


def natural(results, size=None):
    """Ranked samples at natural fill, of one size if it is given."""
    samples = results.samples(natural_only=True)
    return samples if size is None else samples[samples.variables == size]


def fastest(samples, names):
    """Name of the lowest median among `names`; None if none of them was timed."""
    medians = samples[samples.implementation.isin(list(names))].groupby("implementation").step_us
    medians = medians.median().sort_values(kind="stable")
    return None if medians.empty else medians.index[0]


def ratio(samples, slow, fast):
    """Ratio of two implementations within the samples of one scene; None if one is missing."""
    cells = [samples[samples.implementation == name] for name in (slow, fast)]
    if any(cell.empty for cell in cells):
        return None
    found = ratio_interval(*(by_round(cell) for cell in cells))
    if numpy.isnan(found[0]):
        return None
    return Ratio(*found, slow, fast, cells[0].scene.iloc[0], float(cells[0].variables.iloc[0]))


def best_ratio(samples, slow, fast):
    """Ratio of the fastest of the names `slow` to the fastest of the names `fast`."""
    pair = fastest(samples, slow), fastest(samples, fast)
    return None if None in pair else ratio(samples, *pair)


def operations(results, operation):
    """Samples of one operation of Table 2; `step_us` is the time of one call here."""
    tidy = results.tidy
    rows = tidy[(tidy.kind == "operations") & (tidy.status == "ok")
                & (tidy.operation == operation)]
    return rows.assign(step_us=rows.operation_us, round=rows["round"].fillna(1))


def profiled(results, name=None, size=None):
    """Rows of the profiled processes at natural fill, of one cell if it is given."""
    tidy = results.tidy
    rows = tidy[(tidy.kind == "phases") & (tidy.status == "ok") & tidy.fill_asked.isna()
                & tidy.implementation.isin(list(results.variants))]
    rows = rows if name is None else rows[rows.implementation == name]
    return rows if size is None else rows[rows.variables == size]


def group_shares(rows, groups):
    """{group: share} of one cell's profiled rows."""
    shares = phase_shares(rows, PHASES)
    return {group: sum(shares[phase] for phase in phases) for group, phases in groups.items()}


def share_interval(rows, phases, replicates=REPLICATES // 10, seed=SEED):
    """(share, low, high) of `phases` together in one cell: profiled processes are drawn with
    replacement and phase_shares taken of each draw."""
    random = numpy.random.default_rng(seed)
    columns = rows[[f"phase_{phase}" for phase in PHASES]].to_numpy()
    inside = [PHASES.index(phase) for phase in phases]
    drawn = columns[random.integers(len(columns), size=(replicates, len(columns)))]
    medians = numpy.median(drawn, axis=1)
    shares = medians[:, inside].sum(axis=1) / medians.sum(axis=1)
    tail = 50 * (1 - CONFIDENCE)
    low, high = numpy.percentile(shares, [tail, 100 - tail])
    value = sum(phase_shares(rows, PHASES)[phase] for phase in phases)
    return value, float(low), float(high)


def medians_over_size(samples, name):
    """Series of median step_us by number of variables."""
    return samples[samples.implementation == name].groupby("variables").step_us.agg(median)


def crossing(places, values):
    """Where `values` (ratios) first fall below 1, log values interpolated over `places`; -inf if
    they are below from the start, inf if nowhere."""
    logs = numpy.log(values)
    if logs[0] < 0:
        return -numpy.inf
    for left, right, before, after in zip(places, places[1:], logs, logs[1:]):
        if after < 0:
            return left + (right - left) * before / (before - after)
    return numpy.inf


def crossing_interval(places, ratios):
    """(crossing, low, high) of a series of Ratios: between low and high the bootstrap intervals of
    the ratios, interpolated, include 1."""
    return tuple(crossing(places, [getattr(ratio, bound) for ratio in ratios])
                 for bound in ("value", "low", "high"))
