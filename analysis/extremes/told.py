# What the trials say: verdicts by kind, on how many mechanisms they rest, each silent wrong and false alarm.
from analysis.extremes import judge

VERDICTS = (judge.RIGHT, judge.SILENT, judge.FALSE, judge.TOLD, judge.STOPPED)


def judged(table):
    """The runs that can be judged."""
    return table[table.verdict.isin(VERDICTS)]


def kinds(table):
    """A row a kind: mechanisms, runs and their verdicts."""
    return [{"kind": kind, "mechanisms": rows.value.nunique(), "runs": len(rows)} | counts(rows)
            for kind, rows in judged(table).groupby("axis", sort=False)]


def listed(table, verdict):
    """Runs of a verdict, those that are equal but for scheme and implementation in one entry: the worst one and its command."""
    found = []
    for (kind, mechanism, step), rows in table[table.verdict == verdict].groupby(["axis", "value", "step"], sort=False):
        worst = rows.loc[rows.true_error.fillna(-1).idxmax()]
        found.append({"kind": kind, "mechanism": mechanism, "step": step, "runs": len(rows), "settings": list(dict.fromkeys(rows.setting)),
                      "error": worst.true_error, "since": worst.wrong_from, "status": worst.status, "reason": worst.reason,
                      "commands": list(dict.fromkeys(rows.command))})
    return found


def counts(table):
    """{verdict: runs}"""
    return {verdict: int((table.verdict == verdict).sum()) for verdict in VERDICTS}
