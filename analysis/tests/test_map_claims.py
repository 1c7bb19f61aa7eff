# The claims ledger on made-up times: every verdict by its rule, and what a set cannot tell.
import math

import pandas
import pytest

from analysis.core.files import ROOT
from analysis.map import ledger, paper
from analysis.map.claims import (compilers, dense_pairs, pivoting, solvers, sparse_against_dense, starting_sparse, table1, table2_claims,
                                 tuned_blas)
from analysis.map.claims_maps import over_fill, regions
from analysis.map.tables import claims
from analysis.map.ledger import CONFIRMED, EXCEEDED, INCOMPARABLE, MIXED, REFUTED, UNDECIDED, UNMEASURED, Rule, factor, verdict
from analysis.tests.map_tables import cell, failed, operation, phases, results

KLU, FACTOR, SIMPLICIAL = "csc_klu/refactor", "csc_klu/factor", "csc_cholmod/simplicial"
SUPERNODAL, SUPERLU, SPD = "csc_cholmod/supernodal", "eigen_sparse/superlu", "csc_mumps/spd"
GESV, MUMPS, POTRF = "starting_dense/gesv", "starting_sparse/mumps", "armadillo_dense/potrf"
PLAIN, AXPY, NEW = "ublas_sparse/plain", "ublas_sparse/axpy_prod", "new_dense/only"
IDS = {"T1", "T2", "F2", "F4", "F5", "F6", "F7", "C1", "C2", "C3", "C4", "C5"}
FILLS = ["natural", 0.2, 0.5, 0.75, 1.0]
COLUMNS = [{"variables": size, "fills": FILLS} for size in (10, 50, 82, 100, 1000, 2000, 3000, 4000, 5000)]


def test_the_folders_that_claims_name_have_the_role():
    named = {name.split("/")[0] for name in (*paper.STARTING.values(), paper.NOT_OPTIMISED, *sum(paper.SYSTEMS.values(), ()))}
    sources = (ROOT / "implementations").glob("*/implementation.cpp")
    assert named == {path.parent.name for path in sources if "Role::paper" in path.read_text()}


def load(rows):
    return results(rows, dense=[POTRF, GESV, NEW, "hybrid_dense/llt"], sparse=[MUMPS, PLAIN, AXPY, KLU, FACTOR, SIMPLICIAL, SUPERNODAL, SPD, SUPERLU, "csc_ldl/uplooking"],
                   columns=[*COLUMNS, {"variables": 22, "fills": ["natural", 0.75]}])


def steady(name, variables, time, **more):
    """Three processes that agree: their interval is a point."""
    return cell(name, variables, time, time, time, **more)


def outcome(rows, *words):
    """(verdict, ours) of the only row whose claim has these words."""
    found, = [row for row in rows if all(word in row["claim"] for word in words)]
    return found["verdict"], found["ours"]


@pytest.mark.parametrize("low, high, rule, expected", [
    (3, 4, Rule(low=3), CONFIRMED), (2, 2.9, Rule(low=3), REFUTED), (2, 4, Rule(low=3), UNDECIDED),
    (1, 2, Rule(high=2), CONFIRMED), (2.1, 3, Rule(high=2), REFUTED), (40, 60, Rule(30, 50), UNDECIDED),
    (35, 45, Rule(30, 50), CONFIRMED), (51, 60, Rule(30, 50), REFUTED), (1.7, 3.7, factor(2, 3), CONFIRMED),
    (4.2, 4.6, factor(2, 3), EXCEEDED), (3.7, 4.6, factor(2, 3), UNDECIDED), (1.2, 1.5, factor(2, 3), REFUTED)])
def test_verdict_needs_the_whole_interval(low, high, rule, expected):
    assert verdict(low, high, rule) == expected


def judged(*cases, rule=Rule(low=3)):
    return ledger.judged(("X", "", ""), [(f"n = {size}", interval, f"r{size}") for size, interval in cases], rule, "a ÷ b")


@pytest.mark.parametrize("intervals, expected", [
    ([(4, 3.5, 5), (5, 4, 6)], CONFIRMED), ([(4, 3.5, 5), (2, 1, 2.5)], MIXED), ([(4, 3.5, 5), (3, 2, 4)], UNDECIDED),
    ([(2, 1, 2.5), (3, 2, 4)], UNDECIDED), ([(3, 2, 4), (3, 0, math.inf)], UNDECIDED), ([(4, 3.5, 5), (2, 1, 2.5), (3, 2, 4)], MIXED)])
