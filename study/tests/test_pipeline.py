# The whole workflow on a fake `mbs`: failures are kept as data, runs resume, nothing is merged.
import fcntl
import json
import os
import signal
import subprocess
import time

import pandas
import pytest
import yaml

from study.pipeline import builds, child, collect, prepare, profile as profiles, refine
from study.pipeline.job import open_study
from study.pipeline.layout import Layout
from study.pipeline.marks import mark_differing_passes
from study.pipeline.measure import measure
from study.pipeline.verify import verify
from study.tests.conftest import FAKE, ROOT, environment, study


def tidy(results):
    return pandas.read_csv(results / "tidy.csv")


def run_smoke(results, *more, **variables):
    return study("run", "--profile", "smoke", "--results", results, *more, **variables)


def times(results):
    return {path: path.stat().st_mtime_ns for path in (results / "raw").rglob("*.json")}


def test_a_run_leaves_everything(pristine):
    table = tidy(pristine)
    samples = table[(table.status == "ok") & (table.kind == "timing") & (table.stage == "grid")]
    # 3 variants and the null control at n = 4; 3 variants x 2 reached fills and null at n = 10
    assert len(samples) == (3 + 1 + 2 * 3 + 1) * 2 * 2
    assert set(table.status) == {"ok", "not-reached", "unavailable"}
    assert all((pristine / name).exists() for name in
               ("report.html", "figures/f7_map.svg", "figures/f4_sparse_solvers.png",
                "accuracy.csv", "claims.csv"))
    assert not list(pristine.rglob("*.partial"))


def test_second_run_does_nothing(results):
    before = times(results)
    done = run_smoke(results)
    assert done.returncode == 0 and "report: " in done.stdout and "verify" not in done.stdout
    assert times(results) == before


def test_resume_makes_only_what_is_missing(results):
    before = times(results)
    lost = next(results.glob("raw/n0010/round2/good_sparse*"))
    lost.unlink()
    assert run_smoke(results).returncode == 0
    after = times(results)
    assert set(after) == set(before)
    assert [path for path in after if after[path] != before[path]] == [lost]


def test_misbehaviour_is_kept_as_data(tmp_path, monkeypatch):
    smoke = yaml.safe_load((profiles.FOLDER / "smoke.yaml").read_text())
    smoke["limits"].update(pilot_seconds=1, cell_seconds=1, check_seconds=1)
    (tmp_path / "smoke.yaml").write_text(yaml.safe_dump(smoke))
    monkeypatch.setattr(profiles, "FOLDER", tmp_path)
    monkeypatch.setenv("MBS_PROGRAM", str(FAKE))
    monkeypatch.setenv("FAKE_BAD", "1")
    results = tmp_path / "results"
    prepare.start(Layout(results), profiles.load("smoke"), [])
    opened = open_study(results)
    for variables in opened.profile.columns:
        verify(opened, variables)
        measure(opened, variables)
    assert study("figures", results).returncode == 0
    table = tidy(results)
    found = table[table.variables.notna()].groupby("implementation").status.unique().map(set)
    assert found["bad/crash"] == {"crashed"} and found["bad/hang"] == {"timeout"}
    assert found["bad/memory"] == {"out-of-memory"} and found["bad/wrong"] == {"disagrees"}
    assert found["bad/large"] == {"out-of-memory"} and found["bad/crawl"] == {"excluded"}
    assert found["bad/slow"] == {"excluded"} and found["bad/passes"] == {"passes-differ"}
    assert found["bad/nan"] == {"disagrees"} and found["good_dense/first"] == {"ok"}
    reasons = table[table.status != "ok"].reason
    assert reasons.str.contains("SIGSEGV").any() and reasons.str.contains("q differs by").any()
    slow = table[table.implementation == "bad/slow"]
    tried = ~slow.reason.str.startswith("not tried: at n = 4 ")
    assert (slow.pilot_ratio[tried] > 1000).all() and slow.step_us.isna().all()
    assert list(slow.scene[~tried]) == ["four-bar:4"]  # natural fill at the next size
    crawl = table[(table.implementation == "bad/crawl") & table.pilot_ratio.notna()]
    assert (crawl.pilot_ratio > 1000).all() and len(crawl) > 1
    assert crawl.reason.str.contains("its pilot did not end within 1 s").all()
    assert table.fill_seed.notna().any() and table[table.fill_asked.isna()].fill_seed.isna().all()
    page = (results / "report.html").read_text()
    assert "SIGSEGV" in page and "times slower" in page and "NaN at step 100" in page


