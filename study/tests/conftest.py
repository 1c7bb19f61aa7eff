# A study on the fake `mbs`, run once and copied for every test that damages it.
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
FAKE = Path(__file__).with_name("fake_mbs.py")
TEMPORARY = tempfile.TemporaryDirectory()  # apart from the machine's lock: a real study may run


def environment(**more):
    clean = {key: value for key, value in os.environ.items()
             if not key.startswith(("FAKE_", "MBS_"))}
    return clean | {"MBS_PROGRAM": str(FAKE), "TMPDIR": TEMPORARY.name} | more


def study(*arguments, **more):
    """Runs an entry point of study/, `study("run", ...)`, on the fake program."""
    return subprocess.run([ROOT / "study" / arguments[0], *arguments[1:]], capture_output=True,
                          text=True, env=environment(**more), timeout=300)


@pytest.fixture(scope="session")
def pristine(tmp_path_factory):
    results = tmp_path_factory.mktemp("fake") / "results"
    done = study("run", "--profile", "smoke", "--results", results)
    assert done.returncode == 0, done.stderr
    return results


@pytest.fixture
def results(pristine, tmp_path):
    """Results of one's own: a copy, times kept."""
    return Path(shutil.copytree(pristine, tmp_path / "results"))