def test_sizes_are_judged_alone_and_summed_up(intervals, expected):
    assert judged(*enumerate(intervals))["verdict"] == expected


def test_a_mixed_row_says_where():
    row = judged((22, (4, 3.5, 5)), (82, (2, 1, 2.5)), (100, (5, 4, 6)))
    assert row["reason"] == "confirmed at n = 22, 100; refuted at n = 82" and row["where"] == "n = 22, 82, 100, a ÷ b"
    assert (row["ours"], row["low"], row["high"], row["record"]) == ("2 to 5×", "1", "6", "r22 r82 r100")


def test_an_undecided_row_says_so():
    row = judged((22, (3, 2, 4)))
    assert (row["verdict"], row["reason"], row["ours"]) == (UNDECIDED, "The interval includes 3×.", "3×")


def test_a_value_without_an_interval_is_rough_and_decides_nothing():
    row = judged((22, (6609.3, 0, math.inf)))
    assert (row["verdict"], row["ours"], row["low"], row["high"]) == (UNDECIDED, "about 6600×", "", "")
    assert row["reason"] == "A single process has no interval."


def test_a_claim_has_one_verdict_and_rows_are_not_counted():
    rows = [ledger.row((name, "", ""), found, "") for name, found in
            (("A", CONFIRMED), ("A", UNMEASURED), ("B", CONFIRMED), ("B", UNDECIDED), ("C", UNMEASURED))]
    table = pandas.DataFrame(rows)
    assert ledger.by_id(table) == {"A": (CONFIRMED, "confirmed, not measured"), "B": (MIXED, "confirmed, undecided"), "C": (UNMEASURED, "")}
    assert ledger.told(table) == "confirmed: A; mixed: B; not measured: C"


def test_every_claim_has_a_row_even_without_any_data():
    rows = claims(load(cell(KLU, 10, 1.0)))
    assert {row["id"] for row in rows} == IDS == set(paper.SUBJECTS) and {row["verdict"] for row in rows} == {UNMEASURED}
    assert all(row["reason"] for row in rows)


def test_a_single_process_decides_nothing():
    rows = cell(KLU, 100, 1.0) + cell(SIMPLICIAL, 100, 2.0)
    assert outcome(solvers(load(rows)), "KLU with refactor", "to 160")[0] == UNDECIDED


def test_table1_compares_shares_in_points():
    shares = (0.20, 0.25, 0.20, 0.10, 0.05, 0.20)  # evaluation and assembly: 45 %; solving: 30 %
    rows = [*table1(load(cell(GESV, 22, 8.0) + phases(GESV, 22, *[shares] * 6)))]
    few = [*table1(load(cell(GESV, 22, 8.0) + phases(GESV, 22, shares, shares)))]
    assert outcome(few, "dense", "residual")[0] == UNMEASURED and "2 processes" in few[0]["reason"]
    assert outcome(rows, "dense", "residual") == (CONFIRMED, "45 %")
    assert outcome(rows, "dense", "factorize") == (REFUTED, "30 %")
    assert {row["verdict"] for row in rows if "sparse" in row["claim"]} == {UNMEASURED}


def test_table2_is_judged_at_every_size_for_each_plain_version():
    rows = []  # the optimised one grows as n, plain as n², axpy_prod as n: 10 and 5 times at n = 10
    for size in (10, 250, 1000):
        for name, time in ((KLU, size), (PLAIN, size ** 2), (AXPY, 5 * size)):
            rows += operation(name, size, "rank_k_update", time, time)
    rows = [*table2_claims(load(rows))]
    assert outcome(rows, "rank-k", PLAIN) == (MIXED, "10 to 1000×") and outcome(rows, "rank-k", AXPY) == (REFUTED, "5×")
    assert outcome(rows, "addition")[0] == UNMEASURED
    mixed = next(row for row in rows if PLAIN in row["claim"])
    assert mixed["reason"] == "confirmed at n = 250; exceeded at n = 1000; refuted at n = 10"
    assert mixed["seen"] == "10× at n = 10, 250× at n = 250, 1000× at n = 1000"