def test_a_killed_child_loses_its_cell_only(results):
    path = next(results.glob("raw/n0010/round1/good_dense.first@natural*"))
    context = json.loads(path.read_text())["context"]
    ended = child.run(["/bin/sh", "-c", "kill -KILL $$"], 5, 512)
    path.write_text(json.dumps({"context": context, "benchmarks": [],
                                "failure": {"status": ended.status, "reason": ended.reason}}))
    assert study("figures", results).returncode == 0
    table = tidy(results)
    lost = table[(table.status == "crashed")]
    assert set(lost.implementation) == {"good_dense/first"} and set(lost.scene) == {"four-bar:4"}
    # The samples of its other process stay visible, but the cell may not be ranked any more.
    assert lost.reason.str.contains("SIGKILL").all()
    assert lost[lost.stage == "grid"].step_us.notna().sum() == 2 + 2 * (lost.kind == "phases").any()
    assert (table[table.status == "ok"].groupby("scene").implementation.nunique() > 1).all()


def test_mixed_machines_are_refused(results):
    path = next(results.glob("raw/n0004/round1/good_sparse*"))
    raw = json.loads(path.read_text())
    raw["context"]["machine"] = "another"
    path.write_text(json.dumps(raw))
    done = study("figures", results)
    assert done.returncode == 2 and "another machine or build" in done.stderr
    assert path.name in done.stderr and done.stderr.count("\n") == 1


@pytest.mark.parametrize("damage", ["{", "", "\x00\x01"])
def test_a_corrupted_raw_file_is_named(results, damage):
    path = next(results.glob("raw/n0004/round1/good_sparse*"))
    path.write_text(damage)
    done = study("figures", results)
    assert done.returncode == 2 and f"{path} is damaged" in done.stderr


def test_another_build_does_not_continue_old_results(results):
    done = run_smoke(results, FAKE_COMMIT="fff0000")
    assert done.returncode == 2 and "results are never merged" in done.stderr
    assert "commit 'abc1234', now 'fff0000'" in done.stderr


def test_ctrl_c_leaves_complete_files_and_says_how_to_resume(tmp_path):
    results = tmp_path / "results"
    command = [ROOT / "study/run", "--profile", "smoke", "--results", results]
    process = subprocess.Popen(command, env=environment(), stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True,
                               # a parent may ignore it (nohup); a terminal's shell does not
                               preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    while not list(results.glob("raw/*/pilot/*.json")):
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=30)
    assert process.returncode == 130
    assert f"study/run --profile smoke --results {results}" in errors
    for path in (results / "raw").rglob("*.json*"):
        assert path.suffix == ".json" and json.loads(path.read_text())
    assert run_smoke(results).returncode == 0


@pytest.mark.parametrize("arguments, message", [
    (["--profile", "huge"], "unknown profile 'huge'; known: map, paper, quick, smoke"),
    (["--profile", "smoke", "--only", "nobody"], "unknown implementation 'nobody'; known: good_"),
    (["--profile", "smoke", "--only", "absent"], "absent: unavailable: Foo is not installed"),
    (["--fast"], "unrecognized arguments: --fast"),
])
def test_bad_arguments(tmp_path, arguments, message):
    done = study("run", "--results", tmp_path / "r", *arguments)
    assert done.returncode == 2 and message in done.stderr and done.stderr.count("\n") == 1


