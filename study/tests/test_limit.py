# study/limit: what is counted and refused, and a tiny run on the real program.
import tempfile

import pandas
import pytest

from study.limit_study import instructions, measure
from study.limit_study.main import limit
from study.pipeline.contenders import Contender
from study.pipeline.layout import Layout, write_json
from study.tests.conftest import ROOT

ONE = Contender("one/a", "one/a")


def bench_row(step_us):
    return {"step_us": step_us, "passes": 80, "steps": 40} | {
        f"phase_{phase}": 0.5 if phase == "solve" else 0.1 for phase in measure.PHASES}


def test_figures_are_medians_and_phases_add_up():
    found = measure._figures([bench_row(time) for time in (3.0, 1.0, 2.0)])
    assert (found["step_us"], found["low_us"], found["high_us"]) == (2.0, 1.0, 3.0)
    assert found["passes"] == 2.0 and found["rounds"] == 3
    assert sum(found[f"{phase}_us"] for phase in measure.PHASES) == pytest.approx(2.0)
    assert found["solve_us"] == pytest.approx(1.0)


def test_what_the_gate_rejects_is_not_timed(tmp_path):
    write_json(tmp_path / "raw" / "n22" / "one.a-gate.json",
               {"rows": [{"verdict": "disagrees", "reason": "lock-step"}]})
    rows = measure.size(Layout(tmp_path), [ONE], 10, 1, 1.0, lambda text: None)
    assert rows == [{"implementation": "one/a", "loops": 10, "variables": 22,
                     "status": "disagrees", "reason": "disagrees: lock-step"}]


def test_a_cell_that_fails_keeps_its_row_with_the_reason(tmp_path):
    folder = tmp_path / "raw" / "n22"
    write_json(folder / "one.a-gate.json", {"rows": [{"verdict": "agrees", "reason": ""}]})
    write_json(folder / "one.a-1.json", {"found": {"benchmarks": [bench_row(1.0)]}})
    write_json(folder / "one.a-2.json", {"failure": "did not end within 1 s"})
    row, = measure.size(Layout(tmp_path), [ONE], 10, 3, 1.0, lambda text: None)
    assert (row["status"], row["reason"]) == ("failed", "did not end within 1 s")
    assert "step_us" not in row


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
    with pytest.raises(SystemExit) as refused:
        limit(words)
    assert refused.value.code == 2


def test_a_tiny_study_on_the_real_program(tmp_path, monkeypatch):
    if not (ROOT / "build" / "mbs").exists():
        pytest.skip("build/mbs is not built")
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv("MBS_PROGRAM", str(ROOT / "build" / "mbs"))
    words = ["--only", "csc_klu/refactor", "--loops", "1", "2", "--rounds", "1", "--results",
             str(tmp_path)]
    limit(words)
    steps, bounds = (pandas.read_csv(tmp_path / f"{name}.csv") for name in ("steps", "bounds"))
    assert list(steps.implementation) == ["limit/limit", "csc_klu/refactor"] * 2
    assert (steps.status == "ok").all() and (bounds.bound_ns > 0).all()
    page = (tmp_path / "limit.html").read_text()
    assert "csc_klu/refactor" in page and (tmp_path / "figures" / "by_phase.png").exists()
    limit([*words, "--stored"])
    assert (tmp_path / "limit.html").read_text() == page
