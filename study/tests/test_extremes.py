# Extremes: what is known of motions and cells, what the plan asks for in which order, a few cells on the real program.
import json
from dataclasses import replace

import numpy
import pytest
from scipy.integrate import solve_ivp

from analysis.core import records
from analysis.core.registry import Registry
from analysis.core.schema import conform, of_part
from analysis.core.view import View
from analysis.extremes import battery, cells, judge, tables, trials
from analysis.extremes.linkages import Wheel
from analysis.extremes.mechanisms import LightEnd, TwoDrives, Uneven
from analysis.extremes.motions import GRAVITY, Chain, Flat, twin_rod
from study.core import profile as profiles
from study.core.cell import Contender
from study.core.lab import Lab
from study.core.studyset import StudySet, start
from study.extremes import plan
from study.scenes.references import four_bar, turning
from study.tests.conftest import PROGRAM

TIMES = numpy.linspace(0, 3, 31)
CHAINS = [Chain(3, angle=numpy.pi / 2, rate=0.0), Chain(3, angle=numpy.pi / 2, rate=3.0), Chain(1, angle=3.0, rate=0.5),
          Chain(3, angle=numpy.pi / 2, rate=9.0), Chain(1, gravity=0.0), Chain(2, length=0.1, rods=(1, 1e3, 1))]


@pytest.mark.parametrize("chain", CHAINS)
def test_motions_solve_their_equation_of_motion(chain):
    angles, rates = solve_ivp(lambda _, y: [y[1], chain.k * numpy.sin(y[0])], (0, 3), [chain.angle, chain.rate],
                              t_eval=TIMES, rtol=1e-12, atol=1e-12, method="DOP853").y
    found = turning(TIMES, chain.k, chain.angle, chain.rate)
    assert abs(found - numpy.array([numpy.sin(angles), numpy.cos(angles), rates])).max() < 1e-7


def test_motions_are_those_of_the_four_bar_and_scale_with_length():
    known = four_bar(TIMES, 5)
    [small] = Chain(5, length=1e-2, rate=10.0).solutions(TIMES / 10)
    for axis in "xy":
        assert abs(Chain(5).solutions(TIMES)[0][f"B0.{axis}"] - known[f"B0.{axis}"]).max() < 1e-12
        assert abs(small[f"B0.{axis}"] / 1e-2 - known[f"B0.{axis}"]).max() < 1e-12
    assert Chain(1, rods=(3.0, 3.0), couplers=(3.0,)).k == pytest.approx(Chain(1).k)
    assert [len(Flat(1, angle=numpy.pi / 2, rate=0.0).solutions(TIMES)), len(Chain(1).solutions(TIMES))] == [2, 1]


LINKAGES = [(kind, name, linkage) for (kind, name), linkage in trials.near(1e-3).items()]


@pytest.mark.parametrize(("kind", "name", "linkage"), [*LINKAGES, *(("x", *one) for one in (trials.PASSING | trials.FAR).items())])
def test_links_keep_their_lengths_and_assembly(kind, name, linkage):
    angles = numpy.linspace(0.003, 0.003 + 2 * numpy.pi, 20001)
    at = linkage.at(angles)
    for link, (first, second), length in linkage.links:
        assert numpy.hypot(*(at[second] - at[first])) == pytest.approx(length, abs=1e-9), link
    steps = [numpy.hypot(*numpy.diff(at[point])).max() for point in linkage.points]
    assert max(steps) < 0.4 * linkage.shortest  # it does not jump
    document = linkage.document()
    lengths = [rod["length"] for rod in document.get("rods", [])]
    assert lengths and numpy.isfinite(lengths).all() and json.dumps(document, allow_nan=False)


