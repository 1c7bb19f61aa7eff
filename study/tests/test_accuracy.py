# study/accuracy: what is run, left out and refused, on the fake program; a curve on the real one.
import os
import shutil
import tempfile
from types import SimpleNamespace

import numpy
import pandas
import pytest

from study.accuracy_study import (bench, classes, fills, gate, largest, pairs, regions, rounds, settings, subjects,
                                  work)
from study.accuracy_study.main import accuracy
from study.pipeline.contenders import Contender
from study.pipeline.errors import StudyError
from study.pipeline.layout import Layout, read_json
from study.scene_study import mechanics, problems
from study.tests.conftest import FAKE, ROOT, study

PROGRAM = os.environ.get("MBS_PROGRAM", str(ROOT / "build" / "mbs"))
STEPS = (1e-2, 5e-3, 2.5e-3)
BOTH = ("good_dense/first", "good_sparse/only")
CHOICE = ("--loops", "30", "--problems", "none", "--only", *BOTH, "--parts", "work")


@pytest.fixture
def fake(tmp_path, monkeypatch):
    monkeypatch.setenv("MBS_PROGRAM", str(FAKE))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(subjects, "STEPS", STEPS)
    return bench.Bench(Layout(tmp_path / "results"), {"own|system": {}}, 4.0)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Results of study/accuracy on the fake program, N = 30, three steps, which `run` copies."""
    folder = tmp_path_factory.mktemp("accuracy")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MBS_PROGRAM", str(FAKE))
        patch.setattr(tempfile, "tempdir", str(folder))
        patch.setattr(subjects, "STEPS", STEPS)
        accuracy([*CHOICE, "--results", str(folder / "results")])
    return folder / "results"


@pytest.fixture
def run(whole, fake, tmp_path):
    shutil.copytree(whole, tmp_path / "results")
    return lambda *more: accuracy([*CHOICE, "--results", str(tmp_path / "results"), *more])


def table(folder, name):
    return pandas.read_csv(folder / "results" / f"{name}.csv")


def test_every_setting_that_is_served_has_its_rows(run, tmp_path):
    rows, listed = table(tmp_path, "work"), [one.name for one in settings.read_list()]
    universal = ["default", "paper", "loose", "velocity", "unprojected"]
    assert set(rows[rows.implementation == BOTH[0]].setting) == {*universal, "single", "saddle"} <= {*listed}
    assert set(rows[rows.implementation == BOTH[1]].setting) == {*universal}
    done = rows[rows.status == "ok"]
    assert numpy.allclose(done.time, 1e-6 * done.step_us / done.step, rtol=1e-2) and rows.front.any()
    assert numpy.allclose(done.error, 1e-3 * (done.step / 1.25e-3)**2)
    lost = rows[rows.setting == "paper"]
    assert set(lost.status) == {"diverged"} and (lost.status_reason == "NaN in q").all()
    page = (tmp_path / "results" / "accuracy.html").read_text()
    assert "6 diverged" in page and "2 agree, but are less accurate" in page
    for row in rows[rows.raw_file.notna()].itertuples():
        assert row.command.split()[1:] == read_json(tmp_path / "results" / row.raw_file)["command"][1:]


def test_what_is_stored_is_never_run_again_and_can_be_drawn_again(run, tmp_path):
    results = tmp_path / "results"
    before = {path: path.stat().st_mtime_ns for path in results.rglob("raw/**/*.json")}
    content = (results / "work.csv").read_bytes()
    next(path for path in before if "work" in path.parts).unlink()
    run()
    assert sum(path.stat().st_mtime_ns != time for path, time in before.items()) == 1
    assert (results / "work.csv").read_bytes() == content
    drawn = [*results.glob("figures/*"), results / "accuracy.html"]
    before = [path.read_bytes() for path in drawn]
    shutil.rmtree(results / "raw")
    run("--stored")
    assert len(drawn) == 3 and before == [path.read_bytes() for path in drawn]
    assert not list(results.rglob("*.partial"))
    with pytest.raises(StudyError, match=r"holds results of something else \(inputs\)"):
        run("--duration", "2")


def admitted(refused=(), **served):
    names = {"good_dense/first": True, "good_sparse/only": False}
    return settings.Entries({name: Contender(name, name) for name in names}, names,
                            {name: [settings.Setting(one) for one in served.get(name.split("_")[1][:5], (
                                "default",))] for name in names}, dict(refused))


def test_the_regions_and_the_pairs_on_the_fake_program(fake, monkeypatch):
    monkeypatch.setattr(regions, "FILLS", (1.0,))
    monkeypatch.setattr(pairs, "ROUNDS", 2)
    entries = admitted()
    assert all(row["same"] for row in fills.check(fake, entries, print))
    curves = work.measure(fake, subjects.chain(30, 1.0), entries, print)
    found = regions.measure(fake, curves, entries, (30,), print)
    assert set(found.required) == {1e-1, 1e-2}  # the smallest error of three steps is 4e-3
    assert set(found[found.required == 1e-2].step) == {3.33333e-3} and set(found.step) == {1e-2, 3.33333e-3}
    assert found.fill_asked.isna().sum() == 4 and (found.fill_asked == 1).sum() == 4
    pruned = found[found.reason != ""]
    done = found[found.reason == ""]
    assert len(pruned) and pruned.time.isna().all() and set(done["rounds"]) <= {1, 3, 7}
    for _, cell in done.groupby(["required", done.fill_asked.fillna(0)]):
        first, second = cell.sort_values("time").iloc[[0, -1]].itertuples()
        assert first.rounds == second.rounds == 7 and len(first.times.split()) == 7
    entries.settings["good_dense/first"].append(settings.Setting("saddle", (("scheme", "saddle-point"),)))
    [form] = pairs.measure(fake, entries, "forms", pairs.FORMS, (10,), print).to_dict("records")
    assert form["implementation"] == "good_dense/first" and form["ratio"] == pytest.approx(1.1)
    assert form["first_class"] == 1e-3 and form["first_status"] == form["second_status"] == "ok"


def test_what_is_lost_over_a_second_has_no_ratio_and_no_class(fake, monkeypatch):
    monkeypatch.setattr(pairs, "ROUNDS", 2)
    monkeypatch.setattr(pairs, "DURATIONS", (0.2,))  # the fake's single precision is lost at 0.5 s, N = 20
    entries = admitted()
    entries.settings["good_dense/first"].append(settings.Setting("single", (("precision", "single"),)))
    lost, kept = pairs.measure(fake, entries, "precision", pairs.PRECISIONS, (20, 10), print).to_dict("records")
    assert lost["reason"] == "single: diverged: NaN in q" and numpy.isnan(lost["ratio"])
    assert kept["reason"] == "" and kept["duration"] == 0.2 and kept["second_class"] == 1e-3
    assert "/classes/" in kept["second_error_raw_file"]
    monkeypatch.setattr(classes, "SECONDS", 0.0)
    [long] = pairs.measure(fake, entries, "precision", pairs.PRECISIONS, (30,), print).to_dict("records")
    assert long["ratio"] > 0 and long["first_class"] is None and "would take" in long["first_class_reason"]


def test_a_borrowed_class_is_judged_over_a_second(fake):
    cell = {"implementation": "good_dense/first", "setting": "default", "step": 5e-3, "required": 1e-2,
            "error_of": "good_sparse/only", "predicted": 1.0, "duration": 0.2, "reason": ""}
    entries = admitted()

    def judged(loops, **more):
        found = cell | more
        rounds._judge(fake, subjects.chain(loops, 5.0), entries, found)
        return found
    assert judged(10)["error"] == pytest.approx(1.6e-2) and "its own error over 1 s" in judged(10)["reason"]
    assert judged(10, required=1e-1)["reason"] == "" and judged(10, required=1e-1)["class_from"] == "1 s"
    assert "not known: 1 s would take 30 s" in judged(10, predicted=30.0)["reason"]
    assert judged(10, duration=1.0)["class_from"] == "the timed run"
    assert judged(10, error_of=cell["implementation"])["class_from"] == "5 s"
    entries.settings["good_dense/first"] = [settings.Setting("default", (("precision", "single"),))]
    assert judged(20)["reason"] == "over 1 s: diverged: NaN in q"


def test_between_the_steps_that_bracket_a_required_error_another_is_run(fake):
    curves = work.measure(fake, subjects.chain(30, 1.0), admitted(), print)
    between = curves[~curves.step.isin(STEPS)]
    # The fake's errors: 6.4e-2, 1.6e-2 and 4e-3; 3.33 ms meets 1e-2, too. Nobody is at 1e-3.
    assert set(between.step) == {3.33333e-3} and (between.error < 1e-2).all()
    assert largest.largest_steps(curves, admitted())["good_sparse/only", "default"][1e-2].step == 3.33333e-3


def test_short_runs_are_repeated_and_long_ones_are_not(fake, monkeypatch):
    contender, default = admitted().contenders["good_sparse/only"], settings.Setting("default")
    once = fake.run("work", subjects.chain(2, 1.0), contender, default, 5e-3)
    least = fake.steady("work", subjects.chain(2, 1.0), contender, default, 5e-3)
    assert least["summary"]["repeats"] == bench.REPEATS and least["raw_file"] != once["raw_file"]
    assert bench.time_of(least) == pytest.approx(0.9 * bench.time_of(once))
    assert bench.row(subjects.chain(2, 1.0), "x", default, 5e-3, least)["repeats"] == bench.REPEATS
    monkeypatch.setattr(bench, "SHORT", 0.0)
    assert fake.steady("work", subjects.chain(2, 1.0), contender, default, 5e-3) == once


def test_the_largest_step_that_meets_an_error_is_borrowed_where_there_is_no_curve():
    def one(name, step, error):
        return {"implementation": name, "setting": "default", "step": step, "error": error,
                "status": "ok"}
    rows = pandas.DataFrame([one("good_sparse/only", 1e-2, 5e-2), one("good_sparse/only", 5e-3, 9e-3),
                             one("good_sparse/only", 2.5e-3, 2e-2)])
    found = largest.largest_steps(rows, admitted())
    assert {key: {error: row.step for error, row in steps.items()} for key, steps in found.items()} == {
        (name, "default"): {1e-1: 1e-2, 1e-2: 5e-3} for name in BOTH}
    cut = pandas.concat([rows, pandas.DataFrame([one("good_dense/first", 1e-2, 2e-1)])])
    found = largest.largest_steps(cut, admitted())["good_dense/first", "default"]
    assert {error: (row.step, row.implementation) for error, row in found.items()} == {
        1e-1: (5e-3, "good_sparse/only"), 1e-2: (5e-3, "good_sparse/only")}  # its own 1e-2 s is not enough
    refused = {("good_dense/first", "default"): "why"}
    between = pandas.concat([rows, *(pandas.DataFrame([one("good_dense/first", step, error)])
                                     for step, error in ((1e-2, 2e-2), (5e-3, 1e-3), (2.5e-3, 1e-4)))])
    between.loc[len(between)] = one("good_sparse/only", 6.67e-3, 9e-3)
    found = largest.largest_steps(between.reset_index(drop=True), admitted())["good_dense/first", "default"]
    assert (found[1e-2].step, found[1e-2].implementation) == (6.67e-3, "good_sparse/only")
    assert (found[1e-3].step, found[1e-1].step) == (5e-3, 1e-2)
    assert list(largest.largest_steps(rows, admitted(refused))) == [("good_sparse/only", "default")]


def curve(fake, monkeypatch, errors, seconds=0.01, status="ok", known=()):
    """work._curve over `errors`, of runs that take `seconds` and twice that from step to step."""
    subject, steps = subjects.chain(2, 1.0), iter(range(99))

    monkeypatch.setattr(bench, "SHORT", 0.0)
    numbers = {}

    def simulated(_, kind, subject, contender, setting, step, **more):
        number = numbers[step] = numbers[step] if step in numbers else next(steps)
        record = {"seconds": seconds * 2**number, "command": ["mbs"], "raw_file": "x"}
        if status == "timeout":
            return record | {"failure": {"status": "timeout", "reason": "did not end"}}
        return record | {"summary": {
            "status": "ok", "status_reason": "", "steps": round(1 / step), "duration": 1.0, "variables": 6,
            "passes_per_step": 2.0,
            "position_error_max": errors[number], "step_us": {"mean": 1.0, "median": 1.0}}}
    monkeypatch.setattr(bench.Bench, "run", simulated)
    return work._curve(fake, subject, "good_sparse/only", settings.Setting("default"), admitted(), known)


def test_a_curve_ends_where_it_would_take_too_long_or_rounding_has_won(fake, monkeypatch):
    monkeypatch.setattr(subjects, "STEPS", tuple(1e-2 / 2**k for k in range(6)))
    assert [row["status"] for row in curve(fake, monkeypatch, [1, .1, .01, 1e-3, 1e-4, 1e-5])] == ["ok"] * 6
    slow = curve(fake, monkeypatch, [1, .1, .01, 1e-3], seconds=1)
    assert [row["status"] for row in slow] == ["ok"] * 3 + ["not-run"] * 3
    assert slow[3]["status_reason"] == "predicted to take 8.0 s, the limit is 4 s"
    worse = curve(fake, monkeypatch, [1, .1, .2, .3, .4, .5])
    assert [row["status"] for row in worse] == ["ok"] * 4 + ["not-run"] * 2
    assert "do not make the error smaller" in worse[4]["status_reason"]
    far = curve(fake, monkeypatch, [1, .1, .01, 1e-3], known=[
        {"time": 0.25e-4 * 2**k, "error": 10.0**-k} for k in range(3)])
    assert [row["status"] for row in far] == ["ok"] * 3 + ["not-run"] * 3
    assert far[3]["status_reason"].startswith("takes 4.0 times the front's time")
    nearer = curve(fake, monkeypatch, [1, .1, .01, 1e-3, 1e-4, 1e-5], known=[
        {"time": 0.25e-4 * 4**k, "error": 10.0**-k} for k in range(2)])
    assert [row["status"] for row in nearer] == ["ok"] * 6
    dead = curve(fake, monkeypatch, [], status="timeout")
    assert [row["status"] for row in dead] == ["timeout"] + ["not-run"] * 5
    assert dead[1]["status_reason"] == "the run at twice the step did not end"


def test_no_error_is_shown_below_the_reference_s_own(fake, monkeypatch):
    own = subjects.chain(2, 1.0).own_error
    assert 1e-16 < own < 1e-13
    rows = curve(fake, monkeypatch, [1e-20, 2 * own, 1])
    assert [(row["error"], row["at_most"]) for row in rows] == [(own, True), (2 * own, False), (1, False)]


def test_references_of_problems(fake):
    listed = {one.name: one for one in problems.read_list()[1]}
    default = settings.Setting("default")
    pendulum = subjects.problem(listed["A01"], fake, default, None)
    assert 0 < pendulum.own_error < 1e-11 and set(pendulum.known) == {"B.x", "B.y", "vB.vx", "vB.vy"}
    exact = {"t": [0.025, 0.05]} | {name: values[1:3].tolist() for name, values in pendulum.known.items()}
    assert pendulum.error({"outputs": exact}) == 0
    assert pendulum.error({"outputs": exact | {"t": [0.05, 0.075]}}) > 1e-3
    crank = subjects.problem(listed["slider-crank"], fake, default, None)
    assert 1e-13 < crank.own_error < 1e-6 and mechanics.TOLERANCE == 1e-12
    assert subjects._samples(10, 4e-3) == (25, 4) and subjects._samples(10, 3.1e-3) == ()


def test_the_gate_tells_who_disagrees_from_who_is_inaccurate(fake, monkeypatch):
    monkeypatch.setenv("FAKE_BAD", "1")
    group = [Contender(name, name) for name in ("good_sparse/only", "bad/wrong")]
    rows = gate.check(fake, settings.Setting("default"), group)
    assert gate.refused(rows) == {("bad/wrong", "default"):
                                  "gate, four-bar:10: lock-step: q differs by 0.4 m"}
    loose = gate.check(fake, settings.Setting("loose", (("tolerance", "1e-6"),)), group)
    assert set(gate.refused(loose)) == {("bad/wrong", "loose")} and loose[0]["only_inaccurate"]
    assert "--tolerance 1e-6" in loose[0]["command"]


def test_pairs_alone(run, tmp_path, monkeypatch):
    monkeypatch.setattr(pairs, "ROUNDS", 2)
    run("--parts", "pairs")
    assert len(table(tmp_path, "forms")) == 1 and len(table(tmp_path, "precision")) == 1
    assert "A step of the saddle-point form takes" in (tmp_path / "results" / "accuracy.html").read_text()


def test_a_check_that_dies_is_repeated_one_by_one(fake, monkeypatch):
    def killed(path, setting, group, context, final=False):
        names = [one.variant for one in group]
        if not final:
            return None
        return {"command": ["mbs"], "rows": [{"scene": "four-bar:2", "implementation": names[0],
                "verdict": "crashed", "reason": "SIGSEGV", "checks": []}]}
    monkeypatch.setattr(gate, "_run", killed)
    rows = gate.check(fake, settings.Setting("default"), [Contender(name, name) for name in BOTH])
    assert [row["implementation"] for row in rows] == [*BOTH] and not any(row["takes_part"] for row in rows)


def test_slow_implementations_are_not_tried_in_other_settings():
    rows = pandas.DataFrame([{"implementation": name, "step": 1e-2, "time": time, "status": "ok",
                              "error": 1e-3} for name, time in (("a", 1.0), ("b", 2.5), ("c", 9.0))])
    entries = SimpleNamespace(dense={"a": False, "b": False, "c": True, "d": True},
                              settings={"a": [1], "b": [1], "c": [1], "d": [1]})
    found = work._slow(pandas.concat([rows, pandas.DataFrame([{"implementation": "d", "status": "timeout"}])]),
                       entries)
    assert found == {"b": "its default setting takes at least 2.5 times the fastest's time",
                     "d": "its default setting finished no run"}
    entries.settings["b"] = [1, 2]
    assert "b" not in work._slow(rows, entries)


def test_settings_are_read_and_refused(tmp_path):
    [default, *others] = settings.read_list()
    assert default.words() == [] and {"saddle kept", "rattle6", "mixed"} <= {one.name for one in others}
    loose = next(one for one in others if one.name == "loose")
    assert loose.words((("tolerance", "1e-13"), ("penalty", "auto"))) == [
        "--tolerance", "1e-6", "--penalty", "auto"]
    assert settings.Setting("g", (("geometric-stiffness", True),)).words() == ["--geometric-stiffness"]
    for text, what in (("[{name: a, option: {}}]", "no more"), ("[{name: a}, {name: a}]", "must differ"),
                       ("[{name: a, needs: [mixed]}]", "first setting must be the default")):
        (tmp_path / "settings.yaml").write_text(f"settings: {text}")
        with pytest.raises(StudyError, match=what):
            settings.read_list(tmp_path / "settings.yaml")


@pytest.mark.parametrize("arguments, what", [
    (["--loops", "0"], "0 is not a number of loops"), (["--duration", "-1"], "-1 is not a positive number"),
    (["--parts", "all"], "invalid choice: 'all'"), (["--problems", "A99"], "unknown problem 'A99'; known: A01"),
    (["--problems", "A02"], "A02 is an N-four-bar"), (["--stored"], "holds no results"),
    (["--only", "nobody"], "unknown implementation 'nobody'")])
def test_what_is_wrong_is_said_in_a_line(tmp_path, arguments, what):
    done = study("accuracy", "--results", tmp_path, *arguments)
    assert done.returncode == 2 and what in done.stderr and "Traceback" not in done.stderr
    assert not list(tmp_path.glob("*.json")) and not list(tmp_path.glob("*.csv"))


def test_the_start_says_how_long_it_may_take(tmp_path):
    done = study("accuracy", "--dry-run", "--loops", "2", "--results", tmp_path)
    assert done.returncode == 0 and "minutes on a quiet machine" in done.stdout
    assert not list(tmp_path.iterdir())


def test_a_curve_of_the_real_program(fake, monkeypatch):
    monkeypatch.setenv("MBS_PROGRAM", PROGRAM)
    entries = settings.Entries({"csc_klu/refactor": Contender("csc_klu/refactor", "csc_klu/refactor")},
                               {"csc_klu/refactor": False},
                               {"csc_klu/refactor": settings.read_list()[:1]}, {})
    rows = work.measure(fake, subjects.chain(2, 0.2), entries, print)
    assert list(rows.status) == ["ok"] * 3 and rows.front.sum() >= 1
    ratios = rows.error.to_numpy()[:-1] / rows.error.to_numpy()[1:]
    assert ((3.5 < ratios) & (ratios < 4.5)).all()  # second order
