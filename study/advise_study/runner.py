# One `mbs simulate` of the advice as a raw file, and its row; what `mbs describe` says of the scene.
import json
import shlex
import time
from pathlib import Path

from study.advise_study.choice import Pilot
from study.advise_study.settings import LOOSE
from study.pipeline import child, runs
from study.pipeline.errors import StudyError
from study.pipeline.layout import ROOT, program


# After every step: the usual judging of a few of them may keep pace with the motion and miss its worst.
EXACT = ("--judge-every", "1")  # for the exact error
HALVED = ("--half-step", *EXACT)  # for an estimate beside it
REPEATS = 3  # of a motion whose time matters; each step's least counts, as what interrupts one run spares another


def describe(scene):
    """`mbs describe --json`; StudyError with its own words if there is no such scene."""
    ended = child.run([program(), "describe", scene, "--json"], 60, runs.MEMORY_MB)
    if ended.status != "exited" or ended.code != 0:
        raise StudyError(ended.reason.partition("mbs: ")[2] or f"{scene}: {ended.reason}")
    return json.loads(ended.stdout)


def scene_name(text):
    """A scene as programs that run in ROOT find it; a file in the repository without the machine's path."""
    if not Path(text).is_file():
        return text
    path = Path(text).resolve()
    return str(path.relative_to(ROOT)) if path.is_relative_to(ROOT) else str(path)


def advised(command, library):
    """A verified command line as it is advised: without what only tells its error, and without a BLAS where
    `library` of `mbs list --json` is "none"."""
    words = shlex.split(command)
    for option, count in ((HALVED[0], len(HALVED)), *([("--blas", 2)] if library == "none" else [])):
        at = words.index(option) if option in words else len(words)
        del words[at:at + count]
    return shlex.join(words)


class Runner:
    """Runs simulations of one scene one after the other, and keeps a row of each."""

    def __init__(self, layout, scene, contenders, contexts, deadline_us=None):
        self.layout, self.scene = layout, scene
        self.contenders, self.contexts = contenders, contexts
        self.deadline = ["--deadline-us", f"{deadline_us:g}"] if deadline_us else []
        self.rows, self.began = [], time.monotonic()

    def __call__(self, kind, setting, variant, step, duration, seconds, checks=()):
        """The row of a run: kind, setting, implementation, step, outcome, times, command, raw_file. `checks`: EXACT
        or HALVED where its error matters, not only its time. `step_us`, by which runs are ranked, is the mean over
        the steps of each one's least time over the repeats; the other times are those of the first repeat."""
        repeats = [] if checks == HALVED else ["--repeats", str(REPEATS)]
        more = [*setting.options(self._tolerance(setting, variant, step)), *self.deadline, *repeats, *checks]
        record, path = self._simulate(kind, setting, variant, step, duration, seconds, more)
        status, reason = runs.status(record)
        summary = record.get("summary", {})
        times = summary.get("step_us", {})
        row = {"kind": kind, "setting": setting.label, "implementation": variant, "step": step,
               "duration": duration, "status": status, "reason": reason,
               "estimate": summary.get("position_error_estimate"),
               "exact": summary.get("position_error_max"),
               "step_us": (summary.get("least_us") or {}).get("mean"), "step_us_median": times.get("median"),
               "step_us_p99": times.get("p99"),
               "step_us_max": times.get("max"),
               "deadline_misses": times.get("deadline_misses")} | {
                   key: summary.get(key) for key in ("steps", "passes_per_step", "penalty",
                                                     "tolerance")} | {
               "seconds": record["seconds"], "command": runs.typed(record),
               "raw_file": self.layout.relative(path)}
        self.rows.append(row)
        return row

    def pilot(self, setting, variant, step, duration, seconds, kind="pilots"):
        return as_pilot(self(kind, setting, variant, step, duration, seconds, checks=HALVED))

    def _simulate(self, kind, setting, variant, step, duration, seconds, more):
        contender = self.contenders[variant]
        path = (self.layout.results / "raw" / kind / contender.file_name
                / f"{setting.file_name}-{step:g}-{duration:g}.json")
        return runs.simulate(path, contender, self.scene, step=step, duration=duration, every=0,
                             context=self.contexts[contender.environment], seconds=seconds, more=more), path

    def _tolerance(self, setting, variant, step):
        """What the automatic tolerance, which a run of one step tells, is loosened to, m."""
        if not setting.loose:
            return None
        plain = setting.parent
        record, _ = self._simulate("automatic", plain, variant, step, step, 60, plain.options())
        return LOOSE * record.get("summary", {}).get("tolerance", 1e-9)


def as_pilot(row):
    return Pilot(row["step"], row["status"], row["estimate"], row["step_us_median"] or float("nan"),
                 row["step_us_p99"] or float("nan"), row["reason"])