def test_solvers_and_pivoting():
    rows = []
    for size, others in ((50, 2), (160, 1)):  # KLU is last at 160 variables
        times = {KLU: 1.2, FACTOR: 1.8, SIMPLICIAL: others, SPD: 3, SUPERLU: 2.5}
        rows += [row for name, time in times.items() for row in steady(name, size, time)]
    found = solvers(load(rows))
    assert outcome(found, "KLU with refactor", "to 160") == (MIXED, "0.833 to 1.67×")
    assert found[0]["reason"] == "confirmed at n = 50; refuted at n = 160" and outcome(found, "from 161")[0] == UNMEASURED
    assert outcome(found, "85 %") == (REFUTED, "60 to 120 %")
    assert outcome(found, "WSMP is slower") == (CONFIRMED, "1.5 to 3×")
    assert outcome(found, "SuperLU is slower") == (REFUTED, "0.833×")
    assert outcome(pivoting(load(rows)), "full pivoting") == (CONFIRMED, "1.5×")
    rows += [row for size in (50, 160) for row in steady(FACTOR, size, 3)]
    rows = [row for row in rows if row["implementation"] != FACTOR or row["step_us"] == 3]
    assert outcome(pivoting(load(rows)), "full pivoting") == (EXCEEDED, "2.5×")


def test_a_stand_in_is_not_compared_with_itself():
    rows = [row for name, time in ((SIMPLICIAL, 1), (SUPERNODAL, 3), (SPD, 5)) for row in steady(name, 100, time)]
    assert outcome(solvers(load(rows)), "WSMP is slower") == (INCOMPARABLE, "")


@pytest.mark.parametrize("stale, expected", [(1e-6, UNDECIDED), (3e-6, CONFIRMED)])
def test_stale_pivots_are_judged_by_the_error(stale, expected):
    rows = cell(KLU, 100, 1, position_error=stale) + cell(FACTOR, 100, 1, position_error=1e-6)
    assert outcome(pivoting(load(rows)), "stale")[0] == expected


def test_a_claim_over_all_sizes_is_open_where_one_of_them_is():
    rows = steady(KLU, 50, 1) + steady(SIMPLICIAL, 50, 1.1)
    rows += steady(KLU, 160, 1) + cell(SIMPLICIAL, 160, 0.8, 1.2, 2.4)  # slower in the mean, and nothing is certain
    assert outcome(solvers(load(rows)), "KLU with refactor", "to 160") == (UNDECIDED, "1.1 to 1.32×")


def test_starting_sparse_and_dense_against_the_best():
    rows = [row for size, sparse, dense, start in ((10, 2, 1, 9), (22, 1, 3, 2.1), (50, 1, 6, 9), (1000, 1, 99, 4.4))
            for name, time in ((KLU, sparse), (POTRF, dense), (MUMPS, start)) for row in steady(name, size, time)]
    data = load(rows)
    assert outcome(starting_sparse(data), "22 variables") == (CONFIRMED, "2.1×")
    assert outcome(starting_sparse(data), "1000 variables") == (EXCEEDED, "4.4×")
    assert outcome(sparse_against_dense(data), "10 variables") == (REFUTED, "0.5×")
    assert outcome(sparse_against_dense(data), "50 variables") == (CONFIRMED, "6×")


def everywhere():
    """Times from which every claim has a row that was judged."""
    rows = [row for size, times in ((10, (1, 2)), (22, (1, 2)), (50, (1, 6)), (100, (1, 9)), (1000, (1, 99)))
            for name, time in ((KLU, times[0]), (POTRF, times[1]), (f"{POTRF}+reference", 1.1 * times[1]), (GESV, 3 * times[1]), (MUMPS, 3),
                               (SIMPLICIAL, 1.2), (SUPERNODAL, 2), (f"{SUPERNODAL}+reference", 2.05), (SUPERLU, 3), (FACTOR, 1.5))
            for row in steady(name, size, time)]
    rows += [row for fill in FILLS[1:] for size in (50, 100, 1000) for name, time in ((KLU, 4), (SIMPLICIAL, 3), (SUPERNODAL, 2), (POTRF, 1 / fill))
             for row in steady(name, size, time, fill=fill)]
    return rows + [row for name, time in ((KLU, 1), (SIMPLICIAL, 1), (PLAIN, 100)) for row in operation(name, 22, "rank_k_update", time, time)]


