# Where curves of study/accuracy end, what is repeated and what is left out, on the fake program.
from types import SimpleNamespace

import pandas
import pytest

from study.accuracy_study import bench, settings, subjects, work
from study.tests.accuracy_fakes import admitted, fake  # noqa: F401 (a fixture)


def curve(fake, monkeypatch, errors, seconds=0.01, status="ok", known=(), least=0.0):
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
    return work._curve(fake, subject, "good_sparse/only", settings.Setting("default"), admitted(), known, least)


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
    enough = curve(fake, monkeypatch, [1, .1, .01, 1e-3], least=0.01)
    assert [row["status"] for row in enough] == ["ok"] * 3 + ["not-run"] * 3
    assert enough[3]["status_reason"] == "the error is below 0.01 m, the least that is asked for"
    dead = curve(fake, monkeypatch, [], status="timeout")
    assert [row["status"] for row in dead] == ["timeout"] + ["not-run"] * 5
    assert dead[1]["status_reason"] == "the run at twice the step did not end"


def test_no_error_is_shown_below_the_reference_s_own(fake, monkeypatch):
    own = subjects.chain(2, 1.0).own_error
    assert 1e-16 < own < 1e-13
    rows = curve(fake, monkeypatch, [1e-20, 2 * own, 1])
    assert [(row["error"], row["at_most"]) for row in rows] == [(own, True), (2 * own, False), (1, False)]


def test_short_runs_are_repeated_and_long_ones_are_not(fake, monkeypatch):
    contender, default = admitted().contenders["good_sparse/only"], settings.Setting("default")
    once = fake.run("work", subjects.chain(2, 1.0), contender, default, 5e-3)
    least = fake.steady("work", subjects.chain(2, 1.0), contender, default, 5e-3)
    assert least["summary"]["repeats"] == bench.REPEATS and least["raw_file"] != once["raw_file"]
    assert bench.time_of(least) == pytest.approx(0.9 * bench.time_of(once))
    assert bench.row(subjects.chain(2, 1.0), "x", default, 5e-3, least)["repeats"] == bench.REPEATS
    monkeypatch.setattr(bench, "SHORT", 0.0)
    assert fake.steady("work", subjects.chain(2, 1.0), contender, default, 5e-3) == once


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
