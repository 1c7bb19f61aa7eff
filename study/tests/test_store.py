# study/store on a small set: what is refused, what is kept, and that nothing half-written stays.
import shutil
import subprocess
from pathlib import Path

import pytest

from analysis.core import records, schema
from analysis.core.files import StudyError, read_json, write_json
from study.core import studyset
from study.tests.conftest import PART, ROOT
from study.tools import fragments, store

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def measured(tmp_path_factory, whole):
    folder = Path(shutil.copytree(whole[0], tmp_path_factory.mktemp("measured") / "set"))
    for path in (folder / "set.json", *(folder / "contexts").glob("*.json")):  # the tree of a developer is dirty
        found = read_json(path)
        clean = {"dirty": "false", "cpu_model": "AMD EPYC (family 25, model 17, stepping 1)"}
        write_json(path, found | {"context": found["context"] | clean} if "context" in found else found | clean)
    return folder


@pytest.fixture
def folder(measured, tmp_path, monkeypatch):
    """A finished set of one's own; results/ is elsewhere, and one part is the study."""
    monkeypatch.setattr(store, "RESULTS", tmp_path / "results")
    monkeypatch.setattr(store, "parts", lambda: [PART])
    monkeypatch.setattr(fragments, "refresh", lambda: [])
    (tmp_path / "results").mkdir()
    return Path(shutil.copytree(measured, tmp_path / "set"))


def left(folder):
    return sorted(path.name for path in (folder.parent / "results").iterdir() if path.name != ".lock")


def test_a_set_is_packed_and_read_as_it_was(folder, capsys):
    for place in (PART, "contexts"):
        (folder / place / ".partial-node-1-2-maps.csv").write_text("half")
    store.store([str(folder)])
    [name] = left(folder)
    stored = folder.parent / "results" / name
    assert name == "smoke-epyc-25-17" and f"git add results/{name}" in capsys.readouterr().out
    assert records.read_part(stored, PART) == records.read_part(folder, PART) != []
    for table in schema.of_part(PART):
        assert (stored / PART / f"{table}.csv").read_bytes() == (folder / PART / f"{table}.csv").read_bytes()
    files = {path.relative_to(stored).as_posix() for path in stored.rglob("*") if path.is_file()}
    assert {"set.json", "registry.json", "profile.yaml", f"raw/{PART}.tar.xz", f"{PART}/answers.json"} < files
    assert not any(name.endswith((".html", ".svg", ".png")) or name.startswith(f"raw/{PART}/") or ".partial" in name for name in files)


def test_pictures_that_a_text_shows_are_kept(folder, tmp_path, monkeypatch):
    picture = next((folder / PART / "figures").glob("*.svg")).name
    (tmp_path / "README.md").write_text(f"![](results/older-set/{PART}/figures/{picture})")
    monkeypatch.setattr(fragments, "texts", lambda: [tmp_path / "README.md"])
    store.store([str(folder), "one"])
    assert [path.name for path in (folder.parent / "results" / "one").rglob("*.svg")] == [picture]


def test_equal_sets_give_equal_archives(folder):
    store.store([str(folder), "one"])
    store.store([str(folder), "two"])
    one, two = (records.archive_of(folder.parent / "results" / name, PART).read_bytes() for name in ("one", "two"))
    assert one == two


def a_record(folder):
    return next((folder / "raw" / PART).rglob("*@*.json"))


def edit(path, change):
    found = read_json(path)
    change(found)
    write_json(path, found)


def change_context(folder):
    edit(next((folder / "contexts").glob("*.json")), lambda found: found.update(dirty="true"))


def change_table(folder):
    table = next((folder / PART).glob("*.csv"))
    table.write_text(table.read_text().replace("1", "2", 1))


def change_record(folder):
    path = a_record(folder)
    path.write_text(path.read_text().replace('"seconds":0', '"seconds":1'))


DAMAGES = {
    "was measured from a dirty tree (dirty is true)":
        lambda folder: edit(folder / "set.json", lambda found: found["context"].update(dirty="true")),
    "is no evidence: its A/A control failed":
        lambda folder: edit(folder / "set.json", lambda found: found.update(no_evidence="its A/A control failed")),
    "contexts/": change_context,
    "which is no commit of this repository":
        lambda folder: edit(folder / "set.json", lambda found: found["context"].update(commit="0" * 40)),
    "is not finished": lambda folder: next((folder / ".done" / PART).iterdir()).unlink(),
    "is changed: remove it": change_record,
    "is missing: study/run measures it again": lambda folder: a_record(folder).unlink(),
    "is no record of this study: remove it": lambda folder: shutil.copy(a_record(folder), a_record(folder).with_name("x.json")),
    "belongs to no column that has ended": lambda folder: shutil.copytree(a_record(folder).parent, folder / "raw" / PART / "gone" / "x"),
    "is not as it was written": change_table,
    "its tables are not those of its records": lambda folder: (folder / PART / "tables.json").unlink(),
    "lacks stability: a stored set has all parts":
        lambda folder: edit(folder / "set.json", lambda found: found.update(parts=["extremes"])),
    "no set.json": lambda folder: (folder / "set.json").unlink(),
}


