# The battery: a study that is killed at random moments, a full disk, files that are damaged. Afterwards the rerun ends
# alike, nothing finished is measured again, no process is left, and what is wrong is one line that names the file.
import contextlib
import errno
import json
import os
import random
import shutil
import signal
import subprocess
import tempfile
import time
import uuid
from pathlib import Path

import pytest

from analysis.core import records, schema
from analysis.core.files import digest
from study.core import child
from study.main import main
from study.tests.conftest import PART, ROOT, environment, study

pytestmark = pytest.mark.slow
COMMAND = [str(ROOT / "study" / "run"), "--profile", "smoke", "--part", PART, "--wait"]
MARK = "MBS_BATTERY"  # in the environment of all that a run starts
SEED, CHAINS, KILLS = 20080101, 2, 4  # of these on each of those results in turn: every signal comes to the process and to its group
SIGNALS = (signal.SIGKILL, signal.SIGHUP, signal.SIGINT, signal.SIGTERM)


def run(folder, program, **more):
    return subprocess.run([*COMMAND, "--results", folder], capture_output=True, text=True, timeout=300,
                          env=environment(program, **more))


def tables(folder):
    return {name: (folder / PART / f"{name}.csv").read_bytes() for name in schema.of_part(PART)}


def finished(folder):
    """{path: (when it was written, digest)} of the records that are whole."""
    return {path: (path.stat().st_mtime_ns, digest(path)) for path in records.files_of(folder, PART).values()}


