# The claims ledger on made-up times: every verdict by its rule, and what a set cannot tell.
import math

import pandas
import pytest

from analysis.map import ledger
from analysis.map.claims import claims
from analysis.map.claims_libraries import compilers, dense_pairs, tuned_blas
from analysis.map.claims_maps import over_fill, regions
from analysis.map.claims_solvers import pivoting, solvers, sparse_against_dense
from analysis.map.claims_starting import starting_sparse, table1, table2_claims
from analysis.map.ledger import CONFIRMED, REFUTED, UNDECIDED, UNMEASURED, at_least, at_most, more_than, verdict
from analysis.tests.map_tables import build, cell, failed, operation, phases, results

KLU, FACTOR, SIMPLICIAL = "csc_klu/refactor", "csc_klu/factor", "csc_cholmod/simplicial"
SUPERNODAL, SUPERLU, SPD = "csc_cholmod/supernodal", "eigen_sparse/superlu", "csc_mumps/spd"
GESV, MUMPS, POTRF = "starting_dense/gesv", "starting_sparse/mumps", "armadillo_dense/potrf"
PLAIN, AXPY, NEW = "ublas_sparse/plain", "ublas_sparse/axpy_prod", "new_dense/only"
IDS = {"T1", "T2", "F2", "F4", "F5", "F6", "F7", "C1", "C2", "C3", "C4", "C5"}
FILLS = ["natural", 0.2, 0.5, 0.75, 1.0]
COLUMNS = [{"variables": size, "fills": FILLS} for size in (10, 50, 82, 100, 1000, 2000, 3000, 4000, 5000)]


def load(rows):
    return results(rows, dense=[POTRF, GESV, NEW], sparse=[MUMPS, PLAIN, AXPY, KLU, FACTOR, SIMPLICIAL, SUPERNODAL, SPD, SUPERLU],
                   columns=[*COLUMNS, {"variables": 22, "fills": ["natural", 0.75]}])


def steady(name, variables, time, **more):
    """Three processes that agree: their interval is a point."""
    return cell(name, variables, time, time, time, **more)


def outcome(rows, *words):
    """(verdict, ours) of the only row whose claim has these words."""
    found, = [row for row in rows if all(word in row["claim"] for word in words)]
    return found["verdict"], found["ours"]


@pytest.mark.parametrize("low, high, rule, expected", [
    (3, 4, at_least(3), CONFIRMED), (2, 2.9, at_least(3), REFUTED), (2, 4, at_least(3), UNDECIDED),
    (1, 2, at_most(2), CONFIRMED), (2.1, 3, at_most(2), REFUTED), (40, 60, (30, 50), UNDECIDED),
    (35, 45, (30, 50), CONFIRMED), (10, 20, (30, 50), REFUTED), (50, 50, more_than(50), UNDECIDED),
    (50, 60, more_than(50), UNDECIDED), (51, 60, more_than(50), CONFIRMED), (40, 49, more_than(50), REFUTED)])
def test_verdict_needs_the_whole_interval(low, high, rule, expected):
    assert verdict(low, high, rule) == expected


def test_an_undecided_row_says_so():
    row = ledger.tested(("X", "", ""), (3, 2, 4), at_least(3), "", "Reason.")
    assert (row["verdict"], row["reason"], row["ours"]) == (UNDECIDED, "The interval includes 3×.", "3×")


def test_a_value_without_an_interval_is_rough_and_decides_nothing():
    row = ledger.tested(("X", "", ""), (6609.3, 0, math.inf), at_least(3), "", "Reason.")
    assert (row["verdict"], row["ours"], row["low"], row["high"]) == (UNDECIDED, "about 6600×", "", "")
    assert row["reason"] == "A single process has no interval."


def test_verdicts_are_counted_apart():
    rows = [ledger.unmeasured(("X", "", ""), "Not timed.", at_least(3)), ledger.tested(("X", "", ""), (3, 2, 4), at_least(3), "", "")]
    assert ledger.counted(pandas.DataFrame(rows)) == "0 confirmed, 0 refuted, 1 undecided, 1 not measured"


def test_every_claim_has_a_row_even_without_any_data():
    rows = claims(load(cell(KLU, 10, 1.0)))
    assert {row["id"] for row in rows} == IDS and {row["verdict"] for row in rows} == {UNMEASURED}
    assert all(row["reason"] for row in rows)


def test_a_single_process_decides_nothing():
    rows = cell(KLU, 100, 1.0) + cell(SIMPLICIAL, 100, 2.0)
    assert outcome(solvers(load(rows)), "KLU with refactor", "to 160")[0] == UNDECIDED


