# study/limit: what is counted and refused, and a tiny run on the real program.
import json
import tempfile

import pandas
import pytest

from study.limit_study import instructions, lead, main, measure
from study.limit_study.main import limit
from study.pipeline.contenders import Contender, own
from study.pipeline.errors import StudyError
from study.pipeline.layout import Layout, write_json
from study.tests.conftest import ROOT

ONE = Contender("one/a", "one/a")


def bench_row(step_us):
    return {"step_us": step_us, "passes": 80, "steps": 40, "setup_us": 7.0, "memory_bytes": 9e3} | {
        f"phase_{phase}": 0.5 if phase == "solve" else 0.1 for phase in measure.PHASES}


def test_figures_are_medians_and_phases_add_up():
    found = measure._figures([bench_row(time) for time in (3.0, 1.0, 2.0)])
    assert (found["step_us"], found["low_us"], found["high_us"]) == (2.0, 1.0, 3.0)
    assert found["passes"] == 2.0 and found["rounds"] == 3
    assert sum(found[f"{phase}_us"] for phase in measure.PHASES) == pytest.approx(2.0)
    assert found["solve_us"] == pytest.approx(1.0)
    assert (found["setup_us"], found["memory_bytes"]) == (7.0, 9e3)


def test_what_the_gate_rejects_is_not_timed(tmp_path):
    write_json(tmp_path / "raw" / "n22" / "one.a-gate.json",
               {"rows": [{"verdict": "disagrees", "reason": "lock-step"}]})
    rows = measure.size(Layout(tmp_path), [ONE], 10, 1, 1.0, lambda text: None)
    assert rows == [{"implementation": "one/a", "loops": 10, "variables": 22, "scene": "four-bar:10",
                     "status": "disagrees", "reason": "disagrees: lock-step"}]


def test_a_cell_that_fails_keeps_its_row_with_the_reason(tmp_path):
    folder = tmp_path / "raw" / "n22"
    write_json(folder / "one.a-gate.json", {"rows": [{"verdict": "agrees", "reason": ""}]})
    write_json(folder / "one.a-1.json", {"found": {"benchmarks": [bench_row(1.0)]}})
    write_json(folder / "one.a-2.json", {"failure": "did not end within 1 s"})
    row, = measure.size(Layout(tmp_path), [ONE], 10, 3, 1.0, lambda text: None)
    assert (row["status"], row["reason"]) == ("failed", "did not end within 1 s")
    assert "step_us" not in row


def test_what_was_interrupted_is_run_again_and_the_calmest_counts(tmp_path, monkeypatch):
    from types import SimpleNamespace
    made = iter([2.0, 1.3, 1.5, 1.05])

    def run(*_):
        found = {"benchmarks": [bench_row(1.0) | {"real_time": 10 * next(made), "cpu_time": 10.0}]}
        return SimpleNamespace(status="exited", code=0, stdout=json.dumps(found))
    monkeypatch.setattr(measure.child, "run", run)
    assert measure.bench(Layout(tmp_path), ONE, "s", "n22/a", 1.0)[0]["real_time"] == 13.0
    assert measure.bench(Layout(tmp_path), ONE, "s", "n22/b", 1.0)[0]["real_time"] == 10.5
    assert measure.bench(Layout(tmp_path), ONE, "s", "n22/a", 1.0)[0]["real_time"] == 13.0  # stored


def test_of_batches_both_halves_count_as_wall_time():
    def unrest(cpu_time):
        row = {"real_time": 80.0, "cpu_time": cpu_time, "sets": 8, "steps": 10, "step_us": 1.0, "alone_us": 4.0}
        return measure._unrest({"found": {"benchmarks": [row]}})
    assert unrest(400.0) == 1.0 and unrest(200.0) == 2.0


def test_a_wrong_name_is_said_before_set_up(monkeypatch):
    monkeypatch.delenv("MBS_PROGRAM", raising=False)
    monkeypatch.setattr("study.pipeline.carrier.set_up", lambda layout: pytest.fail("set-up has begun"))
    with pytest.raises(StudyError, match="--only: unknown implementation 'nope'; known folders: armadillo_dense, "):
        limit(["--only", "nope"])


def test_collected_instructions():
    assert instructions.collected("==7== \n==7== Collected : 110760\n") == 110760
    for log in ("", "==7== Collected : 0\n"):
        with pytest.raises(ValueError, match="not collected"):
            instructions.collected(log)


def test_instructions_of_a_step_are_what_more_steps_take_more(tmp_path):
    path = tmp_path / "raw" / "n22" / "one.a-instructions.json"
    write_json(path, {"runs": [{"instructions": 1_000_000}, {"instructions": 1_240_000}]})
    assert instructions.count(Layout(tmp_path), ONE, 10, 1.0) == 3000.0
    write_json(path, {"runs": [{"instructions": 1_000_000}, {"failure": "crashed"}]})
    assert instructions.count(Layout(tmp_path), ONE, 10, 1.0) is None