@pytest.mark.parametrize("words", DAMAGES)
def test_what_is_refused_leaves_nothing(folder, words):
    DAMAGES[words](folder)
    with pytest.raises(StudyError) as refused:
        store.store([str(folder)])
    assert words in str(refused.value) and "\n" not in str(refused.value)
    assert left(folder) == []


@pytest.mark.parametrize("name", ["local", "../elsewhere", ".hidden", "a b", "a/b"])
def test_names_that_are_none(folder, name):
    with pytest.raises(StudyError, match="is no name of a set"):
        store.store([str(folder), name])


def test_a_fourth_set_and_a_second_of_a_name_are_refused(folder):
    for name in ("one", "two"):
        store.store([str(folder), name])
    with pytest.raises(StudyError, match="results/one is there already"):
        store.store([str(folder), "one"])
    store.store([str(folder), "three"])
    with pytest.raises(StudyError, match="which is the most: remove one of one, three, two"):
        store.store([str(folder), "four"])


def test_what_fails_half_way_leaves_nothing(folder, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")
    monkeypatch.setattr(records, "pack", full)
    with pytest.raises(StudyError, match="cannot store results/one: No space left on device"):
        store.store([str(folder), "one"])
    assert left(folder) == []


def test_the_newest_local_set_is_the_default_and_tools_have_none(folder):
    local = folder.parent / "results" / "local"
    for name, date, parts in (("old", "2026-01-01 10:00", [PART]), ("new", "2026-01-02 10:00", [PART]),
                              ("against-1", "2026-01-03 10:00", [])):
        shutil.copytree(folder, local / name)
        edit(local / name / "set.json", lambda found: found.update(date=date, parts=parts))
    assert studyset.newest(local) == local / "new"


def test_archives_and_tables_are_tracked_and_what_is_drawn_again_is_not():
    def ignored(*names):
        paths = [f"results/one-set/{name}" for name in names]
        done = subprocess.run(["git", "check-ignore", "--no-index", *paths], cwd=ROOT, capture_output=True, text=True)
        return len(done.stdout.split())
    assert ignored("set.json", "contexts/own-openblas.json", "raw/map.tar.xz", "map/cells.csv", "map/answers.json",
                   "added/new.csv") == 0
    assert ignored("raw/map/c/x.json", "raw/added/new/x.json", "map.html", "map/figures/x.svg", "run.log", ".lock",
                   ".done/map/c", ".snakemake/x") == 8


@pytest.mark.parametrize("text, name", [("AMD EPYC (family 25, model 17, stepping 1)", "epyc-25-17"),
                                        ("Intel(R) Core(TM) i7-8650U CPU @ 1.90GHz", "i7-8650u"), ("", "machine")])
def test_machines_have_short_names(text, name):
    assert store.short(text) == name


def test_records_that_the_tables_were_not_made_of_are_named(tmp_path):
    """Each record of the archive is whole, but it is another one."""
    base = tmp_path / "raw" / "limit"
    made = {"cell": {"role": "about"}, "status": "done", "reason": "", "seconds": 1.0, "command": [], "context": {}, "output": {"x": 1}}
    records.write(base / "column" / "about" / "one.json", made)
    write_json(tmp_path / "limit" / schema.DIGESTS, {
        "records": schema.digest_of(records.read_part(tmp_path, "limit")), "tables": {}})
    records.pack(tmp_path, "limit", records.archive_of(tmp_path, "limit"))
    schema.records_of(tmp_path, "limit", {})
    records.write(base / "column" / "about" / "one.json", made | {"output": {"x": 2}})
    records.pack(tmp_path, "limit", records.archive_of(tmp_path, "limit"))
    with pytest.raises(StudyError, match="holds other records"):
        schema.records_of(tmp_path, "limit", {})


def test_a_column_may_be_called_scenes_and_scenes_are_no_records(tmp_path):
    base = tmp_path / "raw" / "limit"
    records.write(base / "scenes" / "about" / "one.json", {"cell": {"role": "about"}, "status": "done", "reason": "",
                                                           "seconds": 1.0, "command": [], "context": {}})
    write_json(base / "scenes" / "crank.json", {"points": []})
    loose = records.read_part(tmp_path, "limit")
    records.pack(tmp_path, "limit", records.archive_of(tmp_path, "limit"))
    assert [one.name for one in loose] == ["scenes/about/one.json"] == [one.name for one in records.read_part(tmp_path, "limit")]
