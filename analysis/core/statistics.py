# One function a statistic; README.md has definitions and references.
from dataclasses import dataclass

import numpy

REPLICATES = 4000
CONFIDENCE = 0.95
SEED = 20080101


def median(values):
    """Median of finite values; NaN if there is none or one is not finite."""
    values = numpy.asarray(values, dtype=float)
    if values.size == 0 or not numpy.isfinite(values).all():
        return numpy.nan
    return float(numpy.median(values))


def by_round(samples):
    """{round: array of step_us} of one cell's rows."""
    return {number: group.to_numpy() for number, group in samples.groupby("round").step_us}


def ratio_interval(first, second, replicates=REPLICATES, confidence=CONFIDENCE, seed=SEED):
    """(ratio, low, high): median(first) / median(second) with its percentile bootstrap interval.

    Hierarchical bootstrap [Davison and Hinkley 1997, section 3.8; Kalibera and Jones 2013]: rounds
    are drawn with replacement, the same ones for both cells (a round is a common stretch of time on
    the machine, so they are paired), then repetitions inside each drawn round, independently.
    `first`, `second`: {round: samples}; rounds that only one of them has are left out.
    """
    rounds = sorted(set(first) & set(second))
    if not rounds:
        return (numpy.nan,) * 3
    ratio = median(numpy.concatenate([first[r] for r in rounds])) / median(
        numpy.concatenate([second[r] for r in rounds]))
    if not numpy.isfinite(ratio):
        return (numpy.nan,) * 3
    random = numpy.random.default_rng(seed)
    drawn = random.integers(len(rounds), size=(replicates, len(rounds)))
    top = resampled_medians(random, [first[r] for r in rounds], drawn)
    bottom = resampled_medians(random, [second[r] for r in rounds], drawn)
    tail = 50 * (1 - confidence)
    low, high = numpy.percentile(top / bottom, [tail, 100 - tail])
    return ratio, float(low), float(high)


def resampled_medians(random, groups, drawn):
    """Median of each replicate: repetitions drawn anew inside the rounds that `drawn` names."""
    sizes = numpy.array([len(group) for group in groups])
    padded = numpy.full((len(groups), sizes.max()), numpy.nan)
    for row, group in zip(padded, groups):
        row[:len(group)] = group
    choice = (random.random(drawn.shape + (sizes.max(),)) * sizes[drawn][..., None]).astype(int)
    values = padded[drawn[..., None], choice]
    values[numpy.arange(sizes.max()) >= sizes[drawn][..., None]] = numpy.nan
    return numpy.nanmedian(values.reshape(len(drawn), -1), axis=1)


@dataclass(frozen=True)
class Ranking:
    """The fastest two of a scene. `margin` = second / winner, with its interval."""
    winner: str
    second: str | None
    margin: float
    low: float
    high: float
    rivals_failed: bool = False

    @property
    def decided(self):
        """The interval must exclude 1; alone, one wins only if no rival failed: against those that
        are excluded as too slow it has won, of those that failed nothing is known."""
        return not self.rivals_failed if self.second is None else self.low > 1.0


def rank(samples, rivals_failed=False, confidence=CONFIDENCE):
    """Ranking of one scene's ok samples; None if there are none. Only medians order the cells; a
    winner is declared only if the interval of its ratio to the second excludes 1. `rivals_failed`
    says whether another implementation of the scene failed or disagrees."""
    medians = samples.groupby("implementation").step_us.median().sort_values(kind="stable")
    if medians.empty:
        return None
    if len(medians) == 1:
        return Ranking(medians.index[0], None, numpy.nan, numpy.nan, numpy.nan, rivals_failed)
    winner, second = medians.index[:2]
    cells = {name: by_round(samples[samples.implementation == name]) for name in (winner, second)}
    ratio = ratio_interval(cells[second], cells[winner], confidence=confidence)
    return Ranking(winner, second, *ratio, rivals_failed)


def power_law_exponent(sizes, times):
    """Slope of log(time) over log(size) by least squares; NaN for fewer than three sizes."""
    if len(sizes) < 3:
        return numpy.nan
    return float(numpy.polyfit(numpy.log(sizes), numpy.log(times), 1)[0])


def phase_shares(rows, phases):
    """{phase: share} of one cell: medians over its profiled runs, scaled so that they add up to 1
    (a median, because a run that the system interrupts books the interruption on one phase)."""
    shares = {phase: median(rows[f"phase_{phase}"]) for phase in phases}
    total = sum(shares.values())
    return {phase: share / total for phase, share in shares.items()}
