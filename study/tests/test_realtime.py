# study/realtime: the search for the largest scene, refusals, and a tiny run on the real program.
import tempfile

import pandas
import pytest

from study.pipeline import runs
from study.pipeline.contenders import Contender
from study.pipeline.errors import StudyError
from study.pipeline.layout import Layout
from study.realtime_study import search
from study.realtime_study.main import realtime
from study.tests.conftest import ROOT

CASE = search.Case(Contender("one/a", "one/a"), "penalty", 1e-3)


def record(misses, status="ok"):
    return {"command": ["mbs", "simulate"], "summary": {
        "status": status, "status_reason": "because", "steps": 2000,
        "step_us": {"deadline_misses": 2000}, "least_us": {"deadline_misses": misses}}}


def search_with(monkeypatch, tmp_path, answer):
    layout, asked = Layout(tmp_path), []

    def simulate(case, loops, *_):
        asked.append(loops)
        return answer(loops), tmp_path / f"{loops}.json"
    monkeypatch.setattr(search, "simulate", simulate)
    return search.largest(CASE, layout, {}, lambda text: None), asked


@pytest.mark.parametrize("limit", [1, 2, 7, 40, 333, 4000])
def test_the_search_ends_within_a_fifth_below_the_limit(monkeypatch, tmp_path, limit):
    row, asked = search_with(monkeypatch, tmp_path, lambda n: record(0 if n <= limit else 100))
    assert row["largest"] <= limit < row["next"] <= max(row["largest"] + 1, 1.19 * row["largest"] + 1)
    assert row["next_reason"] == "5 % of the steps miss the deadline"
    assert len(asked) == len(set(asked)) < 20


def test_nothing_fits_and_everything_fits(monkeypatch, tmp_path):
    row, _ = search_with(monkeypatch, tmp_path, lambda n: record(2000))
    assert row["largest"] == 0 and row["next"] == 1
    row, _ = search_with(monkeypatch, tmp_path, lambda n: record(0))
    assert row["largest"] == search.MOST and row["next"] is None


def test_a_run_that_loses_the_motion_does_not_fit(monkeypatch, tmp_path):
    row, _ = search_with(monkeypatch, tmp_path,
                         lambda n: record(0, "ok" if n < 30 else "diverged"))
    assert row["largest"] < 30 and row["next_reason"] == "diverged: because"


def test_two_misses_in_two_thousand_steps_are_allowed():
    assert search.in_real_time(record(2)) == (True, "")
    assert not search.in_real_time(record(3))[0]


@pytest.mark.parametrize("words", [["--steps", "0"], ["--loops", "0"], ["--loops", "x"], ["--steps", "inf"]])
def test_what_is_refused(words):
    with pytest.raises(StudyError, match=rf"argument {words[0]}: {words[1]} is not a"):
        realtime(words)


def test_a_tiny_study_on_the_real_program(tmp_path, monkeypatch):
    if not (ROOT / "build" / "mbs").exists():
        pytest.skip("build/mbs is not built")
    monkeypatch.setattr(search, "MOST", 4)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv("MBS_PROGRAM", str(ROOT / "build" / "mbs"))
    words = ["--only", "csc_klu/refactor", "--loops", "2", "--steps", "1e-2", "--duration", "0.5",
             "--results", str(tmp_path)]
    realtime(words)
    steps, largest = (pandas.read_csv(tmp_path / f"{name}.csv") for name in ("steps", "largest"))
    assert list(steps.scheme) == ["penalty", "saddle-point"] == list(largest.scheme)
    assert set(steps.status) <= set(runs.FINISHED) and (steps.deadline_us == 1e4).all()
    page = (tmp_path / "realtime.html").read_text()
    assert "csc_klu/refactor" in page and (tmp_path / "figures" / "largest.png").exists()
    taken = {path: path.stat().st_mtime_ns for path in (tmp_path / "raw").rglob("*.json")}
    realtime(words)  # all of it is kept
    assert taken == {path: path.stat().st_mtime_ns for path in (tmp_path / "raw").rglob("*.json")}
    assert (tmp_path / "realtime.html").read_text() == page
    realtime([*words, "--stored"])
    assert (tmp_path / "realtime.html").read_text() == page
