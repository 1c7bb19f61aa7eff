# Rows of maps, windows and whole runs from their records.
import pandas

from analysis.core.outcomes import of_run

FIGURES = ("failed_at", "position_error_max", "energy_drift_max", "passes_per_step", "steps_at_limit")
MUST_HOLD = {"penalty", "saddle-point"}  # the forms of the trapezoidal rule, up to this size:
LARGEST, ERROR, PASSES, AT_LIMIT = 2000, 2e-3, 2.2, 0  # N; m; passes a step; steps at the pass limit


def build(records, view):
    found = {"maps": [], "windows": [], "whole": []}
    for record in records:
        if record.role == "window":
            asked, window = record.options, record.output["penalty_window"] if record.done else {}
            found["windows"].append({
                "loops": int(record.cell["scene"].partition(":")[2]), "precision": asked["precision"], "step": float(asked["step"]),
                "status": "ok" if record.done else record.status, "reason": record.reason, "record": record.name} | {
                key: window.get(key) for key in ("lower", "lower_from", "upper", "upper_from")})
        elif record.role == "map":
            found["maps"].append(_run(record))
        elif record.role == "whole":
            row = {key: value for key, value in _run(record).items() if key not in ("precision", "step", "penalty_asked", "alpha_dt2_4", "failed_at")}
            found["whole"].append(row | {"must_hold": holds(row)})
    order = ["scheme", "precision", "loops", "step", "penalty"]
    tables = {name: pandas.DataFrame(rows) for name, rows in found.items()}
    return {name: table.sort_values([key for key in order if key in table], kind="stable") for name, table in tables.items()}


def _run(record):
    asked, (status, reason) = record.options, of_run(record)
    penalty, step = asked["penalty"], float(asked["step"])
    alpha = record.output.get("penalty", None if penalty == "auto" else float(penalty))
    return {"loops": int(record.cell["scene"].partition(":")[2]), "scheme": asked["scheme"], "precision": asked["precision"],
            "implementation": record.cell["contenders"][0], "step": step, "penalty_asked": penalty, "penalty": alpha,
            "alpha_dt2_4": alpha and float(f"{alpha * step**2 / 4:.6g}"), "status": status, "reason": reason,
            "record": record.name} | {key: record.output.get(key) for key in FIGURES}


def holds(row):
    """"yes", "no", or "" where nothing is asked or nothing was run."""
    if row["scheme"] not in MUST_HOLD or row["loops"] > LARGEST or row["status"] == "dropped":
        return ""
    kept = row["status"] == "ok" and row["position_error_max"] < ERROR and row["passes_per_step"] <= PASSES
    return "yes" if kept and row["steps_at_limit"] <= AT_LIMIT else "no"
