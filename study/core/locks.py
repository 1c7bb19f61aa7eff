# Locks that vanish with the process that holds them; other load on the machine that is locked.
import contextlib
import fcntl
import os
import time
from pathlib import Path

from analysis.core.files import StudyError

POLL = 0.5  # s
MACHINE = Path(os.environ.get("MBS_LOCKS", "/tmp"))  # one place whatever a job's TMPDIR is; tests have theirs
# Of the processors, by the load's mean over a minute, from which the machine is busy, without what is timed: as `mbs bench` has it.
OTHERS = max(0.5, (os.cpu_count() or 1) / 2 - 1)


def only_one(folder, seconds=0):
    """Holds the results in `folder`, also against other machines that share it."""
    return _hold(Path(folder) / ".lock", f"another study is running in {folder}", seconds)


def noting(folder):
    """Holds the facts of the set in `folder` for a moment."""
    return _hold(Path(folder) / ".noting", f"{folder}/.noting is held for longer than anybody needs it", 60)


@contextlib.contextmanager
def only_one_study(wait=False, tell=print, most=float("inf")):
    """Holds the machine for a study; with `wait` behind the others, for `most` seconds. Says so where the machine is busy."""
    path = MACHINE / "mbs-study.lock"
    held = f"another study is measuring on this machine ({path} is held): wait until it is done, or queue with --wait"
    with _hold(path, held, most if wait else 0, tell):
        if (load := os.getloadavg()[0]) > OTHERS:
            tell(f"the machine is busy (load {load:.1f} over the last minute): times may be too long")
        yield


def only_one_timing():
    """Holds the machine for what is timed: whoever measures holds it, not the study that it belongs to, which may have died a moment ago."""
    path = MACHINE / "mbs-timing.lock"
    return _hold(path, f"something else is being timed on this machine ({path} is held)", 30)


@contextlib.contextmanager
def _hold(path, held, seconds, tell=lambda text: None):
    try:
        file = _opened(path)
    except OSError as error:
        raise StudyError(f"cannot open the lock {path}: {error.strerror}") from error
    try:
        end, told = time.monotonic() + seconds, False
        while True:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                break
            except BlockingIOError as error:
                if time.monotonic() >= end:
                    raise StudyError(held) from error
            except OSError as error:  # not every network file system has locks
                raise StudyError(f"cannot lock {path}: {error.strerror}") from error
            if not told:
                tell("waiting until another study is done")
                told = True
            time.sleep(POLL)
        yield
    finally:
        os.close(file)


def _opened(path):
    """For writing, which a lock in a folder of several machines (NFS) asks for; another user's file in /tmp can be opened
    for reading only, and not with O_CREAT."""
    try:
        return os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
    except PermissionError:
        return os.open(path, os.O_RDONLY)