@pytest.mark.parametrize("words", [["--loops", "0"], ["--rounds", "0"], ["--time-limit", "0"]])
def test_what_is_refused(words):
    with pytest.raises(StudyError, match=rf"argument {words[0]}: {words[1]} is not a"):
        limit(words)


def test_own_code_is_what_has_no_library():
    entries = [{"available": True, "library": library, "variants": [{"name": f"{library}/x"}]}
               for library in ("none", "KLU")]
    assert own({"implementations": [*entries, {"available": False}]}) == {"none/x"}


def test_scenes_are_all_that_users_are_given():
    found = lead.scenes()
    assert "harness/scenes/problems/a04_bricard.json" in found
    assert "harness/scenes/examples/coupler.json" in found and "four-bar:49,fill=0.5" in found
    assert all((ROOT / scene).is_file() for scene in found if scene.endswith(".json"))


def test_who_is_far_behind_at_first_is_not_timed_further(tmp_path, monkeypatch):
    """Own code is timed whatever a first run says; the fastest with a library sets the measure. Who does not
    serve the scene has no row."""
    names = {"own/x": 9.0, "own/chain": None, "one/fast": 2.0, "one/near": 2.9, "one/slow": 3.1}
    timed = []
    monkeypatch.setattr(measure, "bench", lambda layout, one, *_:
                        (bench_row(names[one.name]), "") if names[one.name] else ({}, "unsupported: no chain"))
    monkeypatch.setattr(lead, "_about", lambda scene: {"scene": scene, "dimension": 2})
    monkeypatch.setattr(measure, "cell", lambda layout, near, *_: timed.extend(near) or [])
    rows = lead.rows(Layout(tmp_path), [Contender(name, name) for name in names], {"own/x"},
                     "a.json", 1, 1.0, lambda text: None)
    assert [one.name for one in timed] == ["own/x", "one/fast", "one/near"]
    assert [(row["implementation"], row["status"], row["dimension"]) for row in rows] == [
        ("one/slow", "slower", 2)]


def test_who_failed_at_one_size_is_not_tried_at_a_larger_one(monkeypatch):
    from types import SimpleNamespace
    seen = []

    def size(layout, here, loops, *_):
        seen.append((loops, [one.name for one in here]))
        return [{"implementation": one.name, "status": "failed" if one is ONE else "ok"} for one in here]
    monkeypatch.setattr(measure, "size", size)
    options = SimpleNamespace(loops=[1, 2], rounds=1, time_limit=1.0, instructions=False)
    main._sizes(None, options, [ONE], set(), lambda text: None)
    assert seen == [(1, ["limit/limit", "one/a"]), (2, ["limit/limit"])]


def test_a_tiny_study_on_the_real_program(tmp_path, monkeypatch):
    if not (ROOT / "build" / "mbs").exists():
        pytest.skip("build/mbs is not built")
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv("MBS_PROGRAM", str(ROOT / "build" / "mbs"))
    monkeypatch.setattr(lead, "LARGE", (3,))
    monkeypatch.setattr(lead, "scenes", lambda: ["harness/scenes/double_pendulum.json"])
    words = ["--only", "csc_klu/refactor", "compiled_ldl/chains", "--loops", "1", "2", "--rounds", "1", "--results",
             str(tmp_path)]
    limit(words)
    steps, bounds = (pandas.read_csv(tmp_path / f"{name}.csv") for name in ("steps", "bounds"))
    assert list(steps.implementation) == ["limit/limit", "csc_klu/refactor", "compiled_ldl/chains"] * 2
    assert (steps.status == "ok").all() and (bounds.bound_ns > 0).all()
    growth = pandas.read_csv(tmp_path / "growth.csv")
    assert list(growth.implementation) == ["compiled_ldl/chains"] and (growth.status == "ok").all()
    scenes, batches = (pandas.read_csv(tmp_path / f"{name}.csv") for name in ("scenes", "batches"))
    assert set(scenes.status) <= {"ok", "slower"} and set(scenes.dimension) == {2}
    assert list(batches.implementation) == ["compiled_ldl/chains"] * 4 and (batches.gain > 0).all()
    assert list(batches.sets) == [64, 8] * 2
    page = (tmp_path / "limit.html").read_text()
    assert "csc_klu/refactor" in page and (tmp_path / "figures" / "by_phase.png").exists()
    limit([*words, "--stored"])
    assert (tmp_path / "limit.html").read_text() == page
