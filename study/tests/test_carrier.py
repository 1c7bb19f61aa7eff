# What studies share: tables that were changed, runs that are refused, damaged or interrupted, bad options.
import shlex
import signal
import subprocess
import time

import pandas
import pytest

from study.pipeline import child, progress, runs
from study.pipeline.errors import StudyError
from study.pipeline.layout import need_unchanged, write_csv, write_json
from study.pipeline.options import Parser, need_steps
from study.stability_study.main import stability
from study.tests.conftest import FAKE, ROOT, environment


def test_a_changed_or_missing_table_is_named(tmp_path):
    need_unchanged(tmp_path)  # nothing was written by a study
    for name in ("one", "two"):
        write_csv(tmp_path / f"{name}.csv", pandas.DataFrame({"x": [1, 2, 3]}))
    need_unchanged(tmp_path)
    whole = (tmp_path / "two.csv").read_bytes()
    (tmp_path / "two.csv").write_bytes(whole[:-3])
    with pytest.raises(StudyError, match="two.csv is not as it was written"):
        need_unchanged(tmp_path)
    (tmp_path / "two.csv").write_bytes(whole)
    (tmp_path / "one.csv").unlink()
    with pytest.raises(StudyError, match="one.csv is missing"):
        need_unchanged(tmp_path)


def test_a_cut_table_is_not_drawn_from(tmp_path, monkeypatch):
    monkeypatch.setenv("MBS_PROGRAM", str(FAKE))
    arguments = ["--loops", "1", "--steps", "1e-3", "--penalties", "1e3", "--implementation",
                 "good_sparse/only", "--results", str(tmp_path)]
    stability(arguments)
    page, table = (tmp_path / "stability.html").read_bytes(), tmp_path / "stability.csv"
    table.write_bytes(table.read_bytes()[:-20])
    with pytest.raises(StudyError, match="stability.csv is not as it was written"):
        stability([*arguments, "--stored"])
    assert (tmp_path / "stability.html").read_bytes() == page
    stability(arguments)  # from raw/
    stability([*arguments, "--stored"])


def test_what_cannot_be_written_is_said(tmp_path):
    (tmp_path / "advice.json").mkdir()
    with pytest.raises(StudyError, match="cannot write .*advice.json"):
        write_json(tmp_path / "advice.json", {})
    assert not list(tmp_path.glob("*.partial"))


@pytest.mark.parametrize("damage", ["{\"a\": 1}", "[]", "{\"summary\": 3}", "{\"failure\": {\"status\": 1}}"])
def test_a_raw_file_that_tells_of_no_run_is_damaged(tmp_path, damage):
    path = tmp_path / "run.json"
    path.write_text(damage)
    with pytest.raises(StudyError, match="run.json is damaged"):
        runs.simulate(path, None, "four-bar:1", step=1e-3, duration=1.0, every=0, context={}, seconds=1)


