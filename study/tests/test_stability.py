# study/stability: what runs on the fake program and how it is refused; two by two cells on the real one.
import os
import shutil
import tempfile

import pandas
import pytest

from study.pipeline import runs
from study.pipeline.contenders import Contender
from study.pipeline.errors import StudyError
from study.pipeline.layout import read_json
from study.stability_study import long
from study.stability_study.main import stability
from study.tests.conftest import FAKE, ROOT, study

CELLS = ("--loops", "1", "--steps", "1.25e-3", "2.5e-3", "--penalties", "1e2", "1e3")
SERIES = [("penalty", "double"), ("saddle-point", "double"), ("penalty", "single"),
          ("saddle-point", "single")]


@pytest.fixture
def run(tmp_path, monkeypatch):
    """study/stability on the fake program, four cells and the automatic penalty factor."""
    monkeypatch.setenv("MBS_PROGRAM", str(FAKE))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    return lambda *more: stability([*CELLS, "--results", str(tmp_path / "results"), *more])


def table(folder):
    return pandas.read_csv(folder / "results" / "stability.csv")


def test_what_is_served_is_run_and_can_be_drawn_again(run, tmp_path):
    run("--implementation", "good_sparse/only")
    assert set(zip(table(tmp_path).scheme, table(tmp_path).precision)) == {("penalty", "double")}
    results = tmp_path / "results"
    drawn = [*results.glob("figures/*.svg"), results / "stability.html"]
    before = [path.read_bytes() for path in drawn]
    shutil.rmtree(results / "raw")
    run("--stored")
    assert len(drawn) == 2 and before == [path.read_bytes() for path in drawn]
    (results / "windows.csv").unlink()
    with pytest.raises(StudyError, match="windows.csv is missing"):
        run("--stored")


def test_dense_implementations_run_up_to_twenty_loops(run, tmp_path):
    run("--implementation", "good_dense/first", "--loops", "20", "40", "--steps", "1e-3",
        "--penalties", "1e2")
    assert list(dict.fromkeys(zip(table(tmp_path).scheme, table(tmp_path).precision))) == SERIES
    assert set(table(tmp_path).loops) == {20}
    with pytest.raises(StudyError, match="up to N = 20 only"):
        run("--implementation", "good_dense/first", "--loops", "40")


def test_a_run_that_ends_is_kept_and_never_run_again(run, tmp_path):
    run("--implementation", "good_sparse/only")
    before = {path: path.stat().st_mtime_ns for path in (tmp_path / "results").rglob("raw/**/*.json")}
    content = (tmp_path / "results" / "stability.csv").read_bytes()
    next(iter(before)).unlink()
    run("--implementation", "good_sparse/only")
    after = {path: path.stat().st_mtime_ns for path in before}
    assert len(before) == 6 and sum(after[path] != before[path] for path in before) == 1
    assert (tmp_path / "results" / "stability.csv").read_bytes() == content
    for row in table(tmp_path).itertuples():
        assert row.command == runs.typed(read_json(tmp_path / "results" / row.raw_file))
    assert not list((tmp_path / "results").rglob("*.partial"))


@pytest.mark.parametrize("name, status", [("bad/hang", "timeout"), ("bad/crash", "crashed")])
def test_a_run_that_does_not_end_is_data(run, tmp_path, monkeypatch, name, status):
    monkeypatch.setenv("FAKE_BAD", "1")
    run("--implementation", name, "--steps", "1e-3", "--time-limit", "0.5")
    assert set(table(tmp_path).status) == {status} and table(tmp_path).status_reason.notna().all()
    assert status in (tmp_path / "results" / "stability.html").read_text()


