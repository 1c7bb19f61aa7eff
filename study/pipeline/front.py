# Runs Snakemake in the background and shows stage, cells done of total and the time left.
import os
import signal
import subprocess
import sys
import time

from study.pipeline import estimate
from study.pipeline.errors import StudyError
from study.pipeline.layout import ROOT
from study.pipeline.progress import Reader

STAGES = ("set-up", "verify", "measure", "collect", "figures", "report")


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
            "--directory", str(layout.results), "--cores", "1", "--scheduler", "greedy",
            "--rerun-triggers", "mtime", "--rerun-incomplete", "--nolock", "--nocolor",
            *(["--forceall"] if stored else []),
            "--config", f"root={ROOT}", f"stored={int(stored)}",
            f"columns={'+'.join(map(str, columns))}"]


def run_workflow(layout, columns, plan, stored=False):
    """Runs the workflow to its end. Raises StudyError, or KeyboardInterrupt once all children are
    gone; `plan` is estimate.work() (empty for stored results)."""
    for (stage, variables), work in plan.items():
        path = layout.plan(variables) if stage == "verify" else layout.measured(variables)
        work.done = work.cells if path.exists() else 0
    display, reader = Display(), Reader(layout)
    with open(layout.log, "a", encoding="utf-8") as log:
        process = subprocess.Popen(snakemake_command(layout, columns, stored), stdout=log,
                                   stderr=subprocess.STDOUT, start_new_session=True,
                                   cwd=layout.results)
        follower = _Follower(layout, plan, display, reader)
        try:
            while process.poll() is None:
                follower.update()
                time.sleep(0.15)
            follower.update()
        finally:
            _stop(process)
            display.end()
            layout.progress.unlink(missing_ok=True)
    if process.returncode != 0:
        reason = follower.error or "a stage failed"
        raise StudyError(f"{reason} (log: {layout.log})")


class _Follower:
    """Turns progress events and new files into what the display shows."""

    def __init__(self, layout, plan, display, reader):
        self.layout, self.plan, self.display, self.reader = layout, plan, display, reader
        self.begin, self.spent, self.predicted, self.error = time.time(), 0.0, 0.0, None

    def update(self):
        for event in self.reader.events():
            self.error = event.get("error", self.error)
            work = self.plan.get((event["stage"], event["variables"]))
            if work and "cells" in event:
                work.done = min(work.cells, work.done + event["cells"])
                if event["seconds"] > 0.01:  # resumed cells are instant and say nothing
                    self.spent += event["seconds"]
                    self.predicted += work.seconds * event["cells"] / work.cells
        for stage in ("verify", "measure"):
            of_stage = {key: work for key, work in self.plan.items() if key[0] == stage}
            if any(work.done < work.cells and not self._complete(*key)
                   for key, work in of_stage.items()):
                self._show_cells(stage, of_stage)
                return
        self.display.show(self._late_stage())

    def _complete(self, stage, variables):
        path = self.layout.plan if stage == "verify" else self.layout.measured
        return path(variables).exists()

    def _show_cells(self, stage, of_stage):
        variables = next(key[1] for key, work in of_stage.items() if work.done < work.cells)
        done = sum(work.done for work in of_stage.values())
        total = sum(work.cells for work in of_stage.values())
        left = estimate.duration(estimate.seconds_left(self.plan, self.spent, self.predicted))
        self.display.show(stage, f"n = {variables}: {done} of {total} cells, about {left} left")

    def _late_stage(self):
        def fresh(name):
            path = self.layout.results / name
            return path.exists() and path.stat().st_mtime >= self.begin
        if fresh("figures/step_time.svg"):
            return "report" if fresh("figures/phases.svg") else "figures"
        return "figures" if fresh("tidy.csv") else "collect"


def _stop(process):
    """Ends Snakemake and everything it started; half-written files are only ever *.partial."""
    for sign in (signal.SIGTERM, signal.SIGKILL):
        if process.poll() is not None:
            return
        os.killpg(process.pid, sign)
        try:
            process.wait(timeout=10)
        except subprocess.TimeoutExpired:
            continue
