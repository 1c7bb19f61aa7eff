# Runs Snakemake in the background and shows stage, cells done of total and the time left.
import os
import re
import signal
import subprocess
import sys
import time

from study.pipeline import estimate
from study.pipeline.errors import StudyError
from study.pipeline.layout import ROOT
from study.pipeline.progress import Reader, duration

STAGES = ("set-up", "verify", "measure", "refine", "collect", "figures", "report")


class Display:
    """One line that is rewritten on a terminal; a line now and then elsewhere."""

    def __init__(self):
        self.terminal = sys.stdout.isatty()
        self.shown, self.stage, self.when = "", None, 0.0

    def show(self, stage, text=""):
        line = f"[{STAGES.index(stage) + 1}/{len(STAGES)}] {stage:8} {text}".rstrip()
        now = time.monotonic()
        if self.terminal:
            new_line = "\n" if self.stage not in (None, stage) else ""
            print(f"{new_line}\r\033[K{line[:100]}", end="", flush=True)
        elif stage != self.stage or (line != self.shown and now - self.when > 15):
            print(line, flush=True)
        else:
            return
        self.stage, self.shown, self.when = stage, line, now

    def end(self):
        if self.terminal and self.shown:
            print(flush=True)
        self.shown = ""


def snakemake_command(layout, columns, stored):
    return ["/usr/bin/python3", "-m", "snakemake", "--snakefile", str(ROOT / "study" / "Snakefile"),
            "--directory", str(layout.results), "--cores", "2", "--scheduler", "greedy",
            "--rerun-triggers", "mtime", "--rerun-incomplete", "--nolock", "--nocolor",
            *(["--forceall"] if stored else []),
            "--config", f"root={ROOT}", f"stored={int(stored)}",
            f"columns={'+'.join(map(str, columns))}"]


def run_workflow(layout, columns, plan, stored=False):
    """Runs the workflow to its end. Raises StudyError, or KeyboardInterrupt once all children are
    gone; `plan` is estimate.work() (empty for stored results)."""
    for (stage, variables), work in plan.items():
        work.done = work.cells if _finished(layout, stage, variables) else 0
    display = Display()
    with open(layout.log, "a", encoding="utf-8") as log:
        follower = _Follower(layout, plan, display)
        process = subprocess.Popen(snakemake_command(layout, columns, stored), stdout=log,
                                   stderr=subprocess.STDOUT, start_new_session=True,
                                   cwd=layout.results)
        try:
            while process.poll() is None:
                follower.update()
                time.sleep(0.15)
            follower.update()
        finally:
            _stop(process)
            display.end()
            for path in [layout.progress, *(layout.results / "raw").rglob("*.partial*")]:
                path.unlink(missing_ok=True)
    if process.returncode != 0:
        raise StudyError(f"{follower.error or 'a stage failed'} (log: {layout.log})")


def _finished(layout, stage, variables):
    if stage == "refine":
        return layout.refined_stamp.exists()
    path = layout.plan if stage == "verify" else layout.measured
    return path(variables).exists()


class _Follower:
    """Turns progress events and Snakemake's log into what the display shows."""

    def __init__(self, layout, plan, display):
        self.layout, self.plan, self.display = layout, plan, display
        self.events, self.log = Reader(layout), open(layout.log, encoding="utf-8")
        self.log.seek(0, 2)
        self.stage, self.error, self.column, self.text = None, None, None, ""
        self.spent, self.predicted = 0.0, 0.0

    def update(self):
        for event in self.events.events():
            self.column, self.text = event["variables"], event["text"]
            work = self.plan[event["stage"], self.column]
            work.done = min(work.cells, work.done + event["cells"])
            if event["seconds"] > 0.01:  # resumed cells are instant and say nothing
                self.spent += event["seconds"]
                self.predicted += work.seconds * event["cells"] / work.cells
        for line in self.log.readlines():
            rule = re.match(r"rule (\w+):", line)
            self.stage = rule.group(1).replace("figure", "figures") if rule else self.stage
            if line.startswith("error: "):
                self.error = self.error or line.removeprefix("error: ").strip()
        if self.stage in ("verify", "measure"):
            self._show_cells()
        elif self.stage == "refine":
            work = self.plan["refine", 0]
            self.display.show(self.stage, f"{work.done:.0f} of {work.cells:.0f} s; {self.text}")
        elif self.stage in STAGES:
            self.display.show(self.stage)

    def _show_cells(self):
        mine = {key: work for key, work in self.plan.items() if key[0] == self.stage}
        done = sum(work.done for work in mine.values())
        total = sum(work.cells for work in mine.values())
        left = duration(estimate.seconds_left(self.plan, self.spent, self.predicted))
        size = f"n = {self.column}: " if self.column else ""
        self.display.show(self.stage, f"{size}{done:.0f} of {total:.0f} cells, about {left} left")


def _stop(process):
    """Ends Snakemake and everything it started; half-written files are only ever *.partial*."""
    for sign in (signal.SIGTERM, signal.SIGKILL):
        if process.poll() is not None:
            return
        os.killpg(process.pid, sign)
        try:
            process.wait(timeout=10)
        except subprocess.TimeoutExpired:
            continue
