# The answers to "What happens at the extremes, and what helps there?", from the tables.
from analysis.core.gather import gather
from analysis.core.text import number
from analysis.extremes import battery, trials, verdicts
from analysis.extremes.cells import FORMS
from analysis.extremes.page import nobody, overhead

MOST = 10         # silent wrongs that the answer itself names
MOST_HELPFUL = 2  # settings


def answers(tables, view):
    found = [*_battery(tables["battery"]), *_helps(battery.extreme(tables["battery"])), *_pivots(tables["pivots"])]
    return found or [{"text": "Not measured: nobody that takes part runs at the extremes.", "anchor": ""}]


def _battery(table):
    runs = verdicts.judged(table)
    if runs.empty:
        return
    silent, false = (runs[runs.verdict == verdict] for verdict in (verdicts.SILENT, verdicts.FALSE))
    standard = runs.axis.isin(trials.STANDARD)
    wrongly, others = false[standard[false.index]], false[~standard[false.index]]
    text = (f"In {len(runs)} runs of {len(runs[['axis', 'value']].drop_duplicates())} mechanisms of {runs.axis.nunique()} kinds: {_some(silent, 'silent wrong')} "
            f"and {_some(false, 'false alarm')}. Bound “no run is silently wrong”: {_held(silent)}.")
    if standard.any():
        text += f" Bound “no false alarm on standard problems at their own steps”: {_held(wrongly)}, in {standard.sum()} runs."
    if len(others):
        text += f" Other false alarms: {_places(others)}."
    entries = verdicts.listed(runs, verdicts.SILENT)
    text += " Silent wrongs:" * bool(entries) + "".join(f" {one['kind']}, {one['mechanism']}: {one['commands'][0]}." for one in entries[:MOST])
    yield {"anchor": "battery", "text": text + (f" {len(entries) - MOST} more on the page." if len(entries) > MOST else "")}
    if lost := gather((axis, value) for axis, value, _ in nobody(battery.extreme(runs))):
        yield {"anchor": "nobody", "text": "No run is right, in any setting that was tried, with " + "; ".join(
            f"{axis}: {', '.join(values)}" for axis, values in lost.items()) + "."}


def _some(rows, what):
    return f"{len(rows) or 'no'} {what}{'s' * (len(rows) != 1)}"


def _held(rows):
    """Whether the bound "none of these" holds."""
    return f"not held, {len(rows)} run{'s' if len(rows) > 1 else ''} ({_places(rows)})" if len(rows) else "held"


def _places(rows):
    return ", ".join(f"{kind}: {count}" for kind, count in rows.axis.value_counts(sort=False).items())


def _helps(extreme):
    if len(shares := verdicts.by_setting(extreme)) > len(FORMS):
        told = [f"“{name}” in {right} of {runs}" for name, (right, runs) in shares.items()]
        yield {"anchor": "settings", "text": f"Where other settings were tried as well, runs are right most often with {', '.join(told[:MOST_HELPFUL])}; "
               f"with {' and '.join(told[list(shares).index(form.name)] for form in FORMS if form.name in shares)}."}


def _pivots(table):
    table = table[table.status == "ok"]
    if table.empty or "guarded" not in overhead(table):
        return
    worst = table.groupby("strategy").error_worst.max()
    yield {"anchor": "pivots", "text": f"Solves with kept pivots have backward errors of up to {number(worst['refactor'], 1)}. With a guard they stay within "
           f"{number(worst['guarded'], 1)}; it takes {number(overhead(table)['guarded'].median(), 3)} times as long."}
