# One `mbs simulate` of the advice as a cell, and its row.
import json
import math
import re
import shlex
import time
from pathlib import Path

from analysis.core.files import digest
from analysis.core.outcomes import FINISHED, of_run
from study.core.cell import Cell
from study.tools.advise.choice import Pilot
from study.tools.advise.timing import in_time

FORCES_LOST = "forces-lost"  # of a pilot: it has all of its motion, but a force or acceleration that the scene asks for is off
EXACT, HALVED = "exact", "half-step"  # what a run tells of its error: the exact one, where it is known; an estimate, too
# Judged after every step, as the usual judging of a few may keep pace with the motion and miss its worst; but where steps
# times variables are above VALUES, of a share of them, JUDGED at least.
VALUES, JUDGED = 2e5, 100
REPEATS = 3  # of a motion whose time matters; each step's least counts, as what interrupts one run spares another
QUICK = 200  # steps of a run for its time


def folder_of(scene, *more):
    """The name of a folder: readable, and its own for every scene and whatever else is asked."""
    stem = re.sub(r"[^A-Za-z0-9]+", "-", Path(scene).name.removesuffix(".json")).strip("-")
    return f"{stem}-{digest(json.dumps([scene, *more]))[:8]}"


def typed(record):
    """What repeats the run of a record, to be typed where the repository is."""
    return shlex.join(["build/mbs", *(word for word in record.command[1:] if word != "--json")])


def within(duration, step, end):
    """A duration, or so much of it as whole steps, of which a run has the nearest number, cover before the drivers' `end`, if they have one."""
    return duration if math.floor(duration / step + 0.5) * step <= (end or math.inf) * (1 + 1e-9) else math.floor(duration / step) * step


def advised(command, library, duration):
    """A command line as it is advised: over all of the time, without a BLAS where `library` of `mbs list --json` is "none"."""
    words = shlex.split(command)
    words[words.index("--duration") + 1] = f"{duration:.12g}"
    if library == "none" and "--blas" in words:
        at = words.index("--blas")
        del words[at:at + 2]
    return shlex.join(words)


class Runner:
    """Runs simulations of one scene one after the other, and keeps a row of each. It has the clock of the question: `budget`, s, which began
    at `began` (of time.monotonic). `truth`: where it is known, what a run's series is held against (truth.py)."""

    def __init__(self, lab, scene, variables, contenders, deadline_us=None, budget=math.inf, began=None, end=None):
        self.lab, self.scene, self.variables, self.truth = lab, scene, variables, None
        self.budget, self.began = budget, time.monotonic() if began is None else began
        self.contenders = {one.name: one for one in contenders}
        self.deadline_us, self.end = deadline_us, end
        self.rows, self.wall, self.processor = [], 0.0, 0.0  # s, of all runs
        self.automatic = {}  # {(scheme, step): the automatic tolerance, m}

    def __call__(self, kind, setting, variant, step, duration, seconds, checks="", repeats=REPEATS):
        """The row of a run. `checks`: EXACT or HALVED where its error matters, not only its time. `step_us`, by which runs are ranked, is the
        mean over the steps of each one's least time over the repeats; the other times are those of the first repeat."""
        record = None
        if setting.loosened and (setting.scheme, step) not in self.automatic:  # a run of one step tells the automatic tolerance
            record = self._simulate("automatic", setting.parent, variant, step, step, seconds, setting.parent.words())
        tolerance = (setting.loosened or 0.0) * self.automatic.get((setting.scheme, step), 0.0)
        if tolerance or not setting.loosened:  # else the row is that of the run which should have told it
            repeated = ("--repeats", repeats) if repeats > 1 and checks != HALVED else ()
            every = max(1, min(int(duration / step / JUDGED), int(duration / step * self.variables / VALUES)))
            deadline = ("--deadline-us", f"{in_time(step, self.deadline_us):g}") if self.deadline_us else ()
            words = [*setting.words(tolerance=tolerance), *deadline, *repeated, *["--half-step"] * (checks == HALVED),
                     *(("--judge-every", every) if checks else ())]
            record = self._simulate(kind, setting, variant, step, duration, seconds, words, self.truth if checks == EXACT else None)
        status, reason = of_run(record)
        found = record.output
        times, least = found.get("step_us", {}), found.get("least_us") or {}
        row = {"kind": kind, "setting": setting.name, "implementation": variant, "step": step, "duration": duration, "status": status,
               "reason": reason, "estimate": found.get("position_error_estimate"), "exact": found.get("position_error_max"),
               "step_us": least.get("mean"), "step_us_mean": times.get("mean"), "step_us_median": times.get("median"),
               "step_us_p99": times.get("p99"),
               "deadline_misses": times.get("deadline_misses"),
               **{key: found.get(key) for key in ("steps", "passes_per_step", "penalty", "tolerance", "warnings", "branch_doubt", "forces_lost")},
               "seconds": record.seconds, "command": typed(record), "raw_file": f"raw/advise/{record.name}"}
        if self.truth and checks == EXACT and record.done and status in FINISHED:
            row["exact"] = self.truth.error(record.series)
        self.rows.append(row)
        return row

    def pilot(self, setting, variant, step, duration, seconds):
        row = self("pilots", setting, variant, step, duration, seconds, checks=HALVED)
        status, reason = (FORCES_LOST, row["forces_lost"]) if row["forces_lost"] else (row["status"], row["reason"])
        return Pilot(row["step"], status, row["estimate"], row["step_us_median"] or float("nan"), reason)

    def left(self, share=1.0):
        """Seconds of a share of the budget."""
        return share * self.budget - self.seconds

    def tell(self, text):
        self.lab.tell(f"{self.seconds:.0f} of {self.budget:g} s, {text}" if math.isfinite(self.budget) else text)

    # Since the question began; runs that are read from files count as when they were made, so that they decide alike.
    seconds = property(lambda self: time.monotonic() - self.began)
    # Share of the time of all runs in which they had no processor: other programs had it.
    waited = property(lambda self: min(0.9, max(0.0, 1.0 - self.processor / self.wall)) if self.wall > 1.0 else 0.0)
    slowdown = property(lambda self: 1.0 / (1.0 - self.waited))  # how many times longer runs take for that

    def _simulate(self, kind, setting, variant, step, duration, seconds, words, truth=None):
        seen = {"keep": truth.columns, "every": truth.every(step, duration)} if truth else {}
        known, began = len(self.lab.names), time.monotonic()
        words = ("--step", f"{step:.12g}", "--duration", f"{within(duration, step, self.end):.12g}", *words)
        record = self.lab.one(Cell("simulate", self.scene, (self.contenders[variant],), words, kind, timed=True, seconds=round(seconds, 3), **seen))
        if len(self.lab.names) > known:
            if time.monotonic() - began > 0.9 * record.seconds:
                self.wall, self.processor = self.wall + record.seconds, self.processor + record.machine.get("cpu_s", 0.0)
            else:  # read from a file
                self.began -= record.seconds
        if not setting.changes and record.output.get("tolerance"):
            self.automatic[setting.scheme, step] = record.output["tolerance"]
        return record
