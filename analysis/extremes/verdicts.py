# What the outcome of a run is worth beside its true error; runs of a verdict by kind, those that are equal as one.
from analysis.core.outcomes import FINISHED, GOOD, WHOLE
from analysis.extremes.cells import FORMS

RIGHT, SILENT, FALSE, TOLD, STOPPED = ALL = "right", "silently wrong", "false alarm", "told", "stopped"


def verdict(status, error, limit, wrong_from, harmless):
    """Of a run whose error is allowed to be `limit`. One that stopped (wrong-branch, diverged) before any instant kept at which it
    was wrong did so in time, unless its cell's motion deserves no such outcome (`harmless`)."""
    if status in GOOD:
        return RIGHT if error <= limit else SILENT
    if status in WHOLE:
        small = wrong_from is None and error <= limit / 10
        return FALSE if small and (status in FINISHED or status in harmless) else TOLD
    return TOLD if wrong_from is not None else FALSE if status in harmless else STOPPED


def judged(table):
    return table[table.verdict.isin(ALL)]


def counts(table):
    return {verdict: int((table.verdict == verdict).sum()) for verdict in ALL}


def kinds(table):
    """A row a kind: mechanisms, runs and their verdicts."""
    return [{"kind": kind, "mechanisms": rows.value.nunique(), "runs": len(rows)} | counts(rows) for kind, rows in judged(table).groupby("axis", sort=False)]


def by_setting(table):
    """{setting: (right runs, runs)} where more than the two forms was tried, of those who tried more; the best first."""
    runs = judged(table)
    more = runs[~runs.setting.isin([form.name for form in FORMS])][["axis", "value", "implementation"]].drop_duplicates()
    found = {name: (int((rows.verdict == RIGHT).sum()), len(rows)) for name, rows in runs.merge(more).groupby("setting", sort=False)}
    return dict(sorted(found.items(), key=lambda one: -one[1][0] / one[1][1]))


def listed(table, verdict):
    """Runs of a verdict, those that are equal but for setting and implementation in one entry, with the worst of them."""
    return [{"kind": kind, "mechanism": mechanism, "step": step, "runs": len(rows), "settings": list(rows.setting.unique()),
             "commands": list(rows.command.unique())} | rows.loc[
                 rows.true_error.fillna(-1).idxmax(), ["true_error", "wrong_from", "status", "reason"]].to_dict()
            for (kind, mechanism, step), rows in table[table.verdict == verdict].groupby(["axis", "value", "step"], sort=False)]
