# The claims ledger on made-up times: every verdict by its rule, and what a run cannot tell.
import csv
import subprocess
import sys

import pytest

from analysis import bounds, claims, ledger, summary
from analysis.claims_libraries import compilers, dense_pairs, tuned_blas
from analysis.claims_maps import over_fill, regions
from analysis.claims_solvers import pivoting, solvers, sparse_against_dense
from analysis.claims_starting import starting_sparse, table1, table2_claims
from analysis.ledger import (COLUMNS, CONFIRMED, REFUTED, UNTESTED, at_least, at_most,
                             more_than, verdict)
from analysis.tests.conftest import write
from analysis.tests.synthetic import cell, failed, operation, phases, results

KLU, FACTOR, SIMPLICIAL = "csc_klu/refactor", "csc_klu/factor", "csc_cholmod/simplicial"
SUPERNODAL, SUPERLU, SPD = "csc_cholmod/supernodal", "eigen_superlu/superlu", "csc_mumps/spd"
GESV, MUMPS, POTRF = "starting_dense/gesv", "starting_sparse/mumps", "armadillo_dense/potrf"
PLAIN, AXPY = "ublas_sparse/plain", "ublas_sparse/axpy_prod"
IDS = {"T1", "T2", "F2", "F4", "F5", "F6", "F7", "C1", "C2", "C3", "C4", "C5"}


def load(folder, rows):
    return results(folder, rows, dense=[POTRF, GESV],
                   sparse=[MUMPS, PLAIN, AXPY, KLU, FACTOR, SIMPLICIAL, SUPERNODAL, SPD, SUPERLU])


def outcome(rows, *words):
    """(verdict, ours) of the only row whose claim has these words."""
    found, = [row for row in rows if all(word in row["claim"] for word in words)]
    return found["verdict"], found["ours"]


@pytest.mark.parametrize("low, high, rule, expected", [
    (3, 4, at_least(3), CONFIRMED), (2, 2.9, at_least(3), REFUTED), (2, 4, at_least(3), UNTESTED),
    (1, 2, at_most(2), CONFIRMED), (2.1, 3, at_most(2), REFUTED), (40, 60, (30, 50), UNTESTED),
    (35, 45, (30, 50), CONFIRMED), (10, 20, (30, 50), REFUTED), (50, 50, more_than(50), UNTESTED),
    (50, 60, more_than(50), UNTESTED), (51, 60, more_than(50), CONFIRMED),
    (40, 49, more_than(50), REFUTED)])
def test_verdict_needs_the_whole_interval(low, high, rule, expected):
    assert verdict(low, high, rule) == expected


def test_an_undecided_row_says_so():
    row = ledger.tested("X", "", "", (3, 2, 4), at_least(3), "", "Reason.")
    assert row["verdict"] == UNTESTED and row["why"].startswith("Undecided") and row["ours"] == "3×"


def test_every_claim_has_a_row_even_without_any_data(tmp_path):
    rows = claims.claims(load(tmp_path, cell(KLU, 10, 1.0)))
    assert {row["id"] for row in rows} == IDS
    assert {row["verdict"] for row in rows} == {UNTESTED}
    assert all(row["why"] and set(row) == set(COLUMNS) for row in rows)


def test_table1_compares_shares_in_points(tmp_path):
    shares = (0.20, 0.25, 0.20, 0.10, 0.05, 0.20)  # evaluation and assembly: 45 %; solving: 30 %
    rows = table1(load(tmp_path, cell(GESV, 22, 8.0) + phases(GESV, 22, *[shares] * 6)))
    few = table1(load(tmp_path, cell(GESV, 22, 8.0) + phases(GESV, 22, shares, shares)))
    assert outcome(few, "dense", "residual")[0] == UNTESTED and "2 processes" in few[0]["why"]
    assert outcome(rows, "dense", "residual") == (CONFIRMED, "45 %")
    assert outcome(rows, "dense", "factorize") == (REFUTED, "30 %")
    assert {row["verdict"] for row in rows if "sparse" in row["claim"]} == {UNTESTED}
    why = next(row["why"] for row in rows if "residual" in row["claim"])
    assert "takes 8 µs a step at n = 22, of which assembly 25 %" in why
    assert "from factorize and solve (14 points less) to other (16 points more)" in why