def test_linkages_come_as_near_to_their_change_points_as_they_should():
    for gap in (1e-5, 1e-2):
        for (kind, name), linkage in trials.near(gap).items():
            last = linkage.followers[-1]
            if kind == "six-bar":
                at = linkage.at(numpy.linspace(0, 2 * numpy.pi, 100001))
                far = numpy.hypot(*(at["F"] - at[last.ends[0]])).max()
                assert sum(last.lengths) - far == pytest.approx(gap, rel=1e-3, abs=1e-8), name
            if kind == "four-bar":
                lengths = sorted([linkage.crank, *last.lengths, linkage.feet[1][1][0]])
                assert lengths[1] + lengths[2] - lengths[0] - lengths[3] == pytest.approx(gap, abs=1e-12), name  # Grashof


def test_a_free_linkage_keeps_its_energy():
    linkage = replace(trials.FAR["crank-rocker"], driven=False, gravity=3.0, rate=5.0)
    times = numpy.linspace(0, 3, 30001)
    angle = linkage.angles(times)
    inertia, potential = linkage.energy(angle)
    energy = inertia * numpy.gradient(angle, times)**2 / 2 + potential
    assert angle[-1] > 8 and energy[5:-5] == pytest.approx(energy[5], rel=1e-4) and numpy.ptp(potential) > 0.5


def test_a_wheel_keeps_its_direction_and_a_carried_linkage_moves_as_at_rest():
    still = replace(trials.FAR["crank-rocker"], driven=False)
    for linkage in (still, replace(still, followers=(*still.followers, Wheel("W", "C")))):
        [here], [carried] = (one.solutions(TIMES) for one in (linkage, replace(linkage, carried=0.5)))
        assert carried["C.x"] - here["C.x"] == pytest.approx(0.5 * TIMES) and (carried["C.y"] == here["C.y"]).all()
    assert here["W.x"] - here["C.x"] == pytest.approx(0.3) and abs(here["C.x"] - still.solutions(TIMES)[0]["C.x"]).max() > 0.03  # it is heavy


def test_uneven_speeds_become_their_mean_and_two_drives_have_two_motions():
    [even] = Chain(1, rate=1.005).solutions(TIMES)
    assert Uneven(1, share=0.01).solutions(TIMES)[0]["B1.x"] == pytest.approx(even["B1.x"])
    assert len(TwoDrives(0.01).solutions(TIMES)) == 2 and len(TwoDrives(0.01).document()["constraints"]) == 2


def test_trials_are_many_mechanisms_of_many_kinds():
    found = trials.all_trials()
    assert len({(cell.name, cell.step) for cell in found}) == len(found) > 500
    assert len({(cell.axis, cell.label) for cell in found}) > 300 and len({cell.axis for cell in found}) > 12
    assert {cell.near for cell in found if cell.axis.startswith("driven")} == set(trials.DISTANCES)
    for cell in found:
        assert cell.columns and (cell.scene or json.dumps(cell.document, allow_nan=False) and cell.length > 0)
        assert f"{cell.step:g}" == f"{float(f'{cell.step:g}'):g}" and cell.steps * cell.step < 101
    runs = trials.few(found, 5, 40)
    assert len(runs) == 45 == len(set(runs)) and all(cell.axis in trials.STANDARD for cell, _ in runs[:5])
    assert len(trials.few(found, 0, 0)) == sum(len(cell.settings) for cell in found)


def test_a_light_end_keeps_its_energy_and_follows_the_heavy_rod():
    times = numpy.linspace(0, 3, 3001)
    [found] = LightEnd(0.5).solutions(times)
    a, b = numpy.arctan2(found["B.x"], -found["B.y"]), numpy.arctan2(found["C.x"] - found["B.x"], found["B.y"] - found["C.y"])
    da, db = (numpy.gradient(numpy.unwrap(angle), times) for angle in (a, b))
    energy = ((1 / 3 + 0.5) * da**2 + 0.5 * numpy.cos(a - b) * da * db + 0.5 / 3 * db**2) / 2 - GRAVITY * (
        numpy.cos(a) + 0.25 * numpy.cos(b))
    assert energy[5:-5] == pytest.approx(energy[0], abs=1e-3)
    [light] = LightEnd(1e-9).solutions(times)
    alone = solve_ivp(lambda _, y: [y[1], -1.5 * GRAVITY * numpy.sin(y[0])], (0, 3), [1.0, 0.0], t_eval=times, rtol=1e-10,
                      atol=1e-10).y[0]
    assert light["B.x"] == pytest.approx(numpy.sin(alone), abs=1e-6)