@pytest.mark.parametrize("name, time", [("csc_ldl/uplooking", 0.5), ("hybrid_dense/llt", 0.1), (NEW, 0.01)])
def test_a_newcomer_changes_no_claim(name, time):
    rows = everywhere()
    more = [row for size in (10, 22, 50, 100, 160, 1000) for row in steady(name, size, time)]
    more += [row for fill in (0.1, *FILLS[1:]) for size in (50, 82, 100, 1000) for row in steady(name, size, time, fill=fill)]
    more += operation(name, 22, "rank_k_update", time, time)
    before, after = claims(load(rows)), claims(load(rows + more))
    assert {row["id"] for row in before if row["verdict"] != UNMEASURED} == IDS - {"T1", "C5"}
    assert after == before


def test_the_best_dense_is_the_best_measured_one_on_any_pair_and_says_which_took_part():
    rows = steady(KLU, 50, 1) + steady(POTRF, 50, 8) + steady(f"{POTRF}+reference", 50, 5) + steady(NEW, 50, 2)
    found = sparse_against_dense(load(rows))
    assert outcome(found, "50 variables") == (CONFIRMED, "5×") and f"{POTRF}+reference ÷ {KLU}" in found[1]["where"]
    rows = [row for fill in FILLS[1:] for name, time in ((SIMPLICIAL, 2), (POTRF, 3), (f"{POTRF}+reference", 1))
            for row in steady(name, 100, time, fill=fill)] + steady(f"{POTRF}+reference", 100, 1)
    assert outcome(over_fill(load(rows)), "CHOLMOD") == (REFUTED, "0.5×")
    nowhere = next(row for row in regions(load(rows)) if "nowhere" in row["claim"])
    assert nowhere["verdict"] == REFUTED and f"{POTRF}+reference" in nowhere["seen"]


def test_libraries():
    rows = steady(GESV, 100, 30) + steady(POTRF, 100, 10) + steady(f"{POTRF}+reference", 100, 20)
    rows += steady(SUPERNODAL, 100, 9) + steady(f"{SUPERNODAL}+reference", 100, 10)
    rows += steady(KLU, 100, 5) + steady(f"{KLU}+reference", 100, 5)  # in common to both pairs: says nothing of BLAS
    data = load(rows)
    assert outcome(dense_pairs(data), "starting") == (CONFIRMED, "3×")
    assert outcome(dense_pairs(data), "reference ones") == (CONFIRMED, "2×")
    assert outcome(tuned_blas(data), SUPERNODAL) == (REFUTED, "10 %") and len(tuned_blas(data)) == 1
    assert outcome(compilers(data), "compiler")[0] == outcome(compilers(data), "operating system")[0] == UNMEASURED


def test_pairs_at_small_sizes_only_do_not_speak_of_the_figure():
    assert outcome(dense_pairs(load(steady(GESV, 10, 30) + steady(POTRF, 10, 10))), "starting")[0] == UNMEASURED


def test_one_disturbed_size_does_not_decide():
    rows = [row for size, tuned in ((22, 10.1), (82, 10.5), (160, 10.2)) for row in steady(SUPERNODAL, size, tuned)
            + steady(f"{SUPERNODAL}+reference", size, 10) + steady(KLU, size, 5) + steady(f"{KLU}+reference", size, 5)]
    rows += steady(SUPERNODAL, 100, 7.5) + steady(f"{SUPERNODAL}+reference", 100, 10) + steady(KLU, 100, 5) + steady(f"{KLU}+reference", 100, 5)
    row, = tuned_blas(load(rows))
    assert (row["verdict"], row["reason"]) == (MIXED, "confirmed at n = 22, 82, 160; refuted at n = 100")


def test_over_fill_names_the_fill_where_dense_is_faster():
    rows = [row for fill, sparse in ((None, 1), (0.2, 2), (0.5, 3), (1.0, 5))
            for row in steady(SIMPLICIAL, 100, sparse, fill=fill) + steady(POTRF, 100, 4, fill=fill)]
    found = [*over_fill(load(rows + steady(f"{POTRF}+reference", 100, 4)))]  # a pair that no filled scene has
    assert found[0]["where"].endswith(f"n = 100, {POTRF} ÷ {SIMPLICIAL}")
    assert outcome(found, "CHOLMOD") == (MIXED, "0.8 to 4×") and found[0]["reason"] == "confirmed at 5 %, 20 %, 50 %; refuted at 100 %"
    assert outcome(found, "WSMP")[0] == UNMEASURED