def test_table1_compares_shares_in_points():
    shares = (0.20, 0.25, 0.20, 0.10, 0.05, 0.20)  # evaluation and assembly: 45 %; solving: 30 %
    rows = table1(load(cell(GESV, 22, 8.0) + phases(GESV, 22, *[shares] * 6)))
    few = table1(load(cell(GESV, 22, 8.0) + phases(GESV, 22, shares, shares)))
    assert outcome(few, "dense", "residual")[0] == UNMEASURED and "2 processes" in few[0]["reason"]
    assert outcome(rows, "dense", "residual") == (CONFIRMED, "45 %")
    assert outcome(rows, "dense", "factorize") == (REFUTED, "30 %")
    assert {row["verdict"] for row in rows if "sparse" in row["claim"]} == {UNMEASURED}
    why = next(row["why"] for row in rows if "residual" in row["claim"])
    assert "takes 8 µs a step at n = 22, of which assembly 25 %" in why
    assert "from factorize and solve (14 points less) to other (16 points more)" in why


def test_table2_reports_every_size_and_what_grows():
    rows = []  # the optimised one grows as n, plain as n², axpy_prod as n: 10 and 5 times at n = 10
    for size in (10, 100, 1000):
        for name, time in ((KLU, size), (PLAIN, size ** 2), (AXPY, 5 * size)):
            rows += operation(name, size, "rank_k_update", time, time)
    rows = table2_claims(load(rows))
    assert outcome(rows, "rank-k", "one of the sizes") == (CONFIRMED, "1000×")
    assert outcome(rows, "rank-k", "n = 1000") == (CONFIRMED, "1000×")
    assert outcome(rows, "rank-k", "n = 82")[0] == outcome(rows, "addition", "one of the sizes")[0] == UNMEASURED
    why = next(row["why"] for row in rows if "one of the sizes" in row["claim"])
    assert f"n^1.0 optimised, {PLAIN} as n^2.0, {AXPY} as n^1.0" in why and "it passes 269 near n = 269" in why
    assert "Fair ratio (faster plain version) at most 5 (5 to 5)" in why
    assert f"takes 1/200 of the time of {PLAIN} at n = 1000" in why


def test_solvers_and_pivoting():
    rows = []
    for size, others in ((50, 2), (160, 1)):  # KLU is last at 160 variables
        times = {KLU: 1.2, FACTOR: 1.8, SIMPLICIAL: others, SUPERNODAL: 3, SUPERLU: 2.5}
        rows += [row for name, time in times.items() for row in steady(name, size, time)]
    data = load(rows)
    found = solvers(data)
    assert outcome(found, "KLU with refactor", "to 160") == (REFUTED, "0.833×")
    assert "KLU is shown to lead at 1 of 2 sizes" in found[0]["why"] and outcome(found, "from 161")[0] == UNMEASURED
    assert outcome(found, "85 %") == (REFUTED, "120 %")
    assert outcome(found, "WSMP is slower") == (CONFIRMED, "3×")
    assert outcome(found, "SuperLU is slower") == (REFUTED, "0.833×")
    assert outcome(pivoting(data), "full pivoting") == (CONFIRMED, "1.5×")


@pytest.mark.parametrize("stale, expected", [(1e-6, UNDECIDED), (3e-6, CONFIRMED)])
def test_stale_pivots_are_judged_by_the_error(stale, expected):
    rows = cell(KLU, 100, 1, position_error=stale) + cell(FACTOR, 100, 1, position_error=1e-6)
    assert outcome(pivoting(load(rows)), "stale")[0] == expected


def test_a_claim_over_all_sizes_is_open_where_one_of_them_is():
    rows = steady(KLU, 50, 1) + steady(SIMPLICIAL, 50, 1.1)
    rows += steady(KLU, 160, 1) + cell(SIMPLICIAL, 160, 0.8, 1.2, 2.4)  # slower in the mean, and nothing is certain
    assert outcome(solvers(load(rows)), "KLU with refactor", "to 160") == (UNDECIDED, "1.1×")


def test_starting_sparse_and_dense_against_the_best():
    rows = [row for size, sparse, dense, start in ((10, 2, 1, 9), (22, 1, 3, 4), (50, 1, 6, 9), (1000, 1, 99, 2))
            for name, time in ((KLU, sparse), (POTRF, dense), (MUMPS, start)) for row in steady(name, size, time)]
    data = load(rows)
    assert outcome(starting_sparse(data), "22 variables") == (CONFIRMED, "4×")
    assert outcome(starting_sparse(data), "1000 variables") == (REFUTED, "2×")
    assert outcome(sparse_against_dense(data), "10 variables") == (REFUTED, "0.5×")
    assert outcome(sparse_against_dense(data), "50 variables") == (CONFIRMED, "6×")


