# Runs one simulation of a subject with an implementation and a setting, and reads its row.
from dataclasses import dataclass
from pathlib import Path

from study.pipeline import runs
from study.pipeline.layout import Layout

NOT_RUN = "not-run"  # the status of what was left out, with its reason
SHORT = 0.02   # s of steps: a single run that is shorter says more of the machine's interruptions than of itself
REPEATS = 5    # of such a run in one process; each step's least time counts


@dataclass(frozen=True)
class Bench:
    layout: Layout
    contexts: dict
    time_limit: float  # s, a run that is predicted to take longer is not run

    @property
    def raw(self) -> Path:
        return self.layout.results / "raw"

    def run(self, kind, subject, contender, setting, step, *, duration=None, repeat=1, seconds=None,
            repeats=1):
        """The record of one simulation, with its "raw_file"; an existing file is never run again. `repeat`: the
        round; `repeats`: of the simulation in its process."""
        path = (self.raw / kind / subject.file_name / setting.file_name
                / f"{contender.file_name}-{step:g}"
                  f"{'-least' if repeats > 1 else ''}{f'-{repeat}' if repeat > 1 else ''}.json")
        record = runs.simulate(
            path, contender, subject.scene, step=step, duration=duration or subject.duration,
            every=subject.every(step), context=self.contexts[contender.environment],
            # Predictions may be wrong by half.
            seconds=seconds or 1.5 * self.time_limit, more=[
                *setting.words(subject.base), *subject.judging(step),
                *(["--repeats", repeats] if repeats > 1 else [])])
        return record | {"raw_file": self.layout.relative(path)}

    def steady(self, kind, subject, contender, setting, step):
        """The record of `run`, of a finished run that is SHORT (by its median step) that of REPEATS at once."""
        record = self.run(kind, subject, contender, setting, step)
        if runs.status(record)[0] not in runs.FINISHED:
            return record
        if 1e-6 * record["summary"]["step_us"]["median"] * record["summary"]["steps"] > SHORT:
            return record
        return self.run(kind, subject, contender, setting, step, repeats=REPEATS)


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
                  "repeats": summary.get("repeats", 1), "step_us": _step_us(summary)["mean"],
                  "step_us_median": _step_us(summary)["median"]}
    if status in runs.FINISHED:
        time = time_of(record)
        error = subject.error(record)
        found |= {"time": time, "time_low": time, "time_high": time,
                  "error": max(error, subject.own_error), "at_most": error <= subject.own_error}
    return found | {"raw_file": record["raw_file"],
                    "command": runs.typed(record)}


def time_of(record):
    """s of computation for a simulated second."""
    summary = record["summary"]
    return 1e-6 * _step_us(summary)["mean"] * summary["steps"] / summary["duration"]


def _step_us(summary):
    """Times of the steps; of a repeated run each step's least."""
    return summary["least_us"] if summary.get("repeats", 1) > 1 else summary["step_us"]


def _named(subject, implementation, setting, step):
    return {"subject": subject.name, "loops": subject.loops, "implementation": implementation,
            "setting": setting, "step": step}
