# What the page says: counts, who ends how, what is left out; sentences of each section.
import math

from analysis.core.gather import gather
from analysis.core.outcomes import GOOD
from analysis.core.text import number
from analysis.extremes import battery, verdicts

WORDS = {"silent": "silently wrong", "other": "other failure", "unjudged": "ok or plausible, not judged", "ok": "ok or plausible"}


def context(tables, view):
    return {"battery": _battery(tables["battery"]), "kinds": {kind: WORDS.get(kind, kind) for kind in battery.KINDS},
            "pivots": _pivots(tables["pivots"], tables["claims"])}


def _battery(table):
    runs, extreme = verdicts.judged(table), battery.extreme(table)
    if table.empty:
        return None
    cells = matrix(extreme)
    return {"runs": len(runs), "mechanisms": len(runs[["axis", "value"]].drop_duplicates()), "kinds": verdicts.kinds(runs), "verdicts": verdicts.ALL,
            "lists": {verdict: verdicts.listed(runs, verdict) for verdict in (verdicts.SILENT, verdicts.FALSE)}, "left_out": left_out(table),
            "nobody": nobody(extreme), "matrix": cells, "columns": list(gather(  # of settings that are equal in all cells
                (tuple(row.get(setting) for row in cells.values()), setting) for setting in extreme.setting.unique()).values()),
            "unjudged": int((table.status.isin(GOOD) & table.true_error.isna()).sum()),
            "settings": [(name, len(rows), verdicts.counts(rows)) for name, rows in runs.groupby("setting", sort=False)]}


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
    return [(axis, value, rows.status.mask(rows.verdict == verdicts.SILENT, verdicts.SILENT).value_counts().to_dict())
            for (axis, value), rows in tried.groupby(["axis", "value"], sort=False) if not (rows.verdict == verdicts.RIGHT).any()]


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
