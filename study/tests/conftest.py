# The study as a user starts it, on the real program; a whole run of the smoke profile that tests share.
import fcntl
import os
import subprocess
import tempfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAM = ROOT / "build" / "mbs"
FAKE = Path(__file__).with_name("fake_mbs.py")
TEMPORARY = tempfile.TemporaryDirectory()  # apart from the machine's locks: a real study may run


def environment(program=PROGRAM, **more):
    clean = {key: value for key, value in os.environ.items() if not key.startswith(("FAKE_", "MBS_"))}
    return clean | {"MBS_PROGRAM": str(program), "TMPDIR": TEMPORARY.name} | more


def study(*arguments, program=PROGRAM, seconds=300, **more):
    """Runs an entry point of study/, `study("run", ...)`; with MBS_PROGRAM there is no set-up."""
    return subprocess.run([ROOT / "study" / arguments[0], *map(str, arguments[1:])], capture_output=True,
                          text=True, env=environment(program, **more), timeout=seconds)


@pytest.fixture(scope="session")
def smoke(tmp_path_factory, worker_id):
    """Results of the whole smoke profile; made once, also for several workers. Not to be changed."""
    base = tmp_path_factory.getbasetemp()
    folder = (base if worker_id == "master" else base.parent) / "smoke"
    with open(folder.with_name("smoke.lock"), "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "index.html").exists():
            done = study("run", "--profile", "smoke", "--results", folder, seconds=900)
            assert done.returncode == 0, done.stderr + (folder / "run.log").read_text()[-3000:]
    return folder
