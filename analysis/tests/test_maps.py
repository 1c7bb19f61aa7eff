# The cells of the maps and what the refinement asks for next, on maps whose answer is known.
import pytest

from analysis.loader import load
from analysis.maps import (MOST_ADDITIONS, cell_bounds, map_cells, not_reached, paired_times,
                           refinement_candidates, scene_fills)
from analysis.tests.conftest import timing, write

NATURAL = 52.0


def cell(fill, levels, rounds=(1, 2, 3), stage="grid", size=10, spread=0.01):
    """Rows of one scene: {implementation: time, or status of what was not timed}. Odd rounds lie
    `spread` above the level for a/x, below it for b/y and on it for others."""
    scene = f"four-bar:{size // 2 - 1}" + ("" if fill is None else f",fill={fill:.2f}")
    base = {"scene": scene, "variables": size, "stage": stage,
            "fill_asked": "" if fill is None else fill,
            "fill_percent": NATURAL if fill is None else 100 * fill}
    rows = []
    for name, level in levels.items():
        if isinstance(level, str):
            rows.append(timing(name, "", "", "", status=level, reason="why", **base))
            continue
        for number in rounds:
            wave = {"a/x": spread, "b/y": -spread}.get(name, 0) * (1 if number % 2 else -1)
            rows += [timing(name, number, k, level * (1 + wave), **base) for k in (1, 2)]
    return rows


def loaded(tables, rows):
    write(tables[0] / "tidy.csv", "tidy", rows)
    return load(tables[0])


def test_cells_in_order_with_their_losses(tables):
    rows = (cell(0.8, {"a/x": 3.0, "b/y": 2.0, "c/z": "excluded"})
            + cell(None, {"a/x": 1.0, "b/y": 2.0, "c/z": "crashed"})
            + cell(0.9, {"a/x": 3.0}, stage="refined")
            + [row | {"implementation": "", "fill_percent": ""}
               for row in cell(0.3, {"a/x": "not-reached"})]
            + cell(None, {"a/x+atlas": 0.1, "null/null": 0.01}))
    results = loaded(tables, rows)
    first, second, third = map_cells(results)
    assert [c.fill_percent for c in (first, second, third)] == [52, 80, 90]
    assert (first.ranking.winner, second.ranking.winner) == ("a/x", "b/y")
    assert first.ranking.margin == pytest.approx(2.0, rel=0.03)
    assert (first.failed, first.excluded) == (("c/z",), ())
    assert (second.failed, second.excluded) == ((), ("c/z",))
    assert (first.fill_asked, second.fill_asked) == (None, 0.8)
    assert (first.refined, third.refined) == ("", "cell")
    assert not_reached(results) == [(10, 0.3)]


def test_a_subset_counts_its_own_failures_only(tables):
    rows = cell(None, {"a/x": "crashed", "b/y": 2.0, "c/z": "excluded"})
    results = loaded(tables, rows)
    whole, = map_cells(results)
    assert not whole.ranking.decided and whole.failed == ("a/x",)
    subset, = map_cells(results, ["b/y", "c/z"])
    assert subset.ranking.decided and subset.ranking.winner == "b/y" and subset.failed == ()
    nobody, = map_cells(results, ["c/z"])
    assert nobody.ranking is None and nobody.excluded == ("c/z",)


@pytest.mark.parametrize("fills, bounds", [
    ([], [0.0]), ([0.6], [0.6, 5.6]), ([98.0], [97.5, 100.0]), ([100.0], [97.5, 100.0]),
    ([10, 20, 40], [10, 15, 30, 50]), ([50, 75, 100], [50, 62.5, 87.5, 100])])
def test_cells_reach_no_further_than_their_own_fill(fills, bounds):
    assert cell_bounds(fills) == pytest.approx(bounds)


def test_a_scene_without_any_pilot_stays_on_the_map(tables):
    rows = cell(None, {"a/x": 1.0}) + [row | {"fill_percent": ""} for row in
                                       cell(0.8, {"a/x": "crashed", "b/y": "crashed"})]
    results = loaded(tables, rows)
    assert list(scene_fills(results.tidy)) == [52, 80]
    assert map_cells(results)[1].ranking is None


