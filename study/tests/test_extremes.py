# study/extremes: what is known of motions, cells and scaling; the parts on the fake program; a tiny real run.
import json
import os
import subprocess
from types import SimpleNamespace

import numpy
import pandas
import pytest
from scipy.integrate import solve_ivp

from study.extremes_study import battery, cells, pivots, roundoff, scaling, scenes, settings, tools, ways
from study.extremes_study.cells import Cell, battery as all_cells
from study.extremes_study.motions import Chain, Flat, singular_times
from study.pipeline.contenders import Contender
from study.pipeline.errors import StudyError
from study.pipeline.layout import Layout, write_json
from study.scenes.references import four_bar
from study.tests.conftest import ROOT, study

TIMES = numpy.linspace(0, 3, 31)
CHAINS = [Chain(3, angle=numpy.pi / 2, rate=0.0), Chain(3, angle=numpy.pi / 2, rate=3.0), Chain(1, angle=3.0, rate=0.5),
          Chain(3, angle=numpy.pi / 2, rate=9.0), Chain(1, gravity=0.0), Chain(2, length=0.1, rods=(1, 1e3, 1))]


@pytest.mark.parametrize("chain", CHAINS)
def test_motions_solve_their_equation_of_motion(chain):
    angles, rates = solve_ivp(lambda _, y: [y[1], chain.k * numpy.sin(y[0])], (0, 3), [chain.angle, chain.rate],
                       t_eval=TIMES, rtol=1e-10, atol=1e-12, method="DOP853").y
    sine, cosine = chain.phi(TIMES)
    assert chain.speed(TIMES)**2 == pytest.approx(rates**2, rel=1e-6, abs=1e-6)
    assert abs(sine - numpy.sin(angles)).max() < 1e-7 and abs(cosine - numpy.cos(angles)).max() < 1e-7


def test_motions_are_those_of_the_four_bar_and_scale_with_length():
    known = four_bar(TIMES, 5)
    [small] = Chain(5, length=1e-2, rate=10.0).solutions(TIMES / 10)
    for axis in "xy":
        assert abs(Chain(5).solutions(TIMES)[0][f"B0.{axis}"] - known[f"B0.{axis}"]).max() < 1e-12
        assert abs(small[f"B0.{axis}"] / 1e-2 - known[f"B0.{axis}"]).max() < 1e-12
    assert Chain(1, rods=(3.0, 3.0), couplers=(3.0,)).k == pytest.approx(Chain(1).k)
    times = singular_times(Chain(2), 20)
    assert len(times) == 20 and abs(Chain(2).phi(times)[1]).max() < 1e-9
    assert [len(Flat(1, angle=numpy.pi / 2, rate=0.0).solutions(TIMES)), len(Chain(1).solutions(TIMES))] == [2, 1]


def test_cells_have_names_of_their_own_and_what_is_known():
    cells = all_cells()
    assert len({cell.name for cell in cells}) == len(cells) > 50
    assert {cell.axis for cell in cells if cell.motion is None} == {"spring"}
    assert all(cell.scene or json.dumps(cell.document, allow_nan=False) for cell in cells)
    assert all(float(f"{cell.step:g}") == pytest.approx(cell.step, rel=1e-12) for cell in cells)


def test_only_the_largest_scene_is_one_whose_motion_the_program_knows():
    assert [cell.label for cell in all_cells() if cell.scene] == ["N = 10000"]
    assert all(cell.name.isascii() and "/" not in cell.name for cell in all_cells())


def test_settings_that_few_serve_run_in_cells_that_there_are():
    known = {(cell.axis, cell.label) for cell in all_cells()}
    assert {(axis, label) for axis, labels in settings.CELLS.items() for label in labels} < known
    assert settings.of("loops", "N = 10") == settings.FORMS + settings.OTHERS
    assert settings.of("loops", "N = 1000") == settings.FORMS
    assert {setting.scheme for setting in settings.OTHERS} == {"rattle", "rattle4", "rattle6", "multistep6", "penalty", "saddle-point"}
    assert any(("half-step", "") in setting.changes for setting in settings.OTHERS)  # alone `ok` without exact motion


