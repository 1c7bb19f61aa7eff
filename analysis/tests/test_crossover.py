# The crossing of dense and sparse, on columns whose crossing is known.
import numpy
import pytest

from analysis.crossover import crossings, first_crossing
from analysis.loader import load
from analysis.maps import map_cells
from analysis.tests.conftest import write
from analysis.tests.test_maps import cell

DENSE = {"a/x": True, "b/y": False, "c/z": False}


def crossed(tables, rows):
    write(tables[0] / "tidy.csv", "tidy", rows)
    return crossings(map_cells(load(tables[0])), DENSE)


@pytest.mark.parametrize("logs, adjacent, fill", [
    ([1, -1, -2], [True, True], 20), ([1, 0.5, -1], [True, True], 30 + 20 / 3),
    ([1, 1, 1], [True, True], numpy.inf), ([-1, -1, -2], [True, True], -numpy.inf),
    ([-1, 1, -1], [True, True], 40), ([1, -1, 1], [True, True], 20),
    ([1, -1, -2], [False, True], numpy.inf), ([1, 0, -1], [True, True], 30)])
def test_first_crossing(logs, adjacent, fill):
    fills = numpy.array([10.0, 30.0, 50.0])
    found = first_crossing(fills, numpy.array([logs], dtype=float), adjacent)
    assert found == pytest.approx([fill])


def test_crossing_by_interpolation_of_the_log_ratio(tables):
    """Dense over the best sparse: 4 at 60 %, 1/2 at 90 %: two thirds of the way, at 80 %."""
    rows = (cell(0.6, {"a/x": 4.0, "b/y": 1.0, "c/z": 2.0}, spread=0)
            + cell(0.9, {"a/x": 4.0, "b/y": 9.0, "c/z": 8.0}, spread=0))
    found, = crossed(tables, rows)
    assert (found.variables, found.fill) == (10, pytest.approx(80))
    assert (found.low, found.high) == pytest.approx((80, 80))  # samples without any noise


def test_noise_gives_a_band_around_the_crossing_within_what_was_compared(tables):
    rounds = (1, 2, 3, 4)  # as many above the level as below
    rows = (cell(0.6, {"a/x": 1.05, "b/y": 1.0}, rounds, spread=0.03)
            + cell(0.9, {"a/x": 1.0, "b/y": 1.05}, rounds, spread=0.03))
    found, = crossed(tables, rows)
    assert found.fill == pytest.approx(75)
    assert 60 <= found.low < found.fill < found.high <= 90


@pytest.mark.parametrize("dense", ["excluded", "crashed"])
def test_cells_without_a_dense_time_give_no_crossing(tables, dense):
    rows = (cell(0.6, {"a/x": dense, "b/y": 1.0}) + cell(0.7, {"a/x": 1.0, "b/y": 2.0})
            + cell(0.9, {"a/x": 1.0, "b/y": 2.0}))
    assert crossed(tables, rows) == []
    between = (cell(0.6, {"a/x": 2.0, "b/y": 1.0}) + cell(0.7, {"a/x": dense, "b/y": 1.0})
               + cell(0.9, {"a/x": 1.0, "b/y": 2.0}))
    assert crossed(tables, between) == []


def test_sparse_everywhere_and_a_single_fill_have_none(tables):
    rows = cell(0.6, {"a/x": 2.0, "b/y": 1.0}) + cell(0.9, {"a/x": 2.0, "b/y": 1.0})
    assert crossed(tables, rows) == []
    assert crossed(tables, cell(None, {"a/x": 1.0, "b/y": 2.0})) == []
