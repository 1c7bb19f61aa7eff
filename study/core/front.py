# Runs Snakemake in the background and shows the part, the cells done of all and the time left.
import os
import shutil
import signal
import subprocess
import sys
import time

from analysis.core.errors import StudyError
from analysis.core.files import ROOT, read_json, write_json
from study.core import child
from study.core.job import FRONT


class Display:
    """One line that is rewritten on a terminal; a line now and then elsewhere."""
    EVERY = 20.0  # s

    def __init__(self):
        self.terminal, self.shown, self.stage, self.when = sys.stdout.isatty(), "", None, 0.0

    def show(self, stage, text=""):
        line, now = f"{stage}: {text}" if text else stage, time.monotonic()
        if self.terminal:
            print(f"\r\033[K{line[:110]}", end="", flush=True)
        elif stage != self.stage or (line != self.shown and now - self.when > self.EVERY):
            print(line, flush=True)
        else:
            return
        self.stage, self.shown, self.when = stage, line, now

    def end(self):
        if self.terminal and self.shown:
            print(flush=True)
        self.shown = ""


def run_workflow(studyset, columns, stored=False):
    """Runs the workflow to its end. `columns`: {part: {column: seconds}}. Raises StudyError, or KeyboardInterrupt
    once all children are gone."""
    write_json(studyset.folder / ".parts.json", list(columns))
    follow(studyset, _command(studyset, stored), lambda display: _Cells(studyset, columns, display))


def follow(studyset, command, follower_of, ends=(signal.SIGTERM, signal.SIGKILL)):
    """Runs Snakemake to its end, shown by a Follower. `ends`: signals that stop it, each after the one before."""
    display = Display()
    with open(studyset.log, "a", encoding="utf-8") as log:
        follower = follower_of(display)
        process = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT, cwd=studyset.folder,
                                   start_new_session=True, preexec_fn=lambda parent=os.getpid(): child.die_with(parent),
                                   env=os.environ | {FRONT: str(os.getpid())})
        try:
            while process.poll() is None:
                follower.update()
                time.sleep(0.15)
            follower.update()
        finally:
            _stop(process, ends)
            display.end()
    if process.returncode != 0 and shutil.disk_usage(studyset.folder).free < 2**20:
        raise StudyError(f"no space is left for {studyset.folder}; what is finished is kept: make room and run it again")
    if process.returncode != 0:
        raise StudyError(f"{follower.error or follower.last_words()} (log: {studyset.log})")


def _command(studyset, stored):
    return ["/usr/bin/python3", "-m", "snakemake", "--snakefile", str(ROOT / "study" / "Snakefile"),
            "--directory", str(studyset.folder), "--cores", "all", "--scheduler", "greedy",
            "--rerun-triggers", "mtime", "--rerun-incomplete", "--nolock", "--nocolor", *(["--forceall"] if stored else []),
            "--config", f"stored={int(stored)}"]


class Follower:
    """What the log says from here on."""

    def __init__(self, studyset):
        self.log, self.error, self.lines = open(studyset.log, encoding="utf-8", errors="replace"), None, []
        self.log.seek(0, os.SEEK_END)

    def update(self):
        for line in self.log.readlines():
            self.lines = [*self.lines, line.strip()][-12:]
            if line.startswith("error: "):
                self.error = self.error or line.removeprefix("error: ").strip()

    def last_words(self):
        wrong = [line for line in self.lines if "rror" in line]
        return f"a stage failed: {(wrong or self.lines or ['no word of it'])[-1][:300]}"


class _Cells(Follower):
    """Shows the part and its column at work, and the time left."""

    def __init__(self, studyset, columns, display):
        super().__init__(studyset)
        self.set, self.columns, self.display = studyset, columns, display
        self.now, self.since = None, 0.0
        studyset.progress.unlink(missing_ok=True)

    def update(self):
        super().update()
        if self.set.progress.exists():
            self._show(**read_json(self.set.progress))
        elif self.lines and not any(self.columns.values()):  # of a stored set nothing is run
            self.display.show("pages")

    def _show(self, part, column, cells, text):
        if (part, column) != self.now:
            self.now, self.since = (part, column), time.monotonic()
        ahead = sum(seconds for one, names in self.columns.items() for name, seconds in names.items()
                    if not self.set.stamp(one, name).exists())
        left = duration(ahead - (time.monotonic() - self.since))
        self.display.show(f"[{list(self.columns).index(part) + 1}/{len(self.columns)}] {part}",
                          f"{column}: {cells}, at most {left} left" + (f"; {text}" if text else ""))


def _stop(process, ends):
    """Ends Snakemake and everything that it started here."""
    for sign in ends:
        if process.poll() is not None:
            return
        os.killpg(process.pid, sign)
        try:
            process.wait(timeout=10)
        except subprocess.TimeoutExpired:
            continue


def duration(seconds):
    """The text "1 min 20 s"."""
    seconds = max(0, round(seconds))
    if seconds < 60:
        return f"{seconds} s"
    if seconds < 3600:
        return f"{seconds // 60} min {seconds % 60} s"
    return f"{seconds // 3600} h {seconds % 3600 // 60} min"
