# The part beside the engines: which cells it asks for, on a lab that invents records; every setting on the real programs.
import json
import subprocess
from types import SimpleNamespace

import numpy
import pytest

from analysis.core.files import StudyError
from analysis.core.records import Record
from analysis.engines import andrews
from analysis.engines.runs import ENGINE, OURS, ROUND, row
from analysis.engines.subjects import SOLVERS
from study.core.cell import Contender
from study.core.curves import Curve, follow, of_no_use, too_long
from study.engines import plan
from study.engines.plan import EngineSetting, read_list
from study.scenes.references import andrews_end
from study.tests.conftest import ROOT

VALUES = (1e-2, 5e-3, 2.5e-3)
LISTED = {"able": [EngineSetting("able", "step", VALUES), EngineSetting("able", "step", VALUES, (("does", "lose"),))],
          "broken": [EngineSetting("broken", "step", VALUES)], "absent": [EngineSetting("absent", "step", VALUES)]}
SETTINGS = {"seconds": 100.0, "subjects": ["four-bar-2"], "engine_settings": 2, "implementations": ["one/a", "not/here"],
            "settings": ["default", "rattle"], "time_limit": 10.0, "rounds": 3}


class Lab:
    """Invents the record of each cell: errors go with the square of the step, times with its inverse."""

    def __init__(self, column="four-bar-2", budget=100.0, **changes):
        self.settings, self.budget, self.left = SETTINGS | changes, budget, budget
        self.registry = SimpleNamespace(own=frozenset(), serves=lambda name, *needs: "rattle" not in needs)
        self.column, self.asked, self.skipped = column, [], []

    def contender(self, name):
        return Contender(name, name) if name == "one/a" else None

    def tell(self, text):
        pass

    def run(self, cells, drop=False):
        self.asked += cells
        return [self.record(cell.settled()) for cell in cells]

    def one(self, cell):
        return self.run([cell])[0]

    def skip(self, cell, status, reason):
        self.skipped.append((cell.settled(), status, reason))
        return Record(f"{self.column}/{cell.role}/x", cell.settled().document(), status, reason, 0.0, [], {})

    def record(self, cell):
        words = dict(word.split("=", 1) for word in cell.settings if "=" in word)
        step = float(words.get("step") or cell.settings[cell.settings.index("--step") + 1])
        lost = words.get("does") == "lose" and step > 4e-3
        output = {"status": "wrong-branch" if lost else "ok", "status_reason": "rods differ" if lost else "",
                  "position_error_max": 1e2 * step**2, "time": 1e-5 / step, "repeats": 1, "steps": 1, "duration": 1.0,
                  "step_us": {"mean": 1.0 / step}}
        status = "crashed" if "broken" in cell.program else "done"
        return Record(f"{self.column}/{cell.role}/{len(self.asked)}", cell.document(), status, "SIGABRT" * (status != "done"),
                      0.1, [], {}, output if status == "done" else {})

    def of(self, role):
        return [cell for cell in self.asked if cell.role == role]


@pytest.fixture
def fakes(monkeypatch):
    monkeypatch.setattr(plan, "read_list", lambda: LISTED)
    monkeypatch.setattr(plan, "unavailable", lambda: {"able": "", "broken": "", "absent": "libabsent-dev is not installed"})


def test_curves_of_theirs_and_ours_then_common_rounds_in_new_orders(fakes):
    lab = Lab()
    plan.run(lab, "four-bar-2")
    assert [(cell.program, status, reason) for cell, status, reason in lab.skipped if status == "unavailable"] == [
        ("study/engines/engine_absent", "unavailable", "libabsent-dev is not installed")]
    theirs = [cell.program for cell in lab.of(ENGINE)]
    assert theirs.count("study/engines/engine_able") == 6 and theirs.count("study/engines/engine_broken") == 3
    assert lab.of(ENGINE)[0].settings == ("--loops", 2, "--duration", "5", "--setting", "step=0.01", "--json")
    ours = lab.of(OURS)
    assert {cell.contenders[0].variant for cell in ours} == {"one/a"} and not any(cell.timed for cell in ours)
    assert {"--judge-every"} <= set(ours[0].settings) and "rattle" not in {word for cell in ours for word in cell.settings}
    rounds = lab.of(ROUND)
    assert {cell.number for cell in rounds} == {1, 2, 3} and all(cell.timed and not cell.every for cell in rounds)
    orders = [tuple((cell.program, cell.settings) for cell in rounds if cell.number == number) for number in (1, 2, 3)]
    assert {frozenset(one) for one in orders} == {frozenset(orders[0])} and len(set(orders)) > 1
    assert {cell.program for cell in rounds} == {"mbs", "study/engines/engine_able"}
    assert all(cell.settings[-2:] == ("--repeats", plan.REPEATS) for cell in rounds)  # all are short here
    twice = lab.of("control")  # one of each side
    assert sorted((cell.program, cell.number) for cell in twice) == sorted((name, number) for name in ("mbs", "study/engines/engine_able")
                                                                           for number in (1, 2, 3))
    assert {(cell.program, cell.settings) for cell in twice} < {*orders[0]}
    again = Lab()
    plan.run(again, "four-bar-2")
    assert again.asked == lab.asked  # a study that is resumed comes to the same point


