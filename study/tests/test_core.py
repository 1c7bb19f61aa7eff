# The common layer: cells and their identity, records and their digests, the lab, schemas, sets, locks, profiles.
import errno
import fnmatch
import functools
import json
import math
import os
import shutil
import subprocess
import tempfile
import threading
import time
from dataclasses import fields, replace
from pathlib import Path
from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy
import pandas
import pytest
import yaml

from analysis.core import records, schema, site
from analysis.core.files import MEND, ROOT, StudyError, digest, read_json, read_object, write_json, write_text
from analysis.core.registry import Registry
from analysis.core.style import save
from analysis.core.text import number
from analysis.core.view import View, facts_of, parts
from study import main
from study.core import child, executor, front, locks, profile, studyset
from study.core.cell import Cell, Contender, by_environment, on_usual_pairs
from study.core.front import duration
from study.core.lab import BETWEEN, Lab, cores
from study.core.options import Parser, positive
from study.tests.conftest import FAKE, TEMPORARY, environment, study

ONE, TWO = Contender("one/a", "one/a"), Contender("two/b", "two/b", "openblas")
CELL = Cell("simulate", "four-bar:3", (ONE,), ("--step", 0.001), "map")
FIELDS = {"cell": CELL.settled().document(), "status": "done", "reason": "", "seconds": 0.5, "command": ["mbs"],
          "context": {"machine": "m1"}, "output": {"µ": [1, 2.5, None]}}


# Cells

OTHER = {"kind": "check", "scene": "four-bar:4", "contenders": (TWO,), "settings": ("--step", 0.002), "role": "other",
         "number": 1, "program": "mbs_reference", "timed": True, "seconds": 61.0, "memory_mb": 1, "keep": ("A.x",), "every": 2}


def test_all_that_a_cell_is_makes_another_name():
    names = {replace(CELL, **{key: value}).settled().file_name() for key, value in OTHER.items()}
    assert len(names) == len(OTHER) and CELL.settled().file_name() not in names
    assert set(OTHER) == {one.name for one in fields(Cell)} - {"inputs"}


def test_equal_cells_have_one_name_whatever_words_are_made_of():
    assert replace(CELL, settings=("--step", "0.001")).settled() == CELL.settled()
    assert CELL.settled().file_name() == replace(CELL, settings=["--step", "0.001"]).settled().file_name()
    assert CELL.settled().file_name().startswith("map/one.a@four-bar-3-")


def test_an_edited_scene_is_another_cell(tmp_path):
    path = tmp_path / "scene.json"
    path.write_text("{}")
    before = replace(CELL, scene=str(path)).settled()
    path.write_text("{ }")
    assert replace(CELL, scene=str(path)).settled().file_name() != before.file_name()


@pytest.mark.parametrize("scene", ["a/../../b c\n'\".json", "x" * 500, "ß\x00|<>*?", ""])
def test_names_of_files_are_safe(scene):
    name = replace(CELL, scene=scene).settled().file_name().removeprefix("map/")
    assert "/" not in name and len(name) < 120 and name.isprintable() and not set(name) & set("|<>*?\"' :")


# The executor

def test_command_lines():
    words = executor.command_of(Cell("bench", "four-bar:3", (TWO,), ("--steps", 4)))
    assert words[1:] == ["bench", "four-bar:3", "--implementation", "two/b", "--steps", "4", "--benchmark_out_format=json",
                         "--benchmark_out=FILE", "--blas", "openblas"]
    words = executor.command_of(replace(CELL, every=5, keep=("outputs",)))
    assert words[-5:] == ["--json", "--output", "MOTION", "--every", "5"]


def test_the_stand_in_is_that_of_this_tree_only(monkeypatch):
    monkeypatch.setenv("MBS_PROGRAM", "/other/mbs")
    assert executor.program_of() == executor.program_of(build="clang-O2") == "/other/mbs"
    assert executor.program_of("mbs_reference") == "build/mbs_reference"
    assert executor.program_of(build="against/abc/build") == "build-against/abc/build/mbs"


def test_rows_of_a_benchmark_are_kept_once():
    rows = [{"name": "a/b/s", "run_type": "iteration", "real_time": time, "cpu_time": 1.0, "steps": 8, "passes": passes, "threads": 1}
            for time, passes in ((2.0, 3), (3.0, 4))] + [{"name": "a/b/s_median", "run_type": "aggregate", "real_time": 9}]
    [found] = executor.compact({"benchmarks": rows})["rows"].items()
    assert found == ("a/b/s", {"stretch_us": [2.0, 3.0], "cpu_us": [1.0, 1.0], "steps": 8, "passes": [3, 4]})


@pytest.fixture
def mbs(tmp_path, monkeypatch):
    """Makes a script stand in for `mbs`; it counts its runs."""
    def make(text):
        path = tmp_path / "mbs"
        path.write_text(f"#!/bin/bash\necho run >> {tmp_path}/runs\n{text}\n")
        path.chmod(0o755)
        monkeypatch.setenv("MBS_PROGRAM", str(path))
        monkeypatch.setattr(tempfile, "tempdir", TEMPORARY.name)
        return lambda: len((tmp_path / "runs").read_text().split()) if (tmp_path / "runs").exists() else 0
    return make


@pytest.mark.parametrize("text, status, reason", [
    ("echo 'mbs: --step is 0 s' >&2; exit 2", "refused", "mbs: --step is 0 s"),
    ("echo 'mbs: odd' >&2; exit 7", "crashed", "exit status 7: mbs: odd"),
    ("kill -SEGV $$", "crashed", "SIGSEGV"), ("echo nothing", "crashed", "its output is no JSON"),
    ("echo '[1]'", "crashed", "no JSON object"), ("echo '{\"a\": NaN}'", "crashed", "NaN is no number"),
    ("sleep 9", "timeout", "did not end within 0.5 s"), ("echo std::bad_alloc >&2; exit 1", "out-of-memory", "4096 MB"),
    ("echo '{\"a\": 1}'; exit 1", "done", "")])
