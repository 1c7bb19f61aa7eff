# study/setup asks only for what is missing; apt-get and dpkg-query are stand-ins here.
import os
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from study.tests.conftest import ROOT


@pytest.fixture
def stand_ins():
    """A folder that other users may read, unlike tmp_path."""
    with TemporaryDirectory() as folder:
        Path(folder).chmod(0o777)
        yield Path(folder)


def run_setup(stand_ins, installed, *more, user=None, apt='echo "apt-get $*" >> "$0.log"'):
    for name, text in (("dpkg-query", installed), ("apt-get", apt)):
        (stand_ins / name).write_text(f"#!/bin/bash\n{text}\n")
        (stand_ins / name).chmod(0o755)
    command = ["setpriv", "--reuid", "65534", "--clear-groups"] if user else []
    return subprocess.run([*command, "/bin/bash", ROOT / "study/setup", "--no-build", *more], text=True,
                          capture_output=True, env={"PATH": f"{stand_ins}:/usr/bin:/bin"})


ALL_BUT_CMAKE = 'for p in "$@"; do [[ $p == -* || $p == cmake ]] || printf "ii %s " "$p"; done'
ALL = ALL_BUT_CMAKE.replace(" || $p == cmake", "")


def test_nothing_missing_does_not_touch_apt(stand_ins):
    assert run_setup(stand_ins, ALL).returncode == 0
    assert not (stand_ins / "apt-get.log").exists()


@pytest.mark.skipif(os.geteuid() != 0, reason="installing needs root")
def test_root_installs_what_is_missing(stand_ins):
    assert run_setup(stand_ins, ALL_BUT_CMAKE).returncode == 0
    log = (stand_ins / "apt-get.log").read_text().splitlines()
    assert log == ["apt-get update -q", "apt-get install -y --no-install-recommends cmake"]


@pytest.mark.skipif(os.geteuid() != 0, reason="installing needs root")
def test_what_only_running_needs_comes_second_and_its_failure_is_told(stand_ins):
    but_two = ALL_BUT_CMAKE.replace("== cmake", "== @(cmake|chromium)")
    assert run_setup(stand_ins, but_two).returncode == 0
    log = (stand_ins / "apt-get.log").read_text().splitlines()
    assert [line.split()[-1] for line in log] == ["-q", "cmake", "chromium"]
    done = run_setup(stand_ins, but_two, apt='[[ "$*" != *chromium ]] || { echo "no such package"; exit 100; }')
    assert done.returncode == 1 and "no such package" in done.stderr
    assert "could not be installed: chromium" in done.stderr


ALL_BUT_ENGINES = 'for p in "$@"; do [[ $p == -* || $p == lib@(simbody|ode)-dev ]] || printf "ii %s " "$p"; done'


@pytest.mark.skipif(os.geteuid() != 0, reason="installing needs root")
def test_engines_are_installed_only_when_asked_for(stand_ins):
    assert run_setup(stand_ins, ALL_BUT_ENGINES).returncode == 0
    assert not (stand_ins / "apt-get.log").exists()
    assert run_setup(stand_ins, ALL_BUT_ENGINES, "--engines").returncode == 0
    log = (stand_ins / "apt-get.log").read_text().splitlines()
    assert log[1] == "apt-get install -y --no-install-recommends libsimbody-dev libode-dev"


@pytest.mark.skipif(os.geteuid() != 0, reason="installing needs root")
def test_latex_is_installed_only_when_asked_for(stand_ins):
    without = ALL_BUT_CMAKE.replace("== cmake", "== @(latexmk|biber)")
    assert run_setup(stand_ins, without).returncode == 0
    assert not (stand_ins / "apt-get.log").exists()
    assert run_setup(stand_ins, without, "--paper").returncode == 0
    assert (stand_ins / "apt-get.log").read_text().splitlines()[1] == "apt-get install -y --no-install-recommends latexmk biber"


def test_others_are_told_the_command(stand_ins):
    done = run_setup(stand_ins, ALL_BUT_CMAKE, user="nobody" if os.geteuid() == 0 else None)
    assert done.returncode == 1
    assert "sudo apt-get install -y --no-install-recommends cmake" in done.stderr


def test_unknown_option():
    done = subprocess.run([ROOT / "study/setup", "--fast"], capture_output=True, text=True)
    assert done.returncode == 2 and "unknown option --fast" in done.stderr