def test_standing_still_is_right_only_where_nothing_moves():
    for cell in all_cells():
        times = numpy.linspace(0, cell.duration, 9)
        for solution in cell.motion.solutions(times)[:1] if cell.motion else ():
            still = {column: numpy.full(9, values[0]) for column, values in solution.items()}
            error = tools.distances(still, solution, cell.length).max()
            assert (error > cell.allowed([solution])) == (error > cells.STILL), cell.name


def record(status, error=0.0):
    outputs = {column: list(values + error) for column, values in Chain(1).solutions(TIMES)[0].items()}
    return {"summary": {"status": status, "status_reason": ""}, "outputs": {"t": list(TIMES)} | outputs,
            "command": ["/elsewhere/mbs", "simulate", "a scene.json"]}


def test_what_is_ok_beyond_its_class_is_silently_wrong():
    contender, cell = Contender("one/a", "one/a"), Cell("loops", "1", "four-bar:1", Chain(1))
    place = SimpleNamespace(layout=Layout("/r"), settings={"one/a": {"dense": False}})
    penalty = settings.FORMS[0]
    rows = [battery._row(place, cell, penalty, contender, record(*outcome), {})
            for outcome in (("ok",), ("ok", 0.02), ("degraded", 0.02), ("diverged", 0.5), ("ok", float("nan")))]
    assert [row["silent"] for row in rows] == [False, True, False, False, True]
    assert rows[1]["true_error"] == pytest.approx(0.02 * 2**0.5) and numpy.isnan(rows[3]["true_error"])
    assert rows[0]["command"] == "build/mbs simulate 'a scene.json'"
    reported = record("ok")
    reported["summary"]["position_error_max"] = 0.02  # between two samples
    assert battery._row(place, cell, penalty, contender, reported, {})["silent"]
    dense = battery._row(place, cell, penalty, contender, None, {})
    assert dense["status"] == "not run" and "dense" in dense["reason"] and not dense["silent"]


def test_a_run_is_held_to_the_nearest_of_its_motions_and_to_no_bad_reference():
    flat = Flat(1, angle=numpy.pi / 2, rate=0.0)
    ulp = 2.0**-52
    for chain, least in ((flat, ulp), (Chain(1, rate=0.0), ulp), (Chain(1), 8 * ulp), (Chain(1, offset=1e6), 1e6 * ulp)):
        own = battery.truth(Cell("x", "x", "", chain), {}, TIMES)[1]  # of closed forms, as they are evaluated
        assert least <= own < 30 * least
    assert battery.truth(Cell("x", "x", "", flat), {}, [])[1] == 0
    [_, second] = flat.solutions(TIMES)
    other = record("ok") | {"outputs": {"t": list(TIMES)} | {key: list(values) for key, values in second.items()}}
    assert tools.error_of(other, flat.solutions(TIMES), 1.0) == 0
    assert tools.error_of(other, flat.solutions(TIMES)[:1], 1.0) > 0.1
    cell = Cell("spring", "x", "", None)
    def sprung(shift):
        return {"summary": {"status": "ok", "status_reason": ""},
                "outputs": {"t": [0.0], "B.x": [shift], "B.y": [0.0], "C.x": [0.0], "C.y": [0.0]}}
    solutions, own, _ = battery.truth(cell, {(cell, 4): sprung(3e-4), (cell, 8): sprung(0.0)}, [0.0])
    assert own == pytest.approx(1e-4) and len(solutions) == 1
    assert battery.truth(cell, {(cell, 4): sprung(0.3), (cell, 8): sprung(0.0)}, [0.0])[0] == []


