# The study as a user starts it, on the real program; runs that tests share; which tests stay together.
import fcntl
import os
import subprocess
import tempfile
import time
from pathlib import Path

import pytest

from study.tests.browser import Browser

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAM = ROOT / "build" / "mbs"
FAKE = Path(__file__).with_name("fake_mbs.py")
PART = "stability"  # whose tables have no times: two runs give the same
TEMPORARY = tempfile.TemporaryDirectory()
os.environ["MBS_LOCKS"] = TEMPORARY.name  # apart from the machine's: a real study may run


def environment(program=PROGRAM, **more):
    clean = {key: value for key, value in os.environ.items() if not key.startswith(("FAKE_", "MBS_"))}
    # With CI=true Snakemake asks each second how the jobs of a cluster stand, else every ten.
    return clean | {"MBS_PROGRAM": str(program), "TMPDIR": TEMPORARY.name, "MBS_LOCKS": TEMPORARY.name, "CI": "true"} | more


def study(*arguments, program=PROGRAM, seconds=300, **more):
    """Runs an entry point of study/, `study("run", ...)`; with MBS_PROGRAM there is no set-up."""
    return subprocess.run([ROOT / "study" / arguments[0], *map(str, arguments[1:])], capture_output=True,
                          text=True, env=environment(program, **more), timeout=seconds)


def once(tmp_path_factory, worker_id, name, make):
    """The path `name`, which `make(path)` makes once, also for several workers. Not to be changed."""
    base = tmp_path_factory.getbasetemp()
    path = (base if worker_id == "master" else base.parent) / name
    made = path.with_name(f"{name}.made")
    with open(path.with_name(f"{name}.lock"), "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not made.exists():
            make(path)
            made.touch()
    return path


@pytest.fixture(scope="session")
def smoke(tmp_path_factory, worker_id):
    """Results of the whole smoke profile. Not to be changed."""
    def make(folder):
        done = study("run", "--profile", "smoke", "--results", folder, seconds=900)
        assert done.returncode == 0, done.stderr + (folder / "run.log").read_text()[-3000:]
    return once(tmp_path_factory, worker_id, "smoke", make)


@pytest.fixture(scope="session")
def program(tmp_path_factory, worker_id):
    """The real program, slower by a moment, so that kills find it at work."""
    def make(path):
        path.write_text(f'#!/bin/bash\nsleep 0.03\nexec {PROGRAM} "$@"\n')
        path.chmod(0o755)
    return once(tmp_path_factory, worker_id, "slower_mbs", make)


@pytest.fixture(scope="session")
def whole(tmp_path_factory, worker_id, program):
    """(results of a run of PART that nothing disturbed, how long it took, s). Not to be changed."""
    def make(path):
        begin = time.monotonic()
        done = study("run", "--profile", "smoke", "--part", PART, "--wait", "--results", path / "set", program=program)
        assert done.returncode == 0, done.stderr
        (path / "seconds").write_text(str(time.monotonic() - begin))
    path = once(tmp_path_factory, worker_id, "whole", make)
    return path / "set", float((path / "seconds").read_text())


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    with Browser(tmp_path_factory.mktemp("profile")) as browser:
        yield browser


# What takes longest begins first, so that no worker is left alone with it in the end.
LONGEST = ("smoke", "nodes", "stored", "kills", "test_reliability.py", "test_advise.py", "test_store.py", "test_view_page.py")


@pytest.hookimpl(tryfirst=True)  # before xdist reads the groups
def pytest_collection_modifyitems(items):
    """The tests of a file stay with one worker, but for those that are marked as a group of their own."""
    for item in items:
        if item.get_closest_marker("xdist_group") is None:
            item.add_marker(pytest.mark.xdist_group(item.path.name))

    def rank(item):
        group = item.get_closest_marker("xdist_group").args[0].split()[0]
        return LONGEST.index(group) if group in LONGEST else len(LONGEST)
    items.sort(key=rank)
