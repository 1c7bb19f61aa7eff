# Comparisons of cells, the stand-ins for the paper's systems, and what is said of lost cells.
import math

import pytest

from analysis import compare, marks, paper
from analysis.loader import PHASES
from analysis.tests.synthetic import cell, failed, operation, phases, results


@pytest.fixture
def two_sizes(tmp_path):
    rows = [*cell("d/x", 10, 4, 4), *cell("s/fast", 10, 1, 1), *cell("s/slow", 10, 2, 2),
            *cell("d/x", 50, 60, 60), *cell("s/fast", 50, 12, 12), *cell("s/slow", 50, 10, 10)]
    return results(tmp_path, rows, dense=["d/x"], sparse=["s/fast", "s/slow"])


def test_ratios_of_constant_times_are_exact(two_sizes):
    found = [compare.best_ratio(rows, ["d/x"], ["s/fast", "s/slow"])
             for _, rows in two_sizes.samples().groupby("variables")]
    assert [(r.size, r.fast, r.value, r.low, r.high) for r in found] == [
        (10, "s/fast", 4, 4, 4), (50, "s/slow", 6, 6, 6)]


def test_ratio_needs_both_cells_and_a_common_round(tmp_path):
    rows = [*cell("s/a", 10, 1), *cell("s/b", 10, 2, round=7)]
    samples = results(tmp_path, rows, sparse=["s/a", "s/b"]).samples()
    assert compare.ratio(samples, "s/a", "s/c") is None
    assert compare.ratio(samples, "s/a", "s/b") is None
    assert compare.best_ratio(samples, [], ["s/a"]) is None


def test_ratio_interval_holds_the_ratio(tmp_path):
    rows = [*cell("s/a", 10, 2.0, 2.2, 1.8), *cell("s/b", 10, 1.0, 1.0, 1.0)]
    found = compare.ratio(results(tmp_path, rows, sparse=["s/a", "s/b"]).samples(), "s/a", "s/b")
    assert found.value == 2.0 and found.low == pytest.approx(1.8)
    assert found.high == pytest.approx(2.2)


def test_fastest_looks_at_the_given_names_only(two_sizes):
    samples = compare.natural(two_sizes, 10)
    assert compare.fastest(samples, ["s/slow", "d/x"]) == "s/slow"
    assert compare.fastest(samples, ["none"]) is None


def test_operations_have_their_own_time_and_leave_failures_out(tmp_path):
    rows = [*operation("s/a", 10, "matrix_addition", 3.5),
            *operation("s/a", 10, "rank_k_update", 9.0),
            *operation("s/b", 10, "matrix_addition", "", status="crashed", reason="SIGSEGV")]
    found = compare.operations(results(tmp_path, rows, sparse=["s/a", "s/b"]), "matrix_addition")
    assert list(found.step_us) == [3.5]


def test_shares_of_groups_and_their_interval(tmp_path):
    rows = phases("s/a", 10, (.1, .1, .2, .1, .4, .1), (.1, .1, .4, .1, .2, .1))
    mine = compare.profiled(results(tmp_path, rows, sparse=["s/a"]), "s/a", 10)
    groups = compare.group_shares(mine, paper.GROUPS)
    assert sum(groups.values()) == pytest.approx(1)
    assert groups["factorize and solve"] == pytest.approx(0.4)  # medians 0.3 and 0.1
    assert groups["right-hand side of (6)"] == pytest.approx(0.3)
    assert compare.share_interval(mine, ["factorization"]) == pytest.approx((0.3, 0.2, 0.4))
    assert set(sum(paper.GROUPS.values(), ())) == set(PHASES)


@pytest.mark.parametrize("values, place", [
    ([4, 0.25], 50), ([2, 1, 0.5], 50), ([8, 2, 0.5], 75), ([0.9, 2], -math.inf),
    ([2, 1.1, 1], math.inf), ([2, 0.5, 2, 0.5], 100 / 6)])
def test_crossing(values, place):
    places = [100 * k / (len(values) - 1) for k in range(len(values))]
    assert compare.crossing(places, values) == pytest.approx(place)


def test_crossing_interval_is_where_the_ratio_interval_includes_one():
    ratios = [compare.Ratio(4, 2, 8, "d", "s", "", 100), compare.Ratio(0.25, 0.125, 0.5, "d", "s",
                                                                       "", 100)]
    assert compare.crossing_interval([0, 100], ratios) == pytest.approx((50, 25, 75))


def test_systems_of_the_paper(tmp_path):
    names = ["csc_klu/refactor", "csc_klu/factor", "csc_cholmod/simplicial",
             "csc_cholmod/supernodal", "csc_mumps/spd", "starting_sparse/mumps",
             "ublas_sparse/plain", "own_sparse/x"]
    rows = [row for name in ["eigen_dense/llt", *names] for row in cell(name, 10, 1)]
    found = results(tmp_path, rows, dense=["eigen_dense/llt"], sparse=names,
                    libraries={"own_sparse": "none"})
    assert paper.members(found, "KLU") == ["csc_klu/refactor"]
    assert paper.members(found, "WSMP") == ["csc_cholmod/supernodal", "csc_mumps/spd"]
    assert paper.dense(found) == ["eigen_dense/llt"]
    assert paper.optimised(found) == [*names[:5], "own_sparse/x"]
    assert paper.library_backed(found) == names[:5]


def test_lost_cells_are_told_once_with_their_places(tmp_path):
    rows = [*cell("s/a", 10, 1), *cell("s/b", 10, "", "", status="crashed", reason="SIGSEGV"),
            *failed("s/b", 50, "crashed", "SIGSEGV"), *failed("s/c", 50, "excluded", "slow",
                                                              pilot=70),
            *failed("s/c", 80, "excluded", "its pilot ran out of time")]
    tidy = results(tmp_path, rows, sparse=["s/a", "s/b", "s/c"]).tidy
    cells = marks.lost(tidy)
    assert list(zip(cells.implementation, cells.variables)) == [
        ("s/b", 10), ("s/b", 50), ("s/c", 50), ("s/c", 80)]
    assert list(marks.rough(cells).pilot_step_us) == [70]
    assert marks.reasons(cells) == [
        "✕ crashed – SIGSEGV: s/b (n = 10, 50)",
        "○ excluded – hollow: too slow, rough time of the pilot: s/c (n = 50)",
        "○ excluded – its pilot ran out of time: s/c (n = 80)"]
