# The figures numbered as in the paper: what they compute and show, also of failed and missing data.
import math

import matplotlib.pyplot as plt
import pytest

from analysis.figures import (f2_dense_pairs, f4_sparse_solvers, f5_fill, t1_phases,
                              t2_operations)
from analysis.style import Look, number_axis, plain, size_ticks
from analysis.tests.synthetic import cell, failed, operation, phases, results

GESV, MUMPS = "starting_dense/gesv", "starting_sparse/mumps"
POTRF = "armadillo_dense/potrf"
PAIRS = [{"name": name, "blas": blas, "lapack": lapack, "available": not reason, "reason": reason}
         for name, blas, lapack, reason in (
             ("openblas", "OpenBLAS (successor of GotoBLAS)", "its own LAPACK", ""),
             ("atlas", "ATLAS", "its own LAPACK", ""),
             ("blis-flame", "BLIS", "libflame", "libflame not found"))]


def texts(figure):
    """Everything that is written anywhere in a figure."""
    legends = [axes.get_legend() for axes in figure.axes if axes.get_legend()] + figure.legends
    return "\n".join([text.get_text() for axes in figure.axes for text in axes.texts]
                     + [text.get_text() for axes in figure.axes for text in
                        [axes.title, axes._left_title, *axes.get_yticklabels()]]
                     + [text.get_text() for text in figure.texts]
                     + [text.get_text() for legend in legends
                        for text in [legend.get_title(), *legend.get_texts()]])


def hollow(axes):
    return [(line.get_xdata()[0], line.get_ydata()[0]) for line in axes.get_lines()
            if line.get_markerfacecolor() == "none"]


def crosses(axes):
    return [tuple(line.get_xdata()) for line in axes.get_lines()
            if line.get_marker() == "x" and len(line.get_xdata())]


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


@pytest.mark.parametrize("figure", [t1_phases, t2_operations, f2_dense_pairs, f4_sparse_solvers,
                                    f5_fill])
@pytest.mark.parametrize("rows", [[], cell("s/a", 10, 1, 1), cell("d/x", 10, 1, 1),
                                  failed("s/a", 10, "crashed", "SIGSEGV")])
def test_missing_data_is_said_and_never_a_crash(tmp_path, figure, rows):
    drawn = figure.draw(results(tmp_path, rows, dense=["d/x"], sparse=["s/a"]))
    drawn.savefig(tmp_path / "figure.svg", bbox_inches="tight")
    said = texts(drawn)
    timed = rows and rows[0]["status"] == "ok" and rows[0]["implementation"] == "s/a"
    expected = {t1_phases: "not profiled at this size", t2_operations: "no operation of Table 2",
                f2_dense_pairs: "no dense implementation was timed on more than one pair",
                f4_sparse_solvers: "s/a   1.00×" if timed else "no sparse implementation",
                f5_fill: "no size was timed at three"}
    assert expected[figure] in said
    crashed = bool(rows) and rows[0]["status"] == "crashed"
    assert ("SIGSEGV" in said) == (crashed and figure is f4_sparse_solvers)


# Table 1

def test_table_1_has_the_papers_groups_and_reasons(tmp_path):
    rows = [*phases(GESV, 22, (.1, .4, .2, .2, .05, .05)), *cell(GESV, 22, 9),
            *cell("s/a", 22, 1), *phases("s/a", 22, (.2, .2, .2, .2, .1, .1)),
            *failed(MUMPS, 22, "crashed", "SIGSEGV")]
    found = t1_phases.table(results(tmp_path, rows, dense=[GESV], sparse=[MUMPS, "s/a"]))
    labels = {row["label"]: row for row in found if row["variables"] == 22}
    assert list(labels) == ["paper: starting dense", GESV, MUMPS, "fastest today: s/a"]
    assert list(labels[GESV]["shares"].values()) == pytest.approx([50, 5, 40, 5])
    assert list(labels["paper: starting dense"]["shares"].values()) == [48, 4, 44, 4]
    assert labels[MUMPS]["shares"] == {} and labels[MUMPS]["why"] == "crashed: SIGSEGV"
    assert "crashed: SIGSEGV" in texts(t1_phases.draw(results(
        tmp_path, rows, dense=[GESV], sparse=[MUMPS, "s/a"])))


# Table 2

