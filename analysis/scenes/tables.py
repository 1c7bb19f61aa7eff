# The tables of study/scenes, read and reduced for its report.
from pathlib import Path

import numpy
import pandas

from analysis.accuracy.front import GOOD
from analysis.loader import TableError
from analysis.statistics import median, ratio_interval

PLAIN = "plain"
TABLES = ("problems", "gate", "convergence", "modelling")


def load(folder):
    """{name: DataFrame}; empty tables where nothing was run."""
    tables = {}
    for name in TABLES:
        path = Path(folder) / f"{name}.csv"
        try:
            tables[name] = pandas.read_csv(path, keep_default_na=True)
        except pandas.errors.EmptyDataError:
            tables[name] = pandas.DataFrame()
        except (OSError, ValueError) as error:
            raise TableError(f"{path}: cannot be read: {error}") from error
    return tables


def costs(modelling):
    """One row for each implementation, size and case: time of a step with its ratio to the case that
    it is compared with, usually the plain model (paired by round, 95 % interval), time of the whole
    process likewise, error, tangent."""
    result = []
    if modelling.empty:
        return result
    for (implementation, loops), group in modelling.groupby(["implementation", "loops"], sort=False):
        for case in dict.fromkeys(group[group["round"] == 1].case):
            rows = group[group.case == case]
            plain = group[group.case == rows.base.iloc[0]]
            failed = rows[~rows.status.isin(GOOD)]
            row = {"implementation": implementation, "loops": loops, "case": case,
                   "piece": "" if case == PLAIN else rows.piece.iloc[0],
                   "status": "ok" if failed.empty else failed.status.iloc[0],
                   "reason": "" if failed.empty else failed.reason.iloc[0]}
            if failed.empty:
                row |= {"variables": int(rows.variables.iloc[0]),
                        "constraints": int(rows.constraints.iloc[0]),
                        "tangent": int(rows.tangent_nonzeros.iloc[0]),
                        "passes": median(rows.passes_per_step), "step_us": median(rows.step_us),
                        "error": median(rows.position_error.dropna()),
                        "energy_drift": median(rows.energy_drift_max),
                        "step": _ratio(rows, plain, "step_us"),
                        "run": _ratio(rows, plain, "run_seconds"),
                        "run_seconds": median(rows.run_seconds)}
            result.append(row)
    return sorted(result, key=lambda row: (row["implementation"], row["loops"]))


def _ratio(rows, plain, column):
    groups = [{number: group.to_numpy() for number, group in table.groupby("round")[column]}
              for table in (rows, plain)]
    return ratio_interval(*groups)


def best_errors(problems):
    """One row a problem: what is known, and for each implementation that ran it at the finest step
    its error and class."""
    result = []
    for name, group in problems.groupby("problem", sort=False):
        first = group.iloc[0]
        runs = [row for _, of_one in group.groupby("implementation", sort=False)
                for _, row in of_one[of_one.step == of_one.step.min()].iterrows()]
        result.append({"problem": name, "title": first.title, "scene": first.scene,
                       "variables": first.get("variables"), "constraints": first.get("constraints"),
                       "duration": first.duration, "reference": first.reference,
                       "conserved": bool(first.conserved), "runs": runs})
    return result


def agreement(gate):
    """{problem: (how many agree, how many took part, [(implementation, verdict, reason)] others)}"""
    result = {}
    for name, group in gate.groupby("problem", sort=False):
        others = group[group.verdict != "agrees"]
        result[name] = (int((group.verdict == "agrees").sum()), len(group),
                        list(others[["implementation", "verdict", "reason"]].fillna("").itertuples(
                            index=False, name=None)))
    return result


def digits(value, count=8):
    """`value` with `count` significant digits, never in powers of ten for positions."""
    if not numpy.isfinite(value):
        return "–"
    if value == 0:
        return "0"
    places = max(0, count - 1 - int(numpy.floor(numpy.log10(abs(value)))))
    return f"{value:.{places}f}"
