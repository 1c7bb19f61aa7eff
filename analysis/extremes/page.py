# What the page says: counts, who ends how, what is left out; the answers to "What happens at the extremes, and what helps there?".
import math

from analysis.core.gather import gather
from analysis.core.outcomes import GOOD
from analysis.core.text import number
from analysis.extremes import battery, trials
from analysis.extremes.cells import FORMS

WORDS = {"silent": "silently wrong", "other": "other failure", "unjudged": "ok or plausible, not judged", "ok": "ok or plausible"}
MOST = 10         # silent wrongs that the answer itself names
MOST_HELPFUL = 2  # settings


def context(tables, view):
    return {"battery": _battery(tables["battery"]), "kinds": {kind: WORDS.get(kind, kind) for kind in battery.KINDS},
            "pivots": _pivots(tables["pivots"], tables["claims"])}


def _battery(table):
    runs, extreme = battery.judged(table), battery.extreme(table)
    if table.empty:
        return None
    cells = matrix(extreme)
    return {"runs": len(runs), "mechanisms": len(runs[["axis", "value"]].drop_duplicates()), "kinds": battery.kinds(runs), "verdicts": battery.ALL,
            "lists": {verdict: battery.listed(runs, verdict) for verdict in (battery.SILENT, battery.FALSE)}, "left_out": left_out(table),
            "nobody": nobody(extreme), "matrix": cells, "columns": list(gather(  # of settings that are equal in all cells
                (tuple(row.get(setting) for row in cells.values()), setting) for setting in extreme.setting.unique()).values()),
            "unjudged": int((table.status.isin(GOOD) & table.true_error.isna()).sum()),
            "settings": [(name, len(rows), battery.counts(rows)) for name, rows in runs.groupby("setting", sort=False)]}


def matrix(extreme):
    """{(axis, value): {setting: (the worst kind, exponent of the largest true error or None, whether implementations end differently)}} of
    extreme cells; no error is shown below that of the truth."""
    rows = extreme[~extreme.status.isin(battery.NOT_RUN) | (extreme.status == "refused")]
    rows = rows.assign(kind=[battery.kind(row) for row in rows.itertuples()], error=rows.true_error.clip(lower=rows.truth_error).clip(1e-17, 1e99))
    found = {}
    for (axis, value, setting), mine in rows.groupby(["axis", "value", "setting"], sort=False):
        power = math.floor(math.log10(mine.error.max())) if mine.error.notna().any() else None
        found.setdefault((axis, value), {})[setting] = min(mine.kind, key=battery.KINDS.index), power, mine.kind.nunique() > 1
    return found


def nobody(extreme):
    """[(axis, value, {outcome: count})] of cells in which no run is right."""
    tried = extreme[~extreme.status.isin(("excluded", "dropped", "unsupported"))]
    return [(axis, value, rows.status.mask(rows.verdict == battery.SILENT, battery.SILENT).value_counts().to_dict())
            for (axis, value), rows in tried.groupby(["axis", "value"], sort=False) if not (rows.verdict == battery.RIGHT).any()]


def left_out(table):
    found = [f"Left out: {', '.join(dict.fromkeys(rows.implementation))} in {', '.join(dict.fromkeys(rows.axis + ' ' + rows.value))} ({reason})."
             for reason, rows in table[table.status == "excluded"].groupby("reason", sort=False)]
    dropped = int((table.status == "dropped").sum())
    return found + [f"{dropped} runs were left out, as the budget was spent: the more telling ones came first."] * (dropped > 0)


def _pivots(table, claims):
    lost, table = [f"{row.status}: {row.reason}" for row in table[table.status != "ok"].itertuples()], table[table.status == "ok"]
    if table.empty:
        return {"lost": lost, "said": []}
    found = [f"{one.strategy}: worst error {number(one.error_worst, 2)} ({one.sequence}, {one.form} form, {one.pivoting} pivots)."
             for one in table.loc[table.groupby("strategy", sort=False).error_worst.idxmax()].itertuples()]
    found += [f"With default pivots a factorization and solve of {strategy} takes {rows.median():.2f} times that of refactor "
              f"(median over the sequences; {rows.min():.2f} to {rows.max():.2f})." for strategy, rows in overhead(table).items()]
    return {"lost": lost, "said": found, "rows": table.to_dict("records"), "claims": claims.to_dict("records"), "matrices": int(table.matrices.max())}


def overhead(table):
    """{strategy: times over refactor, of each sequence} with default pivots."""
    default = table[table.pivoting == "default"].dropna(subset=["time_ratio"])
    return {strategy: rows.time_ratio for strategy, rows in default.groupby("strategy", sort=False) if strategy != "refactor"}


def answers(tables, view):
    found = [*_of_battery(tables["battery"]), *_helps(battery.extreme(tables["battery"])), *_of_pivots(tables["pivots"])]
    return found or [{"text": "Not measured: nobody that takes part runs at the extremes.", "anchor": ""}]


def _of_battery(table):
    runs = battery.judged(table)
    if runs.empty:
        return
    silent, false = (runs[runs.verdict == verdict] for verdict in (battery.SILENT, battery.FALSE))
    standard = runs.axis.isin(trials.STANDARD)
    wrongly, others = false[standard[false.index]], false[~standard[false.index]]
    text = (f"In {len(runs)} runs of {len(runs[['axis', 'value']].drop_duplicates())} mechanisms of {runs.axis.nunique()} kinds: {_some(silent, 'silent wrong')} "
            f"and {_some(false, 'false alarm')}. Bound “no run is silently wrong”: {_held(silent)}.")
    if standard.any():
        text += f" Bound “no false alarm on standard problems at their own steps”: {_held(wrongly)}, in {standard.sum()} runs."
    if len(others):
        text += f" Other false alarms: {_places(others)}."
    entries = battery.listed(runs, battery.SILENT)
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
    if len(shares := battery.by_setting(extreme)) > len(FORMS):
        told = [f"“{name}” in {right} of {runs}" for name, (right, runs) in shares.items()]
        yield {"anchor": "settings", "text": f"Where other settings were tried as well, runs are right most often with {', '.join(told[:MOST_HELPFUL])}; "
               f"with {' and '.join(told[list(shares).index(form.name)] for form in FORMS if form.name in shares)}."}


def _of_pivots(table):
    table = table[table.status == "ok"]
    if table.empty or "guarded" not in overhead(table):
        return
    worst = table.groupby("strategy").error_worst.max()
    yield {"anchor": "pivots", "text": f"Solves with kept pivots have backward errors of up to {number(worst['refactor'], 1)}. With a guard they stay within "
           f"{number(worst['guarded'], 1)}; it takes {number(overhead(table)['guarded'].median(), 3)} times as long."}