def test_table_2_compares_with_the_fastest_optimised(tmp_path):
    names = ["ublas_sparse/plain", "s/a", "s/b", "starting_sparse/mumps"]
    rows = [row for name, time in zip(names, (300.0, 3.0, 2.0, 1.0)) for size in (22, 82)
            for row in operation(name, size, "rank_k_update", time)]
    rows += operation("s/b", 160, "rank_k_update", "", status="timeout", reason="took too long")
    found = results(tmp_path, rows, sparse=names)
    assert [(row["variables"], row["slow"], row["fast"], row["ratio"].value)
            for row in t2_operations.table(found)] == [
        (22, names[0], "s/b", 150), (82, names[0], "s/b", 150)]
    said = texts(t2_operations.draw(found))
    assert "paper: 269" in said and "✕ timeout – took too long: s/b (n = 160)" in said


# Figure 2

@pytest.fixture
def dense_pairs(tmp_path):
    rows = [*cell(GESV, 10, 8, 8), *failed(GESV, 1000, "excluded", "slow", pilot=900),
            *cell(POTRF, 10, 4, 4, blas="openblas"), *cell(POTRF, 1000, 100, 100),
            *cell(f"{POTRF}+atlas", 10, 2, 2, blas="atlas"),
            *failed(f"{POTRF}+atlas", 1000, "excluded", "slow", pilot=300, blas="atlas"),
            *cell(f"{POTRF}+clang-O2", 10, 1, build="clang-O2"),
            *failed(f"{POTRF}+blis-flame", 10, "unavailable", "libflame not found")]
    return results(tmp_path, rows, dense=[GESV, POTRF], pairs=PAIRS)


def test_speed_ups_over_the_starting_version(dense_pairs):
    found = f2_dense_pairs.series(f2_dense_pairs.dense_rows(dense_pairs))
    values = {name: [(size, middle, ratio and ratio.value) for size, middle, _, _, ratio in points]
              for name, points in found.items()}
    assert values == {GESV: [(10, 8, 1)], POTRF: [(10, 4, 2), (1000, 100, None)],
                      f"{POTRF}+atlas": [(10, 2, 4)]}
    assert f2_dense_pairs.with_pairs(dense_pairs) == [POTRF]


def test_pairs_are_named_and_unavailable_ones_told(dense_pairs):
    drawn = f2_dense_pairs.draw(dense_pairs)
    said = texts(drawn)
    assert "OpenBLAS (successor of GotoBLAS)\n  + its own LAPACK  (its usual pair)" in said
    assert "BLIS\n  + libflame\n  unavailable: libflame not found" in said
    assert crosses(drawn.axes[0]) == [(10,)]
    assert sorted(hollow(drawn.axes[0])) == [(1000, 1), (1000, 3), (1000, 9)]
    assert sorted(hollow(drawn.axes[1])) == [(1000, 300), (1000, 900)]


def test_pairs_that_were_not_tried_are_told(tmp_path):
    rows = [*cell(GESV, 10, 8), *cell(POTRF, 10, 4), *cell(f"{POTRF}+openblas", 10, 2)]
    said = texts(f2_dense_pairs.draw(results(tmp_path, rows, dense=[GESV, POTRF], pairs=PAIRS)))
    assert "✕ atlas (ATLAS + its own LAPACK): not part of this run" in said
    assert "✕ blis-flame (BLIS + libflame): libflame not found" in said


# Figure 4

def test_sparse_solvers_in_order_of_efficiency(tmp_path):
    rows = [*cell("s/a", 10, 1, 1), *cell("s/a", 160, 10, 10), *cell("s/b", 10, 3, 3),
            *cell("s/b", 160, 20, 20), *failed("s/b", 1000, "excluded", "slow", pilot=600),
            *cell("s/a", 1000, 100, 100), *cell("s/c", 160, 90, 90),
            *failed("s/c", 10, "disagrees", "lambda is off"), *cell("d/x", 10, 0.5, 0.5)]
    found = results(tmp_path, rows, dense=["d/x"], sparse=["s/a", "s/b", "s/c"],
                    unavailable=[("csc_pardiso", "library not found")])
    assert [ratio.value for ratio in f4_sparse_solvers.ratios(found)["s/b"]] == [3, 2]
    drawn = f4_sparse_solvers.draw(found)
    assert [text.get_text() for text in drawn.axes[1].get_legend().get_texts()] == [
        "s/c   9.00×   –", "s/b   2.00×   –", "s/a   1.00×   1.00×"]
    assert hollow(drawn.axes[1]) == [(1000, 600)] and hollow(drawn.axes[3]) == [(1000, 6)]
    assert hollow(drawn.axes[0]) == [] and crosses(drawn.axes[0]) == [(10,)]
    said = texts(drawn)
    assert "✕ disagrees – lambda is off: s/c (n = 10)" in said
    assert "beyond the top of the linear axes, see right: s/c" in said
    assert "csc_pardiso is unavailable: library not found" in said
    assert "sizes above 602" in said


