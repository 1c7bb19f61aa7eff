# Runs one `mbs` as a child with a hard time limit and a memory limit, and says how it ended.
import contextlib
import ctypes
import os
import re
import resource
import signal
import subprocess
import tempfile
import threading
import time
from dataclasses import dataclass

from analysis.core.errors import StudyError
from analysis.core.files import ROOT

MEMORY_WORDS = re.compile(r"bad_alloc|(out of|not enough) memory|cannot allocate|std::length_error",
                          re.I)
GRACE = 1.0  # s between being asked to end and being made to
OUTPUT_LIMIT = 256 * 2**20  # bytes a child may write to any file


class Signalled(KeyboardInterrupt):
    """SIGINT, SIGTERM or SIGHUP: the study ends, and says how to resume."""

    def __init__(self, number):
        super().__init__()
        self.number = number


_signals = []  # received; compiled code of libraries may swallow what their handler raises


def end_on_signals():
    """Lets these signals, unless they are ignored, end the study, at the latest before its next child."""
    def end(number, _):
        _signals.append(number)
        raise Signalled(number)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, end)


@dataclass(frozen=True)
class Ended:
    status: str  # "exited", "crashed", "timeout" or "out-of-memory"
    reason: str
    code: int | None
    stdout: str
    stderr: str  # its end
    seconds: float


def run(command, seconds, memory_mb):
    """Runs `command` in ROOT; it and all its children are gone when this returns or raises."""
    if _signals:  # a pool's thread would die of the first, with a traceback
        own = threading.current_thread() is threading.main_thread()
        raise Signalled(_signals[0]) if own else StudyError("interrupted")
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        begin = time.monotonic()
        child = subprocess.Popen(command, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=out,
                                 stderr=err, start_new_session=True,
                                 preexec_fn=lambda parent=os.getpid(): _limit(memory_mb, parent))
        try:
            code = child.wait(timeout=seconds)
        except subprocess.TimeoutExpired:
            code = None
            child.terminate()  # so that it can say in what it was
            with contextlib.suppress(subprocess.TimeoutExpired):
                child.wait(timeout=GRACE)
        finally:
            _end_group(child)
        took = time.monotonic() - begin
        stdout, stderr = _text(out), _text(err, tail=4000)
    return Ended(*_judge(code, stderr, seconds, memory_mb), code, stdout, stderr, took)


def die_with(parent):
    """In a child that process `parent` has just started: it is killed when that ends."""
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG
    if os.getppid() != parent:  # which has ended meanwhile
        os._exit(1)


def _limit(memory_mb, parent):
    die_with(parent)  # never outlive the study
    resource.setrlimit(resource.RLIMIT_AS, (memory_mb * 2**20,) * 2)
    resource.setrlimit(resource.RLIMIT_FSIZE, (OUTPUT_LIMIT,) * 2)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def _end_group(child):
    try:
        os.killpg(child.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    child.wait()


def _text(file, tail=None):
    size = file.seek(0, os.SEEK_END)
    file.seek(max(0, size - tail) if tail else 0)
    return file.read().decode("utf-8", "replace")


def _judge(code, stderr, seconds, memory_mb):
    lines = [line.strip() for line in stderr.splitlines() if line.strip()]
    last = f": {lines[-1][:300]}" if lines else ""
    if code is None:
        return "timeout", f"did not end within {seconds:g} s"
    if code != 0 and MEMORY_WORDS.search(stderr):
        return "out-of-memory", f"needs more than {memory_mb} MB{last}"
    if code == -signal.SIGKILL:
        return "crashed", "SIGKILL from outside, as the system sends it when memory runs out"
    if code < 0:
        return "crashed", f"{signal.Signals(-code).name} ({signal.strsignal(-code)}){last}"
    return "exited", f"exit status {code}{last}"