def test_every_way_to_end_has_a_status_and_a_reason(mbs, text, status, reason):
    mbs(text)
    found = executor.run(replace(CELL, seconds=0.5).settled(), {"machine": "m1"})
    assert found["status"] == status and reason in found["reason"]
    assert found["output"] == ({"a": 1} if status == "done" else {}) and found["context"] == {"machine": "m1"}


def test_who_ended_a_process_of_several_is_known(mbs):
    mbs("echo 'mbs bench: ended by SIGSEGV in one/a/four-bar:3' >&2; kill -SEGV $$")
    assert executor.run(CELL.settled(), None)["output"] == {"culprit": "one/a/four-bar:3"}


def test_the_motion_is_kept_by_columns(mbs):
    mbs('while [[ $1 != --trajectory ]]; do shift; done; printf "t,A.x,A.y\\n0,1,2\\n1,inf,4\\n" > $2; echo "{}"')
    found = executor.run(replace(CELL, every=1, keep=("A.x",)).settled(), {})
    assert found["series"] == {"t": [0, 1], "A.x": [1, None]}


def test_results_of_another_build_are_never_merged():
    known = dict.fromkeys(executor.FINGERPRINT, "x") | {"blas_loaded": "a;b"}
    executor.need_same(known, known | {"blas_loaded": "b;a", "date": "later"}, "set")
    for key in executor.FINGERPRINT:
        with pytest.raises(StudyError, match=rf"another machine or build \({key} is"):
            executor.need_same(known, known | {key: "y"}, "set")


# Records

def test_a_record_is_read_as_it_was_written(tmp_path):
    records.write(tmp_path / "one.json", FIELDS)
    found = records.read(tmp_path / "one.json", "c/map/one.json")
    assert (found.name, found.column, found.role, found.done, found.series) == ("c/map/one.json", "c", "map", True, {})
    assert found.output == FIELDS["output"]


def test_every_changed_byte_of_a_record_is_noticed():
    text = records.to_text(FIELDS)
    for place in range(len(text)):
        changed = text[:place] + ("x" if text[place] != "x" else "y") + text[place + 1:]
        for damaged in (changed, text[:place], text + text[place]):
            with pytest.raises(StudyError, match="HERE is (changed|truncated or no record)"):
                records.from_text(damaged, "one", "HERE")


@pytest.mark.parametrize("key, value", [
    ("cell", []), ("status", 3), ("reason", None), ("seconds", "1"), ("command", "mbs"), ("context", 1), ("output", [1]),
    ("series", "x"), ("unknown", 1), *((key, ...) for key in records.KINDS)])
def test_a_record_of_another_shape_is_none_whatever_its_digest(key, value):
    data = FIELDS | {key: value}
    if value is ...:
        del data[key]
    with pytest.raises(StudyError, match=rf"HERE is no record \({key}\)"):
        records.from_text(records.to_text(data), "one", "HERE")


def test_not_a_number_is_never_written():
    with pytest.raises(ValueError):
        records.to_text(FIELDS | {"seconds": math.nan})


@pytest.fixture
def loose(tmp_path):
    """A set's folder with records, a scene and a partial file."""
    for place in range(5):
        records.write(tmp_path / "raw" / "part" / "c" / "map" / f"{place}.json", FIELDS | {"seconds": place / 3})
    write_json(tmp_path / "raw" / "part" / "scenes" / "x.json", {"points": []})
    (tmp_path / "raw" / "part" / "c" / ".partial-1-x.json").write_text("half")
    return tmp_path


def test_an_archive_holds_the_same_records_and_scenes(loose):
    before = records.read_part(loose, "part")
    archive = records.archive_of(loose, "part")
    records.pack(loose, "part", archive)
    assert [one.name for one in before] == [f"c/map/{place}.json" for place in range(5)]
    assert records.read_part(loose, "part") == before
    again = loose / "again.tar.xz"
    shutil.copytree(loose / "raw" / "part", loose / "other" / "raw" / "part")  # other times
    records.pack(loose / "other", "part", again)
    assert again.read_bytes() == archive.read_bytes()
    import tarfile
    with tarfile.open(archive) as tar:
        assert [name for name in tar.getnames() if "scenes" in name or "partial" in name] == ["scenes/x.json"]


def test_records_come_in_one_order_loose_or_packed(tmp_path):
    for name in ("a/x", "a-b/x", "a/X", "a.b/x", "a/y-1", "a/y"):
        records.write(tmp_path / "raw" / "part" / f"{name}.json", FIELDS)
    before = records.read_part(tmp_path, "part")
    records.pack(tmp_path, "part", records.archive_of(tmp_path, "part"))
    assert records.read_part(tmp_path, "part") == before and len(before) == 6


def test_an_archive_that_was_cut_or_changed_anywhere_is_damaged(loose):
    archive = records.archive_of(loose, "part")
    records.pack(loose, "part", archive)
    whole = archive.read_bytes()
    for place in range(0, len(whole), 7):
        for damaged in (whole[:place], whole[:place] + bytes([whole[place] ^ 255]) + whole[place + 1:]):
            archive.write_bytes(damaged)
            with pytest.raises(StudyError, match="part.tar.xz"):
                records.read_part(loose, "part")


# The lab

class Set:
    """What a lab needs of a set."""
    facts = {"context": {"machine": "m1"}}
    registry = contenders = None

    def __init__(self, folder):
        self.folder, self.progress, self.scratch = folder, folder / ".progress", folder
        self.profile = type("Profile", (), {"parts": {"part": {"key": 3}}})

    def context(self, _):
        return self.facts["context"]

    def need_programs(self, _):
        pass


def cells(count, **more):
    return [replace(CELL, number=number, **more) for number in range(count)]


def test_what_has_a_record_is_never_run_again(mbs, tmp_path):
    runs = mbs('echo "{}"')
    first = Lab(Set(tmp_path), "part", "column")
    found = first.run(cells(6) + cells(2))
    assert runs() == 6 and [one.cell["number"] for one in found] == [0, 1, 2, 3, 4, 5, 0, 1]
    path = tmp_path / "raw" / "part" / found[3].name
    before = {one: one.stat().st_mtime_ns for one in (tmp_path / "raw").rglob("*.json")}
    path.unlink()
    second = Lab(Set(tmp_path), "part", "column")
    again = second.run(cells(6))
    assert runs() == 7 and sorted(second.names) == sorted(first.names) == sorted(set(first.names))
    assert [one.stat().st_mtime_ns for one in before if one != path] == [at for one, at in before.items() if one != path]
    assert [one.output for one in again] == [{}] * 6 and second.settings == {"key": 3}


