# Every way a child can end is told apart, and nothing of it is left running.
import os
import time

import pytest

from analysis.core.files import StudyError
from study.core import child


def shell(text, seconds=10, memory_mb=512):
    return child.run(["/bin/bash", "-c", text], seconds, memory_mb)


def ended_soon(pid):
    for _ in range(50):  # until init has collected it
        if not os.path.exists(f"/proc/{pid}") or "Z" in open(f"/proc/{pid}/stat").read().split()[2]:
            return True
        time.sleep(0.1)
    return False


@pytest.mark.parametrize("command, status, reason", [
    ("exit 0", "exited", "exit status 0"),
    ("echo 'mbs: no such scene' >&2; exit 2", "exited", "mbs: no such scene"),
    ("kill -SEGV $$", "crashed", "SIGSEGV"),
    ("kill -KILL $$", "crashed", "SIGKILL"),
    ("echo std::bad_alloc >&2; kill -ABRT $$", "out-of-memory", "needs more than 512 MB"),
    ("echo 'mbs: not enough memory for this scene with this implementation' >&2; exit 2",
     "out-of-memory", "not enough memory for this scene"),
])
def test_endings(command, status, reason):
    ended = shell(command)
    assert ended.status == status and reason in ended.reason


def test_memory_limit_is_real():
    ended = child.run(["/usr/bin/python3", "-c", "x = bytearray(10**9)"], 20, 256)
    assert ended.code != 0


def test_time_limit_ends_grandchildren_too(tmp_path):
    pid_file = tmp_path / "pid"
    begin = time.monotonic()
    ended = shell(f"sleep 100 & echo $! > {pid_file}; wait", seconds=0.5)
    assert ended.status == "timeout" and time.monotonic() - begin < 5
    assert ended_soon(int(pid_file.read_text()))


def test_a_signal_whose_exception_was_swallowed_ends_the_study_before_the_next_child(monkeypatch):
    monkeypatch.setattr(child, "_signals", [15])
    with pytest.raises(KeyboardInterrupt) as ended:
        shell("exit 0")
    assert ended.value.args == (15,)


@pytest.mark.parametrize("name", ["INT", "TERM", "HUP"])
def test_what_is_sent_to_the_whole_group_is_no_result_of_the_child(name):
    with pytest.raises(StudyError, match=f"interrupted: /usr/bin/python3 was ended by SIG{name}"):
        child.run(["/usr/bin/python3", "-c", "import os, signal\n"
                   f"signal.signal(signal.SIG{name}, signal.SIG_DFL)\n"  # a shell may have had it ignored
                   f"os.kill(os.getpid(), signal.SIG{name})"], 10, 512)


def test_without_limits_it_runs_to_its_end():
    ended = child.run(["/bin/bash", "-c", "ulimit -v; exit 3"])
    assert (ended.code, ended.stdout) == (3, "unlimited\n")


def test_what_was_started_beside_ends_with_the_block_too(tmp_path):
    pid_file = tmp_path / "pid"
    with child.with_all(["/bin/bash", "-c", "echo begun; exit 7"]) as process:
        assert process.stdout.read() == "begun\n" and process.wait() == 7
    with pytest.raises(KeyError), child.with_all(["/bin/bash", "-c", f"sleep 100 & echo $! > {pid_file}; echo begun; wait"]) as process:
        process.stdout.readline()
        raise KeyError
    assert ended_soon(int(pid_file.read_text()))
