# Does artificial fill leave the motion and its error as they are? The premise of regions.py, checked.
from study.accuracy_study import subjects
from study.pipeline import runs

LOOPS, FILLS = 10, (0.6, 1.0)
STEP, DURATION = 2.5e-3, 5.0
SAME = 1e-2  # share of the error by which it may differ: rounding, multiplied at singular positions
CHECKED = ("default", "saddle", "rattle")


def check(bench, entries, tell):
    """The rows of fills.csv: the first dense and the first sparse implementation, in CHECKED settings."""
    rows = []
    for dense in (True, False):
        variant = next((name for name in entries.settings if entries.dense[name] == dense), None)
        for setting in entries.settings.get(variant, ()):
            if setting.name in CHECKED and (variant, setting.name) not in entries.refused:
                tell(f"artificial fill: {variant}, {setting.name}")
                rows += _compare(bench, entries, variant, setting)
    return rows


def _compare(bench, entries, variant, setting):
    found = []
    for fill in (None, *FILLS):
        subject = subjects.chain(LOOPS, DURATION, fill)
        record = bench.run("fills", subject, entries.contenders[variant], setting, STEP)
        summary = record.get("summary", {})
        found.append({"scene": subject.scene, "implementation": variant, "setting": setting.name,
                      "step": STEP, "fill_asked": fill, "status": runs.status(record)[0],
                      "error": summary.get("position_error_max"),
                      "passes_per_step": summary.get("passes_per_step"),
                      "raw_file": record["raw_file"],
                      "command": runs.typed(record)})
    natural = found[0]
    for row in found:
        known = row["error"] is not None and natural["error"]
        row["difference"] = abs(row["error"] / natural["error"] - 1) if known else None
        row["same"] = row["status"] == natural["status"] and (
            row["difference"] is None or row["difference"] <= SAME)
    return found