def test_scaling_of_unknowns_changes_no_bit_but_by_the_choice_of_pivots():
    table = pandas.DataFrame(scaling.rows())
    own = table.solver == "LU, pivots of its own"
    assert (table[~own].components_that_differ == 0).all() and (table[own].components_that_differ > 0).any()
    chain = scenes.unlike_masses(10, 1e3)
    matrix = scaling.tangent(chain, 1.0, 1e-3, 1e9)
    right = numpy.arange(1.0, len(matrix) + 1)
    known = numpy.linalg.solve(matrix, right)
    for found in (scaling.cholesky(matrix, right), scaling.l_d_l(matrix, right), scaling.lu(matrix, right, matrix)):
        assert found == pytest.approx(known, rel=1e-6)


def test_the_tangent_is_that_of_the_energy():
    chain = Chain(2, rods=(1.0, 2.0, 3.0), couplers=(4.0, 5.0))
    mass = scaling.tangent(chain, 0.4, 1.0, 0.0)
    turning = numpy.tile([numpy.cos(0.4), -numpy.sin(0.4)], 3)
    assert turning @ mass @ turning == pytest.approx(6 / 3 + 9)
    assert scaling.tangent(chain, 0.4, 2.0, 1e9) @ turning == pytest.approx(mass @ turning, abs=1e-5)


def test_growth_is_taken_as_long_as_both_have_steps():
    ours, theirs = record("ok", 1e-3), record("ok")
    theirs["outputs"] = {key: values[:5] for key, values in theirs["outputs"].items()}
    times, found = roundoff.differences(ours, theirs)
    assert len(times) == 5 and found == pytest.approx(numpy.full(5, 1e-3 * 2**0.5))
    line = pandas.DataFrame({"loops": [40], "t": [19.98000001], "difference": [1.23456e-13], "speed": [float("nan")]})
    assert roundoff._short(line).to_csv(index=False).splitlines()[1] == "40,19.98,1.235e-13,"
    assert roundoff._at([0.0, 1.0], [0.0, 2.0], 1.0) == 2 and roundoff._at([0.0], [0.0], 1.0) is None


def test_ways_take_the_first_variant_that_serves_them():
    ones = [Contender(name, name) for name in ("csc_klu/refactor", "csc_klu/guarded")]
    place = tools.Study(None, ones, {"csc_klu/refactor": {}, "csc_klu/guarded": {"settings": ["geometric-stiffness"]}},
                        {}, 1.0, None)
    named = {way.name: way for way in ways.WAYS}
    names = ways.PREFERRED["csc_klu"]
    assert ways.stands_for(place, named["α auto"], names).variant == "csc_klu/refactor"
    assert ways.stands_for(place, named["exact tangent"], names).variant == "csc_klu/guarded"
    assert ways.stands_for(place, named["mixed precision"], names) is None


def stale(folder, text):
    program = folder / tools.STALE_PIVOTS
    program.parent.mkdir(parents=True)
    program.write_text(f"#!/bin/sh\necho '{text}'\n")
    program.chmod(0o755)


def test_stale_pivots_are_kept_as_the_program_gave_them(tmp_path, monkeypatch):
    row = dict.fromkeys(pivots.COLUMNS, 1) | {"sequence": "upright"}
    monkeypatch.setenv("MBS_PROGRAM", str(tmp_path / "b" / "mbs"))
    place = tools.Study(Layout(tmp_path), [], {}, {"own": {}}, 1.0, lambda text: None)
    with pytest.raises(StudyError, match="csc_klu_stale_pivots is missing"):
        pivots.run(place)
    stale(tmp_path / "b", json.dumps({"rows": [row], "claims": [{"claim": "safe", "holds": False}]}))
    tables = pivots.run(place)
    assert list(tables["pivots"].sequence) == ["upright"] and not tables["pivots_claims"].holds.any()
    (tmp_path / "b" / tools.STALE_PIVOTS).unlink()
    assert pivots.run(place)["pivots"].equals(tables["pivots"])  # never run again
    stale(tmp_path / "c", json.dumps({"rows": [{"sequence": "x"}]}))
    monkeypatch.setenv("MBS_PROGRAM", str(tmp_path / "c" / "mbs"))
    with pytest.raises(StudyError, match="its rows lack form"):
        pivots.run(tools.Study(Layout(tmp_path / "d"), [], {}, {"own": {}}, 1.0, lambda text: None))


