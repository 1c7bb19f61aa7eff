# The plan of the part stability: which cells it asks for, of a lab that runs nothing.
from types import SimpleNamespace

import pytest

from analysis.core.registry import Registry
from study.core.cell import Contender
from study.stability import plan

SETTINGS = {"seconds": 10, "loops": [1, 5], "powers": [0, 1], "decades": [2], "duration": 0.5,
            "whole": {"penalty": [3, 1], "rattle": [1], "rattle4": [1]}}


def cells_of(column, served, names=tuple(plan.IMPLEMENTATIONS.values())):
    asked = []
    registry = Registry({"implementations": [{"folder": name.split("/")[0], "available": True, "variants": [
        {"name": name, "settings": served}]} for name in names]})
    lab = SimpleNamespace(settings=SETTINGS, registry=registry, run=lambda cells, drop=False: asked.extend(cells),
                          contender=lambda name: Contender(name, name) if name in names else None)
    plan.run(lab, column)
    return asked


def test_a_map_has_every_step_and_factor_of_every_size():
    asked = cells_of("maps", ["saddle-point", "single"])
    runs = [cell for cell in asked if cell.role == "map"]
    assert len(runs) == 2 * 4 * 2 * 2  # sizes, forms in both precisions, steps, factors with the automatic one
    assert {cell.scene for cell in runs} == {"four-bar:1", "four-bar:5"} and not any(cell.timed for cell in runs)
    assert len([cell for cell in asked if cell.role == "window"]) == 2 * 2 * 2


def test_what_is_not_served_or_takes_no_part_is_left_out():
    assert {cell.contenders[0].name for cell in cells_of("maps", []) if cell.role == "map"} == {"csc_klu/refactor"}
    assert cells_of("maps", [], names=("other/one",)) == []


@pytest.mark.parametrize("served, schemes", [([], {"penalty"}), (["rattle"], {"penalty", "rattle", "rattle4"})])
def test_whole_runs_are_of_what_is_served_the_small_ones_first(served, schemes):
    asked = cells_of("whole", served)
    assert {cell.settings[1] for cell in asked} == schemes
    sizes = [int(cell.scene.partition(":")[2]) for cell in asked]
    assert sizes == sorted(sizes)


def test_columns_share_the_budget():
    assert sum(plan.columns(SETTINGS).values()) == pytest.approx(SETTINGS["seconds"])