def test_without_any_engine_nothing_is_run(monkeypatch):
    monkeypatch.setattr(plan, "unavailable", lambda: dict.fromkeys(read_list(), "libx is not installed"))
    lab = Lab()
    plan.run(lab, "four-bar-2")
    assert not lab.asked and {status for _, status, _ in lab.skipped} == {"unavailable"} and len(lab.skipped) == 6


def test_a_scene_is_asked_of_solvers_alone(monkeypatch):
    missing = dict.fromkeys(read_list(), "")
    monkeypatch.setattr(plan, "unavailable", lambda: missing)
    lab = Lab("andrews", settings=["default"], engine_settings=1)
    monkeypatch.setattr(plan.Bench, "rounds", lambda *rest: None)
    monkeypatch.setattr(plan, "follow", lambda lab, curves, *rest: lab.asked.extend(curves) or [])
    plan.run(lab, "andrews")
    theirs, ours = [dict(curve.cells) for curve in lab.asked]
    assert {cell.program for cell in theirs.values()} == {"study/engines/engine_ida"}
    assert theirs[1e-4].settings[:4] == ("--scene", "harness/scenes/problems/a03_andrews.json", "--duration", "0.03")
    assert (ours[1e-4].scene, ours[1e-4].keep, ours[1e-4].every) == (theirs[1e-4].settings[1], ("outputs",), 1)
    assert not lab.skipped
    missing["ida"] = "libsundials-dev is not installed"
    lab = Lab("andrews")
    plan.run(lab, "andrews")
    assert [cell.program for cell, _, _ in lab.skipped] == ["study/engines/engine_ida"] and not lab.asked


def test_columns_share_the_budget_of_the_part():
    found = plan.columns(SETTINGS | {"subjects": ["four-bar-10", "andrews"]})
    assert found == pytest.approx({"four-bar-10": 200 / 3, "andrews": 100 / 3})


@pytest.mark.parametrize("built", [True, False])
def test_the_build_with_our_flags_runs_what_was_chosen_of_the_packaged_one(monkeypatch, tmp_path, built):
    monkeypatch.setattr(plan, "read_list", lambda: {"ode": [EngineSetting("ode", "step", VALUES)]})
    monkeypatch.setattr(plan, "unavailable", lambda: {"ode": ""})
    monkeypatch.setattr(plan, "ROOT", tmp_path)
    (tmp_path / "build").mkdir()
    if built:
        native = tmp_path / "build" / plan.NATIVE_PROGRAM
        (tmp_path / "build-engines/study/engines").mkdir(parents=True)
        native.touch()
    lab = Lab()
    plan.run(lab, "four-bar-2")
    said = [(status, reason) for cell, status, reason in lab.skipped if cell.program == plan.NATIVE_PROGRAM]
    assert said == ([] if built else [("unavailable", "not built with our flags: study/engines/native")])
    for role in (ENGINE, ROUND):
        ours, packaged = ({cell.settings for cell in lab.of(role) if cell.program == program}
                          for program in (plan.NATIVE_PROGRAM, "study/engines/engine_ode"))
        assert bool(ours) == built and ours <= packaged and (not built or role == ENGINE or ours == packaged)


def test_the_double_pendulum_is_sampled_for_its_error(fakes, monkeypatch):
    lab, asked = Lab("double-pendulum"), []
    bench = plan.Bench(lab, plan.subject_of("double-pendulum"))
    monkeypatch.setattr(plan, "follow", lambda lab, curves, *rest: asked.extend(curves) or [])
    bench.ours(0.0)
    cell = dict(asked[0].cells)[2.5e-3]
    assert (cell.scene, cell.keep, cell.every) == ("study/engines/double_pendulum.json", ("outputs",), 4)
    assert bench.engine_cell("x", ()).settings == ("--pendulum", "--duration", "2", "--json")


