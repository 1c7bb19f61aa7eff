# Nodes of a cluster and its controller, on the program's stand-in and on jobs that are processes of this machine.
import json
import os
import shutil
import signal
import subprocess
import tempfile
from contextlib import ExitStack
from types import SimpleNamespace

import pytest

from analysis.core.files import StudyError, read_object, write_json, write_text
from study.core import cluster, job, locks, node, studyset as sets
from study.core.studyset import StudySet
from study.tests.conftest import FAKE, ROOT, environment, study
from study.tests.slurm import until


def alone(name):
    """Of a slow test that mostly waits: others run beside it."""
    def marked(test):
        return pytest.mark.slow(pytest.mark.xdist_group(f"nodes {name}")(test))
    return marked


PLAN = {"profile": "smoke", "only": [], "parts": ["map"]}
# Jobs in turn on nodes a and b, which are machines of their own, but for those that were refused.
SUBMIT = """#!/bin/bash
count=$(cat .cluster/jobs 2> /dev/null | wc -l)
order=(a b a b a b a b); node=${order[$((count % 8))]}
[ -e .cluster/refused/$node ] && node=$(tr ab ba <<< "$node")
SLURMD_NODENAME=$node FAKE_MACHINE=$node setsid bash -c 'bash "$1"; echo $? > .cluster/ended-$$' job "$2" >> run.log 2>&1 &
echo $! >> .cluster/jobs
echo $!
"""
STATUS = """#!/bin/bash
kill -0 "$1" 2> /dev/null && echo running && exit
[ "$(cat .cluster/ended-"$1" 2> /dev/null)" = 0 ] && echo success || echo failed
"""
CANCEL = '#!/bin/bash\nfor id in "$@"; do kill -- -"$id"; done\n'


@pytest.fixture
def begun(tmp_path, monkeypatch):
    """A set that this node has begun."""
    monkeypatch.setenv("MBS_PROGRAM", str(FAKE))
    monkeypatch.setenv("SLURMD_NODENAME", "first")
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    folder = tmp_path / "set"
    write_json(node.home(folder) / "plan.json", PLAN)
    node.begin(folder)
    return StudySet(folder)


@pytest.fixture
def profile(tmp_path):
    folder = tmp_path / "profile"
    folder.mkdir()
    for name, text in {"submit": SUBMIT, "status": STATUS, "cancel": CANCEL, "config.yaml": (
            "cluster: submit {resources.minutes}\ncluster-status: status\ncluster-cancel: cancel\njobs: 1\n"
            "local-cores: 1\nretries: 2\nkeep-going: true\n")}.items():
        (folder / name).write_text(text)
        (folder / name).chmod(0o755)
    return folder


def run(profile, folder, **more):
    return study("run", *RUN, "--results", folder, "--cluster", profile, program=FAKE, seconds=900, **more)


RUN = ("--profile", "smoke", "--part", "map")


def admit(studyset):
    with ExitStack() as held:
        node.admit(StudySet(studyset.folder), held)


def refused(studyset, words):
    with pytest.raises(StudyError, match=words):
        admit(studyset)
    return read_object(studyset.folder / "set.json")["context"]


def test_a_node_of_the_sets_kind_is_admitted(begun):
    admit(begun)
    assert (node.home(begun.folder) / "nodes" / "first").exists() and not node.refusals(begun.folder)


@pytest.mark.parametrize("key, variable", [("machine", "FAKE_MACHINE"), ("compiler", "FAKE_COMPILER"), ("commit", "FAKE_COMMIT")])
def test_a_node_of_another_kind_begins_a_set_of_its_own(begun, monkeypatch, key, variable):
    monkeypatch.setenv(variable, "another")
    monkeypatch.setenv("SLURMD_NODENAME", "second")
    assert refused(begun, rf"second is not of this set: another machine or build \({key} is 'another'")[key] != "another"
    [own] = node.own_sets(begun.folder)
    assert own.name.startswith("set-fake-cpu-") and StudySet(own).facts["context"][key] == "another"
    assert [*node.refusals(begun.folder)] == ["second"]
    monkeypatch.delenv(variable)  # and there a node of the first kind is refused, without a third set
    refused(StudySet(own), "another machine or build")
    assert node.own_sets(own) == []