@pytest.mark.parametrize("arguments, what", [
    (["--parts", "all"], "invalid choice: 'all'"), (["--time-limit", "0"], "0 is not a positive number"),
    (["--stored"], "holds no results"),
    (["--parts", "ways", "--only", "nobody"], "unknown implementation 'nobody'"),
    (["--parts", "ways", "pivots"], "csc_klu_stale_pivots is missing")])
def test_what_is_wrong_is_said_in_a_line(tmp_path, arguments, what):
    done = study("extremes", "--results", tmp_path, *arguments)
    assert done.returncode == 2 and what in done.stderr and "Traceback" not in done.stderr
    assert not list(tmp_path.glob("*.csv"))


@pytest.fixture
def place(tmp_path, monkeypatch):
    """A study of one implementation of the real program."""
    monkeypatch.setenv("MBS_PROGRAM", os.environ.get("MBS_PROGRAM", str(ROOT / "build" / "mbs")))
    one = Contender("csc_klu/refactor", "csc_klu/refactor")
    return tools.Study(Layout(tmp_path), [one], {one.variant: {"dense": False, "settings": ["saddle-point"]}},
                       {one.environment: {}}, 20.0, lambda text, share=None: None)


def test_the_battery_on_the_real_program_is_resumed(place, monkeypatch):
    cells = [Cell("loops", "one", "four-bar:1", Chain(1), steps=80),
             Cell("length", "1e4 m", "", Chain(2, length=1e4, rate=1e-2),
                  Chain(2, length=1e4, rate=1e-2).document(), step=0.125, steps=80, length=1e4),
             Cell("redundant", "rod given twice", "", Chain(1), scenes.twin_rod(same_points=True), steps=80),
             Cell("step", "too long", "four-bar:1", Chain(1), step=0.5, steps=80)]
    monkeypatch.setattr(battery, "battery", lambda: cells)
    table = battery.run(place)["battery"]
    assert list(table.setting) == 4 * ["penalty", "saddle-point"] and not table.silent.any()
    assert list(table.status[:6]) == 2 * ["ok"] + 2 * ["plausible"] + 2 * ["refused"] and (table.true_error[:4] < 1e-4).all()
    assert (table.status[6:] == "diverged").all() and table.failed_at[6:].notna().all()
    assert "allowed is one rod" in table.reason[4]
    files = [place.layout.results / name for name in table.raw_file]
    before = [path.stat().st_mtime_ns for path in files[1:]]
    files[0].unlink()
    again = battery.run(place)["battery"]
    assert again.equals(table) and before == [path.stat().st_mtime_ns for path in files[1:]]
    command = again.command[0].replace("build/mbs", os.environ["MBS_PROGRAM"], 1)
    assert subprocess.run(command, shell=True, cwd=ROOT, capture_output=True).returncode == 0


def test_ways_on_the_real_program(place, monkeypatch):
    monkeypatch.setattr(ways, "WAYS", ways.WAYS[:2] + ways.WAYS[4:6])
    monkeypatch.setattr(ways, "STEPS", (5e-3,))
    monkeypatch.setattr(ways, "LOOPS", (2,))
    monkeypatch.setattr(ways, "DURATION", 0.1)
    tables = ways.run(place)
    found = tables["ways"]
    assert list(dict.fromkeys(found.way)) == ["α = 1e8", "α auto", "exact tangent", "saddle-point"]
    assert list(found[found.way == "exact tangent"].status) == ["unsupported"]
    assert found[(found.axis == "step")].safe.astype(bool).all()
    cost = tables["ways_cost"]
    assert len(cost) == 3 * 2 * ways.ROUNDS and (cost.step_us > 0).all()
    assert list(cost.way[:3]) == ["α = 1e8", "α auto", "saddle-point"]  # in turn
