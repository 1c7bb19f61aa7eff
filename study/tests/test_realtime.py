# study/realtime: the search for the largest scene, refusals, and a tiny run on the real program.
import math
import tempfile

import pandas
import pytest

from analysis.realtime.figure import answer
from analysis.realtime.report import render
from study.pipeline import runs
from study.pipeline.contenders import Contender
from study.pipeline.errors import StudyError
from study.pipeline.layout import Layout, read_json
from study.realtime_study import search
from study.realtime_study.main import realtime
from study.tests.conftest import ROOT

CASE = search.Case(Contender("one/a", "one/a"), "penalty", 1e-3)


def record(misses, status="ok"):
    return {"command": ["mbs", "simulate"], "summary": {
        "status": status, "status_reason": "because", "steps": 2000,
        "step_us": {"deadline_misses": 2000}, "least_us": {"deadline_misses": misses}}}


def search_with(monkeypatch, tmp_path, answer):
    """The row, and [(loops, repeats)] that were asked; `answer(loops, repeats)` is a record."""
    layout, asked = Layout(tmp_path), []

    def simulate(case, loops, layout, contexts, duration, repeats):
        asked.append((loops, repeats))
        return answer(loops, repeats), tmp_path / f"{loops}.json"
    monkeypatch.setattr(search, "simulate", simulate)
    return search.largest(CASE, layout, {}, lambda text: None), asked


@pytest.mark.parametrize("limit", [1, 2, 7, 40, 333, 4000])
def test_the_search_ends_within_a_fifth_below_the_limit(monkeypatch, tmp_path, limit):
    row, asked = search_with(monkeypatch, tmp_path, lambda n, _: record(0 if n <= limit else 100))
    assert row["largest"] <= limit < row["next"] <= max(row["largest"] + 1, 1.19 * row["largest"] + 1)
    assert row["next_reason"] == "5 % of the steps miss the deadline" and row["confirmed"]
    assert len(asked) == len(set(asked)) < 22
    assert {n for n, repeats in asked if repeats == search.AGAIN} == {row["largest"], row["next"]}


def test_nothing_fits_and_everything_fits(monkeypatch, tmp_path):
    row, asked = search_with(monkeypatch, tmp_path, lambda *_: record(2000))
    assert row["largest"] == 0 and row["next"] == 1 and row["confirmed"] and len(asked) == 2
    assert answer(pandas.Series(row)) == "0"
    row, _ = search_with(monkeypatch, tmp_path, lambda *_: record(0))
    assert row["largest"] == search.MOST and row["next"] is None and row["confirmed"]
    assert answer(pandas.Series(row | {"next": math.nan})) == "8000 or more (end of the search)"


@pytest.mark.parametrize("interrupted", [1, 2, 20, 64, 70])
def test_a_size_that_was_only_interrupted_does_not_end_the_search(monkeypatch, tmp_path, interrupted):
    row, _ = search_with(monkeypatch, tmp_path, lambda n, repeats: record(
        100 if n > 80 or (n >= interrupted and repeats < search.AGAIN and n < interrupted + 9) else 0))
    assert 66 <= row["largest"] <= 80 < row["next"] and row["confirmed"]


def test_a_largest_size_that_is_late_the_second_time_is_not_confirmed(monkeypatch, tmp_path):
    row, _ = search_with(monkeypatch, tmp_path, lambda n, repeats: record(
        3 if n > 30 or repeats == search.AGAIN else 0, "degraded" if n > 20 else "ok"))
    assert 25 <= row["largest"] <= 30 and not row["confirmed"] and row["deadline_misses"] == 0
    assert answer(pandas.Series(row)) == f"{row['largest']} (degraded; not confirmed)"


def test_a_run_that_loses_the_motion_does_not_fit(monkeypatch, tmp_path):
    row, _ = search_with(monkeypatch, tmp_path,
                         lambda n, _: record(0, "ok" if n < 30 else "diverged"))
    assert row["largest"] < 30 and row["next_reason"] == "diverged: because"
    assert answer(pandas.Series(row)) == f"{row['largest']} (diverged above)"


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
    words = ["--only", "csc_klu/refactor", "--loops", "2", "--steps", "2e-3", "--duration", "0.5",
             "--results", str(tmp_path)]
    realtime(words)
    steps, largest = (pandas.read_csv(tmp_path / f"{name}.csv") for name in ("steps", "largest"))
    assert list(steps.scheme) == ["penalty", "saddle-point"] == list(largest.scheme)
    assert set(steps.status) <= set(runs.FINISHED) and (steps.deadline_us == 2e3).all()
    page = (tmp_path / "realtime.html").read_text()
    assert "4 or more (end of the search)" in page and largest.confirmed.all()
    assert "csc_klu/refactor" in page and (tmp_path / "figures" / "largest.png").exists()
    assert len(list((tmp_path / "raw").rglob("*-4-*-again.json"))) == 2
    taken = {path: path.stat().st_mtime_ns for path in (tmp_path / "raw").rglob("*.json")}
    realtime(words)  # all of it is kept
    assert taken == {path: path.stat().st_mtime_ns for path in (tmp_path / "raw").rglob("*.json")}
    assert (tmp_path / "realtime.html").read_text() == page
    realtime([*words, "--stored"])
    assert (tmp_path / "realtime.html").read_text() == page
    _told_what_judging_costs(steps, largest, read_json(tmp_path / "run.json"))


def _told_what_judging_costs(steps, largest, run):
    figures = {"steps": "", "largest": ""}
    text = render(steps.assign(judge_us=0.2, observed_mean_us=0.4), largest, run, figures)
    assert "at most\n50 %, 0.2 µs a step beside 0.4 µs" in text and "judging takes longer" not in text
    text = render(steps.assign(judge_us=0.6, observed_mean_us=0.4), largest, run, figures)
    assert "150 %" in text and "n = 6): judging takes longer than such a step." in text
    large = steps.assign(loops=40, judge_us=0.01, observed_mean_us=1.0, steps=20000)
    short = largest.assign(largest=80, judge_us=0.12, observed_mean_us=1.0, steps=2000)
    text = render(large, short, run, figures)
    assert ("of 0.5 s, at most\n<span class=\"good\">1.00 % of a step</span> (csc_klu/refactor, penalty, "
            "n = 82, 20000 steps)") in text
    assert '<span class="bad">12.00 % of a step</span> (csc_klu/refactor, penalty, n = 162, 2000 steps)' in text