def test_another_program_is_another_build(begun, monkeypatch, tmp_path):
    other = tmp_path / "mbs"
    other.write_text(FAKE.read_text() + "# built anew\n")
    other.chmod(0o755)
    monkeypatch.setenv("MBS_PROGRAM", str(other))
    refused(begun, "another build .mbs.")
    assert StudySet(node.own_sets(begun.folder)[0]).facts["programs"] != begun.facts["programs"]


def test_a_failed_control_is_a_set_of_its_node(begun, monkeypatch):
    def noted(path, data):  # whatever ends the node, its set says what it is
        assert path.name != "set.json" or data["no_evidence"]
        write_json(path, data)
    monkeypatch.setattr(sets, "write_json", noted)
    monkeypatch.setenv("FAKE_NEW", f"{begun.contenders[0].name}+twin=9")
    refused(begun, "its A/A control failed: .* times its own time")
    [own] = node.own_sets(begun.folder)
    assert own.name == "set-first" and (node.home(own) / "only").read_text() == "first\n"
    assert StudySet(own).facts["no_evidence"].startswith("its A/A control failed") and "no_evidence" not in begun.facts
    admit(StudySet(own))  # which says whose it is, and is measured
    monkeypatch.setenv("SLURMD_NODENAME", "second")
    refused(StudySet(own), "it is that of first alone")


def test_a_set_of_a_failed_control_is_run_only_if_it_is_named(begun, monkeypatch, capsys):
    ran = []
    monkeypatch.setattr(cluster, "_workflow", lambda studyset, *more: ran.append(studyset.folder))
    monkeypatch.setenv("FAKE_NEW", f"{begun.contenders[0].name}+twin=9")
    refused(begun, "its A/A control failed")
    [own] = node.own_sets(begun.folder)
    for folder in (begun.folder, own):
        cluster.run(begun.profile, [], ["map"], folder, None, {"map": {}})
    assert ran == [begun.folder, own] and f"{own} is of one node whose A/A control failed" in capsys.readouterr().out


def test_a_control_that_does_not_run_is_no_passed_one(begun, monkeypatch):
    monkeypatch.setenv("FAKE_CRASH", f"{begun.contenders[0].name}+twin")
    refused(begun, "its A/A control does not run: crashed: SIGSEGV")
    assert node.own_sets(begun.folder) == []


def test_who_is_refused_stays_so_but_for_what_may_be_mended(begun, monkeypatch, tmp_path):
    monkeypatch.setenv("FAKE_MACHINE", "another")
    refused(begun, "another machine")
    monkeypatch.setenv("SLURMD_NODENAME", "full")
    monkeypatch.setattr(shutil, "disk_usage", lambda folder: SimpleNamespace(free=0))
    refused(begun, "less than 100 MB free")
    cluster._plan(begun.profile, [], ["map"], begun.folder, {})
    assert [*node.refusals(begun.folder)] == ["first"] and len(node.own_sets(begun.folder)) == 1
    write_text(node.home(begun.folder) / "refused" / ".partial-lost-1-2-lost", "")  # of a node that was lost as it wrote
    assert [*node.refusals(begun.folder)] == ["first"] and len(node.own_sets(begun.folder)) == 1
    (tmp_path / "mbs").write_text("built anew")
    monkeypatch.setenv("MBS_PROGRAM", str(tmp_path / "mbs"))
    cluster._plan(begun.profile, [], ["map"], begun.folder, {})
    assert node.refusals(begun.folder) == {}


def test_a_node_that_cannot_run_the_program_is_refused(begun, monkeypatch):
    monkeypatch.setenv("MBS_PROGRAM", "/bin/false")
    refused(begun, "first is not of this set: /bin/false bench does not work")
    assert node.own_sets(begun.folder) == []


def test_a_node_that_another_study_holds_is_waited_for_and_then_refused(begun, monkeypatch):
    monkeypatch.setattr(node, "WAIT", 0.1)
    with locks.only_one_study(), pytest.raises(StudyError, match="first is not of this set: another study is measuring"):
        job.column(StudySet(begun.folder), "map", "any")
    assert [*node.refusals(begun.folder)] == ["first"]
    cluster._plan(begun.profile, [], ["map"], begun.folder, {})
    assert node.refusals(begun.folder) == {}  # the next run asks it again
    admit(begun)


