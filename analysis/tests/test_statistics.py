# The statistics on samples whose right answer is known.
import numpy
import pandas
import pytest

from analysis.loader import PHASES
from analysis.statistics import (median, phase_shares, power_law_exponent, rank, ratio_interval)


def rows(name, rounds):
    return [{"implementation": name, "round": number, "step_us": value}
            for number, values in rounds.items() for value in values]


def noisy(random, level, spread=0.02, rounds=3):
    return {r: level * (1 + spread * random.standard_normal(3)) for r in range(1, rounds + 1)}


def test_median_never_hides_a_nan():
    assert median([3.0, 1.0, 2.0]) == 2.0
    assert numpy.isnan(median([1.0, numpy.nan, 2.0]))
    assert numpy.isnan(median([1.0, numpy.inf]))
    assert numpy.isnan(median([]))


def test_constant_samples_have_an_interval_without_width():
    ratio = ratio_interval({1: numpy.full(3, 3.0), 2: numpy.full(3, 3.0)},
                           {1: numpy.full(3, 2.0), 2: numpy.full(3, 2.0)})
    assert ratio == pytest.approx((1.5, 1.5, 1.5))


def test_rounds_are_paired():
    """The machine is three times slower in one round: the ratio of 1.1 is clear all the same."""
    random = numpy.random.default_rng(1)
    drift = {1: 1.0, 2: 3.0, 3: 1.7}
    first = {r: 1.1 * f * (1 + 0.005 * random.standard_normal(3)) for r, f in drift.items()}
    second = {r: f * (1 + 0.005 * random.standard_normal(3)) for r, f in drift.items()}
    _, low, high = ratio_interval(first, second)
    assert 1.0 < low < 1.1 < high


def test_only_common_rounds_count():
    ratio, _, _ = ratio_interval({1: numpy.array([2.0]), 2: numpy.array([9.0])},
                                 {1: numpy.array([1.0])})
    assert ratio == 2.0
    assert numpy.isnan(ratio_interval({1: numpy.array([1.0])}, {2: numpy.array([1.0])})[0])


def test_interval_covers_the_truth_about_as_often_as_it_says():
    """With three rounds the bootstrap is known to be slightly narrow; far off would be wrong."""
    random = numpy.random.default_rng(2)
    covered = 0
    for _ in range(200):
        _, low, high = ratio_interval(noisy(random, 1.2), noisy(random, 1.0), replicates=500)
        covered += low <= 1.2 <= high
    assert 0.85 <= covered / 200 <= 1.0


@pytest.mark.parametrize("rounds, repetitions", [(7, 1), (9, 1)])  # quick, paper
def test_interval_covers_the_truth_though_processes_differ(rounds, repetitions):
    """Each process has an effect of its own of 3 %, far above the noise inside it (1 %)."""
    random = numpy.random.default_rng(5)

    def cell(level):
        return {r: level * (1 + 0.03 * random.standard_normal())
                * (1 + 0.01 * random.standard_normal(repetitions)) for r in range(rounds)}
    intervals = [ratio_interval(cell(1.2), cell(1.0), replicates=500) for _ in range(400)]
    covered = sum(low <= 1.2 <= high for _, low, high in intervals) / len(intervals)
    assert 0.9 <= covered <= 0.99


def test_clear_difference_is_decided_and_the_same_is_not():
    random = numpy.random.default_rng(3)
    clear = pandas.DataFrame(rows("a", noisy(random, 1.0)) + rows("b", noisy(random, 1.5)))
    ranking = rank(clear)
    assert (ranking.winner, ranking.second, ranking.decided) == ("a", "b", True)
    assert ranking.low < ranking.margin < ranking.high
    same = {1: [1.0, 1.2, 1.1], 2: [1.3, 1.0, 1.1], 3: [1.1, 1.2, 1.0]}
    assert not rank(pandas.DataFrame(rows("a", same) + rows("b", same))).decided


def test_alone_and_nobody():
    alone = rank(pandas.DataFrame(rows("a", {1: [1.0, 1.1]})))
    assert alone.winner == "a" and alone.second is None and alone.decided
    assert not rank(pandas.DataFrame(rows("a", {1: [1.0, 1.1]})), rivals_failed=True).decided
    assert rank(pandas.DataFrame(rows("a", {1: [1.0]})).iloc[:0]) is None


def test_power_law_exponent():
    sizes = numpy.array([100.0, 200, 400, 1000])
    assert power_law_exponent(sizes, 7 * sizes**1.05) == pytest.approx(1.05)
    assert numpy.isnan(power_law_exponent(sizes[:2], sizes[:2]))


def test_phase_shares_survive_one_interrupted_run():
    calm = {f"phase_{phase}": 1 / 6 for phase in PHASES}
    hit = {f"phase_{phase}": 0.02 for phase in PHASES} | {"phase_solve": 0.9}
    shares = phase_shares(pandas.DataFrame([calm, calm, hit]), PHASES)
    assert sum(shares.values()) == pytest.approx(1.0)
    assert shares["solve"] == pytest.approx(1 / 6)