def test_cells_have_names_of_their_own_and_what_is_known():
    found = cells.extremes()
    assert len({cell.name for cell in found}) == len(found) > 50
    assert {cell.axis for cell in found if cell.motion is None} == {"spring"}
    assert [cell.label for cell in found if cell.scene] == ["N = 10000"]  # whose motion the program knows
    assert all(cell.scene or json.dumps(cell.document, allow_nan=False) for cell in found)
    assert all(cell.scene or cell.name.isascii() and "/" not in cell.name for cell in found)
    assert all(float(f"{cell.step:g}") == pytest.approx(cell.step, rel=1e-12) for cell in found)
    telling = {(axis, label) for axis, labels in cells.TELLING.items() for label in labels}
    assert telling < {(cell.axis, cell.label) for cell in found}
    assert {cell.axis for cell in found} == set(cells.TELLING)


def test_what_is_kept_judges_every_loop_and_every_turn():
    for cell in cells.extremes():
        instants = cell.steps // cell.every
        assert instants >= min(cell.steps, cells.INSTANTS)
        if cell.motion and cell.loops <= 5:
            assert set(cell.columns) == set(cell.motion.solutions(numpy.zeros(1))[0])
        assert len(cell.columns) * instants < 4000  # numbers of a record
    assert Chain(1000).columns[::2] == ("B0.x", "B200.x", "B400.x", "B600.x", "B800.x", "B1000.x")


def test_standing_still_is_right_only_where_nothing_moves():
    for cell in cells.extremes():
        times = numpy.linspace(0, cell.step * cell.steps, 9)
        for solution in cell.motion.solutions(times)[:1] if cell.motion and cell.loops <= 1000 else ():
            still = {column: numpy.full(9, solution[column][0]) for column in cell.columns}
            error = judge.distances(still, solution, cell.length).max()
            assert (error > judge.allowed(cell, [solution])) == (error > judge.STILL), cell.name


VARIANTS = {"eigen_dense/llt": ["saddle-point", "rattle", "single"], "csc_klu/refactor": ["saddle-point"],
            "csc_klu/guarded": ["saddle-point", "geometric-stiffness"], "some/one": []}
REGISTRY = Registry({"implementations": [{"folder": name.split("/")[0], "available": True, "library": "x", "variants": [
    {"name": name, "settings": settings, "dense": name.startswith("eigen")}]} for name, settings in VARIANTS.items()]})


class Asked:
    """A lab that only notes what it is asked for."""

    def __init__(self, names=tuple(VARIANTS), **settings):
        self.registry, self.contenders = REGISTRY, [Contender(name, name) for name in names]
        self.settings = {"implementations": {"forms": ["csc_klu/refactor"], "others": ["eigen_dense/llt"],
                                              "trials": ["csc_klu/refactor", "eigen_dense/llt"]}, "trials": {"standard": 3, "others": 30}, "everyone": True,
                         "cells": 0, "processes": 2,
                         "limit": 5.0} | settings
        self.runs, self.skipped = [], []

    def contender(self, name):
        return next((one for one in self.contenders if one.name == name), None)

    def scene(self, name, document):
        return f"raw/scenes/{name}.json"

    def run(self, asked, drop=False):
        self.runs.append(asked)

    def skip(self, cell, status, reason):
        self.skipped.append((cell, status, reason))

    def found(self):
        return [cell.settled() for some in self.runs for cell in some]


def who(found):
    return [cell.contenders[0].variant for cell in found]