def test_the_ladder_of_our_steps_is_fixed():
    steps = plan.Bench(Lab(), plan.subject_of("four-bar-2")).steps()
    assert steps[0] == 2e-2 and steps[1] == 1e-2 and steps[-1] >= 1e-5
    assert steps == sorted(steps, reverse=True) and len(steps) == 11
    assert plan.Bench(Lab(), plan.subject_of("andrews")).steps()[:2] == [4e-4, 2e-4]


def one_curve(lab, limit=10.0, least=0.0, share=1.0, **options):
    bench = plan.Bench(lab, plan.subject_of("four-bar-2"))
    setting = EngineSetting("able", "step", VALUES, tuple(options.items()))
    cells = [(value, bench.engine_cell("study/engines/engine_able", setting.words(value))) for value in VALUES]
    curve = Curve("able", cells, 2.0)
    follow(lab, [curve], row, limit, least, share)
    return curve.rows


def test_curves_end_with_a_row_that_says_why():
    rows = one_curve(Lab(), limit=0.005)
    assert [one["status"] for one in rows] == ["ok", "not-reached"] and rows[1]["reason"].startswith("predicted to take")
    assert [one["value"] for one in rows] == [1e-2, 5e-3]
    rows = one_curve(Lab(), least=3e-3)
    assert [one["status"] for one in rows] == ["ok", "ok", "not-reached"] and "the least that is asked for" in rows[2]["reason"]
    lab = Lab()
    lab.left = 30.0
    rows = one_curve(lab, share=0.6)
    assert [one["status"] for one in rows] == ["dropped"] and "60 s" in rows[0]["reason"]


def point(error, time, status="ok"):
    return {"error": error, "time": time, "status": status, "duration": 5.0}


def test_a_run_that_would_take_too_long_is_not_made():
    assert too_long([], 4, 2.0) == too_long([point(1, 0.39)], 4, 2.0) == too_long([point(1, None, "diverged")], 4, 2.0) == ""
    assert "5.0 s, the limit is 4 s" in too_long([point(1, 0.5)], 4, 2.0)
    assert "did not end" in too_long([point(numpy.nan, numpy.nan, "timeout")], 4, 2.0)


def test_finer_values_of_no_use():
    assert of_no_use([point(1, 1), point(1, 2), point(2, 4)], [], 0.0).startswith("finer values")
    behind = [point(1, 10), point(0.1, 20), point(0.01, 40)]
    assert "40.0 times the front" in of_no_use(behind, [point(0.01, 1), *behind], 0.0)
    assert of_no_use([point(1, 10), point(0.1, 20), point(0.01, 1.5)], behind, 0.0) == ""
    assert of_no_use([point(1, 1), point(1, 2, "diverged"), point(1, 3)], [], 0.0) == ""
    better = [point(1.0, 1), point(0.1, 2), point(0.01, 4)]
    assert of_no_use(better, better, 0.0) == "" and "the least that is asked for" in of_no_use(better, better, 0.01)


def test_settings_are_read_and_refused(tmp_path):
    listed = read_list()
    assert list(listed) == ["simbody", "mujoco", "ode", "bullet", "dart", "ida"] and all(len(one) > 5 for one in listed.values())
    assert all(one[0].options == () for one in listed.values())  # an engine's own values are always there
    assert listed["ode"][1].words(2.5e-3) == ("--setting", "erp=1", "cfm=1e-14", "step=0.0025")
    for text, what in (("[{over: iterations}]", "iterations.*one of step, accuracy"), ("[{over: step, option: {}}]", "option is unknown"),
                       ("[{over: step}, {over: step}]", "settings must differ")):
        (tmp_path / "s.yaml").write_text(f"values: {{step: [1.0e-2], accuracy: []}}\nengines: {{able: {text}}}")
        with pytest.raises(StudyError, match=what):
            read_list(tmp_path / "s.yaml")
    (tmp_path / "s.yaml").write_text("values: {step: [1.0e-3, 1.0e-2], accuracy: []}\nengines: {}")
    with pytest.raises(StudyError, match="the coarsest must be the first"):
        read_list(tmp_path / "s.yaml")