def test_other_programs_are_not_said_to_be_built_as_mbs_is(mbs, tmp_path):
    mbs('echo "{}"')
    known = Set(tmp_path)
    known.facts = {"context": {"machine": "m1", "commit": "c1", "compiler": "gcc", "libraries": "KLU"}}
    (tmp_path / "other").symlink_to("mbs")  # which prints no context
    other = Cell("", program=os.path.relpath(tmp_path / "other", ROOT / "build"))
    lab = Lab(known, "part", "column")
    for record in (lab.one(other), lab.skip(replace(other, number=1), "unavailable", "not built")):
        assert record.context == {"machine": "m1", "commit": "c1"}
    assert lab.one(CELL).context == known.facts["context"]


def test_a_program_may_come_anew_but_not_change(mbs, tmp_path):
    mbs('echo "{}"')
    write_json(tmp_path / "set.json", FACTS)
    (tmp_path / ".scratch").mkdir()
    known = studyset.StudySet(tmp_path)
    write_json(tmp_path / "contexts" / "own-system.json", CONTEXT)
    Lab(known, "part", "column").run(cells(1))
    known.need_programs(["mbs", "study/engines/engine_that_is_not_built"])
    assert set(facts_of(tmp_path)["programs"]) == {"mbs"}
    mbs('echo "{}"; exit 0')
    Lab(studyset.StudySet(tmp_path), "part", "column").run(cells(1))  # has its record
    with pytest.raises(StudyError, match="something else .programs: mbs was built anew"):
        Lab(studyset.StudySet(tmp_path), "part", "column").run(cells(2))


def test_a_changed_record_stops_it(mbs, tmp_path):
    mbs('echo "{}"')
    [record] = Lab(Set(tmp_path), "part", "column").run(cells(1))
    path = tmp_path / "raw" / "part" / record.name
    path.write_text(path.read_text().replace('"seconds":', '"seconds":1'))
    with pytest.raises(StudyError, match=f"{path.name} is changed"):
        Lab(Set(tmp_path), "part", "column").run(cells(1))


def test_what_the_budget_has_no_room_for_has_a_record_that_says_so(mbs, tmp_path):
    runs = mbs('sleep 0.2; echo "{}"')
    lab = Lab(Set(tmp_path), "part", "column", 0.5)
    found = lab.run(cells(6, timed=True), drop=True)
    statuses = [one.status for one in found]
    done = statuses.count("done")
    assert statuses == ["done"] * done + ["dropped"] * (6 - done) and 1 <= done <= 3 and runs() == done
    assert "the budget of" in found[-1].reason and lab.left <= 0 and len(lab.names) == 6
    again = Lab(Set(tmp_path), "part", "column", 0.5)
    assert [one.status for one in again.run(cells(6, timed=True), drop=True)] == statuses and runs() == done
    assert again.left == pytest.approx(lab.left)


@pytest.mark.parametrize("text, free", [("echo 'mbs: cannot write x.json: No space left on device' >&2; exit 2", 2**30),
                                        ("echo 'mbs: odd' >&2; exit 2", 0), ("echo nothing", 0)])
def test_what_a_full_disk_ended_is_no_result(mbs, tmp_path, monkeypatch, text, free):
    mbs(text)
    monkeypatch.setattr(shutil, "disk_usage", lambda folder: SimpleNamespace(free=free))
    with pytest.raises(StudyError, match="no space is left on a disk.*nothing is kept of that run"):
        Lab(Set(tmp_path), "part", "column").run(cells(1))
    assert not list((tmp_path / "raw").rglob("*.json"))


@pytest.mark.parametrize("timed", [True, False])
def test_what_is_timed_stays_on_one_processor_and_says_how_it_was_disturbed(mbs, tmp_path, timed):
    mbs("""/usr/bin/python3 -c 'import os; print("{\\"free\\": %d}" % len(os.sched_getaffinity(0)))'""")
    [record] = Lab(Set(tmp_path), "part", "column").run(cells(1, timed=timed))
    assert record.output["free"] == (1 if timed else cores())
    assert set(record.machine) == ({"steal", "mhz", "cpu_s"} if timed else set())
    assert not timed or 0 < record.machine["cpu_s"] < record.seconds + 0.1


def test_a_program_that_is_not_built_is_unavailable(tmp_path):
    record = Lab(Set(tmp_path), "part", "column").one(replace(CELL, program="no_such_program"))
    assert (record.status, record.reason) == ("unavailable", "build/no_such_program is missing: study/setup builds it")


def test_the_count_of_cells_comes_to_its_end(mbs, tmp_path):
    mbs('sleep 0.2; echo "{}"')
    for _ in range(2):  # the second time all have records
        lab = Lab(Set(tmp_path), "part", "column", 0.1)
        lab.run(cells(3, timed=True), drop=True)
        lab.run(cells(2, timed=True))
        lab.skip(CELL, "excluded", "too slow")
        assert read_json(tmp_path / ".progress") == {"part": "part", "column": "column", "cells": "4 of 4 cells", "text": ""}


def test_untimed_cells_share_the_cores_and_timed_ones_have_the_machine(mbs, tmp_path):
    mbs(f'echo begin >> {tmp_path}/log; sleep 0.1; echo end >> {tmp_path}/log; echo "{{}}"')
    Lab(Set(tmp_path), "part", "timed").run(cells(3, timed=True))
    assert (tmp_path / "log").read_text().split() == ["begin", "end"] * 3
    lab = Lab(Set(tmp_path), "part", "others")
    records_of = lab.run(cells(4))
    seconds = [one.seconds for one in records_of]
    assert lab.spent == pytest.approx(max(4 * BETWEEN + sum(seconds) / cores(), *seconds))