def test_the_battery_asks_for_what_is_most_telling_first():
    lab = Asked()
    plan.run(lab, "battery")
    runs = lab.runs[1][33:]  # after the trials
    assert len({cell.settled() for cell in runs}) == len(runs)
    telling = {cell.name for cell in cells.extremes() if cell.place is not None}
    asked = [(cell.scene.removeprefix("raw/scenes/").removesuffix(".json") in telling, cell.role in ("penalty", "saddle-point"),
              cell.contenders[0].variant) for cell in runs]
    ranks = [[(True, True), (False, True), (True, False)].index(one[:2]) + 3 * (
        one[2] != ("csc_klu/refactor" if one[1] else "eigen_dense/llt")) for one in asked]
    assert ranks == sorted(ranks) and set(ranks) == set(range(6))
    served = {name: {"penalty", *settings} for name, settings in VARIANTS.items()}
    assert all("saddle-point" not in cell.role or "saddle-point" in served[name] for cell, name in zip(runs, who(runs)))
    assert {name for cell, name in zip(runs, who(runs)) if cell.role == "rattle"} == {"eigen_dense/llt"}
    assert {(status, cell.contenders[0].variant) for cell, status, _ in lab.skipped} == {("excluded", "eigen_dense/llt")}
    assert {"N-1000", "four-bar:10000"} <= {cell.scene.removeprefix("raw/scenes/loops-").removesuffix(".json")
                                           for cell, _, _ in lab.skipped}


def test_trials_come_first_by_implementations_in_turn():
    lab = Asked()
    plan.run(lab, "battery")
    references, runs = lab.runs
    assert [cell.program for cell in references] == 2 * 2 * ["mbs"] + 2 * 4 * ["mbs_reference"]
    assert set(who(references[:4])) == {"eigen_dense/llt"} and {cell.role for cell in references} == {"reference"}
    assert who(runs)[:3] == 3 * ["csc_klu/refactor"] and set(who(runs[3:33])) == {"csc_klu/refactor", "eigen_dense/llt"}
    assert all(cell.scene.startswith("harness/") for cell in runs[:3]) and len(lab.found()) == len(set(lab.found()))


def test_a_small_battery_has_one_cell_an_axis_and_nobody_else():
    lab = Asked(cells=1, everyone=False)
    plan.run(lab, "battery")
    scenes_asked = {cell.scene for cell in lab.runs[1][33:]}
    assert len(scenes_asked) == len(cells.TELLING) and set(who(lab.runs[1])) == {"csc_klu/refactor", "eigen_dense/llt"}
    alone = Asked(names=["some/one"], cells=1, everyone=False)
    plan.run(alone, "battery")
    assert set(who(alone.runs[1])) == {"some/one"}  # who is chosen with --only runs though no profile names it


def test_the_reference_is_kept_at_the_same_instants():
    lab = Asked()
    plan.run(lab, "battery")
    pendulum = next(cell for cell in cells.extremes() if cell.motion is None)
    for cell in lab.runs[0][4:]:
        step = float(dict(zip(cell.settings[::2], cell.settings[1::2]))["--step"])
        assert step * cell.every == pytest.approx(pendulum.step * pendulum.every)


def test_pivots_need_klu():
    lab = Asked(names=["some/one"])
    plan.run(lab, "pivots")
    assert [one[1] for one in lab.skipped] == 2 * ["excluded"] and not lab.found()
    lab = Asked()
    plan.run(lab, "pivots")
    assert [cell.number for cell in lab.found()] == [1, 2] and all(cell.timed for cell in lab.found())


@pytest.mark.parametrize("name", profiles.names())
def test_columns_keep_the_budget(name):
    settings = profiles.load(name, ["extremes"]).parts["extremes"]
    assert set(plan.columns(settings)) == {"battery", "pivots"}
    assert sum(plan.columns(settings).values()) <= settings["seconds"] * (1 + 1e-12)


