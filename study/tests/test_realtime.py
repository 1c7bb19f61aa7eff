# The search for the largest size in real time, and the null process.
import json
import subprocess
from dataclasses import replace
from types import SimpleNamespace

import pytest

from study.core.cell import Contender
from study.realtime.plan import GRID, JUDGED_RUNS, TWICE, judging, search
from study.tests.conftest import ROOT


def found(verdict, count=57):
    """The answer and the places that were asked for, where `verdict(place)` says how each of them does."""
    asked = []

    def probe(place):
        asked.append(place)
        return verdict(place)
    return search(probe, count), asked


def test_the_grid_is_fixed_and_close():
    assert GRID[:6] == [1, 2, 3, 4, 5, 6] and 8192 in GRID
    assert all(big <= max(small + 1, 1.25 * small) for small, big in zip(GRID, GRID[1:]))


@pytest.mark.parametrize("limit", [-1, 0, 7, 8, 20, 55, 56])
def test_the_search_finds_the_last_place_and_asks_for_none_twice(limit):
    answer, asked = found(lambda place: "kept" if place <= limit else "failed")
    assert answer == limit and len(asked) == len(set(asked)) <= 12
    assert limit == 56 or limit + 1 in asked


def test_a_place_that_was_only_interrupted_does_not_end_the_search():
    answer, asked = found(lambda place: "unsure" if place == 15 else "kept" if place <= 33 else "failed")
    assert answer == 33 and 15 in asked


def test_a_place_of_which_one_run_failed_is_no_answer():
    answer, _ = found(lambda place: "unsure" if 10 < place <= 30 else "kept" if place <= 30 else "failed")
    assert answer == 10


@pytest.mark.parametrize("at", [1, 2, 3, 6])
def test_the_search_gives_up_without_budget(at):
    answers = iter(["kept"] * (at - 1) + [None])
    answer, asked = found(lambda place: next(answers))
    assert answer is None and len(asked) == at


def test_judging_has_a_control_in_each_of_its_rounds():
    lab = SimpleNamespace(contender=lambda name: Contender(name, name), settings={"implementations": []}, cells=[])
    lab.run = lambda cells, drop: lab.cells.extend(cells)
    judging(lab)
    twice = [cell for cell in lab.cells if cell.role == "control"]
    assert sorted((cell.scene, cell.number) for cell in twice) == sorted((scene, number) for scene in TWICE for number in range(1, JUDGED_RUNS + 1))
    assert all(replace(cell, role="judging") in lab.cells for cell in twice)
    assert [cell.number for cell in lab.cells] == sorted(cell.number for cell in lab.cells)


def test_the_null_process_counts_gaps():
    def watched(deadline):
        done = subprocess.run([ROOT / "study/realtime/null_process", "--deadline-us", deadline, "--seconds", "0.02",
                               "--after", "it"], capture_output=True, text=True, check=True, timeout=30)
        return json.loads(done.stdout)
    loose, tight = watched("1e9"), watched("0.001")
    assert loose["lost"] == 0 and loose["after"] == "it" and loose["largest_us"] > 0
    assert tight["lost"] == tight["readings"] > 0