def test_a_fill_at_which_a_solver_was_lost_leaves_the_claim_open():
    rows = [row for fill in (0.2, 0.5) for row in steady(SIMPLICIAL, 100, 1, fill=fill) + steady(POTRF, 100, 4, fill=fill)]
    rows += steady(POTRF, 100, 4, fill=1.0) + failed(SIMPLICIAL, 100, "crashed", "SIGSEGV", fill=1.0)
    row, _ = over_fill(load(rows))
    assert row["verdict"] == UNMEASURED and "fills of 100 %" in row["reason"]


def test_regions_are_judged_cell_by_cell():
    rows = []
    for size in (10, 22, 50, 82):
        rows += steady(KLU, size, 1, fill_percent=52 if size == 10 else 5) + steady(SIMPLICIAL, size, 2, fill_percent=52 if size == 10 else 5)
        doubtful = (3, 0.5, 1) if size in (10, 22) else (3, 3, 3)  # undecided at 10 and 22
        rows += cell(SPD, size, 1, 1, 1, fill=0.75) + cell(POTRF, size, *doubtful, fill=0.75)
    rows += steady(SPD, 22, 1, fill=0.2) + steady(KLU, 22, 2, fill=0.2)  # not of the profile's grid: does not count
    found = regions(load(rows))
    assert outcome(found, "KLU wins") == (CONFIRMED, "4 of 4 cells")  # the own fill is the lowest of its size
    assert outcome(found, "WSMP wins at high") == (UNDECIDED, "2 of 4 cells")
    wsmp = next(row for row in found if "high fill" in row["claim"])
    assert wsmp["reason"] == "confirmed at n = 50 and 75 %, 82 and 75 %; undecided at n = 10 and 75 %, 22 and 75 %"
    dense = next(row for row in found if "dense wins nowhere" in row["claim"])
    assert (dense["ours"], dense["verdict"]) == ("6 of 8 cells", UNDECIDED)
    assert outcome(found, "above 900")[0] == UNMEASURED


def test_a_region_that_some_cells_refute_and_none_confirms_is_refuted():
    rows = []
    for size, who in ((10, POTRF), (22, SPD), (50, KLU), (82, SUPERNODAL)):  # at 22 open, at 82 of two systems
        rows += [row for name in (POTRF, KLU, SPD, SUPERNODAL) for row in cell(name, size, *(3 * [1 if name == who else 2]), fill=0.75)]
    rows = [row | {"step_us": time, "samples_us": str(time)} if row["variables"] == 22 and row["implementation"] == POTRF else row
            for row in rows for time in [(3, 0.5, 1)[row["process"] - 1]]]
    row = next(row for row in regions(load(rows)) if "WSMP wins at high" in row["claim"])
    assert (row["verdict"], row["ours"]) == (REFUTED, "0 of 4 cells")
    assert row["reason"] == "refuted at n = 10 and 75 %, 50 and 75 %; undecided at n = 22 and 75 %; not comparable at n = 82 and 75 %"


def test_a_region_half_of_which_is_lost_is_mixed():
    rows = []
    for size in (1000, 2000, 3000, 4000):
        klu, cholmod = (1, 2) if size < 2500 else (2, 1)
        rows += steady(KLU, size, klu) + steady(SIMPLICIAL, size, cholmod)
    row = next(row for row in regions(load(rows)) if "above 900" in row["claim"])
    assert (row["verdict"], row["ours"]) == (MIXED, "2 of 4 cells")
    assert row["reason"] == "confirmed at n = 3000 and 5 %, 4000 and 5 %; refuted at n = 1000 and 5 %, 2000 and 5 %"


def test_a_winner_that_stands_for_two_systems_tells_nothing_of_either():
    rows = [row for size in (10, 22, 50, 82) for row in steady(SUPERNODAL, size, 1, fill=0.75) + steady(SPD, size, 2, fill=0.75)]
    assert outcome(regions(load(rows)), "WSMP wins at high") == (INCOMPARABLE, "0 of 4 cells")