def test_a_log_has_a_line_a_subject_and_one_half_a_minute_with_the_rest(monkeypatch, capsys):
    now = [100.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    tell = progress.Teller()
    for run in range(1, 101):  # of which 20 are kept, the others take 10 s each
        now[0] += 10.0 if run > 20 else 0.001
        tell(f"N = {run > 50:d}: run {run} of 100", run / 100)
    tell("next", 0.0)
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "[0 s] N = 0: run 1 of 100 (1 % done)"
    assert lines[1] == "[30 s] N = 0: run 23 of 100 (23 % done, about 12 min 50 s left)"
    assert "[5 min 10 s] N = 1: run 51 of 100 (51 % done, about 8 min 10 s left)" in lines
    assert lines[-1] == "[13 min 20 s] next (0 % done)" and 20 <= len(lines) <= 30


def test_what_is_typed_writes_nothing():
    words = ["simulate", "four-bar:1,fill=0.6", "--step", "1e-3"]
    for written in ([], ["--json"], ["--json", "--output", "OUTPUT.csv", "--every", "3"]):
        record = {"command": ["/elsewhere/mbs", *words, *written, "--blas", "atlas"]}
        assert runs.typed(record) == "build/mbs simulate four-bar:1,fill=0.6 --step 1e-3 --blas atlas"


@pytest.mark.parametrize("path", sorted((ROOT / "results").glob("*/*.csv")), ids=lambda path: path.stem)
def test_commands_of_stored_tables_name_scenes_that_are_there_and_run(path):
    table = pandas.read_csv(path)
    columns = [column for column in table if column.endswith("command")]
    commands = [shlex.split(text) for column in columns for text in table[column].dropna()
                if text.startswith("build/mbs simulate ")]
    for words in commands:
        assert not any("OUTPUT" in word for word in words)
        assert words[2].startswith("four-bar:") or (ROOT / words[2]).exists(), words[2]
    mbs = ROOT / "build" / "mbs"
    if commands and mbs.exists():
        done = subprocess.run([mbs, *commands[0][1:]], cwd=ROOT, capture_output=True, text=True, timeout=100)
        assert done.returncode in (0, 1), done.stderr


class Program:
    variant = "a/b"

    def __init__(self, path, text):
        self.path = path
        path.write_text(f"#!/bin/bash\n{text}\n")
        path.chmod(0o755)

    def call(self, *arguments):
        return [str(self.path), *arguments]


@pytest.mark.parametrize("text, status, reason", [
    ("echo 'mbs: --step is 0 s' >&2; exit 2", "refused", "mbs: --step is 0 s"),
    ("echo 'mbs: odd' >&2; exit 7", "crashed", "exit status 7: mbs: odd")])
def test_what_the_program_refuses_did_not_crash(tmp_path, text, status, reason):
    record = runs.simulate(tmp_path / "raw" / "run.json", Program(tmp_path / "mbs", text), "four-bar:1", step=1e-3,
                           duration=1.0, every=0, context={}, seconds=10)
    assert runs.status(record) == (status, reason)


def test_an_interrupted_child_leaves_no_half_written_file(tmp_path):
    def interrupt(*_):
        raise KeyboardInterrupt
    before = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, 0.5)
    try:
        with pytest.raises(KeyboardInterrupt):
            child.run(["/bin/bash", "-c", f"touch {tmp_path}/out.csv {tmp_path}/out.csv.77.partial; sleep 60"], 60,
                      512, tmp_path / "out.csv")
    finally:
        signal.signal(signal.SIGALRM, before)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("sent, code", [(signal.SIGTERM, 143), (signal.SIGINT, 130)])
def test_an_interrupted_study_says_how_to_resume(tmp_path, sent, code):
    command = [ROOT / "study/stability", "--loops", "1", "--implementation", "bad/hang", "--results", tmp_path]
    process = subprocess.Popen(command, env=environment(FAKE_BAD="1"), stderr=subprocess.PIPE, text=True,
                               preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    while not (tmp_path / "raw").exists():
        time.sleep(0.02)
    process.send_signal(sent)
    _, errors = process.communicate(timeout=30)
    assert process.returncode == code and "study/stability --loops 1 --implementation bad/hang" in errors
    assert "Traceback" not in errors and not list(tmp_path.rglob("*.partial*"))


@pytest.mark.parametrize("duration, step", [(1e-9, 1e-3), (1e9, 1e-3), (1e300, 1.0)])
def test_a_run_has_a_possible_number_of_steps(duration, step):
    with pytest.raises(StudyError, match="a run has 1 to 1e8"):
        need_steps(duration, [step])
    need_steps(20.0, [1.25e-3, 1e-4])


def test_bad_options_are_one_line():
    with pytest.raises(StudyError, match=r"unrecognized arguments: --fast \(see study/x --help\)"):
        Parser(prog="study/x").parse_args(["--fast"])
