# Runs one simulation of a subject with an implementation and a setting, and reads its row.
import shlex
from dataclasses import dataclass
from pathlib import Path

from study.pipeline import runs
from study.pipeline.layout import Layout

NOT_RUN = "not-run"  # the status of what was left out, with its reason


@dataclass(frozen=True)
class Bench:
    layout: Layout
    contexts: dict
    time_limit: float  # s, a run that is predicted to take longer is not run

    @property
    def raw(self) -> Path:
        return self.layout.results / "raw"

    def run(self, kind, subject, contender, setting, step, *, duration=None, repeat=1, seconds=None):
        """The record of one simulation, with its "raw_file"; an existing file is never run again."""
        path = (self.raw / kind / subject.file_name / setting.file_name
                / f"{contender.file_name}-{step:g}{f'-{repeat}' if repeat > 1 else ''}.json")
        record = runs.simulate(
            path, contender, subject.scene, step=step, duration=duration or subject.duration,
            every=subject.every(step), context=self.contexts[contender.environment],
            # Predictions may be wrong by half.
            seconds=seconds or 1.5 * self.time_limit, more=[*setting.words(subject.base), *subject.judging(step)])
        return record | {"raw_file": self.layout.relative(path)}


def left_out(subject, variant, setting, step, reason):
    """The row of a run that was not made."""
    return _named(subject, variant, setting.name, step) | {
        "status": NOT_RUN, "status_reason": reason, "rounds": 0}


def row(subject, variant, setting, step, record):
    """What tables say of a run. `time`: s of computation for a simulated second."""
    status, reason = runs.status(record)
    found = _named(subject, variant, setting.name, step) | {
        "status": status, "status_reason": reason, "rounds": 1}
    if "summary" in record:
        summary = record["summary"]
        found |= {key: summary[key] for key in (
            "variables", "passes_per_step", "factorizations_per_step", "steps_at_limit", "penalty",
            "tolerance", "duration") if key in summary}
        found |= {"fill": summary.get("tangent_nonzeros", 0) / summary["variables"]**2,
                  "step_us": summary["step_us"]["mean"],
                  "step_us_median": summary["step_us"]["median"]}
    if status in runs.FINISHED:
        time = time_of(record)
        error = subject.error(record)
        found |= {"time": time, "time_low": time, "time_high": time,
                  "error": max(error, subject.own_error), "at_most": error <= subject.own_error}
    return found | {"raw_file": record["raw_file"],
                    "command": shlex.join(["build/mbs", *record["command"][1:]])}


def time_of(record):
    """s of computation for a simulated second."""
    summary = record["summary"]
    return 1e-6 * summary["step_us"]["mean"] * summary["steps"] / summary["duration"]


def _named(subject, implementation, setting, step):
    return {"subject": subject.name, "loops": subject.loops, "implementation": implementation,
            "setting": setting, "step": step}