def rank_k(folder):
    """The optimised one grows as n, plain as n², axpy_prod as n: 10 and 5 times at n = 10."""
    rows = []
    for size in (10, 100, 1000):
        for name, time in ((KLU, size), (PLAIN, size ** 2), (AXPY, 5 * size)):
            rows += operation(name, size, "rank_k_update", time)
    return load(folder, rows)


def test_table2_reports_every_size_and_what_grows(tmp_path):
    rows = table2_claims(rank_k(tmp_path))
    assert outcome(rows, "rank-k", "one of the sizes") == (CONFIRMED, "1000×")
    assert outcome(rows, "rank-k", "n = 1000") == (CONFIRMED, "1000×")
    assert outcome(rows, "rank-k", "n = 82")[0] == UNTESTED
    assert outcome(rows, "addition", "one of the sizes")[0] == UNTESTED
    why = next(row["why"] for row in rows if "one of the sizes" in row["claim"])
    assert f"n^1.0 optimised, {PLAIN} as n^2.0, {AXPY} as n^1.0" in why
    assert "it passes 269 near n = 269" in why
    assert "Fair ratio (faster plain version) at most 5 (5 to 5)" in why
    assert f"takes 1/200 of the time of {PLAIN} at n = 1000" in why


def test_bounds_of_table2_hold_at_the_best_size_or_give_the_analysis(tmp_path):
    rows = {row["claim"].split(",")[0]: row for row in bounds.must_hold(rank_k(tmp_path))}
    assert rows["rank-k update"]["holds"] and rows["rank-k update"]["value"] == "1000"
    assert rows["matrix addition"]["value"] is None
    slow = load(tmp_path, operation(KLU, 82, "matrix_addition", 1)
                + operation(PLAIN, 82, "matrix_addition", 40))
    row = next(row for row in bounds.must_hold(slow) if "addition" in row["claim"])
    assert not row["holds"] and row["value"] == "40" and "Fair ratio" in row["note"]


def test_solvers_and_pivoting(tmp_path):
    rows = []
    for size, others in ((50, 2), (160, 1)):  # KLU is last at 160 variables
        times = {KLU: 1.2, FACTOR: 1.8, SIMPLICIAL: others, SUPERNODAL: 3, SUPERLU: 2.5}
        rows += [row for name, time in times.items() for row in cell(name, size, time, time)]
    data = load(tmp_path, rows)
    found = solvers(data)
    assert outcome(found, "KLU with refactor", "to 160") == (REFUTED, "0.833×")
    assert "leads at 1 of 2 sizes" in found[0]["why"]
    assert outcome(found, "from 161")[0] == UNTESTED
    assert outcome(found, "85 %") == (REFUTED, "120 %")
    assert outcome(found, "WSMP is slower") == (CONFIRMED, "3×")
    assert outcome(found, "SuperLU is slower") == (REFUTED, "0.833×")
    assert outcome(pivoting(data), "full pivoting") == (CONFIRMED, "1.5×")


@pytest.mark.parametrize("stale, expected", [(1e-6, UNTESTED), (3e-6, CONFIRMED)])
def test_stale_pivots_are_judged_by_the_error(tmp_path, stale, expected):
    rows = cell(KLU, 100, 1, position_error=stale) + cell(FACTOR, 100, 1, position_error=1e-6)
    assert outcome(pivoting(load(tmp_path, rows)), "stale")[0] == expected


def test_starting_sparse_and_dense_against_the_best(tmp_path):
    rows = [row for size, sparse, dense, start in ((10, 2, 1, 9), (22, 1, 3, 4), (50, 1, 6, 9),
                                                   (1000, 1, 99, 2))
            for name, time in ((KLU, sparse), (POTRF, dense), (MUMPS, start))
            for row in cell(name, size, time)]
    data = load(tmp_path, rows)
    assert outcome(starting_sparse(data), "22 variables") == (CONFIRMED, "4×")
    assert outcome(starting_sparse(data), "1000 variables") == (REFUTED, "2×")
    assert outcome(sparse_against_dense(data), "10 variables") == (REFUTED, "0.5×")
    assert outcome(sparse_against_dense(data), "50 variables") == (CONFIRMED, "6×")
    held = {row["claim"]: row["holds"] for row in bounds.must_hold(data)}
    assert held["starting sparse ÷ best library-backed sparse, n = 22"]
    assert not held["starting sparse ÷ best library-backed sparse, n = 1000"]


