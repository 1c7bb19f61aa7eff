# study/run and study/sweep --cluster on a real Slurm of two nodes on this machine: a node is lost, the run is interrupted.
# Run by `study/test --cluster`.
import re
import signal
import subprocess

import pandas
import pytest

from analysis.core import records, schema
from analysis.core.files import digest
from study.tests.conftest import PROGRAM, ROOT, environment, study
from study.tests.slurm import Slurm, missing, until

pytestmark = [pytest.mark.cluster, pytest.mark.skipif(bool(missing()), reason=missing())]
PARTS = ("stability", "tuning")  # two columns without times, and one that is timed
TIMES = {"base_us", "step_us", "ratio", "low", "high", "decided"}  # of tuning
RUN = ["run", "--profile", "smoke", "--part", *PARTS]


@pytest.fixture(scope="module")
def slurm(tmp_path_factory):
    found = Slurm(tmp_path_factory.mktemp("cluster") / "slurm")
    try:
        found.start("slurmctld", "node1", "node2")
        yield found
    finally:
        found.end()


@pytest.fixture(scope="module")
def slower(tmp_path_factory):
    """The real program, slower by a moment, so that what happens to a run finds it at work."""
    path = tmp_path_factory.mktemp("program") / "mbs"
    path.write_text(f'#!/bin/bash\nsleep 0.1\nexec {PROGRAM} "$@"\n')
    path.chmod(0o755)
    return path


@pytest.fixture
def folder(tmp_path):
    return tmp_path / "set"


def begin(slurm, folder, program):
    return subprocess.Popen([ROOT / "study" / "run", *RUN[1:], "--results", folder, "--cluster", "slurm"], text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment(program, **slurm.environment))


def again(slurm, folder, program, **more):
    return study(*RUN, "--results", folder, "--cluster", "slurm", program=program, seconds=600, **slurm.environment, **more)


def running(slurm):
    """Nodes that have a job."""
    return slurm.ask("squeue", "-h", "-t", "R", "-o", "%N").split()


def finished(folder, part="stability"):
    return {path: (path.stat().st_mtime_ns, digest(path)) for path in records.files_of(folder, part).values()}


def log(folder):
    return (folder / "run.log").read_text()[-6000:]


def one_line(text):
    return text.count("\n") == 1 and text.startswith("study/run: ")


def test_a_node_is_lost_and_the_run_interrupted(slurm, slower, folder, tmp_path):
    process = begin(slurm, folder, slower)
    try:
        until(lambda: len(finished(folder)) > 3 and len(running(slurm)) == 2, "both nodes measure", lambda: log(folder))
        node = running(slurm)[0]
        slurm.lose(node)
        kept = finished(folder)
        until(lambda: len(finished(folder)) > len(kept) + 3, "the other node goes on", lambda: log(folder))
        process.send_signal(signal.SIGINT)
        told = process.communicate(timeout=120)[1]
    finally:
        process.kill()
    assert process.returncode == 128 + signal.SIGINT and "To resume:" in told, told
    assert slurm.ask("squeue", "-h", "-t", "R,PD") == ""  # Ctrl-C cancels
    kept |= finished(folder)
    slurm.start(node)
    done = again(slurm, folder, slower)
    assert done.returncode == 0, done.stderr + log(folder)
    assert kept.items() <= finished(folder).items()  # nothing that was finished is measured again

    local = tmp_path / "local"
    done = study(*RUN, "--results", local, program=slower, seconds=600)
    assert done.returncode == 0, done.stderr
    assert finished(folder).keys() == {folder / path.relative_to(local) for path in finished(local)}
    for name in schema.of_part("stability"):  # has no times
        assert (folder / "stability" / f"{name}.csv").read_bytes() == (local / "stability" / f"{name}.csv").read_bytes()
    for name in schema.of_part("tuning"):
        here, there = (pandas.read_csv(one / "tuning" / f"{name}.csv") for one in (folder, local))
        times = TIMES & {*here.columns}
        assert {"ratio", "low", "high"} < times
        pandas.testing.assert_frame_equal(here.drop(columns=times), there.drop(columns=times), obj=f"tuning/{name}")
    assert (folder / "index.html").stat().st_size and study("figures", folder, program=slower).returncode == 0


def test_a_sweep_is_an_array_job(slurm, tmp_path):
    words = ["four-bar:1", "--vary", "gravity/1=-12:-6:40", "--implementation", "csc_klu/refactor", "--duration", "0.1"]
    alone = subprocess.run([PROGRAM, "sweep", *words, "--output", tmp_path / "one.csv"], capture_output=True, text=True)
    assert alone.returncode in (0, 1), alone.stderr
    made = study("sweep", tmp_path / "all.csv", "--output", tmp_path / "all.png", "--cluster", "slurm", "--parts", 3, "--", *words,
                 **slurm.environment)
    assert made.returncode == 0, made.stderr
    assert (tmp_path / "all.csv").read_bytes() == (tmp_path / "one.csv").read_bytes() and (tmp_path / "all.png").stat().st_size
    bad = study("sweep", tmp_path / "bad.csv", "--cluster", "slurm", "--parts", 2, "--", "nosuch:1", *words[1:], **slurm.environment)
    assert bad.returncode == 2 and bad.stderr.startswith("study/sweep: mbs: ") and "nosuch" in bad.stderr and bad.stderr.count("\n") == 1


def test_a_job_does_not_wait_for_one_node_that_is_drained(slurm, tmp_path):
    def said(name, *words):
        return subprocess.run([ROOT / "study" / "cluster" / "slurm" / name, *words], cwd=tmp_path, env=environment(**slurm.environment),
                              capture_output=True, text=True)
    (tmp_path / ".cluster" / "refused").mkdir(parents=True)
    (tmp_path / ".cluster" / "only").write_text("node1\n")
    (tmp_path / "job").write_text("#!/bin/bash\n")
    slurm.ask("scontrol", "update", "nodename=node1", "state=drain", "reason=a new disk")
    try:
        told = said("status", said("submit", "1", "job").stdout.strip())
    finally:
        slurm.ask("scontrol", "update", "nodename=node1", "state=resume")
    assert told.stdout == "failed\n" and re.search("error: node1 takes no jobs: State=.*DRAIN.* Reason=a new disk", told.stderr), told
    assert slurm.ask("squeue", "-h") == ""
    assert said("status", said("submit", "1", "job").stdout.strip()).stdout in ("running\n", "success\n")