def test_the_best_dense_is_the_best_measured_one_and_a_newcomer_plays_no_part():
    rows = steady(KLU, 50, 1) + steady(POTRF, 50, 8) + steady(f"{POTRF}+reference", 50, 6) + steady(NEW, 50, 2)
    assert outcome(sparse_against_dense(load(rows)), "50 variables") == (CONFIRMED, "6×")


def test_libraries():
    rows = steady(GESV, 100, 30) + steady(POTRF, 100, 10) + steady(f"{POTRF}+reference", 100, 20)
    rows += steady(SUPERNODAL, 100, 9) + steady(f"{SUPERNODAL}+reference", 100, 10)
    rows += steady(KLU, 100, 5) + steady(f"{KLU}+reference", 100, 5)  # in common to both pairs: says nothing of BLAS
    for word, time in (("", 5), ("gcc-O2", 5.25), ("clang-O2", 5)):
        rows += build(KLU, 100, word, time, time, time)
    data = load(rows)
    assert outcome(dense_pairs(data), "starting") == (CONFIRMED, "3×")
    assert outcome(dense_pairs(data), "reference ones") == (CONFIRMED, "2×")
    assert outcome(tuned_blas(data), SUPERNODAL) == (REFUTED, "10 %") and len(tuned_blas(data)) == 1
    assert outcome(compilers(data), KLU) == (CONFIRMED, "6.25 %")  # 5 % of the middle one's 80 %
    assert "gcc-O3 5 µs" in compilers(data)[0]["why"]
    assert outcome(compilers(data), "operating system")[0] == UNMEASURED


def test_pairs_at_small_sizes_only_do_not_speak_of_the_figure():
    assert outcome(dense_pairs(load(steady(GESV, 10, 30) + steady(POTRF, 10, 10))), "starting")[0] == UNMEASURED


def test_over_fill_names_the_fill_where_dense_is_faster():
    rows = [row for fill, sparse in ((None, 1), (0.2, 2), (0.5, 3), (1.0, 5))
            for row in steady(SIMPLICIAL, 100, sparse, fill=fill) + steady(POTRF, 100, 4, fill=fill)]
    found = over_fill(load(rows))
    assert outcome(found, "CHOLMOD") == (REFUTED, "0.8×") and "Dense is faster at 100 %" in found[0]["why"]
    assert outcome(found, "WSMP")[0] == UNMEASURED


def test_a_fill_at_which_a_solver_was_lost_leaves_the_claim_open():
    rows = [row for fill in (0.2, 0.5) for row in steady(SIMPLICIAL, 100, 1, fill=fill) + steady(POTRF, 100, 4, fill=fill)]
    rows += steady(POTRF, 100, 4, fill=1.0) + failed(SIMPLICIAL, 100, "crashed", "SIGSEGV", fill=1.0)
    row = over_fill(load(rows))[0]
    assert row["verdict"] == UNMEASURED and "fills of 100 %" in row["reason"]


def test_regions_count_undecided_cells_both_ways():
    rows = []
    for size in (10, 22, 50, 82):
        rows += steady(KLU, size, 1) + steady(SIMPLICIAL, size, 2)
        doubtful = (3, 0.5, 1) if size in (10, 22) else (3, 3, 3)  # undecided at 10 and 22
        rows += cell(SPD, size, 1, 1, 1, fill=0.75) + cell(POTRF, size, *doubtful, fill=0.75)
    rows += steady(SPD, 22, 1, fill=0.2) + steady(KLU, 22, 2, fill=0.2)  # not of the profile's grid: does not count
    found = regions(load(rows))
    assert outcome(found, "KLU wins") == (CONFIRMED, "100 %")
    assert outcome(found, "WSMP wins at high") == (UNDECIDED, "50 %")
    wsmp = next(row for row in found if "high fill" in row["claim"])
    assert (wsmp["low"], wsmp["high"]) == ("50", "100")
    dense = next(row for row in found if "dense wins nowhere" in row["claim"])
    assert (dense["low"], dense["high"], dense["verdict"]) == ("0", "25", UNDECIDED)
    assert outcome(found, "above 900")[0] == UNMEASURED


def test_half_of_a_region_is_a_draw():
    rows = []
    for size in (1000, 2000, 3000, 4000):
        klu, cholmod = (1, 2) if size < 2500 else (2, 1)
        rows += steady(KLU, size, klu) + steady(SIMPLICIAL, size, cholmod)
    row = next(row for row in regions(load(rows)) if "above 900" in row["claim"])
    assert (row["verdict"], row["ours"], row["rule"]) == (UNDECIDED, "50 %", "more than 50 %")
    rows += steady(KLU, 5000, 2) + steady(SIMPLICIAL, 5000, 1)
    assert outcome(regions(load(rows)), "above 900") == (CONFIRMED, "60 %")