# Figure 5

def filled(name, size, times):
    return [row for fill, time in times.items() for row in cell(name, size, time, time, fill=fill)]


@pytest.mark.parametrize("sizes, chosen", [
    ({82: 5, 160: 3, 22: 5}, 82), ({100: 3, 82: 5}, 100), ({82: 5, 118: 5}, 118),
    ({50: 12, 100: 3}, 50), ({10: 2}, None), ({}, None)])
def test_size_of_figure_5(tmp_path, sizes, chosen):
    rows = [row for size, count in sizes.items()
            for row in filled("s/a", size, {(k + 1) / 20: 1 for k in range(count)})]
    assert f5_fill.chosen_size(results(tmp_path, rows, sparse=["s/a"])) == chosen


def test_fills_at_which_dense_overtakes(tmp_path):
    rows = [*filled("d/x", 82, {.1: 8, .5: 8, .9: 8}), *filled("d/y", 82, {.1: 9, .5: 9, .9: 4}),
            *filled("s/a", 82, {.1: 2, .5: 4, .9: 8}), *filled("s/b", 82, {.1: 1, .5: 1, .9: 1}),
            *filled("s/c", 82, {.1: 90, .5: 99}),
            *failed("s/c", 82, "excluded", "slow", fill=.9, pilot=500)]
    found = results(tmp_path, rows, dense=["d/x", "d/y"], sparse=["s/a", "s/b", "s/c"])
    crossed = f5_fill.crossings(found, 82)
    assert crossed["s/a"] == {"fill": pytest.approx(70), "low": pytest.approx(70),
                              "high": pytest.approx(70), "first": 10, "last": 90}  # 2 and 1/2
    assert crossed["s/b"]["fill"] == math.inf and crossed["s/c"]["fill"] == -math.inf
    drawn = f5_fill.draw(found)
    said = texts(drawn)
    assert "nearest measured to the paper's 100" in said
    assert "fastest dense:\n   d/x\n   d/y" in said
    assert "70.0 % (95 %: 70.0 to 70.0)" in said
    assert "faster than dense at every fill timed, to 90 %" in said
    assert hollow(drawn.axes[0]) == [(90, 250)]  # a pilot takes two passes a step
    assert "s/c (90 %)" in said


@pytest.mark.parametrize("fill, low, high, text", [
    (50, -math.inf, math.inf, "50.0 % (95 %: below 5 to above 90)"),
    (math.inf, 80, math.inf, "faster than dense at every fill timed, to 90 %, undecided from 80 %"),
    (-math.inf, -math.inf, 20,
     "slower than dense from the lowest fill timed, 5 %, undecided at first")])
def test_crossings_in_words(fill, low, high, text):
    row = {"fill": fill, "low": low, "high": high, "first": 5, "last": 90}
    assert f5_fill.outcome(row) == text


# The look

def test_every_implementation_has_a_look_of_its_own(tmp_path):
    names = [f"f{k // 3}/v{k % 3}" for k in range(20)]
    rows = [*cell("f0/v0+atlas", 10, 1, blas="atlas"),
            *cell("f0/v0+atlas-reference", 10, 1, blas="atlas-reference")]
    look = Look(results(tmp_path, rows, dense=names[:6], sparse=names[6:]))
    assert len({look.letter(name) for name in names}) == 20
    assert len({(look.colour(name), look.marker(name)) for name in names}) == 20
    own, other = look.line("f0/v0+atlas"), look.line("f0/v0+atlas-reference")
    assert own["color"] == other["color"] and own["linestyle"] != other["linestyle"]


def test_ticks():
    assert [plain(value) for value in (0.5, 20, 10000, 1e5, 2e6)] == [
        "0.5", "20", "10000", "$10^{5}$", "$2·10^{6}$"]
    _, axes = plt.subplots()
    axes.plot([10, 1000], [1, 8])
    axes.set_yscale("log")
    size_ticks(axes, [10, 10.5, 1000])
    number_axis(axes.yaxis, "×")
    assert [text.get_text() for text in axes.get_xticklabels()] == ["10", "", "1000"]
    axes.figure.canvas.draw()
    assert {"1×", "2×", "5×"} <= {text.get_text() for text in axes.get_yticklabels()}
