# Error against time of every engine and setting, from coarse to fine.
import numpy

from study.accuracy_study.bench import NOT_RUN
from study.accuracy_study.work import of_no_use, too_long
from study.engines.programs import named, row

FINER = {"step": 2.0, "accuracy": 2.5}  # predicted: how much longer the next value of a curve takes


def measure(bench, subject, listed, missing, tell):
    """The rows of engines.csv of one subject. `missing`: {engine: why it is left out}."""
    rows = []
    for engine, settings in listed.items():
        if missing.get(engine):
            rows.append({"subject": subject.name, "loops": subject.loops, "engine": engine, "rounds": 0,
                         "status": "unavailable", "status_reason": missing[engine]})
            continue
        mine = []
        for setting in settings:
            tell(f"{subject.name}: {engine}, {setting.name}")
            mine += _curve(bench, subject, setting, mine)
        rows += mine
    return rows


def _curve(bench, subject, setting, known):
    """Until a run would take too long, or finer values are of no use. `known`: the engine's other rows."""
    rows, ahead = [], 0.0
    for value in setting.values:
        reason = too_long(ahead, bench.time_limit) or of_no_use(rows, known)
        if reason:
            rows.append(named(subject, setting, value) | {
                "status": NOT_RUN, "status_reason": reason, "rounds": 0})
            continue
        record = bench.steady(subject, setting, value)
        rows.append(row(subject, setting, value, record))
        ahead = _ahead(subject, setting, record)
    return rows


def _ahead(subject, setting, record):
    """Predicted seconds of the run with the next value; a run that was lost early counts as if it had ended."""
    if record.get("failure", {}).get("status") == "timeout":
        return numpy.inf
    time = record.get("summary", {}).get("time") or 0.0
    return FINER[setting.over] * time * subject.duration