def test_unwritable_results(tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("")
    done = run_smoke(blocked / "results")
    assert done.returncode == 2 and "cannot write to" in done.stderr


def test_missing_build_and_missing_results(tmp_path):
    done = study("run", "--profile", "smoke", "--results", tmp_path, MBS_PROGRAM="/none/mbs")
    assert done.returncode == 2 and "/none/mbs is missing: build it with study/setup" in done.stderr
    done = study("figures", tmp_path / "nothing")
    assert done.returncode == 2 and "holds no results" in done.stderr


def test_dry_run_and_list_touch_nothing(tmp_path):
    done = study("run", "--dry-run", "--results", tmp_path / "new")
    assert done.returncode == 0 and "estimated: " in done.stdout and "n =  160" in done.stdout
    assert not (tmp_path / "new").exists()
    done = study("run", "--list")
    assert "quick" in done.stdout and "good_sparse/only" in done.stdout
    assert "absent" in done.stdout and "Foo is not installed" in done.stdout


def test_only_selects(tmp_path):
    assert run_smoke(tmp_path, "--only", "good_sparse").returncode == 0
    assert set(tidy(tmp_path).implementation.dropna()) == {"good_sparse/only", "null/null"}


def test_figures_work_from_tables_alone(results):
    subprocess.run(["rm", "-r", results / "raw", results / "report.html"], check=True)
    assert study("figures", results).returncode == 0
    assert (results / "report.html").exists()


def row(name, passes):
    return {"kind": "timing", "status": "ok", "scene": "s", "implementation": name,
            "passes": passes}


@pytest.mark.parametrize("passes, accused", [
    ({"a/x": [7, 7], "b/x": [7, 7], "c/x": [8, 8]}, {"c/x"}),
    ({"a/x": [7, 7], "b/x": [8, 8]}, {"a/x", "b/x"}),           # a tie: nobody can be trusted
    ({"a/x": [7, 8], "b/x": [7, 7], "c/x": [7, 7]}, {"a/x"}),   # not even itself
    ({"a/x": [7, 7]}, set()),
])
def test_passes_must_agree(passes, accused):
    rows = [row(name, value) for name, values in passes.items() for value in values]
    mark_differing_passes(rows)
    assert {r["implementation"] for r in rows if r["status"] == "passes-differ"} == accused


def test_two_studies_never_measure_at_once(tmp_path):
    with open(tmp_path / "mbs-study.lock", "w") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        done = run_smoke(tmp_path / "results", TMPDIR=str(tmp_path))
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert "another study is measuring on this machine" in done.stderr
    assert run_smoke(tmp_path / "results", "--only", "good_sparse",
                     TMPDIR=str(tmp_path)).returncode == 0


@pytest.mark.parametrize("text", ["{}", "[]", "null", '{"profile": "smoke"}'])
def test_a_run_record_that_lacks_something_is_one_clear_line(tmp_path, text):
    (tmp_path / "run.json").write_text(text)
    result = study("figures", tmp_path)
    assert result.returncode != 0
    assert result.stderr.count("\n") == 1 and "is no record of a run" in result.stderr


CELL = {"kind": "cell", "variables": 10, "fill": 0.7, "why": "the winner changes"}
SAMPLES = {"kind": "samples", "scene": "four-bar:4", "variables": 10, "fill": None,
           "implementations": ["good_dense/first", "good_sparse/only"], "why": "undecided"}


def refined_rows(results, monkeypatch, *answers):
    """Runs the refinement on candidates of the test's own; its rows, and what it recorded."""
    monkeypatch.setenv("MBS_PROGRAM", str(FAKE))
    text = (results / "profile.yaml").read_text()
    (results / "profile.yaml").write_text(text.replace("refine: {seconds: 1,",
                                                       "refine: {seconds: 1000,"))
    looks = iter(answers)
    monkeypatch.setattr(refine, "refinement_candidates", lambda *_: next(looks, []))
    refine.refine(open_study(results))
    collect.collect(open_study(results))
    table = tidy(results)
    record = json.loads((results / "plans" / "refined.json").read_text())
    return table[(table.stage == "refined") & (table.status == "ok")], record


def test_refinement_adds_cells_and_rounds(results, monkeypatch):
    (results / "plans" / "refined.json").unlink()
    rows, record = refined_rows(results, monkeypatch, [CELL, SAMPLES], [SAMPLES])
    assert [entry["kind"] for entry in record["added"]] == ["cell", "samples", "samples"]
    assert [entry["rounds"] for entry in record["added"]] == [[1, 2], [3, 4], [5, 6]]
    cell = rows[rows.fill_asked == 0.7]
    assert set(cell.implementation) == {"good_dense/first", "good_dense/second", "good_sparse/only"}
    again = rows[rows.fill_asked.isna()]
    assert set(again.implementation) == set(SAMPLES["implementations"])
    assert set(again["round"]) == {3, 4, 5, 6} and record["seconds"] > 0


def test_an_interrupted_refinement_is_finished_first(results, monkeypatch):
    path = results / "plans" / "refined.json"
    path.write_text(json.dumps({"seconds": 0.0, "added": [], "next": CELL}))
    _, record = refined_rows(results, monkeypatch, [])
    assert [entry["kind"] for entry in record["added"]] == ["cell"] and "next" not in record
    path.write_text(json.dumps(record | {"seconds": 1e9}))  # the budget is spent
    before = times(results)
    _, record = refined_rows(results, monkeypatch, [SAMPLES])
    assert len(record["added"]) == 1 and times(results) == before


def test_missing_pairs_are_rows_with_their_reason(tmp_path, monkeypatch):
    text = (profiles.FOLDER / "smoke.yaml").read_text()
    text = text.replace("[armadillo_dense]", "[good_sparse]").replace(
        "blas: [reference, openblas-reference]", "blas: [reference, atlas]")
    (tmp_path / "smoke.yaml").write_text(text)
    monkeypatch.setattr(profiles, "FOLDER", tmp_path)
    monkeypatch.setenv("MBS_PROGRAM", str(FAKE))
    results = tmp_path / "results"
    prepare.start(Layout(results), profiles.load("smoke"), [])
    opened = open_study(results)
    for variables in opened.profile.columns:
        verify(opened, variables)
        measure(opened, variables)
    assert study("figures", results).returncode == 0
    table = tidy(results)
    pair = table[table.implementation == "good_sparse/only+reference"]
    assert set(pair.blas) == {"reference"} and set(pair.variables) == {10}
    assert pair.fill_asked.isna().all() and set(pair.status) == {"ok"}
    missing = table[table.implementation == "good_sparse/only+atlas"]
    assert list(missing.status) == ["unavailable"]
    assert list(missing.reason) == ["libatlas3-base is not installed"]
    operations = table[table.kind == "operations"]
    assert set(operations.implementation) == {"good_sparse/only"}
    assert (operations.operation_us > 0).all() and operations.step_us.isna().all()


def test_a_build_that_fails_says_why(monkeypatch, tmp_path):
    monkeypatch.setattr(builds, "BUILDS", {"bad": ("no-such-compiler", "gcc", "-O1")})
    monkeypatch.setattr(builds, "program", lambda name: str(tmp_path / name / "mbs"))
    with open(tmp_path / "log", "w") as log:
        reason = builds.build("bad", log, lambda line: None)
    assert reason.startswith("the build with no-such-compiler -O1 failed: ")


def test_two_runs_are_compared(results, tmp_path):
    figure = tmp_path / "comparison.png"
    done = study("compare", results, results, "--output", figure)
    assert done.returncode == 0 and "of them with the same winner" in done.stdout
    assert figure.stat().st_size > 1000
    done = study("compare", results, tmp_path / "none")
    assert done.returncode == 1 and done.stderr.count("\n") == 1 and "none" in done.stderr