def test_a_full_disk_of_a_node_is_named(begun, monkeypatch):
    monkeypatch.setattr(shutil, "disk_usage", lambda folder: SimpleNamespace(free=0))
    refused(begun, "less than 100 MB free for")


def test_a_read_only_disk_of_a_node_is_named(begun, monkeypatch, tmp_path):
    place = tmp_path / "disk"
    place.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "ro", "tmpfs", place], capture_output=True).returncode != 0:
        pytest.skip("no file system can be mounted here, as by who is not root")
    try:
        monkeypatch.setattr(tempfile, "tempdir", str(place))
        refused(begun, f"first is not of this set: cannot write to {place}: Read-only file system")
    finally:
        subprocess.run(["umount", "-l", place], check=True)
    assert node.own_sets(begun.folder) == [] and [*node.refusals(begun.folder)] == ["first"]


@alone("kinds")
def test_nodes_of_two_kinds_make_two_sets(profile, tmp_path):
    done = run(profile, tmp_path / "set")
    assert done.returncode == 0, done.stderr + (tmp_path / "set" / "run.log").read_text()[-3000:]
    [own] = tmp_path.glob("set-fake-cpu-*")
    assert "b is not of this set: another machine" in done.stdout and f"a set of its own: {own}" in done.stdout
    for folder, machine in ((tmp_path / "set", "a"), (own, "b")):
        found = [json.loads(path.read_text())["record"]["context"]["machine"] for path in folder.glob("raw/map/*/*/*.json")]
        assert found and set(found) == {machine} and (folder / "map.html").stat().st_size
    before = {path: path.stat().st_mtime_ns for path in tmp_path.glob("set/raw/**/*.json")}
    assert run(profile, tmp_path / "set").returncode == 0  # all is there
    assert before == {path: path.stat().st_mtime_ns for path in tmp_path.glob("set/raw/**/*.json")}
    record = sorted(before)[0]
    record.write_text(record.read_text().replace('"kind":"', '"kind":"x', 1))
    done = run(profile, tmp_path / "set")
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and str(record) in done.stderr


@alone("kill")
def test_jobs_of_a_killed_controller_are_ended(profile, tmp_path):
    folder = tmp_path / "set"
    process = subprocess.Popen([ROOT / "study" / "run", *RUN, "--results", folder, "--cluster", profile],
                               env=environment(FAKE), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    until(lambda: [*folder.glob("raw/map/*/*/*.json")], "records", seconds=300)
    second = run(profile, folder)  # beside it
    assert second.returncode == 2 and second.stderr == f"study/run: another study is running in {folder}\n"
    process.send_signal(signal.SIGKILL)
    process.wait()
    [*_, last] = (folder / ".cluster" / "jobs").read_text().split()
    cluster.end_jobs(folder, profile)
    with pytest.raises(ProcessLookupError):
        os.kill(int(last), 0)
    assert run(profile, folder).returncode == 0
    with locks.only_one(folder):  # nobody holds it
        pass


def test_a_dry_run_says_what_it_takes(profile, tmp_path):
    done = study("run", *RUN, "--results", tmp_path / "set", "--cluster", profile, "--dry-run", program=FAKE)
    assert "2 jobs, at most 0.51 node-hours" in done.stdout and not (tmp_path / "set").exists()


@pytest.mark.parametrize("arguments, words", [(("--cluster", "nosuch"), "nosuch is no profile (config.yaml is missing); known: slurm"),
                                              (("--cluster", "slurm", "--wait"), "--wait: found with --cluster")])
def test_bad_options_are_one_line(arguments, words, tmp_path):
    done = study("run", *RUN, "--results", tmp_path / "set", *arguments, program=FAKE)
    assert done.returncode == 2 and words in done.stderr and done.stderr.count("\n") == 1


@alone("nothing")
def test_a_program_that_does_not_run_is_one_line_and_the_folder_can_be_used(profile, tmp_path):
    config = profile / "config.yaml"
    config.write_text(config.read_text().replace("retries: 2", "retries: 1"))  # each of the two nodes is asked once
    for _ in range(2):
        done = study("run", *RUN, "--results", tmp_path / "set", "--cluster", profile, program="/bin/false", seconds=900)
        assert done.returncode == 2 and done.stderr.count("\n") == 1 and "/bin/false list" in done.stderr, done.stderr