def test_more_rounds_of_the_leaders_do_not_slow_them(tables):
    """The machine is twice as slow in the rounds that only the leaders were measured in."""
    rows = cell(None, {"a/x": 1.0, "b/y": 1.1, "c/z": 1.5})
    rows += cell(None, {"a/x": 2.0, "b/y": 2.2}, (4, 5, 6, 7, 8), "refined")
    found, = map_cells(loaded(tables, rows))
    assert (found.ranking.winner, found.ranking.second) == ("a/x", "b/y")
    assert found.refined == "samples" and found.rounds == 8
    times = paired_times(found.samples)
    assert list(times) == ["a/x", "b/y", "c/z"]
    assert times["c/z"] / times["a/x"] == pytest.approx(1.5, rel=0.03)


def test_a_new_cell_lies_midway_where_the_winner_changes(tables):
    fast, slow = {"a/x": 1.0, "b/y": 2.0}, {"a/x": 2.0, "b/y": 1.0}
    rows = cell(None, fast) + cell(0.6, fast) + cell(0.7, slow) + cell(1.0, slow)
    rows += [row | {"variables": 22} for row in cell(0.6, fast, size=22) + cell(1.0, slow, size=22)]
    asked = refinement_candidates(loaded(tables, rows))
    assert [(c["kind"], c["variables"], c["fill"]) for c in asked] == [
        ("cell", 22, 0.8), ("cell", 10, 0.65)]  # the widest gap first
    assert asked[1]["why"] == "a/x leads at 60 %, b/y at 70 %"


@pytest.mark.parametrize("high, count", [(0.63, 0), (0.64, 1)])
def test_no_cell_between_near_fills(tables, high, count):
    rows = cell(0.6, {"a/x": 1.0, "b/y": 2.0}) + cell(high, {"a/x": 2.0, "b/y": 1.0})
    assert len(refinement_candidates(loaded(tables, rows))) == count


UNDECIDED = {"a/x": 1.0, "b/y": 1.005, "c/z": 1.5}


def test_an_undecided_cell_asks_for_samples_of_its_leaders(tables):
    asked, = refinement_candidates(loaded(tables, cell(0.6, UNDECIDED)))
    assert asked["kind"] == "samples" and asked["scene"] == "four-bar:4,fill=0.60"
    assert (asked["variables"], asked["fill"]) == (10, 0.6)
    assert sorted(asked["implementations"]) == ["a/x", "b/y"]
    third = refinement_candidates(loaded(tables, cell(0.6, UNDECIDED | {"c/z": 1.008})))
    assert sorted(third[0]["implementations"]) == ["a/x", "b/y", "c/z"]


def test_decided_and_lonely_cells_ask_for_nothing(tables):
    assert refinement_candidates(loaded(tables, cell(0.6, {"a/x": 1.0, "b/y": 1.5}))) == []
    natural, = refinement_candidates(loaded(tables, cell(None, UNDECIDED)))
    assert (natural["kind"], natural["fill"]) == ("samples", None)
    assert refinement_candidates(loaded(tables, cell(0.6, {"a/x": 1.0, "b/y": "crashed"}))) == []
    natural = refinement_candidates(loaded(tables, cell(None, UNDECIDED) + cell(
        0.6, {"a/x": 1.5, "b/y": 1.0})))
    assert [c["fill"] for c in natural] == [None]  # a column with filled scenes


@pytest.mark.parametrize("additions, asks", [(MOST_ADDITIONS - 1, True), (MOST_ADDITIONS, False)])
def test_samples_are_added_so_many_times(tables, additions, asks):
    rows = cell(0.6, UNDECIDED)
    rows += cell(0.6, UNDECIDED, range(4, 4 + 3 * additions), "refined")
    assert bool(refinement_candidates(loaded(tables, rows))) == asks
    smaller = refinement_candidates(loaded(tables, rows), rounds_added=1)
    assert not smaller  # three or more additions of one round each


def test_the_two_kinds_alternate(tables):
    fast, slow = {"a/x": 1.0, "b/y": 2.0}, {"a/x": 2.0, "b/y": 1.0}
    rows = []
    for size in (10, 22):
        rows += cell(0.6, fast, size=size) + cell(0.7, slow, size=size)
        rows += cell(0.9, {"b/y": 1.0, "c/z": 1.005, "a/x": 1.002}, size=size)
    kinds = [c["kind"] for c in refinement_candidates(loaded(tables, rows))][:4]
    assert kinds == ["cell", "samples", "cell", "samples"]
