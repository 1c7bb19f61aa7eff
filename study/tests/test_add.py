# study/add on a small set that was made by hand and the fake `mbs`: who changes hands, what is refused, what is kept.
import random
import shutil
import tempfile
from types import SimpleNamespace

import pandas
import pytest

from analysis.core import records, schema, timing
from analysis.core.files import StudyError, digest, read_json, write_json
from analysis.core.registry import Registry
from analysis.core.timing import NO_VARIANCE
from analysis.core.view import View
from analysis.map.results import Results
from study.core.cell import CONTROL, Contender
from study.core.lab import Lab
from study.core.studyset import StudySet, context_of, listed
from study.core.timing import measure as timed
from study.tests.conftest import FAKE, ROOT, TEMPORARY
from study.tools import add, shelf
from study.tools.merge import machine

pytestmark = pytest.mark.slow
NEW = "new_one/only"
LED = ("good_dense/first", "good_sparse/only")
CONTESTS = [("map", "four-bar:4", "penalty", ()), ("map", "four-bar:10", "penalty", ()),
            *(("families", "four-bar:6", scheme, ("--scheme", scheme, "--steps", "40")) for scheme in ("penalty", "saddle-point"))]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A set whose map has two scenes and whose families one in both forms, led by good_dense/first before good_sparse/only."""
    monkeypatch.setattr(tempfile, "tempdir", TEMPORARY.name)
    monkeypatch.setenv("MBS_PROGRAM", str(FAKE))
    monkeypatch.setattr(add, "PASSES", (2, 3))
    folder = tmp_path / "set"
    for pair in ("openblas", "system"):
        context = context_of(Contender(CONTROL.name, CONTROL.variant, pair))
        write_json(folder / "contexts" / f"own-{pair}.json", context)
    write_json(folder / "set.json", {"profile": "smoke", "only": [], "parts": ["families", "map"], "programs": {}, "context": context,
                                     "date": "2026-01-01 10:00"})
    write_json(folder / "registry.json", listed().listed)
    (folder / "profile.yaml").write_text((ROOT / "study" / "profiles" / "smoke.yaml").read_text())
    rows = {"families": [], "map": []}
    for part, scene, scheme, words in CONTESTS:
        lab = Lab(StudySet(folder), part, "column")
        lab.set.clear()
        found = timed(lab, scene, [Contender(name, name, "openblas") for name in LED], processes=2, repetitions=2, settings=words)
        rows[part] += [{"scene": scene, "layer": layer, "variables": 10, "winner": LED[0], "second": LED[1], "record": found[0].name}
                       | ({"scheme": scheme} if part == "families" else {}) for layer in ("libraries", "all")]
    for part, leaders in rows.items():
        schema.write_tables(folder, part, {name: pandas.DataFrame() for name in schema.of_part(part)} | {add.TABLES[part]: pandas.DataFrame(leaders)},
                            records.read_part(folder, part))
    return folder


def measure(folder, monkeypatch, times=None, name=NEW):
    if times:
        monkeypatch.setenv("FAKE_NEW", f"{NEW}={times}")
    status = add.add([name, "--to", str(folder), "--wait"])
    table = pandas.read_csv(folder / "added" / f"{name.replace('/', '.')}.csv", keep_default_na=False)
    assert status == (0 if "ok" in set(table.status) else 1)
    return table


def test_a_faster_newcomer_takes_the_cells(folder, monkeypatch, capsys):
    monkeypatch.setenv("FAKE_DIRTY", "true")
    monkeypatch.setenv("FAKE_COMMIT", "fedcba9")
    table = measure(folder, monkeypatch, 0.3)
    assert len(table) == 6 and set(table.hands) == {"changes"} and set(table.status) == {"ok"}
    assert ((table.low < table.ratio) & (table.ratio < table.high) & (table.high < 1)).all()
    assert set(table.before) == {"good_dense/first"} and set(table.processes) == {3}
    assert set(zip(table.commit, table.dirty.astype(str))) == {("fedcba9", "True")}
    told = capsys.readouterr().out
    assert "contests of" in told and told.count(f"{NEW} among libraries: ") == 2  # a part each
    assert all(f"{part}: {count} cells change hands, 0 are open, 0 stay, 0 were not timed" in told for part, count in (("families", 2), ("map", 4)))


def test_who_serves_a_form_is_asked_and_timed_in_it_as_the_set_did(folder, monkeypatch):
    table = measure(folder, monkeypatch, name="good_dense/first")
    assert set(zip(table.part, table.scheme)) == {("map", "penalty"), ("families", "penalty"), ("families", "saddle-point")}
    found = [one for path in (folder / "raw" / "added").rglob("*.json") for one in [records.read(path, path.name)]]
    saddle = [one for one in found if "saddle-point" in one.command]
    assert {one.role for one in saddle} == {"gate", "time"} and all("40" in one.command for one in saddle if one.role == "time")
    assert set(measure(folder, monkeypatch, 2.0).scheme) == {"penalty"}  # the newcomer serves that alone


def test_all_take_turns_in_the_same_processes_and_records_have_digests(folder, monkeypatch):
    measure(folder, monkeypatch, 0.3)
    base = folder / "raw" / "added" / "new_one.only"
    names = read_json(folder / "added" / "new_one.only.json")
    assert names["table"] == digest(folder / "added" / "new_one.only.csv")
    found = {name: records.read(folder / "raw" / "added" / name, name) for name in names["records"]}
    assert {name: digest(folder / "raw" / "added" / name) for name in found} == names["records"]
    assert len(list(base.rglob("*.json"))) == len(found)
    turns = [one for one in found.values() if one.role == "time"]
    assert len(turns) == 9 and all(one.cell["contenders"] == [NEW, *LED] for one in turns)
    assert {one.role for one in found.values()} == {"time", "gate"}


def test_on_artificial_fill_the_interval_is_that_for_other_seeds(folder, monkeypatch):
    """As the set's map has it (analysis/map/results.py); at a mechanism's own fill it is that of the processes alone."""
    draw = random.Random(1)
    row = lambda name, process, us, **more: {"implementation": name, "environment": "own", "process": process, "status": "ok", "step_us": us, **more}
    seeds = pandas.DataFrame([
        row(name, process, us, scene=f"four-bar:10,fill=0.4,seed={seed}", kind="seeds", variables=22, fill_asked=0.4, record="r",
            samples_us=f"{us * (1 + 0.1 * seed * (name == LED[0]))}") for seed in (1, 2, 3) for process in (1, 2)
        for name, us in ((LED[0], 1.0), (LED[1], 2.0))])
    schema.write_tables(folder, "map", {name: schema.read_table(folder, "map", name) for name in schema.of_part("map")} | {"tidy": seeds},
                        records.read_part(folder, "map"))
    beyond = machine.of_seeds(StudySet(folder))
    assert beyond[0] > 0 and beyond == Results({"tidy": schema.read_table(folder, "map", "tidy")}, View(folder, "map"))._of_seeds
    timed = pandas.DataFrame([row(name, process, us, steps=9.0, start=0.0, passes=9, reason="", samples=(us * draw.uniform(0.99, 1.01),))
                              for process in (1, 2, 3, 4) for name, us in ((NEW, 0.97), (LED[0], 1.0))])
    monkeypatch.setattr(add.timing, "processes", lambda found: timed)
    monkeypatch.setattr(add.timing, "counted", lambda found: found)
    [led] = pandas.DataFrame([{"layer": "all", "winner": LED[0], "second": LED[1]}]).itertuples()

    def compared(more):
        contest = add.Contest("map", "four-bar:10,fill=0.4", "penalty", 22, [led], (), (), 9.0, 0.0, {}, [NEW], more)
        [found] = add._rows(contest, SimpleNamespace(own=()), {NEW: ("ok", "")}, [SimpleNamespace(name="one")])
        return found
    here, elsewhere = compared(NO_VARIANCE), compared(beyond)
    assert elsewhere["low"] < here["low"] < here["ratio"] == elsewhere["ratio"] < here["high"] < elsewhere["high"]
    assert here["hands"] == "changes" and elsewhere["hands"] == "open" and here["chance"] < 0.05 < elsewhere["chance"]


def test_artificial_fill_alone_has_the_variance_between_seeds(folder, monkeypatch):
    monkeypatch.setattr(machine, "of_seeds", lambda _: (0.1, 3))
    rows = schema.read_table(folder, "map", "cells").assign(scene=lambda rows: rows.scene.replace("four-bar:4", "four-bar:4,fill=0.9"))
    schema.write_tables(folder, "map", {name: schema.read_table(folder, "map", name) for name in schema.of_part("map")} | {"cells": rows},
                        records.read_part(folder, "map"))
    found = {one.scene: one.beyond for one in add.contests(StudySet(folder), [LED[0]], listed())}
    assert found == {"four-bar:4,fill=0.9": (0.1, 3), "four-bar:10": NO_VARIANCE, "four-bar:6": NO_VARIANCE}


def test_what_is_asked_at_once_is_held_to_that(tmp_path, capsys):
    rows = [{"part": "map", "scheme": "penalty", "layer": layer, "chance": chance, "decided": chance < 0.05, "holm": False, "status": "ok", "rival": "a",
             "hands": "changes" if chance < 0.05 else "open"} for layer, chances in (("all", (0.001, 0.03, 0.04, 0.5)), ("libraries", (0.04,)))
            for chance in chances]
    untimed = {"part": "map", "scheme": "penalty", "layer": "all", "status": "dropped", "hands": "not timed"}
    found = timing.holm([*rows, untimed], "part", "scheme", "layer")
    assert [row["holm"] for row in found[:-1]] == [True, False, False, False, True] and "holm" not in found[-1]
    add.tell(shelf.table(found, "added"), tmp_path, NEW)
    assert "4 cells change hands, 1 are open, 0 stay, 1 were not timed; asked all at once 2 change hands" in capsys.readouterr().out


def test_a_slower_newcomer_changes_nothing(folder, monkeypatch):
    assert set(measure(folder, monkeypatch, 30).hands) == {"stays"}


def test_a_leader_that_became_slower_loses_its_cells(folder, monkeypatch, tmp_path):
    slow = tmp_path / "mbs.py"
    slow.write_text(FAKE.read_text().replace("    dense = 2 +", "    dense = 200 +"))
    slow.chmod(0o755)
    monkeypatch.setenv("MBS_PROGRAM", str(slow))
    table = measure(folder, monkeypatch, name="good_dense/first")
    assert set(table.hands) == {"changes"} and set(table.rival) == {"good_sparse/only"} and (table.low > 1).all()


def test_asked_again_nothing_is_measured_and_of_another_program_everything(folder, monkeypatch, tmp_path):
    def stamps():
        return {path: path.stat().st_mtime_ns for path in (folder / "raw" / "added").rglob("*.json")}
    before, first = measure(folder, monkeypatch, 0.5), stamps()
    assert measure(folder, monkeypatch, 0.5).equals(before) and stamps() == first
    edited = tmp_path / "mbs.py"
    edited.write_text(FAKE.read_text() + "# edited\n")
    edited.chmod(0o755)
    monkeypatch.setenv("MBS_PROGRAM", str(edited))
    measure(folder, monkeypatch, 0.5)
    assert not set(stamps().values()) & set(first.values())


def test_who_fails_the_gate_is_not_timed(folder, monkeypatch, capsys):
    monkeypatch.setenv("FAKE_BAD", "1")
    table = measure(folder, monkeypatch, name="bad/wrong")
    told = capsys.readouterr().out
    assert told.count("disagrees: ") == 2 and all(scene in told for scene in table.scene)  # a line a part
    assert set(table.status) == {"disagrees"} and "q differs by 0.4 m" in table.reason[0] and set(table.hands) == {"stays"}


def test_who_is_not_timed_is_told_by_the_term_that_is_not_served_not_by_its_places(tmp_path, capsys):
    reasons = [f"it does not serve {term}: the scene has {what} (mbs list tells who does)"
               for term, what in (("dots", "constraint 'a'"), ("dots", "constraint 'b'"), ("springs", "spring 'c'"))]
    rows = [{"part": "families", "scene": f"robot:{place}", "layer": "all", "status": "unsupported", "reason": reason, "hands": "stays"}
            for place, reason in enumerate(reasons)]
    add.tell(shelf.table(rows, "added"), tmp_path, NEW)
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith("unsupported")]
    assert lines == ["unsupported: it does not serve dots: robot:0, robot:1", "unsupported: it does not serve springs: robot:2"]


def test_reasons_that_differ_in_numbers_are_told_once(tmp_path, capsys):
    rows = [{"part": "map", "scene": scene, "layer": "all", "status": "disagrees", "reason": reason, "hands": "stays"} for scene, reason in (
        ("four-bar:4", "lock-step: a differs by 2.1e-05 of 1e-10"), ("four-bar:8", "lock-step: a differs by 31 of 1e-10"), ("grid:4", "free-running: x"))]
    add.tell(shelf.table(rows, "added"), tmp_path, NEW)
    assert [line for line in capsys.readouterr().out.splitlines() if line.startswith("disagrees")] == [
        "disagrees: lock-step: a differs by 2.1e-05 of 1e-10 (or alike): four-bar:4, four-bar:8", "disagrees: free-running: x: grid:4"]


@pytest.mark.parametrize("name, status", [("bad/crash", "crashed"), ("bad/passes", "disagrees"), ("bad/nan", "diverged")])
def test_who_fails_while_timed_has_a_reason_and_the_others_their_times(folder, monkeypatch, name, status):
    monkeypatch.setenv("FAKE_BAD", "1")
    table = measure(folder, monkeypatch, name=name)
    assert set(table.status) == {status} and (table.reason != "").all()


@pytest.mark.parametrize("variable, value, words", [
    ("FAKE_MACHINE", "m2", "its machine is 'm1', here it is 'm2'"),
    ("FAKE_COMPILER", "fake 2.0", "its compiler is 'fake 1.0', here it is 'fake 2.0'")])
def test_another_machine_or_compiler_is_refused(folder, monkeypatch, variable, value, words):
    monkeypatch.setenv(variable, value)
    with pytest.raises(StudyError, match=words):
        measure(folder, monkeypatch, 0.5)
    assert not (folder / "added").exists()


def test_another_version_of_a_library_is_refused_and_a_further_library_is_not(folder, monkeypatch):
    for path in (folder / "contexts").iterdir():
        write_json(path, read_json(path) | {"libraries": "Fake 1.0; KLU 1.2"})
    with pytest.raises(StudyError, match="it has KLU 1.2, here there is none of it"):
        measure(folder, monkeypatch, 0.5)
    assert add.versions({"libraries": "A 1; B 2"}) - add.versions({"libraries": "B 2; C 1; A 1"}) == set()


def test_a_changed_table_is_named(folder, monkeypatch):
    path = folder / "map" / "cells.csv"
    path.write_text(path.read_text().replace("good_sparse", "good_dense"))
    with pytest.raises(StudyError, match="cells.csv is not as it was written"):
        measure(folder, monkeypatch, 0.5)


def test_a_changed_record_is_named_loose_or_packed(folder, monkeypatch):
    one, *_ = (folder / "raw" / "families" / "column" / "time").iterdir()
    whole = one.read_text()
    one.write_text(whole.replace('"seconds":', '"seconds":1'))
    with pytest.raises(StudyError, match=f"{one.name} is changed"):
        measure(folder, monkeypatch, 0.5)
    one.write_text(whole)
    records.pack(folder, "families", records.archive_of(folder, "families"))
    assert len(measure(folder, monkeypatch, 0.5)) == 6
    records.write(one, read_json(one)["record"] | {"seconds": 1e6})  # with its right digest
    records.pack(folder, "families", records.archive_of(folder, "families"))
    with pytest.raises(StudyError, match="families: its tables are not those of its records"):
        measure(folder, monkeypatch, 0.5)


def test_the_newest_of_this_machine_is_the_default_and_without_one_it_says_what_to_do(folder, monkeypatch, tmp_path):
    monkeypatch.setattr(add, "RESULTS", folder.parent)
    monkeypatch.setattr(add, "ROOT", folder.parent)
    older = folder.parent / "local" / "older"
    shutil.copytree(folder, older)
    write_json(older / "set.json", read_json(older / "set.json") | {"date": "2025-01-01 10:00"})
    for known in (listed(), Registry(listed().listed | {"blas": []})):  # with BLAS pairs, and without any that it knows
        assert add.newest(known) == folder
    monkeypatch.setenv("FAKE_MACHINE", "m2")
    with pytest.raises(StudyError, match="set is of .*study/run --part map makes one.*mbs bench"):
        add.newest(listed())


def test_unknown_names_and_sets(folder, monkeypatch, tmp_path):
    with pytest.raises(StudyError, match="unknown implementation 'nobody'"):
        measure(folder, monkeypatch, name="nobody")
    with pytest.raises(StudyError, match="holds no set"):
        add.add([NEW, "--to", str(tmp_path / "nowhere")])


def test_it_keeps_to_a_fifth_of_a_runs_time(folder, monkeypatch):
    monkeypatch.setattr(add, "SHARE", 0.0)
    table = measure(folder, monkeypatch, 0.5)
    assert set(table.status) == {"dropped"} and "budget" in table.reason[0] and set(table.hands) == {"not timed"}