@pytest.fixture
def studyset(tmp_path, monkeypatch):
    monkeypatch.setenv("MBS_PROGRAM", str(PROGRAM))
    return start(tmp_path, profiles.load("smoke", ["extremes"]), ["csc_klu/refactor"], ["extremes"])


def made(studyset):
    """The tables as the schema has them."""
    found = tables.build(records.read_part(studyset.folder, "extremes"), View(studyset.folder, "extremes"))
    schema = of_part("extremes")
    return {name: conform(rows, schema[name], name) for name, rows in found.items()}


def test_the_battery_on_the_real_program_is_resumed(studyset, monkeypatch):
    far = Chain(2, length=1e4, rate=1e-2)
    some = [cells.Extreme("loops", "one", "four-bar:1", Chain(1), steps=80),
            cells.Extreme("length", "1e4 m", "", far, far.document(), step=0.125, steps=80, length=1e4),
            cells.Extreme("redundant", "rod given twice", "", Chain(1), twin_rod(same_points=True), steps=80),
            cells.Extreme("step", "too long", "", Chain(1), Chain(1).document(), step=0.5, steps=80)]
    monkeypatch.setattr(cells, "extremes", lambda: some)
    monkeypatch.setitem(studyset.profile.parts["extremes"], "cells", 0)
    monkeypatch.setattr(cells, "OTHERS", ())
    monkeypatch.setattr(trials, "all_trials", lambda: [])
    plan.run(Lab(studyset, "extremes", "battery"), "battery")
    table = made(studyset)["battery"]
    assert list(table.setting) == 4 * ["penalty", "saddle-point"]
    assert list(table.status[:6]) == 2 * ["ok"] + 2 * ["plausible"] + 2 * ["refused"] and (table.true_error[:4] < 1e-4).all()
    assert (table.status[6:8] == "diverged").all() and table.failed_at[6:8].notna().all() and table.true_error[6:8].isna().all()
    assert "allowed is one rod" in table.reason[4] 
    assert list(table.verdict) == 4 * ["right"] + ["", ""] + 2 * ["stopped"]
    files = [studyset.folder / "raw" / "extremes" / name for name in table.record]
    before = [path.stat().st_mtime_ns for path in files[1:]]
    files[0].unlink()
    lab = Lab(StudySet(studyset.folder), "extremes", "battery")
    monkeypatch.setitem(lab.settings, "cells", 0)
    plan.run(lab, "battery")
    assert made(studyset)["battery"].drop(columns="record").equals(table.drop(columns="record"))
    assert files[0].exists() and before == [path.stat().st_mtime_ns for path in files[1:]]


def test_trials_on_the_real_program(studyset, monkeypatch):
    some = [one for one in trials.all_trials() if (one.label, f"{one.step:g}") in {
        ("pendulum", "0.00125"), ("A01", "0.001"), ("crank-rocker, 1 per s", "0.00125"), ("kite at 0.01", "0.00125"), ("lower rod of 0.001 kg", "0.00125"),
        ("two drives, by 0.01", "0.00125"), ("Watt at 0.01, 1 per s", "0.01")}]
    monkeypatch.setattr(trials, "all_trials", lambda: [replace(one, settings=one.settings[:2]) for one in some])
    monkeypatch.setattr(cells, "extremes", lambda: [])
    monkeypatch.setitem(studyset.profile.parts["extremes"], "trials", {"standard": 0, "others": 0})
    plan.run(Lab(studyset, "extremes", "battery"), "battery")
    table = made(studyset)["battery"]
    assert len(table) == 2 * len(some) and set(table.status) <= {"ok", "plausible", "degraded", "refused", "diverged", "wrong-branch"}
    right = table[table.verdict == "right"]
    assert {"pendulum", "A01", "kite at 0.01", "Watt at 0.01, 1 per s"} <= set(right.value) and (right.true_error < 0.01).all()
    assert not (table.verdict == battery.SILENT).any()
