# Runs one `mbs` as a child with a hard time limit and a memory limit, and says how it ended; or what has children of its own.
import contextlib
import errno
import os
import re
import select
import signal
import subprocess
import tempfile
import threading
import time
from collections import namedtuple

from analysis.core.files import ROOT, StudyError

MEMORY_WORDS = re.compile(r"bad_alloc|(out of|not enough) memory|cannot allocate|std::length_error", re.I)
GRACE = 1.0  # s between being asked to end and being made to
ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "GOTO_NUM_THREADS", "BLIS_NUM_THREADS",
                                     "MKL_NUM_THREADS")}  # else `mbs` sees to it, and starts a second time for that
OUTPUT_LIMIT = 256 * 2**20  # bytes a child may write to any file
ENDS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
_signals = []  # received; compiled code of libraries may swallow what their handler raises


def end_on_signals():
    """Lets these signals, unless they are ignored, end the study, at the latest before its next child: by a KeyboardInterrupt with the number."""
    def end(number, _):
        _signals.append(number)
        raise KeyboardInterrupt(number)
    for number in ENDS:
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, end)


# status: "exited", "crashed", "timeout" or "out-of-memory"; code: None if it did not end; stderr: its end; cpu_s: of its children, too
Ended = namedtuple("Ended", "status reason code stdout stderr seconds cpu_s")


def run(command, seconds=None, memory_mb=None, alone=False):
    """Runs `command` in ROOT, within limits if they are given; it and all its children are gone when this returns or raises. `alone`: it
    stays on one processor."""
    if _signals:  # a pool's thread would die of the first, with a traceback
        raise KeyboardInterrupt(_signals[0]) if threading.current_thread() is threading.main_thread() else StudyError("interrupted")
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        begin = time.monotonic()
        on_one = ["taskset", "--cpu-list", str(max(os.sched_getaffinity(0)))] if alone else []  # the last that this process may use
        child = subprocess.Popen([*on_one, *_limited(command, memory_mb)], cwd=ROOT, stdin=subprocess.DEVNULL, stdout=out,
                                 stderr=err, start_new_session=True, env=os.environ | ONE_THREAD)
        try:
            if not (ended := _ends(child, seconds)):
                os.kill(child.pid, signal.SIGTERM)  # so that it can say in what it was
                _ends(child, GRACE)
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(child.pid, signal.SIGKILL)
            _, status, used = os.wait4(child.pid, 0)
            child.returncode = os.waitstatus_to_exitcode(status)  # Popen has not seen it
        code = child.returncode if ended else None
        if ended and -code in ENDS:  # sent to this process's group, too, before the child had left it: no result
            raise StudyError(f"interrupted: {command[0]} was ended by {signal.Signals(-code).name} from outside; "
                             "the same command goes on from there")
        took = time.monotonic() - begin
        stdout, stderr = _text(out), _text(err, tail=4000)
    return Ended(*_judge(code, stderr, seconds, memory_mb), code, stdout, stderr, took, used.ru_utime + used.ru_stime)


def _ends(child, seconds):
    """Whether the child ends within that time; told at once, where `Popen.wait` looks every 50 ms."""
    handle = os.pidfd_open(child.pid)
    try:
        return bool(select.select([handle], [], [], seconds)[0])
    finally:
        os.close(handle)


def tied(script, *words, end="KILL"):
    """The words that start a shell script on `words`, which gets the signal `end` when this process ends, however that ends. By programs of the
    system: what Python runs between fork and exec makes it copy the tables of its memory, 8 ms with pandas loaded."""
    return ["setpriv", "--pdeathsig", end, "/bin/sh", "-c", f'[ "$PPID" = "$1" ] || exit; shift; {script}', "sh", str(os.getpid()), *words]


@contextlib.contextmanager
def with_all(command):
    """A Popen of `command` in ROOT, for its output. It and all that it started are told to end when the block is left, or when
    this process ends, however that ends: told, not killed, as compilers have process groups that only their ninja knows."""
    words = tied("""trap 'trap "" TERM; kill 0; wait' TERM; "$@" & wait $!""", *command, end="TERM")
    process = subprocess.Popen(words, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", start_new_session=True)
    with process:  # closes its output and waits for its end
        try:
            yield process
        finally:
            process.terminate()


def _limited(command, memory_mb):
    """The words that start `command` so that it never outlives this process, nor passes its limits."""
    if not (ROOT / command[0]).exists():
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), command[0])
    return tied('ulimit -c 0; ulimit -f "$1"; ulimit -v "$2"; shift 2; exec "$@"', str(OUTPUT_LIMIT // 512),
                str(memory_mb * 1024) if memory_mb else "unlimited", *command)


def _text(file, tail=None):
    file.seek(max(0, file.seek(0, os.SEEK_END) - tail) if tail else 0)
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
