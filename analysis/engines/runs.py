# What a record says of one run, of an engine's or of ours.
import math
from pathlib import PurePath

from analysis.core.outcomes import FINISHED, of_run
from analysis.engines.subjects import FLOOR, subject_of

ENGINE, OURS, ROUND = "engine", "ours", "round"  # roles of cells
OVER = ("step", "accuracy")                      # what changes along a curve
NATIVE = "+native"                               # of an engine that was built with our flags


def row(record):
    """`name`: the engine or implementation; `time`: s of computation for a simulated second."""
    subject = subject_of(record.column)
    engine = PurePath(record.cell["program"]).name.startswith("engine_")
    found = (_engine if engine else _ours)(record, subject)
    status, reason = of_run(record)
    found |= {"subject": subject.name, "status": status, "reason": reason, "round": record.cell["number"],
              "side": ENGINE if engine else OURS, "record": record.name}
    found["error"] = max(found["error"], FLOOR) if status in FINISHED and found["error"] is not None else math.nan
    if status not in FINISHED:
        return found
    return found | ({} if math.isfinite(found["error"]) or record.role == ROUND else
                    {"status": "diverged", "reason": "its position error is not finite"})


def _engine(record, subject):
    words, output = record.cell["settings"], record.output
    pairs = dict(word.split("=", 1) for word in words if "=" in word)
    over = next((key for key in OVER if key in pairs), "")
    name = PurePath(record.cell["program"]).name.removeprefix("engine_")
    whole = output.get("status") in FINISHED
    return {"name": name + (NATIVE if "build-engines" in record.cell["program"] else ""),
            "setting": ", ".join(f"{key} {text}" for key, text in pairs.items() if key != over), "over": over,
            "value": float(pairs[over]) if over else None, "time": output.get("time"), "version": output.get("version"),
            "error": subject.engine_error(output) if whole and record.role == ENGINE else None}


def _ours(record, subject):
    output = record.output
    options = {key: value for key, value in record.options.items() if key not in ("duration", "judge-every", "repeats")}
    step, scheme = float(options.pop("step")), options.pop("scheme")
    times = output.get("least_us") or output.get("step_us") or {}
    whole = output.get("status") in FINISHED
    return {"name": record.cell["contenders"][0], "over": "step", "value": step,
            "setting": ", ".join([scheme, *(f"{key} {value}".strip() for key, value in options.items())]),
            "time": 1e-6 * times["mean"] * output["steps"] / output["duration"] if times else None,
            "error": subject.our_error(record) if whole and record.role == OURS else None}


def key(one):
    """What a run has in common with its repetition in the rounds; `one`: a row."""
    return f"{one['side']}|{one['name']}|{one['setting']}|{one['over']}|{one['value']:g}"