def test_an_untimed_cell_that_is_alone_takes_its_whole_time_from_the_budget(mbs, tmp_path, monkeypatch):
    monkeypatch.setattr("study.core.lab.cores", lambda: 4)
    mbs('sleep 0.2; echo "{}"')
    for _ in range(2):  # the second time it has a record
        lab = Lab(Set(tmp_path), "part", "column")
        record = lab.one(CELL)
        assert lab.spent == pytest.approx(record.seconds)


def test_of_cells_that_end_at_once_each_is_taken_from_the_budget(mbs, tmp_path, monkeypatch):
    def slow():
        time.sleep(0.1)
        return 4
    monkeypatch.setattr("study.core.lab.cores", slow)
    mbs('echo "{}"')
    lab = Lab(Set(tmp_path), "part", "column")
    seconds = [one.seconds for one in lab.run(cells(8))]
    assert lab.spent == pytest.approx(max(8 * BETWEEN + sum(seconds) / 4, *seconds))


def test_a_skipped_cell_has_a_reason_and_stays(tmp_path):
    lab = Lab(Set(tmp_path), "part", "column")
    assert lab.skip(CELL, "excluded", "too slow").reason == "too slow"
    assert lab.skip(CELL, "excluded", "another one").reason == "too slow" and list(lab.names) == ["column/" + CELL.settled().file_name()]


def test_what_a_lab_does_is_told(tmp_path):
    lab = Lab(Set(tmp_path), "part", "column")
    lab.skip(CELL, "excluded", "too slow")
    lab.tell("words")
    assert read_json(tmp_path / ".progress") == {"part": "part", "column": "column", "cells": "1 of 1 cells", "text": "words"}
    assert [duration(one) for one in (5, 80, 7300)] == ["5 s", "1 min 20 s", "2 h 1 min"]


# Schemas and tables

COLUMNS = {"name": ("text", "", "who"), "x": ("number", "m", "where"), "good": ("flag", "", "whether")}


def test_tables_come_back_to_the_last_bit(tmp_path, monkeypatch):
    monkeypatch.setattr(schema, "of_part", lambda part: {"one": COLUMNS | {"record": ("text", "", "")}})
    values = numpy.random.default_rng(1).random(500) * 10.0 ** numpy.arange(-250, 250)
    frame = pandas.DataFrame({"x": [*values, math.inf, math.nan], "name": "a,b\n\"c\"", "record": "r"})
    written = schema.write_tables(tmp_path, "part", {"one": frame}, [])["one"]
    found = schema.read_table(tmp_path, "part", "one")
    assert list(found.columns) == ["name", "x", "good", "record"]
    assert (found.x[:501] == [*values, math.inf]).all() and math.isnan(found.x[501]) and found.good.isna().all()
    assert found.name.equals(written.name)


@pytest.mark.parametrize("frame, words", [
    ({"x": ["1", "two"]}, "x: could not convert string to float: 'two'"), ({"y": [1]}, "its schema does not know: y")])
def test_what_is_not_of_the_schema_is_refused(frame, words):
    with pytest.raises(StudyError, match=words):
        schema.conform(pandas.DataFrame(frame), COLUMNS, "one.csv")


def test_flags_and_texts():
    found = schema.conform(pandas.DataFrame({"good": [True, "False", numpy.bool_(True), None], "name": [1, None, "a", "b"]}),
                           COLUMNS, "one.csv")
    assert found.good.tolist()[:3] == [True, False, True] and found.good.isna().tolist() == [False] * 3 + [True]
    assert found.name.tolist()[1:] == ["", "a", "b"] and found.x.isna().all()


@pytest.mark.parametrize("part", list(parts()))
def test_schemas_of_all_parts_are_whole(part):
    for table, columns in schema.of_part(part).items():
        assert all(meaning for _, _, meaning in columns.values()), table
        assert all(name.isidentifier() for name in columns), table


def test_a_schema_without_records_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(schema, "ROOT", tmp_path)
    for columns in ("x: [number, m, where]", "record: [words, '', '']", "record: [text, '']"):
        write_text(tmp_path / "analysis" / "part" / "schema.yaml", f"one:\n  {columns}\n")
        with pytest.raises(StudyError, match="one: "):
            schema.of_part("part")


# Sets, profiles, files

CONTEXT = dict.fromkeys(("machine", "commit", "cpu_model", "kernel", "compiler", "flags"), "m1") | {"dirty": "false", "num_cpus": 2}
FACTS = {"profile": "quick", "only": [], "parts": ["map"], "programs": {}, "context": CONTEXT, "date": "today"}


@pytest.mark.parametrize("key", FACTS)
def test_a_set_of_another_shape_is_named(tmp_path, key):
    for changed in ({name: value for name, value in FACTS.items() if name != key}, FACTS | {key: 3}):
        write_json(tmp_path / "set.json", changed)
        with pytest.raises(StudyError, match=rf"set.json is damaged \({key} (is missing|must be of type)"):
            facts_of(tmp_path)


@pytest.mark.parametrize("parts, words", [(["foo"], "parts: 'foo' is none of"), ([1], "parts: 1 is none"),
                                          ([["map"]], "is none"), ([], "has no parts")])
@pytest.mark.parametrize("command", ["figures", "store", "merge", "add"])
def test_a_set_of_parts_that_are_none_is_named_before_anything_else(tmp_path, monkeypatch, capsys, command, parts, words):
    monkeypatch.setattr(child, "end_on_signals", lambda: None)
    write_json(tmp_path / "set.json", FACTS | {"parts": parts})
    folder = str(tmp_path)
    assert main.main({"merge": [command, folder, f"{folder}/.."], "add": [command, "klu", "--to", folder]}.get(command, [command, folder])) == 2
    told = capsys.readouterr()
    assert told.out == "" and "set.json" in told.err and words in told.err and told.err.count("\n") == 1


def without(*path):
    """Takes a value out of JSON or YAML: what is left is whole, but for that."""
    def change(content):
        data = yaml.safe_load(content)
        *outer, last = path
        del functools.reduce(lambda inner, key: inner[key], outer, data)[last]
        return json.dumps(data).encode()
    return change


