# What the page says: counts, who ends how, what is left out; the answers to "What happens at the extremes, and what helps there?".
import math
from pathlib import Path

from analysis.core.gather import gather
from analysis.core.outcomes import GOOD
from analysis.core.text import answers as said, number
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
    table, pivots = tables["battery"], tables["pivots"].loc[lambda rows: rows.status == "ok"]
    runs, extreme, shares, over = battery.judged(table), battery.extreme(table), battery.by_setting(battery.extreme(table)), overhead(pivots)
    told = [(name, f"“{name}” in {right} of {of}") for name, (right, of) in shares.items()] if len(shares) > len(FORMS) else []
    return said(Path(__file__).with_name("answers.j2"), "Not measured: nobody that takes part runs at the extremes.", most=MOST,
                runs=runs.assign(standard=runs.axis.isin(trials.STANDARD)), silent=runs[runs.verdict == battery.SILENT],
                alarms=runs[runs.verdict == battery.FALSE], entries=battery.listed(runs, battery.SILENT),
                nobody=gather((axis, value) for axis, value, _ in nobody(battery.extreme(runs))), helpful=[one for _, one in told[:MOST_HELPFUL]],
                forms=[dict(told)[form.name] for form in FORMS if form.name in dict(told)],
                worst=pivots.groupby("strategy").error_worst.max(), guarded=over["guarded"].median() if "guarded" in over else None)