def test_a_results_directory_is_of_one_selection_and_program(run, monkeypatch):
    run("--implementation", "good_sparse/only")
    for more, what in ((("--implementation", "good_dense/first"), "variants"),
                       (("--duration", "1"), r"inputs: duration \S+, now 1.0")):
        with pytest.raises(StudyError, match=rf"holds results of something else \({what}\)"):
            run("--implementation", "good_sparse/only", *more)
    monkeypatch.setenv("FAKE_COMMIT", "def5678")
    with pytest.raises(StudyError, match="holds results of something else .commit 'abc1234'"):
        run("--implementation", "good_sparse/only")


@pytest.mark.parametrize("arguments, what", [
    (["--loops", "0"], "0 is not a number of loops"), (["--loops", "x"], "x is not a number of loops"),
    (["--steps", "-1"], "-1 is not a positive number"), (["--steps", "fast"], "'fast'"),
    (["--implementation", "nobody"], "unknown or unavailable implementation 'nobody'; known: good_d"),
    ([], "unknown or unavailable implementation 'csc_klu/refactor'"),
    (["--all", "--loops", "1"], "exclude each other"), (["--stored"], "holds no results")])
def test_what_is_wrong_is_said_in_a_line(tmp_path, arguments, what):
    done = study("stability", "--results", tmp_path, *arguments)
    assert done.returncode == 2 and what in done.stderr and "Traceback" not in done.stderr
    assert not list(tmp_path.glob("*.json")) and not list(tmp_path.glob("*.csv"))


def test_the_real_program(tmp_path):
    program = os.environ.get("MBS_PROGRAM", str(ROOT / "build" / "mbs"))
    choice = [*CELLS, "--duration", "0.1", "--results", tmp_path / "results"]
    done = study("stability", *choice, MBS_PROGRAM=program)
    assert done.returncode == 0, done.stderr
    found = table(tmp_path)
    assert len(found) == 4 * 6 and list(dict.fromkeys(zip(found.scheme, found.precision))) == SERIES
    double = found[found.precision == "double"]
    assert set(double.status) == {"ok"} and (double.position_error_max < 1e-3).all()
    assert set(found.alpha_dt2_4[found.penalty_asked != "auto"]) == {1e2, 1e3}
    assert (pandas.read_csv(tmp_path / "results" / "windows.csv").lower > 0).all()
    assert len(list((tmp_path / "results" / "figures").iterdir())) == 8


ROW = {"scheme": "saddle-point", "loops": 2000, "status": "ok", "position_error_max": 1e-3,
       "passes_per_step": 2.0, "steps_at_limit": 0}


@pytest.mark.parametrize("change, verdict", [
    ({}, "yes"), ({"loops": 3000}, ""), ({"scheme": "rattle"}, ""), ({"status": "degraded"}, "no"),
    ({"position_error_max": 3e-3}, "no"), ({"position_error_max": None, "status": "timeout"}, "no"),
    ({"passes_per_step": 2.3}, "no"), ({"steps_at_limit": 1}, "no"),
    ({"scheme": "penalty", "loops": 200, "steps_at_limit": 9, "passes_per_step": 3.0}, "yes")])
def test_what_whole_runs_must_hold(change, verdict):
    assert long.holds(ROW | change) == verdict


def test_compositions_of_rattle_run_where_rattle_is_served():
    contender = Contender("one/a", "one/a")
    assert {cell.scheme for cell in long.cells(contender, ["rattle"])} == {"penalty", "rattle", "rattle4", "rattle6"}
    assert {cell.scheme for cell in long.cells(contender, ["saddle-point"])} == {"penalty", "saddle-point"}


def test_whole_runs_are_a_table_and_a_section_of_the_page(run, tmp_path, monkeypatch):
    monkeypatch.setattr(long, "LOOPS", {"penalty": (1, 2), "rattle": (1,)})
    run("--implementation", "good_sparse/only", "--long")
    found = pandas.read_csv(tmp_path / "results" / "long.csv")
    assert list(found.loops) == [1, 2] and set(found.scheme) == {"penalty"}
    assert "Whole runs" in (tmp_path / "results" / "stability.html").read_text()
