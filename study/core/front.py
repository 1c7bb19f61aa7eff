# Runs Snakemake in the background and shows the part, the cells done of all and the time left.
import os
import re
import shutil
import signal
import subprocess
import sys
import time

from analysis.core.errors import StudyError
from analysis.core.files import ROOT, write_json
from study.core import child
from study.core.job import FRONT
from study.core.progress import Reader, duration


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
            self.take(line)
            if line.startswith("error: "):
                self.error = self.error or line.removeprefix("error: ").strip()

    def take(self, line):
        """For those that show it."""

    def last_words(self):
        wrong = [line for line in self.lines if "rror" in line]
        return f"a stage failed: {(wrong or self.lines or ['no word of it'])[-1][:300]}"


class _Cells(Follower):
    """Turns progress events and Snakemake's log into what the display shows."""

    def __init__(self, studyset, columns, display):
        super().__init__(studyset)
        self.columns, self.display, self.events = columns, display, Reader(studyset.progress)
        self.done_columns = {(part, column) for part, names in columns.items() for column in names
                             if studyset.stamp(part, column).exists()}
        self.now, self.cells, self.expected, self.text = None, 0, 0, ""
        self.since = time.monotonic()

    def take(self, line):
        if re.match(r"rule (\w+):", line) and not self.now and not any(self.columns.values()):  # of a stored set nothing is run
            self.display.show("pages")

    def update(self):
        super().update()
        events = self.events.events()
        for event in events:
            self._take(event)
        if self.now and events:
            self._show()

    def _take(self, event):
        at = event["part"], event["column"]
        if at != self.now:
            if self.now:
                self.done_columns.add(self.now)
            self.now, self.cells, self.expected, self.text, self.since = at, 0, 0, "", time.monotonic()
        self.expected += event.get("expected", 0)
        self.cells += event.get("done", 0)
        self.text = event.get("text", self.text)

    def _show(self):
        part, column = self.now
        left = sum(seconds for one, names in self.columns.items() for name, seconds in names.items()
                   if (one, name) not in self.done_columns) - (time.monotonic() - self.since)
        place = list(self.columns).index(part) + 1
        total = max(self.expected, self.cells)
        self.display.show(f"[{place}/{len(self.columns)}] {part}", f"{column}: {self.cells} of {total} cells, "
                          f"at most {duration(left)} left" + (f"; {self.text}" if self.text else ""))


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
