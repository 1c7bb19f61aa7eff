# The fill from which the best dense implementation beats the best sparse one, size by size.
from dataclasses import dataclass
from itertools import groupby

import numpy

from analysis import statistics
from analysis.statistics import by_round, median


@dataclass(frozen=True)
class Crossing:
    """Where time of the best dense / best sparse passes 1, with its 95 % interval, in percent."""
    variables: float
    fill: float
    low: float       # cut off at the ends of the fills that were compared
    high: float


@dataclass(frozen=True)
class Comparison:
    """Log of best dense over best sparse in one cell, and its bootstrap replicates."""
    fill: float
    value: float
    replicates: numpy.ndarray


def crossings(cells, dense):
    """One Crossing a size that has one. `cells`: maps.map_cells; `dense`: {name: whether dense}.

    Between two neighbouring fills that were compared the log of the ratio is interpolated linearly
    over the fill; the lowest fill where it passes from sparse to dense counts. A cell in which
    everyone of a family failed or is excluded is not compared, and nothing is interpolated past it.
    """
    found = []
    for size, column in groupby(cells, key=lambda cell: cell.variables):
        compared = [comparison(cell, dense, seed) for seed, cell in enumerate(column)]
        crossing = _crossing(size, compared)
        found += [crossing] if crossing else []
    return found


def comparison(cell, dense, seed=0, replicates=statistics.REPLICATES):
    """Comparison of a cell's fastest dense and fastest sparse implementation; None if one of the
    families has no time. Rounds are drawn as in statistics.ratio_interval."""
    names = list(cell.times)
    fastest = [next((n for n in names if dense[n] == family), None) for family in (True, False)]
    if None in fastest:
        return None
    top, bottom = (by_round(cell.samples[cell.samples.implementation == n]) for n in fastest)
    rounds = sorted(set(top) & set(bottom))
    if not rounds:
        return None
    top, bottom = ([times[r] for r in rounds] for times in (top, bottom))
    random = numpy.random.default_rng([statistics.SEED, seed])
    drawn = random.integers(len(rounds), size=(replicates, len(rounds)))
    ratios = (statistics.resampled_medians(random, top, drawn)
              / statistics.resampled_medians(random, bottom, drawn))
    value = median(numpy.concatenate(top)) / median(numpy.concatenate(bottom))
    return Comparison(cell.fill_percent, float(numpy.log(value)), numpy.log(ratios))


def _crossing(size, compared):
    """Crossing of one column of Comparison or None, by fill; None if there is none."""
    places = [place for place, found in enumerate(compared) if found]
    if len(places) < 2:
        return None
    known = [compared[place] for place in places]
    adjacent = numpy.diff(places) == 1
    fills = numpy.array([c.fill for c in known])
    fill = first_crossing(fills, numpy.array([[c.value for c in known]]), adjacent)[0]
    if not numpy.isfinite(fill):
        return None
    drawn = first_crossing(fills, numpy.array([c.replicates for c in known]).T, adjacent)
    tail = 50 * (1 - statistics.CONFIDENCE)
    low, high = numpy.percentile(drawn, [tail, 100 - tail], method="nearest")
    return Crossing(size, float(fill), *(float(numpy.clip(x, fills[0], fills[-1]))
                                         for x in (low, high)))


def first_crossing(fills, logs, adjacent):
    """Per row of `logs` (one column a fill) the lowest fill at which it passes from above 0 to 0 or
    below between neighbours that are `adjacent`; without one -inf if the row begins at 0 or below,
    else inf."""
    left, right = logs[:, :-1], logs[:, 1:]
    passes = (left > 0) & (right <= 0) & numpy.asarray(adjacent)
    share = numpy.where(passes, left / numpy.where(passes, left - right, 1), 0)
    at = fills[:-1] + share * numpy.diff(fills)
    first = passes.argmax(axis=1)
    without = numpy.where(logs[:, 0] <= 0, -numpy.inf, numpy.inf)
    return numpy.where(passes.any(axis=1), at[numpy.arange(len(logs)), first], without)