def test_libraries(tmp_path):
    rows = cell(GESV, 100, 30) + cell(POTRF, 100, 10, blas="openblas")
    rows += cell(f"{POTRF}+reference", 100, 20, blas="reference")
    rows += cell(SUPERNODAL, 100, 9, blas="openblas")
    rows += cell(f"{SUPERNODAL}+reference", 100, 10, blas="reference")
    rows += cell(KLU, 100, 5) + cell(f"{KLU}+gcc-O2", 100, 5.25, build="gcc-O2")
    rows += cell(f"{KLU}+clang-O2", 100, 5, build="clang-O2")
    data = load(tmp_path, rows)
    assert outcome(dense_pairs(data), "starting") == (CONFIRMED, "3×")
    assert outcome(dense_pairs(data), "reference ones") == (CONFIRMED, "2×")
    assert outcome(tuned_blas(data), SUPERNODAL) == (REFUTED, "10 %")
    assert outcome(compilers(data), KLU) == (CONFIRMED, "6.25 %")  # 5 % of the middle one's 80 %
    assert outcome(compilers(data), "operating system")[0] == UNTESTED


def test_pairs_at_small_sizes_only_do_not_speak_of_the_figure(tmp_path):
    data = load(tmp_path, cell(GESV, 10, 30) + cell(POTRF, 10, 10))
    assert outcome(dense_pairs(data), "starting")[0] == UNTESTED


def test_over_fill_names_the_fill_where_dense_is_faster(tmp_path):
    rows = [row for fill, sparse in ((None, 1), (0.2, 2), (0.5, 3), (1.0, 5))
            for row in cell(SIMPLICIAL, 100, sparse, fill=fill) + cell(POTRF, 100, 4, fill=fill)]
    found = over_fill(load(tmp_path, rows))
    assert outcome(found, "CHOLMOD") == (REFUTED, "0.8×")
    assert "Dense is faster at 100 %" in found[0]["why"]
    assert outcome(found, "WSMP")[0] == UNTESTED


def test_a_fill_at_which_a_solver_was_lost_leaves_the_claim_open(tmp_path):
    rows = [row for fill in (0.2, 0.5, 1.0)
            for row in cell(SIMPLICIAL, 100, 1, fill=fill) + cell(POTRF, 100, 4, fill=fill)]
    rows = rows[:-2] + cell(POTRF, 100, 4, fill=1.0)
    rows += failed(SIMPLICIAL, 100, "crashed", "SIGSEGV", fill=1.0)
    row = over_fill(load(tmp_path, rows))[0]
    assert row["verdict"] == UNTESTED and "fills of 100 %" in row["why"]


def test_regions_count_undecided_cells_both_ways(tmp_path):
    rows = []
    for size in (10, 22, 50, 82):
        rows += cell(KLU, size, 1, 1) + cell(SIMPLICIAL, size, 2, 2)
        doubtful = (3, 0.5) if size in (10, 22) else (3, 3)  # undecided at 10 and 22
        rows += cell(SPD, size, 1, 1, fill=0.75) + cell(POTRF, size, *doubtful, fill=0.75)
    rows += cell(SPD, 22, 1, 1, fill=0.2, stage="refined")  # not of the grid: does not count
    rows += cell(KLU, 22, 2, 2, fill=0.2, stage="refined")
    found = regions(load(tmp_path, rows))
    assert outcome(found, "KLU wins") == (CONFIRMED, "100 %")
    assert outcome(found, "WSMP wins at high") == (UNTESTED, "50 %")
    wsmp = next(row for row in found if "high fill" in row["claim"])
    assert (wsmp["low"], wsmp["high"]) == ("50", "100")
    dense = next(row for row in found if "dense wins nowhere" in row["claim"])
    assert (dense["low"], dense["high"], dense["verdict"]) == ("0", "25", UNTESTED)
    assert outcome(found, "above 900")[0] == UNTESTED