def alive(mark):
    """Command lines of the processes that a run has."""
    found = []
    for entry in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            state = (entry / "stat").read_text().rpartition(")")[2].split()[0]
            if state not in "ZX" and f"{MARK}={mark}".encode() in (entry / "environ").read_bytes().split(b"\0"):
                found.append((entry / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace"))
    return found


def kill(folder, program, after, sign, group):
    """Starts a run, ends it so many seconds later; its exit status and the processes that it left."""
    mark = uuid.uuid4().hex
    process = subprocess.Popen([*COMMAND, "--results", folder], env=environment(program, **{MARK: mark}),
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True,
                               preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(timeout=after)
    with contextlib.suppress(ProcessLookupError):
        (os.killpg if group else os.kill)(process.pid, sign)
    errors = process.communicate(timeout=180)[1]
    return process.returncode, errors, left_by(mark)


def left_by(mark):
    """Command lines of the processes that a run has left, some seconds after its end."""
    end = time.monotonic() + 10
    while (left := alive(mark)) and time.monotonic() < end:
        time.sleep(0.1)
    return left


@pytest.mark.parametrize("chain", [pytest.param(chain, marks=pytest.mark.xdist_group(f"kills {chain}"))
                                   for chain in range(CHAINS)])
def test_killed_at_any_moment_it_resumes_and_loses_nothing(whole, program, tmp_path, chain):
    reference, seconds = whole
    rng, folder = random.Random(SEED + chain), tmp_path / "set"
    kept = {}
    for number in range(KILLS):
        sign, group = SIGNALS[(chain + number) % len(SIGNALS)], bool(number % 2)
        after = rng.uniform(0.1, 0.6) * seconds if number < KILLS - 1 else rng.uniform(0.1, 1.0) * seconds
        code, errors, left = kill(folder, program, after, sign, group)
        assert left == [], f"{sign.name} after {after:.2f} s left {left}"
        if code not in (0, -signal.SIGKILL, -sign):  # the last: before anything had begun
            assert code == 128 + sign and "To resume:" in errors, (sign, code, errors)
        assert "Traceback" not in errors and "error" not in errors, errors
        now = finished(folder)
        assert kept.items() <= now.items(), "a finished record was lost or measured again"
        for path in now:
            records.read(path, path.name)  # whole
        kept = now
    done = run(folder, program)
    assert done.returncode == 0, done.stderr
    assert kept.items() <= finished(folder).items()
    assert tables(folder) == tables(reference)
    assert set(records.files_of(folder, PART)) == set(records.files_of(reference, PART))
    assert not list(folder.rglob(".partial-*")) and (folder / "index.html").exists()
    before = finished(folder)
    assert run(folder, program).returncode == 0 and finished(folder) == before


@pytest.mark.parametrize("sign", SIGNALS)
def test_killed_while_it_sets_up_it_leaves_no_process(tmp_path, sign):
    """On a copy of the study whose set-up starts others and never ends."""
    for name in ("study", "analysis"):
        shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("tests", "__pycache__"))
    (tmp_path / "study" / "setup").write_text("#!/bin/bash\nsleep 600 & echo begun\nsleep 600\n")
    mark, log = uuid.uuid4().hex, tmp_path / "set" / "run.log"
    own = {key: value for key, value in environment(**{MARK: mark}).items() if key != "MBS_PROGRAM"}
    process = subprocess.Popen([tmp_path / "study" / "run", "--profile", "smoke", "--wait", "--results", log.parent], env=own, start_new_session=True,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
    end = time.monotonic() + 300  # that it has begun
    while sum("sleep 600" in line for line in alive(mark)) < 2:
        assert process.poll() is None and time.monotonic() < end
        time.sleep(0.3)
    os.kill(process.pid, sign)
    process.wait(timeout=60)
    assert left_by(mark) == []


def test_a_second_study_waits_or_is_refused_while_the_first_measures(program, tmp_path):
    first = subprocess.Popen([*COMMAND, "--results", tmp_path / "one"], env=environment(program),
                             stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while not (tmp_path / "one" / "raw").exists():
        time.sleep(0.05)
        assert first.poll() is None
    other = [word for word in COMMAND if word != "--wait"]
    done = subprocess.run([*other, "--results", tmp_path / "two"], env=environment(program), capture_output=True, text=True)
    assert done.returncode == 2 and "another study is measuring on this machine" in done.stderr
    same = subprocess.run([*COMMAND, "--results", tmp_path / "one"], env=environment(program), capture_output=True, text=True)
    assert same.returncode == 2 and "another study is running in" in same.stderr
    assert first.wait(timeout=120) == 0


@pytest.fixture
def small_disk(tmp_path):
    """A file system that is just large enough to begin on."""
    if os.geteuid() != 0:
        pytest.skip("only root can mount a small file system")
    place = tmp_path / "disk"
    place.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=110m", "tmpfs", place], capture_output=True).returncode != 0:
        pytest.skip("no file system can be mounted here")
    yield place
    subprocess.run(["umount", "-l", place], check=True)


def test_a_full_disk_is_one_line_and_the_rerun_ends_alike(whole, program, small_disk):
    folder = small_disk / "set"
    process = subprocess.Popen([*COMMAND, "--results", folder], env=environment(program), stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True)
    while len(list((folder / "raw").rglob("*.json"))) < 5 and process.poll() is None:
        time.sleep(0.02)
    fill(small_disk)
    errors = process.communicate(timeout=120)[1]
    assert process.returncode == 2 and one_line(errors) and "no space is left for" in errors, errors
    kept = finished(folder)
    again = run(folder, program)
    assert again.returncode == 2 and one_line(again.stderr) and "100 MB free" in again.stderr, again.stderr
    (small_disk / "filler").unlink()
    done = run(folder, program)
    assert done.returncode == 0, done.stderr
    assert kept.items() <= finished(folder).items() and tables(folder) == tables(whole[0])


def test_without_room_for_a_page_it_is_one_line_and_the_rerun_ends_alike(whole, program, tmp_path):
    """Where no small disk can be mounted, either: a limit of what Python may write to a file (programs have one of their own)."""
    folder, most = tmp_path / "set", (whole[0] / f"{PART}.html").stat().st_size // 1024
    limited = ["/bin/bash", "-c", 'ulimit -S -f "$1"; shift; exec "$@"', "bash", str(most // 2), *COMMAND, "--results", folder]
    done = subprocess.run(limited, capture_output=True, text=True, timeout=300, env=environment(program))
    assert done.returncode == 2 and one_line(done.stderr) and os.strerror(errno.EFBIG) in done.stderr, done.stderr
    kept = finished(folder)
    assert set(kept) == set(folder / path.relative_to(whole[0]) for path in finished(whole[0])) and not (folder / f"{PART}.html").exists()
    done = run(folder, program)
    assert done.returncode == 0, done.stderr
    assert kept == finished(folder) and tables(folder) == tables(whole[0]) and (folder / f"{PART}.html").exists()


def fill(place):
    with contextlib.suppress(OSError), open(place / "filler", "wb", buffering=0) as file:
        while True:
            file.write(b"\0" * 2**16)


def one_line(text):
    return text.count("\n") == 1 and text.startswith("study/") and "Traceback" not in text


def record_in(folder):
    return sorted(records.files_of(folder, PART).items())[0][1]


def forge(path, change):
    """Another record, with its right digest."""
    data = json.loads(path.read_text().partition("\n")[2].removeprefix('"record": ').rstrip()[:-1])
    change(data)
    records.write(path, data)


def cut(path):
    path.write_bytes(path.read_bytes()[:-20])


def edit(path, old, new):
    text = path.read_text()
    assert old in text, path
    path.write_text(text.replace(old, new, 1))


def rewrite(path, change):
    data = json.loads(path.read_text())
    change(data)
    path.write_text(json.dumps(data))


EVERY = ("run", "figures", "add")
NAMED = {  # damage: (file that the line names, what is done to it, commands that must see it)
    "record of zeros": (record_in, lambda path: path.write_bytes(bytes(path.stat().st_size)), EVERY),
    "changed digit of a record": (record_in, lambda path: edit(path, '"kind":"', '"kind":"x'), EVERY),
    "record that is a list": (record_in, lambda path: path.write_text("[]"), EVERY),
    "other record with a right digest": (record_in, lambda path: forge(path, lambda data: data.update(seconds=1e6)),
                                         EVERY),
    "wrong-typed record with a right digest": (record_in, lambda path: forge(path, lambda data: data.update(output=[])),
                                               EVERY),
    "record without its cell, right digest": (record_in, lambda path: forge(path, lambda data: data.pop("cell")),
                                              EVERY),
    "record of nobody's": (lambda folder: record_in(folder).with_name("more.json"),
                           lambda path: shutil.copy(record_in(path.parents[4]), path), EVERY),
    "record of another machine, without a stamp": (
        record_in, lambda path: (forge(path, lambda data: data["context"].update(machine="another")),
                                 shutil.rmtree(path.parents[4] / ".done")), EVERY),
    "changed table": (lambda folder: folder / PART / "maps.csv", lambda path: edit(path, "0", "1"), EVERY),
    "removed table": (lambda folder: folder / PART / "maps.csv", Path.unlink, EVERY),
    "digests that are a list": (lambda folder: folder / PART / "tables.json", lambda path: path.write_text("[]"),
                                EVERY),
    "digests of another type": (lambda folder: folder / PART / "tables.json", lambda path: path.write_text('{"tables": 3}'),
                                EVERY),
    "set that is a list": (lambda folder: folder / "set.json", lambda path: path.write_text("[1]"), EVERY),
    "set that is binary": (lambda folder: folder / "set.json", lambda path: path.write_bytes(os.urandom(300)),
                           EVERY),
    "set with parts that are a number": (lambda folder: folder / "set.json",
                                         lambda path: rewrite(path, lambda data: data.update(parts=3)), EVERY),
    "set with a context that is a text": (lambda folder: folder / "set.json",
                                          lambda path: rewrite(path, lambda data: data.update(context="x")),
                                          EVERY),
    "set that is deep": (lambda folder: folder / "set.json", lambda path: path.write_text("[" * 100000), EVERY),
    "binary profile": (lambda folder: folder / "profile.yaml", lambda path: path.write_bytes(b"\xff\xfe\x00\x80" * 50), EVERY),
    "profile that is a number": (lambda folder: folder / "profile.yaml", lambda path: path.write_text("3\n"), EVERY),
    "stamp that is a list": (lambda folder: folder / ".done" / PART / "maps", lambda path: path.write_text("[]"),
                             EVERY),
    "registry that is a list": (lambda folder: folder / "registry.json", lambda path: path.write_text("[]"), EVERY),
    "context that is a list": (lambda folder: next((folder / "contexts").glob("*.json")), lambda path: path.write_text("[]"), EVERY),
}


def words_of(command, folder):
    return {"run": ["run", *COMMAND[1:], "--results", folder], "figures": ["figures", folder],
            "add": ["add", "csc_klu", "--to", folder, "--wait"]}[command]


def test_a_truncated_record_ends_each_command(whole, program, tmp_path):
    for command in EVERY:
        folder = Path(shutil.copytree(whole[0], tmp_path / command))
        cut(record_in(folder))
        done = study(*words_of(command, folder), program=program)
        assert done.returncode == 2 and one_line(done.stderr) and record_in(folder).name in done.stderr, (command, done.stderr)


@pytest.fixture
def here(monkeypatch, program, capfd):
    """Runs a command of the study in this process, which saves the time to load it; (exit status, standard error)."""
    for key, value in environment(program).items():
        monkeypatch.setenv(key, value)
    monkeypatch.setattr(tempfile, "tempdir", None)  # is that of the environment
    monkeypatch.setattr(child, "end_on_signals", lambda: None)

    def run_here(*words):
        capfd.readouterr()
        return main([str(word) for word in words]), capfd.readouterr().err
    return run_here


@pytest.mark.parametrize("damage", NAMED)
def test_what_is_damaged_is_named_in_one_line(whole, here, tmp_path, damage):
    where, change, commands = NAMED[damage]
    for command in commands:
        folder = Path(shutil.copytree(whole[0], tmp_path / command))
        path = where(folder)
        change(path)
        code, errors = here(*words_of(command, folder))
        assert code == 2 and one_line(errors) and path.name in errors, (command, errors)


def test_another_profile_is_no_profile_of_this_set(whole, here, tmp_path):
    folder = Path(shutil.copytree(whole[0], tmp_path / "set"))
    edit(folder / "profile.yaml", "title: ", "title: another, ")
    code, errors = here(*words_of("run", folder))
    assert code == 2 and one_line(errors) and "the profile's settings" in errors


@pytest.mark.parametrize("damage", [cut, lambda path: path.write_bytes(b"no archive"), lambda path: path.write_bytes(b"")])
def test_a_damaged_archive_is_named(whole, here, tmp_path, damage):
    folder = Path(shutil.copytree(whole[0], tmp_path / "set"))
    records.pack(folder, PART, records.archive_of(folder, PART))
    shutil.rmtree(folder / "raw" / PART)
    shutil.rmtree(folder / ".done")
    damage(records.archive_of(folder, PART))
    code, errors = here(*words_of("figures", folder))
    assert code == 2 and one_line(errors) and f"{PART}.tar.xz" in errors, errors


def test_a_record_that_is_missing_is_measured_again_and_no_other(whole, program, tmp_path):
    folder = Path(shutil.copytree(whole[0], tmp_path / "set"))
    lost = record_in(folder)
    lost.unlink()
    kept = finished(folder)
    assert run(folder, program).returncode == 0
    assert {path for path in finished(folder) if path not in kept} == {lost} and kept.items() <= finished(folder).items()
    assert tables(folder) == tables(whole[0])


@pytest.mark.parametrize("arguments, words", [
    (["run", "--results", "/proc/nowhere"], "cannot write to /proc/nowhere"),
    (["run", "--results", "/dev/null"], "cannot write to /dev/null"),
    (["figures", "/nowhere/at/all"], "holds no set"),
    (["store", "/nowhere/at/all"], "holds no set"),
    (["run", "--profile", "\udcff"], "unknown profile"),
    (["run", "--part", "nothing"], "unknown part 'nothing'"),
    (["view", "/bin/true"], "/bin/true"), (["view", "four-bar:2", "/bin/true"], "/bin/true is no trajectory"),
    (["view", "four-bar:2", "--duration", "0.1", "--output", "/proc/page.html"], "cannot write /proc/page.html")])
def test_forbidden_places_and_files_that_are_none_are_one_line(arguments, words):
    done = subprocess.run([ROOT / "study" / arguments[0], *arguments[1:]], capture_output=True, text=True, timeout=60,
                          env=environment())
    assert done.returncode == 2 and one_line(done.stderr) and words in done.stderr, done.stderr