BROKEN = {"empty": lambda content: b"", "a list": lambda content: b"[]", "a number": lambda content: b"3", "no UTF-8": lambda content: b"\xff\xfe" + content,
          "cut": lambda content: content[:len(content) // 9], "deep": lambda content: b"- " * 3000 if content.startswith(b"#") else b"[" * 3000}
DAMAGES = [*((file, name, change) for file in ("set.json", "registry.json", "profile.yaml", "contexts/own-system.json") for name, change in BROKEN.items()),
           *((file, f"without {path[-1]}", without(*path)) for file, path in (
               ("set.json", ("context",)), ("set.json", ("context", "commit")), ("registry.json", ("implementations",)),
               ("registry.json", ("implementations", 0, "variants", 1, "name")), ("profile.yaml", ("parts",)), ("profile.yaml", ("parts", "map")),
               ("profile.yaml", ("parts", "map", "seconds")), ("contexts/own-system.json", ("machine",)))),
           ("registry.json", "a context", lambda content: json.dumps(CONTEXT).encode()),
           ("registry.json", "terms", lambda content: content.replace(b'"kept"', b"3")), ("set.json", "names", lambda content: content.replace(b"[]", b"[3]")),
           ("profile.yaml", "a date", lambda content: content.replace(b"title: ", b"title: 2020-99-99 #"))]


@pytest.mark.parametrize("file, change", [pytest.param(file, change, id=f"{file}: {name}") for file, name, change in DAMAGES])
def test_a_damaged_set_is_one_line_and_nothing_is_written(tmp_path, monkeypatch, capsys, file, change):
    folder = tmp_path / "set"
    write_json(folder / "set.json", FACTS | {"profile": "smoke"})
    write_json(folder / "registry.json", REGISTRY.listed)
    write_json(folder / "contexts" / "own-system.json", CONTEXT)
    shutil.copyfile(profile.FOLDER / "smoke.yaml", folder / "profile.yaml")
    studyset.opened(folder)
    for where, name, stub in ((child, "end_on_signals", lambda: None), (main, "set_up", lambda log: None), (tempfile, "tempdir", TEMPORARY.name),
                              (studyset, "listed", lambda: REGISTRY), (studyset, "context_of", lambda one: CONTEXT)):
        monkeypatch.setattr(where, name, stub)
    (folder / file).write_bytes(change((folder / file).read_bytes()))
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    for command, *words in (["run", "--profile", "smoke", "--part", "map", "--wait", "--results"], ["figures"], ["store"], ["paper", "--claims"],
                            ["merge", "--to", tmp_path / "merged", tmp_path / "set"], ["add", "one", "--to"]):
        code, said = main.main([command, *map(str, words), str(folder)]), capsys.readouterr().err
        assert code == 2 and said.startswith(f"study/{command}: {folder / file} is damaged (") and MEND in said and said.count("\n") == 1, (command, said)
        assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file() and path.name != ".lock"} == before, command


@pytest.mark.parametrize("content", [b"", b"[]", b"3", b"\xff\xfe", b"[" * 100000, b'{"a": '])
def test_what_is_no_object_is_named(tmp_path, content):
    (tmp_path / "one.json").write_bytes(content)
    with pytest.raises(StudyError, match="one.json is damaged"):
        read_object(tmp_path / "one.json")


@pytest.mark.parametrize("text", ["", "3", "parts: 3", "parts: {map: }", "\0", "a: [", "parts: {other: {}}"])
def test_a_damaged_profile_of_a_set_is_named(tmp_path, text):
    (tmp_path / "profile.yaml").write_text(text)
    with pytest.raises(StudyError, match="profile.yaml is damaged"):
        View(tmp_path, "map").settings
    with pytest.raises(StudyError, match="profile.yaml"):
        profile.read(tmp_path / "profile.yaml", "one")


@pytest.mark.parametrize("name", profile.names())
def test_profiles_fit_their_plans_and_keep_to_their_budgets(name):
    found = profile.load(name)
    for part, settings in found.parts.items():
        columns = profile.plan_of(part).columns(settings)
        assert columns and sum(columns.values()) <= settings["seconds"] * 1.0001, part
        assert all(column.replace("-", "").replace("_", "").isalnum() for column in columns), part


@pytest.mark.parametrize("name, minutes", [("quick", 10), ("full", 100)])
def test_what_a_profile_takes_is_what_it_promises(name, minutes):
    assert profile.planned(profile.columns_of(profile.load(name), parts())) <= 60 * minutes


@pytest.mark.parametrize("change, words", [
    (lambda data: data.pop("title"), "title is missing"), (lambda data: data.update(parts=None), "parts must be of type dict"),
    (lambda data: data.update(blas=[]), "blas must be of type dict, is .]"), (lambda data: data.update(blas={}), "blas: all is missing"),
    (lambda data: data.update(more=1, other=2), "more is unknown, other is unknown"),
    (lambda data: data["parts"].update(stability=[]), "parts: stability must be of type dict"),
    (lambda data: data["parts"]["stability"].update(seconds="10"), "stability: seconds must be of type float, is '10'"),
    (lambda data: data["parts"]["stability"].update(seconds=float("inf")), "must be a number of at least 0"),
    (lambda data: data["parts"]["stability"].pop("loops"), "stability: loops is missing"), (lambda data: data.update(title=[1]), "title must be of type str"),
    (lambda data: data.update(blas={"all": [1]}), "blas: all must be of type str"),
    (lambda data: data["parts"]["stability"].update(powers=["1e-3"]), "powers: entry 1 must be of type float"),
    (lambda data: data["parts"]["stability"].update(whole={"penalty": 3}), "whole: penalty must be of type list")])
def test_a_wrong_profile_is_one_line(tmp_path, change, words):
    data = yaml.safe_load((profile.FOLDER / "smoke.yaml").read_text())
    change(data)
    (tmp_path / "one.yaml").write_text(yaml.safe_dump(data))
    with pytest.raises(StudyError, match=words):
        profile.read(tmp_path / "one.yaml", "one", ["stability"])


@pytest.mark.parametrize("content", [b"", b"\xff\xfe", b"a: [", b"a: 2020-99-99", b"!!bool foo", b"!!int ''", b"!!timestamp x"])
def test_a_damaged_profile_of_a_user_is_one_line(tmp_path, monkeypatch, capsys, content):
    monkeypatch.setattr(child, "end_on_signals", lambda: None)
    monkeypatch.setattr(profile, "FOLDER", tmp_path)
    (tmp_path / "mine.yaml").write_bytes(content)
    for words in (["--profile", "mine", "--dry-run"], ["--profile", "mine", "--results", str(tmp_path / "new")], ["--list"]):
        code, told = main.main(["run", *words]), capsys.readouterr()
        assert code == 2 and told.err.startswith(f"study/run: {tmp_path / 'mine.yaml'} is damaged (") and told.err.count("\n") == 1, told
        assert profile.MENDED in told.err and [*tmp_path.iterdir()] == [tmp_path / "mine.yaml"]


def test_only_a_set_or_what_became_none_is_continued(tmp_path):
    own = tmp_path / "own"
    for theirs in ("notes.txt", "profile.yaml", ".scratch", "raw"):
        folder = tmp_path / theirs
        (folder / theirs).mkdir(parents=True)
        with pytest.raises(StudyError, match="is not empty and holds no set .no set.json.: name another"):
            studyset.need_own(folder)
        studyset.need_own(own)  # it may be missing, empty, or begun by a run that was killed
        own.mkdir(exist_ok=True)
    for name in (".partial-1-set.json", ".lock", "run.log", ".scratch", "registry.json", "profile.yaml"):
        (own / name).touch()
        studyset.need_own(own)
    (own / "notes.txt").touch()
    with pytest.raises(StudyError, match="is not empty"):
        studyset.need_own(own)
    (own / "set.json").touch()
    studyset.need_own(own)


def test_only_the_folders_of_a_set_are_cleared(tmp_path):
    names = [f"{folder}/.partial-1-x" for folder in (".", "raw/map/c", "contexts", ".done/map", "map/figures", "theirs")]
    for name in names:
        write_text(tmp_path / name, "")
    studyset.StudySet(tmp_path).clear()
    assert [name for name in names if (tmp_path / name).exists()] == ["theirs/.partial-1-x"]


@pytest.mark.parametrize("command", [["run", "--profile", "smoke"], ["advise", "four-bar:2", "--error", "1"],
                                     ["advise", "--validate"], ["against", "HEAD"]])
def test_a_folder_of_a_user_is_left_alone(tmp_path, command):
    (tmp_path / "notes.txt").write_text("mine")
    done = study(*command, "--results", tmp_path, program=FAKE)
    assert done.returncode == 2 and "is not empty" in done.stderr and done.stderr.count("\n") == 1, done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["notes.txt"]


@pytest.mark.parametrize("command", [["run", "--profile", "smoke"], ["against", "HEAD"]])
def test_of_a_set_that_does_not_begin_nothing_is_left(tmp_path, command):
    command = [*command, "--only", "nope", "--wait", "--results"]
    done = study(*command, tmp_path / "new", program=FAKE)
    assert done.returncode == 2 and "unknown implementation 'nope'" in done.stderr and not (tmp_path / "new").exists(), done.stderr
    write_json(tmp_path / "set.json", FACTS)
    assert study(*command, tmp_path, program=FAKE).returncode == 2 and (tmp_path / "set.json").exists()


def test_the_workflow_runs_in_a_folder_of_any_name(tmp_path):
    folder = tmp_path / "a: b"
    write_json(folder / ".parts.json", ["stability"])
    command = front.snakemake(studyset.StudySet(folder), ROOT / "study" / "Snakefile", "--cores", "all", "--dry-run")
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0 and ".done/stability.page" in done.stdout + done.stderr, done.stderr


def test_a_column_is_opened_again_only_where_a_record_is_missing(tmp_path):
    known = studyset.StudySet(tmp_path)
    for column in ("a", "b"):
        records.write(tmp_path / "raw" / "part" / column / "one.json", FIELDS)
        studyset.finish(known, "part", column, [f"{column}/one.json"])
    (tmp_path / "part.html").write_text("page")
    studyset.reopen(known, {"part": {"a": 1.0, "b": 1.0}})
    assert known.stamp("part", "a").exists() and (tmp_path / "part.html").exists()
    (tmp_path / "raw" / "part" / "b" / "one.json").unlink()
    with pytest.raises(StudyError, match="one.json is missing"):
        studyset.need_records(known)
    studyset.reopen(known, {"part": {"a": 1.0, "b": 1.0}})
    assert known.stamp("part", "a").exists() and not known.stamp("part", "b").exists()
    assert not (tmp_path / "part.html").exists()  # or nothing would be run
    records.write(tmp_path / "raw" / "part" / "a" / "one.json", FIELDS | {"seconds": 9.0})
    for check in (studyset.need_records, lambda one: studyset.reopen(one, {"part": {"a": 1.0}})):
        with pytest.raises(StudyError, match="is not the one that was measured"):
            check(known)


def test_a_stamp_that_is_being_written_is_none(tmp_path):
    known = studyset.StudySet(tmp_path)
    records.write(tmp_path / "raw" / "part" / "a" / "one.json", FIELDS)
    studyset.finish(known, "part", "a", ["a/one.json"])
    write_text(tmp_path / ".done" / "part" / ".partial-node-1-2-b", '{"b/')  # by another node, or one that was lost
    studyset.need_records(known)


def test_a_column_is_opened_again_where_a_program_was_missing_and_is_there_now(tmp_path, monkeypatch):
    monkeypatch.setattr(studyset, "ROOT", tmp_path)
    known, program = studyset.StudySet(tmp_path / "set"), tmp_path / "build" / "engine"
    for name, status in (("absent", "unavailable"), ("other", "done")):
        cell = FIELDS["cell"] | {"program": "engine"}
        records.write(known.folder / "raw" / "part" / "a" / f"{name}.json", FIELDS | {"cell": cell, "status": status})
    studyset.finish(known, "part", "a", ["a/absent.json", "a/other.json"])
    studyset.reopen(known, {"part": {"a": 1.0}})
    assert known.stamp("part", "a").exists()
    write_text(program, "")
    studyset.reopen(known, {"part": {"a": 1.0}})
    assert not known.stamp("part", "a").exists()
    assert [path.name for path in (known.folder / "raw" / "part" / "a").iterdir()] == ["other.json"]


def test_a_dry_run_has_the_time_of_a_part_whose_programs_are_there_now(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(studyset, "ROOT", tmp_path)
    known, chosen = studyset.StudySet(tmp_path / "set"), profile.load("smoke", ["engines"])
    [columns] = profile.columns_of(chosen, ["engines"]).values()
    for column in columns:
        cell = FIELDS["cell"] | {"program": "study/engines/engine_ode"}
        records.write(known.folder / "raw" / "engines" / column / "one.json", FIELDS | {"cell": cell, "status": "unavailable"})
        studyset.finish(known, "engines", column, [f"{column}/one.json"])
    main.dry_run(chosen, ["engines"], known.folder, [], None)
    assert "engines    done: " in capsys.readouterr().out
    write_text(tmp_path / "build" / "study" / "engines" / "engine_ode", "")
    main.dry_run(chosen, ["engines"], known.folder, [], None)
    assert f"engines    at most {duration(profile.planned({'engines': columns}))}: " in capsys.readouterr().out


def test_only_parts_that_are_asked_for_are_run_in_a_set_that_has_others(tmp_path, monkeypatch):
    ran = []
    monkeypatch.setattr(tempfile, "tempdir", TEMPORARY.name)
    write_json(tmp_path / "set.json", FACTS | {"profile": "smoke", "parts": ["map", "limit"]})
    write_json(tmp_path / "registry.json", REGISTRY.listed)
    shutil.copyfile(profile.FOLDER / "smoke.yaml", tmp_path / "profile.yaml")
    monkeypatch.setattr(main, "set_up", lambda log: None)
    monkeypatch.setattr(main, "start", lambda folder, *_: studyset.StudySet(folder))
    monkeypatch.setattr(main, "run_workflow", lambda known, columns: ran.extend(columns))
    main._run_here(profile.load("smoke", ["map"]), [], ["map"], tmp_path, True)
    assert ran == ["map"]


def test_the_time_that_is_planned_has_what_is_around_each_part_that_runs():
    around = profile.planned({"one": {"a": 10.0, "b": 20.0}, "two": {"c": 1.0}, "done": {}}) - 31.0
    assert around == pytest.approx(2 * profile.STARTED + profile.DRAWN * 31.0) and around > 0


@pytest.mark.parametrize("damage", [Path.unlink, lambda path: path.write_text("")])
def test_a_page_that_is_missing_or_empty_is_drawn_again(tmp_path, damage):
    known = studyset.StudySet(tmp_path)
    for name in (".done/one.page", ".done/two.page", "one.html", "two.html", "index.html"):
        write_text(tmp_path / name, "page")
    studyset.reopen(known, {"one": {}, "two": {}})
    assert known.page("one").exists() and known.page("two").exists() and (tmp_path / "index.html").exists()
    damage(tmp_path / "one.html")
    studyset.reopen(known, {"one": {}, "two": {}})
    assert not known.page("one").exists() and known.page("two").exists()
    damage(tmp_path / "index.html")  # which is drawn with each part
    studyset.reopen(known, {"one": {}, "two": {}})
    assert not known.page("two").exists()


def test_a_further_page_is_drawn_again_only_with_a_part_that_it_is_made_of(tmp_path):
    context = {"commit": "0" * 40, "dirty": False, "cpu_model": "P", "num_cpus": 1, "compiler": "", "flags": "", "kernel": "", "machine": ""}
    write_json(tmp_path / "set.json", {"profile": "quick", "only": [], "parts": ["map"], "programs": {}, "context": context, "date": ""})
    write_json(tmp_path / "registry.json", {"implementations": []})
    drawn = []
    for part in (None, "tuning", "map", "tuning"):
        site.write_index(tmp_path, part)
        drawn.append(((tmp_path / "explore.html").stat().st_mtime_ns, (tmp_path / "index.html").stat().st_mtime_ns))
    pages, fronts = zip(*drawn)
    assert pages[0] == pages[1] < pages[2] == pages[3] and len(set(fronts)) == 4
    write_json(tmp_path / ".explore.json", [{"case": "the case", "state": "n=1", "take": "one/a"}])  # of a set with few mechanisms
    site.write_index(tmp_path, "tuning")
    front = (tmp_path / "index.html").read_text()
    assert "the case" in front and "Three questions" not in front


REGISTRY = Registry({"implementations": [
    {"library": "", "version": "1", "licence": "MIT", "reason": ""} | one for one in (
        {"folder": "one", "available": True, "library": "Lib", "variants": [
            {"name": "one/a", "description": ""}, {"name": "one/b", "description": "", "dense": True}]},
        {"folder": "own", "available": True, "library": "none", "variants": [{"name": "own/c", "description": "", "settings": ["kept"]}]},
        {"folder": "gone", "available": False, "reason": "not installed", "variants": []})],
    "blas": [{"name": "openblas", "available": True, "reason": ""}, {"name": "atlas", "available": False, "reason": "missing"}]})


def test_selections():
    assert studyset.select(REGISTRY, []) == ["one/a", "one/b", "own/c"]
    assert studyset.select(REGISTRY, ["own", "one/b"]) == ["one/b", "own/c"]
    for only, words in (["gone", "gone is unavailable: not installed"], ["nobody", "unknown implementation"], ["one/x", "unknown"]):
        with pytest.raises(StudyError, match=words):
            studyset.select(REGISTRY, [only])
    assert REGISTRY.own == {"own/c"} and REGISTRY.libraries == ["one/a", "one/b"] and REGISTRY.dense == {"one/b"}
    assert REGISTRY.serves("own/c", "kept", "penalty") and not REGISTRY.serves("one/a", "kept")
    assert [*REGISTRY.coverage.items()] == [(("kept",), ["own/c"]), ((), ["one/a", "one/b"])]
    pairs = {"all": "openblas", "own": "atlas"}
    assert [one.blas for one in on_usual_pairs(REGISTRY, pairs, ["one/a", "own/c"])] == ["openblas", "system"]


def test_contenders_of_an_environment_are_together_in_their_order():
    other = Contender("three/c", "three/c", "openblas", "gcc-O2")
    assert by_environment([TWO, ONE, other, replace(ONE, name="one/b")]) == {
        "own|openblas": (TWO,), "own|system": (ONE, replace(ONE, name="one/b")), "gcc-O2|openblas": (other,)}
    assert by_environment([]) == {}


def test_files_are_seen_whole_or_not_at_all(tmp_path):
    path = tmp_path / "one.json"
    write_json(path, {"a": 1})
    with pytest.raises(TypeError):
        write_json(path, {"a": object()})
    (tmp_path / "folder").mkdir()
    with pytest.raises(StudyError, match="cannot write .*folder"):
        write_text(tmp_path / "folder", "text")
    assert sorted(one.name for one in tmp_path.iterdir()) == ["folder", "one.json"] and read_object(path) == {"a": 1}
    assert digest(path) == digest(path.read_text()) == digest(path.read_bytes())
    with pytest.raises(StudyError, match="cannot read .*nothing"):
        digest(Path(tmp_path / "nothing"))


def test_a_figure_that_is_cut_short_leaves_what_a_set_removes(tmp_path):
    def killed(partial, **_):
        written.append(partial.name)
        partial.write_text("half")
        raise KeyboardInterrupt
    written, figure = [], plt.figure()
    figure.savefig = killed
    with pytest.raises(KeyboardInterrupt):
        save(figure, tmp_path / "one.svg")
    assert fnmatch.fnmatch(written[0], ".partial-*") and not any(tmp_path.iterdir())


def test_threads_that_write_one_file_at_once_do_not_disturb_each_other(tmp_path):
    wrong = []

    def often(number):
        try:
            for _ in range(100):
                write_json(tmp_path / "one.json", {"number": number})
        except StudyError as error:
            wrong.append(error)
    threads = [threading.Thread(target=often, args=(number,)) for number in range(4)]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    assert wrong == [] and set(read_object(tmp_path / "one.json")) == {"number"}


def test_locks_are_held_once_and_waited_for(tmp_path, monkeypatch):
    monkeypatch.setattr(locks, "MACHINE", tmp_path)
    monkeypatch.setattr(locks, "POLL", 0.02)
    monkeypatch.setattr(os, "getloadavg", lambda: (0.1, 0, 0))
    with locks.only_one_study():
        for most in ({}, {"wait": True, "most": 0.1}):
            with pytest.raises(StudyError, match="queue with --wait"), locks.only_one_study(**most, tell=str):
                pass
        told, order = [], []

        def queue():
            with locks.only_one_study(wait=True, tell=told.append):
                order.append("second")
        thread = threading.Thread(target=queue)
        thread.start()
        time.sleep(0.2)
        order.append("first")
    thread.join(timeout=10)
    assert order == ["first", "second"] and told == ["waiting until another study is done"]


def test_locks_of_the_machine_are_where_no_job_moves_them(tmp_path):
    where = [environment(TMPDIR=str(tmp_path), **more) for more in ({}, {"MBS_LOCKS": "/elsewhere"})]
    del where[0]["MBS_LOCKS"]
    said = [subprocess.run(["/usr/bin/python3", "-c", "from study.core import locks; print(locks.MACHINE)"], cwd=ROOT, env=one, text=True,
                           capture_output=True, check=True).stdout for one in where]
    assert said == ["/tmp\n", "/elsewhere\n"]


def test_a_file_system_without_locks_is_not_taken_for_another_study(tmp_path, monkeypatch):
    def none(file, how):
        raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))
    monkeypatch.setattr(locks, "MACHINE", tmp_path)
    monkeypatch.setattr(locks.fcntl, "flock", none)
    with pytest.raises(StudyError, match="cannot lock .*: No locks available"), locks.only_one_study():
        pass


