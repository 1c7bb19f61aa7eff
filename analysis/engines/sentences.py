# What the page says of the engines, computed from its tables.
import pandas

from analysis.accuracy.front import FINISHED, finished
from analysis.accuracy.names import step
from analysis.engines.figure import NAMES
from analysis.text import number

LEAST = {False: 10, True: 20}  # times less time at equal error than each engine; on scenes without singular positions


def name(engine):
    return NAMES.get(engine, engine)


def value(over, amount):
    """"step 5 ms" or "accuracy 10⁻⁶"."""
    return f"step {step(amount)}" if over == "step" else f"accuracy {number(amount)}"


def of_ratios(table, regular):
    """Sentences on the rows of equal_error.csv; `regular`: {subject: whether it has no singular position}."""
    said = []
    for kind, least in LEAST.items():
        rows = table[(table.scope == "all") & (table.subject.map(regular) == kind)]
        if rows.empty:
            continue
        where = "Without singular positions" if kind else "Past singular positions"
        timed = rows[rows.ratio.notna()]
        holds = int((timed.ratio >= least).sum())
        text = (f"{where} ours takes at least {least} times less time in {holds} of {len(rows)} comparisons at "
                "equal error")
        if len(timed):
            worst = timed.loc[timed.ratio.idxmin()]
            text += (f"; the smallest ratio is {number(worst.ratio, 2)} ({number(worst.low, 2)} to "
                     f"{number(worst.high, 2)}), against {name(worst.engine)} ({worst.engine_setting}, "
                     f"{value(worst.over, worst.engine_value)}) on {worst.subject} at "
                     f"{number(worst.engine_error, 2)} m")
        if len(timed) < len(rows):
            text += f"; {len(rows) - len(timed)} of its errors ours does not reach"
        said.append(text + ".")
    return said


def of_engines(engines):
    """A sentence for each engine: what it reaches, what it loses."""
    said = []
    for engine, rows in engines.groupby("engine", sort=False):
        if (rows.status == "unavailable").all():
            said.append(f"{name(engine)}: left out, {rows.status_reason.iloc[0]}.")
            continue
        made = rows[rows["rounds"] > 0]
        lost = made[~made.status.isin(FINISHED)]
        kinds = ", ".join(f"{count} {status}" for status, count in lost.status.value_counts().items())
        done = finished(made)
        best = "none finished" if done.empty else (
            f"{number(done.error.min(), 2)} m is the smallest error ({done.loc[done.error.idxmin()].subject})")
        said.append(f"{name(engine)} {made.version.dropna().iloc[0] if made.version.notna().any() else ''}: "
                    f"{len(made)} runs; {best}; not finished: {kinds or 'none'}.")
    return said


def summary(table, scope):
    """[{"subject", "cells": {engine: {"low", "high", "rows", "unreached"} or None}}] of equal_error.csv."""
    rows, engines = table[table.scope == scope], list(table.engine.unique())
    found = []
    for subject, mine in rows.groupby("subject", sort=False):
        cells = {}
        for engine in engines:
            one = mine[mine.engine == engine]
            ratios = one.ratio.dropna()
            cells[engine] = None if one.empty else {
                "low": ratios.min() if len(ratios) else None, "high": ratios.max() if len(ratios) else None,
                "rows": len(one), "unreached": int(one.ratio.isna().sum())}
        found.append({"subject": subject, "cells": cells})
    return found


def reached(engines, subjects):
    """[{"engine", "setting", "options", "cells": [{"error", "time", "text"}]}]: the smallest error of each setting on
    each subject, or how its runs were lost."""
    found = []
    for (engine, setting), rows in engines[engines["setting"].notna()].groupby(["engine", "setting"], sort=False):
        found.append({"engine": name(engine), "setting": setting,
                      "cells": [_cell(rows[rows.subject == subject]) for subject in subjects]})
    return found


def _cell(rows):
    made = rows[rows["rounds"] > 0]
    done = finished(made)
    lost = made[~made.status.isin(FINISHED)]
    text = ", ".join(f"{count} {status}" for status, count in lost.status.value_counts().items())
    reasons = "; ".join(f"{value(row.over, row.value)}: {row.status}, {row.status_reason}"
                        for row in lost.itertuples())
    if done.empty:
        return {"error": None, "time": None, "text": text or "not run", "why": reasons}
    best = done.loc[done.error.idxmin()]
    return {"error": best.error, "time": best.time, "text": text, "why": reasons,
            "at": value(best.over, best.value)}


def complaints(engines):
    """[{"engine", "runs", "text"}]: what engines said while they ran."""
    if "first_complaint" not in engines:
        return []
    said = engines[engines.first_complaint.notna() & (engines.first_complaint != "")]
    return [{"engine": name(engine), "runs": len(rows), "text": rows.first_complaint.iloc[0]}
            for engine, rows in said.groupby("engine", sort=False)]


def records(table):
    """Rows as dictionaries, without NaN."""
    return table.astype(object).where(pandas.notna(table), None).to_dict("records")
