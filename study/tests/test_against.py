# study/against on two copies of the fake `mbs`: samples of another program are never reused.
import tempfile

import pandas
import pytest

from analysis.core.files import StudyError
from study.core import executor, studyset
from study.tests.conftest import FAKE, TEMPORARY
from study.tools import against

CHOICE = ["HEAD~1", "--only", "good_sparse", "--scenes", "four-bar:4", "--rounds", "1", "--wait"]


def described(scene):
    if not scene.startswith("four-bar:"):
        raise StudyError(f"unknown scene '{scene}'")


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
    monkeypatch.setattr(against, "_build", lambda revision, log: "against/old")
    monkeypatch.setattr(against, "describe", described)
    program_of = executor.program_of
    for module in (executor, studyset, against):
        monkeypatch.setattr(module, "program_of", lambda name="mbs", build="": str(paths["old"]) if build
                            else program_of(name, build))
    return paths


def compare(results, *more):
    against.against([*CHOICE, "--results", str(results), *more])
    return pandas.read_csv(results / "ratios.csv")


def stamps(results):
    return {path: path.stat().st_mtime_ns for path in (results / "raw").rglob("*.json")}


def test_a_second_run_continues_the_first(programs, tmp_path):
    results = tmp_path / "results"
    table = compare(results)
    assert table.reason.isna().all() and table.ratio.between(0.8, 1.25).all() and list(table.pairs) == [2]
    before = stamps(results)
    assert len(before) == 4 and {path.parent.name for path in before} == {"old", "new"}
    compare(results, "--rounds", "2")
    after = stamps(results)
    assert len(after) == 8 and before.items() <= after.items()


def test_a_program_that_is_twice_as_fast_is_found_out(programs, tmp_path):
    programs["old"].write_text(FAKE.read_text().replace('"real_time": one * steps', '"real_time": 2 * one * steps'))
    table = compare(tmp_path / "results", "--only", "good_sparse", "good_dense", "--rounds", "3")
    assert len(table) == 3 and table.ratio.between(0.4, 0.6).all()
    assert (table.low < table.ratio).all() and (table.ratio < table.high).all() and (table.high < 0.7).all()


@pytest.mark.parametrize("tree, key", [("old", "old"), ("new", "programs: mbs was built anew")])
def test_samples_of_a_program_built_anew_are_refused(programs, tmp_path, tree, key):
    compare(tmp_path / "results")
    programs[tree].write_text(FAKE.read_text() + "# edited and built again\n")
    with pytest.raises(StudyError, match=rf"holds results of something else \({key}\)"):
        compare(tmp_path / "results")


def test_who_ends_a_process_of_all_has_a_reason_and_the_others_a_ratio(programs, tmp_path):
    programs["new"].write_text(FAKE.read_text().replace(
        "def misbehave(name):", "def misbehave(name):\n    if name == 'good_dense/second':\n        sys.exit(7)"))
    table = compare(tmp_path / "results", "--only", "good_dense").set_index("implementation")
    assert table.reason["good_dense/second"].startswith("new: crashed: exit status 7")
    assert table.ratio["good_dense/first"] > 0


def test_a_variant_that_the_revision_lacks_is_said(programs, tmp_path):
    programs["old"].write_text(FAKE.read_text().replace('"good_sparse/only": 1', '"other/only": 1'))
    assert list(compare(tmp_path / "results").reason) == ["is not in 0123456789"]


@pytest.mark.parametrize("more, what", [(["--only", "good_dense"], "only"), (["--scenes", "four-bar:10"], "scenes")])
def test_another_selection_is_refused(programs, tmp_path, more, what):
    compare(tmp_path / "results")
    with pytest.raises(StudyError, match=rf"something else \({what}\)"):
        compare(tmp_path / "results", *more)


@pytest.mark.parametrize("more, words", [(["--only", "nobody"], "unknown implementation 'nobody'"),
                                         (["--scenes", "four-bar:4", "nosuch"], "unknown scene 'nosuch'")])
def test_names_that_are_none_are_said_before_the_other_revision_is_built(programs, tmp_path, monkeypatch, more, words):
    monkeypatch.setattr(against, "_build", lambda *_: pytest.fail("it was built"))
    with pytest.raises(StudyError, match=words):
        compare(tmp_path / "results", *more)


def test_another_machine_is_refused(programs, tmp_path, monkeypatch):
    compare(tmp_path / "results")
    monkeypatch.setenv("FAKE_MACHINE", "m2")
    with pytest.raises(StudyError, match="machine is 'm2', the set's is 'm1'"):
        compare(tmp_path / "results")


def test_an_old_program_that_cannot_be_read_is_one_clear_error(programs, tmp_path):
    programs["old"].write_text(FAKE.read_text().replace('"steps": steps', '"number_of_steps": steps'))
    with pytest.raises(StudyError, match="lacks 'steps': its program is of a revision that"):
        compare(tmp_path / "results")
    programs["old"].write_text(FAKE.read_text().replace('"benchmarks": rows', '"results": rows'))
    assert "gave no row" in compare(tmp_path / "other").reason[0]
