# study/against on two copies of the fake `mbs`: samples of another program are never reused.
import json
import tempfile

import pandas
import pytest

from study.pipeline import against
from study.pipeline.errors import StudyError
from study.tests.conftest import FAKE, TEMPORARY

CHOICE = ["HEAD~1", "--only", "good_sparse", "--scenes", "four-bar:4", "--rounds", "2"]


@pytest.fixture
def programs(tmp_path, monkeypatch):
    """Paths of the programs of the old revision and of this tree."""
    paths = {}
    for tree in ("old", "new"):
        paths[tree] = tmp_path / f"{tree}_mbs.py"
        paths[tree].write_text(FAKE.read_text())
        paths[tree].chmod(0o755)
    monkeypatch.setenv("MBS_PROGRAM", str(paths["new"]))
    monkeypatch.setattr(tempfile, "tempdir", TEMPORARY.name)
    monkeypatch.setattr(against, "_resolve", lambda name: "0123456789abcdef")
    monkeypatch.setattr(against, "_build", lambda revision: paths["old"])
    return paths


def compare(results, *more):
    against.against([*CHOICE, "--results", str(results), *more])
    return pandas.read_csv(results / "ratios.csv")


def stamps(results):
    return {path: path.stat().st_mtime_ns for path in (results / "raw").rglob("*.json")}


def test_a_second_run_continues_the_first(programs, tmp_path):
    results = tmp_path / "results"
    table = compare(results)
    assert table.reason.isna().all() and table.ratio.between(0.8, 1.25).all()
    before = stamps(results)
    assert len(before) == 2 * 2
    compare(results, "--rounds", "3")
    after = stamps(results)
    assert len(after) == 3 * 2 and before.items() <= after.items()


@pytest.mark.parametrize("tree", ["old", "new"])
def test_samples_of_a_program_built_anew_are_refused(programs, tmp_path, tree):
    compare(tmp_path / "results")
    programs[tree].write_text(FAKE.read_text() + "# edited and built again\n")
    with pytest.raises(StudyError, match=r"holds results of something else \(programs\)"):
        compare(tmp_path / "results")


def test_failures_of_a_program_built_anew_are_refused(programs, tmp_path):
    programs["new"].write_text(FAKE.read_text().replace(
        "    misbehave(name)", "    if name != 'null/null':\n        sys.exit(1)"))
    assert "exit status 1" in compare(tmp_path / "results").reason[0]
    programs["new"].write_text(FAKE.read_text())
    with pytest.raises(StudyError, match="something else"):
        compare(tmp_path / "results")


@pytest.mark.parametrize("more, what", [(["--only", "good_dense"], "variants"),
                                        (["--scenes", "four-bar:10"], "scenes")])
def test_another_selection_is_refused(programs, tmp_path, more, what):
    compare(tmp_path / "results")
    with pytest.raises(StudyError, match=rf"something else \({what}\)"):
        compare(tmp_path / "results", *more)


def test_another_machine_is_refused(programs, tmp_path, monkeypatch):
    compare(tmp_path / "results")
    monkeypatch.setenv("FAKE_MACHINE", "m2")
    with pytest.raises(StudyError, match="machine 'm1', now 'm2'"):
        compare(tmp_path / "results")


@pytest.mark.parametrize("old, new", [('"step_us": one', '"us_per_step": one'),
                                      ('"benchmarks": rows', '"results": rows'),
                                      ('"benchmarks": rows', '"benchmarks": []')])
def test_an_old_program_with_other_keys_is_one_clear_error(programs, tmp_path, old, new):
    programs["old"].write_text(FAKE.read_text().replace(old, new))
    with pytest.raises(StudyError, match=r"old-good_sparse.only@four-bar4.json has no time of a step"):
        compare(tmp_path / "results")


def test_what_is_stored_says_which_programs_it_is_of(programs, tmp_path):
    compare(tmp_path / "results")
    record = json.loads((tmp_path / "results" / "run.json").read_text())
    assert set(record["programs"]) == {"old", "new"} and set(record["contexts"]) == {"new"}
    assert record["variants"] == ["good_sparse/only"] and record["scenes"] == {"four-bar:4": ""}