def test_programs_that_are_not_built_are_said_so(tmp_path, monkeypatch):
    monkeypatch.setattr(plan, "ROOT", tmp_path)
    assert set(plan.unavailable().values()) == {"its program is not built: study/setup --engines"}
    (tmp_path / "build/study/engines").mkdir(parents=True)
    (tmp_path / "build/study/engines/engines.json").write_text('{"ode": "", "bullet": "libbullet-dev is not installed"}')
    found = plan.unavailable()
    assert found["ode"] == "" and found["bullet"] == "libbullet-dev is not installed" and "not built" in found["mujoco"]


def test_the_motion_of_andrews_mechanism():
    times = numpy.array([0.0, 0.015, andrews.DURATION_S])
    found = andrews.positions(times)
    known = andrews_end()  # published to 14 digits
    ends = numpy.array([[known[f"{point}.{axis}"] for axis in "xy"] for point in "EPSU"])
    assert numpy.abs(found[:, :, 2] - ends).max() < 2e-11
    e, p, s, u = found.transpose(0, 2, 1)
    for one, other, length in ((e, 0, 7e-3), (p, e, 28e-3), (s, p, 20e-3), (u, p, 20e-3)):
        assert numpy.allclose(numpy.linalg.norm(one - other, axis=1), length, rtol=0, atol=1e-14)


def program(engine):
    return ROOT / "build" / plan.PROGRAMS / f"engine_{engine}"


REAL = [one for found in read_list().values() for one in found if program(one.engine).exists()]


@pytest.mark.parametrize("engine", sorted({one.engine for one in REAL}))
def test_every_setting_means_something_to_its_program(engine):
    for setting in read_list()[engine]:
        done = subprocess.run([program(engine), "--loops", "1", "--duration", "0.05", *setting.words(setting.values[2]),
                               "--json"], capture_output=True, text=True)
        output = json.loads(done.stdout)
        assert output["engine"] == engine and output["status"] in ("ok", "degraded", "diverged"), output
        cell = plan.Cell("", program=f"{plan.PROGRAMS}/engine_{engine}", role=ENGINE, settings=setting.words(setting.values[2])).settled()
        found = row(Record("four-bar-1/engine/x", cell.document(), "done", "", 0.1, [], {}, output))
        assert found["value"] == setting.values[2] and found["time"] > 0


@pytest.mark.parametrize("engine", sorted({one.engine for one in REAL}))
def test_programs_refuse_bad_input(engine):
    over = read_list()[engine][0].over
    bad = [(["--loops", "0"], "--loops"), (["--loops", "1", "--setting", "stp=1"], "stp means nothing"),
           (["--loops", "1", "--setting", f"{over}=fast"], "must be a number"), (["--loops", "1", "--pendulum"], "excludes"), ([], "is required")]
    solver = [(["--scene", "none.json"], "none.json"), (["--scene", "harness/scenes/problems/a04_bricard.json"], "three dimensions"),
              (["--scene", "harness/scenes/problems/half_car.json"], "drivers"), (["--scene", "x", "--pendulum"], "excludes")]
    for words, what in bad + (solver if engine in SOLVERS else [(["--scene", "x"], "--scene")]):
        done = subprocess.run([program(engine), *words], capture_output=True, text=True, cwd=ROOT)
        assert done.returncode == 2 and what in done.stderr and done.stderr.count("\n") == 1


def error(name, form, accuracy):
    """Of a run of IDA; its program reads scenes relative to the repository."""
    subject = plan.subject_of(name)
    words = (*map(str, subject.words), "--duration", f"{subject.duration:g}", "--setting", f"form={form}", f"accuracy={accuracy}", "--json")
    done = subprocess.run([program("ida"), *words], capture_output=True, text=True, cwd=ROOT)
    output = json.loads(done.stdout)
    assert output["status"] in ("ok", "degraded"), output
    return subject.error(SimpleNamespace(output=output, series={}), True)


@pytest.mark.skipif(not program("ida").exists(), reason="engine_ida is not built")
@pytest.mark.parametrize("form", ["ggl", "baumgarte"])
@pytest.mark.parametrize("name, least", [("four-bar-4-regular", 1e-6), ("double-pendulum", 1e-5), ("andrews", 1e-6)])
def test_the_error_of_ida_falls_with_its_accuracy(name, form, least):
    errors = [error(name, form, accuracy) for accuracy in ("1e-3", "1e-5", "1e-8")]
    assert errors[0] > 10 * errors[1] > 100 * errors[2] and errors[2] < least, errors
