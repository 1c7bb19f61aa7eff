# What a record says of one run, of an engine's or of ours.
import math
from pathlib import PurePath

from analysis.core.controls import CONTROL
from analysis.core.outcomes import FINISHED, of_run
from analysis.engines.subjects import FLOOR, subject_of

ENGINE, OURS, ROUND = "engine", "ours", "round"  # roles of cells
OVER = ("step", "accuracy")                      # what changes along a curve
NATIVE = "+native"                               # of an engine that was built with our flags


def row(record):
    """`name`: the engine or implementation; `time`: s of computation for a simulated second; `error`: NaN where it was timed; `key`: what a run has
    in common with its repetition there."""
    subject, (status, reason) = subject_of(record.column), of_run(record)
    engine = PurePath(record.cell["program"]).name.startswith("engine_")
    is_timed = record.role in (ROUND, CONTROL)
    error = subject.error(record, engine) if status in FINISHED and not is_timed else None
    error = math.nan if error is None else max(error, FLOOR)
    if status in FINISHED and not is_timed and not error <= subject.worst:  # as the programs judge the four-bar
        status, reason = "diverged", f"position error {error:.2e} m (allowed {subject.worst:.1g})"
    found, side = (_engine if engine else _ours)(record), ENGINE if engine else OURS
    return found | {"subject": subject.name, "status": status, "reason": reason, "error": error, "round": record.cell["number"], "side": side,
                    "key": "|".join([side, *(f"{found[name]}" for name in ("name", "setting", "over", "value"))]), "record": record.name}


def _engine(record):
    words, output = record.cell["settings"], record.output
    pairs = dict(word.split("=", 1) for word in words if "=" in word)
    over = next((key for key in OVER if key in pairs), "")
    name = PurePath(record.cell["program"]).name.removeprefix("engine_")
    return {"name": name + (NATIVE if "build-engines" in record.cell["program"] else ""),
            "setting": ", ".join(f"{key} {text}" for key, text in pairs.items() if key != over), "over": over,
            "value": float(pairs[over]) if over else None, "time": output.get("time"), "version": output.get("version")}


def _ours(record):
    output = record.output
    options = {key: value for key, value in record.options.items() if key not in ("duration", "judge-every", "repeats")}
    step, scheme = float(options.pop("step")), options.pop("scheme")
    times = output.get("least_us") or output.get("step_us") or {}
    return {"name": record.cell["contenders"][0], "over": "step", "value": step,
            "setting": ", ".join([scheme, *(f"{key} {value}".strip() for key, value in options.items())]),
            "time": 1e-6 * times["mean"] * output["steps"] / output["duration"] if times else None}
