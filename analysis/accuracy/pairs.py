# Two settings of one implementation side by side at one step: the form of the step, the precision of its numbers, the reuse of its factors.
import math

import pandas

from analysis.core import timing
from analysis.core.outcomes import FINISHED
from analysis.accuracy.points import USED

STEP = 1.25e-3  # s
FORMS, PRECISION, REUSE = "form", "precision", "reuse"
PAIRS = {  # of settings by name: what the second one costs or gains beside the first
    FORMS: (("default", "saddle"),),
    PRECISION: (("default", "mixed"), ("default", "single"), ("saddle", "saddle mixed")),
    REUSE: (("default", "every-step"), ("default", "kept"), ("default", "kept tight"), ("saddle", "saddle every-step"), ("saddle", "saddle kept"))}
CLASSES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-6)  # m; an error is of the smallest that it meets
NO_CLASS = ("", "dropped", "excluded", "timeout")  # outcomes of runs that tell no error class
GAIN = 1.2  # the speed-up that is asked of lower precision


def table(scene, made, measured):
    """A row for each pair and implementation of a scene whose settings were both timed."""
    own = made[(made.step / STEP - 1).abs() < 1e-6].sort_values("duration", kind="stable")
    runs = {(run["implementation"], run["setting"]): run for run in own.to_dict("records")}  # the longest
    mine = measured.loc[(measured.role == "pair") & (measured.status != "dropped"), measured.columns.intersection([*USED, "layout"])]
    return pandas.DataFrame([
        {"scene": scene, "kind": kind, "first": both[0], "second": both[1], "implementation": name}
        | _row(rows, [runs.get((name, setting)) for setting in both], both)
        for kind, pairs in PAIRS.items() for both in pairs
        for name, rows in mine[mine.setting.isin(both)].groupby("implementation", sort=False) if rows.setting.nunique() == 2])


def _row(rows, runs, both):
    """`runs`: of `both` settings, None where there is none."""
    lost = rows[rows.status != "ok"]
    ratio = timing.ratio(timing.apart(rows.assign(implementation=rows.setting)), both[1], both[0])
    why = "" if lost.empty or ratio.value > 0 else f"{lost.iloc[0].setting}: {lost.iloc[0].status}: {lost.iloc[0].reason}"
    found = ratio.columns() | {"processes": rows.process.nunique(), "variables": rows.get("variables", pandas.Series(dtype=float)).max(),
                               "reason": why, "record": " ".join(dict.fromkeys(rows.record))}
    for place, setting, run in zip(("first", "second"), both, runs):
        found[f"{place}_us"] = rows.step_us[(rows.setting == setting) & (rows.status == "ok")].median()
        if run:
            found |= {f"{place}_{key}": run[key] for key in ("status", "error", "passes", "factorizations", "duration")}
            found[f"{place}_class"] = min((one for one in CLASSES if run["error"] <= one), default=None)
            found["record"] += f" {run['record']}"
            if run["status"] not in FINISHED and not found["reason"]:
                found["reason"] = f"{setting}: {run['status']}: {run['reason']}"
    return found


def same_class(rows):
    """Whether both errors are known and in the same class."""
    return (rows.first_class == rows.second_class) & rows.first_class.notna()


def shown(rows):
    """Rows of the same class that have an interval: of one process alone nothing can be shown."""
    return rows[same_class(rows) & (rows.high < math.inf)]


def gains(rows):
    """Rows in which the second setting is at least GAIN times faster with the same error class, by the whole interval."""
    return rows[same_class(rows) & (rows.high <= 1 / GAIN)]