def test_half_of_a_region_is_a_draw(tmp_path):
    rows = []
    for size in (1000, 2000, 3000, 4000):
        klu, cholmod = (1, 2) if size < 2500 else (2, 1)
        rows += cell(KLU, size, klu, klu) + cell(SIMPLICIAL, size, cholmod, cholmod)
    row = next(row for row in regions(load(tmp_path, rows)) if "above 900" in row["claim"])
    assert (row["verdict"], row["ours"], row["rule"]) == (UNTESTED, "50 %", "more than 50 %")
    rows += cell(KLU, 5000, 2, 2) + cell(SIMPLICIAL, 5000, 1, 1)
    assert outcome(regions(load(tmp_path, rows)), "above 900") == (CONFIRMED, "60 %")


def test_summary_by_size_fill_and_price(tmp_path):
    rows = cell(KLU, 10, 2) + cell(POTRF, 10, 1)
    for fill, sparse in ((0.2, 1), (0.5, 4), (1.0, 9)):
        rows += cell(KLU, 22, sparse, fill=fill) + cell(POTRF, 22, 3, fill=fill)
    rows += cell(KLU, 22, 1) + cell(POTRF, 22, 3) + cell(KLU, 1000, 1)
    rows += failed(POTRF, 1000, "excluded", "too slow", pilot=300, pilot_ratio=300)
    data = load(tmp_path, rows)
    assert [(group["first"], group["last"], group["names"], group["low"])
            for group in summary.by_size(data)][0] == (10, 10, (POTRF,), 2)
    assert summary.by_size(data)[1]["last"] == 1000
    assert summary.dense_from(data) == [
        {"variables": 22, "from": 50, "last_sparse": 20, "between": None}]
    dear, cheap = (next(row for row in summary.prices(data) if row["implementation"] == name)
                   for name in (POTRF, KLU))
    assert (dear["worst"], dear["rough"], dear["cells"]) == (300, 1, 6)
    assert cheap["worst"] == 3 and cheap["mean"] == pytest.approx((2 * 4 / 3 * 3) ** (1 / 6))


def test_cells_that_the_gate_did_not_pass_are_counted(tmp_path):
    load(tmp_path, cell(KLU, 10, 1) + cell(POTRF, 10, 2) + cell(SPD, 10, 3))
    write(tmp_path / "verification.csv", "verification",
          [{"scene": "n10", "implementation": name, "verdict": "agrees", "check": check,
            "passed": passed} for name, check, passed in (
                (KLU, "lock-step", "True"), (KLU, "exact", ""), (POTRF, "lock-step", "True"),
                (POTRF, "passes", "False"), (SPD, "exact", ""))])
    row = bounds.must_hold(claims.load(tmp_path))[-1]
    assert (row["bound"], row["value"], row["holds"]) == ("3", "1", False)


def test_command_line_writes_the_columns(tmp_path):
    load(tmp_path, cell(KLU, 10, 1.0))
    command = [sys.executable, "-m", "analysis.claims", str(tmp_path)]
    subprocess.run([*command, str(tmp_path / "claims.csv")], check=True)
    with open(tmp_path / "claims.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert tuple(rows[0]) == COLUMNS and {row["id"] for row in rows} == IDS
    (tmp_path / "tidy.csv").unlink()
    broken = subprocess.run([*command, "x.csv"], capture_output=True, text=True)
    assert broken.returncode == 1 and broken.stderr.startswith("error: ")
    assert broken.stderr.count("\n") == 1


def test_dense_may_be_ahead_in_between_only(tmp_path):
    rows = [row for fill, sparse in ((0.2, 1), (0.5, 4), (1.0, 2))
            for row in cell(KLU, 22, sparse, fill=fill) + cell(POTRF, 22, 3, fill=fill)]
    assert summary.dense_from(load(tmp_path, rows)) == [
        {"variables": 22, "from": None, "last_sparse": 100, "between": (50, 50)}]