def test_a_busy_machine_is_said_when_a_study_begins(tmp_path, monkeypatch):
    monkeypatch.setattr(locks, "MACHINE", tmp_path)
    monkeypatch.setattr(locks, "OTHERS", 0.5)  # of two processors
    for load, said in ((0.1, []), (1.7, ["the machine is busy (load 1.7 over the last minute): times may be too long"])):
        monkeypatch.setattr(os, "getloadavg", lambda load=load: (load, 0, 0))
        told = []
        with locks.only_one_study(tell=told.append):
            assert told == said


@pytest.mark.parametrize("command", [["run", "--results", ""], ["figures", ""], ["store", ""], ["add", "klu", "--to", ""],
                                     ["advise", "--results", ""], ["against", "HEAD", "--results", ""], ["merge", "", ""]])
def test_an_empty_name_stands_for_no_default(command, capsys, monkeypatch):
    monkeypatch.setattr(child, "end_on_signals", lambda: None)
    assert main.main(command) == 2
    assert "an empty name is no directory" in capsys.readouterr().err


def test_numbers_and_bad_options_are_plain():
    assert [number(one) for one in (None, math.nan, 1234567.0, 1.2345e-5, 3.14159)] == [
        "–", "–", "1.23·10⁶", "1.23·10⁻⁵", "3.14"]
    with pytest.raises(StudyError, match=r"unrecognized arguments: --fast \(see study/x --help\)"):
        Parser(prog="study/x").parse_args(["--fast"])
    assert positive("1e-3") == 1e-3
    for text in ("0", "-1", "nan", "inf"):
        with pytest.raises(Exception, match="positive number"):
            positive(text)


def test_a_record_in_json_is_what_others_can_read(tmp_path):
    records.write(tmp_path / "one.json", FIELDS)
    data = json.loads((tmp_path / "one.json").read_text())
    assert set(data) == {"sha256", "record"} and data["record"] == json.loads(json.dumps(FIELDS))
