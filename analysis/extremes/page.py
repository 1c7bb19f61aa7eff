# What the page says besides its figures: counts, who ends how, what is left out; sentences of each section.
import numpy

from analysis.core.outcomes import GOOD
from analysis.core.text import number
from analysis.extremes import battery, pivots, roundoff, verdicts, ways


def context(tables, view):
    return {"settings": view.settings, "battery": _battery(tables["battery"]), "ways": _ways(tables["ways"], tables["ways_cost"]),
            "pivots": _pivots(tables["pivots"], tables["claims"]), "roundoff": _roundoff(tables["roundoff"])}


def _battery(table):
    """None where there is nothing to show."""
    runs, extreme = verdicts.judged(table), battery.extreme(table)
    if table.empty:
        return None
    return {"runs": len(runs), "mechanisms": len(runs[["axis", "value"]].drop_duplicates()), "kinds": verdicts.kinds(runs), "verdicts": verdicts.ALL,
            "lists": {verdict: verdicts.listed(runs, verdict) for verdict in (verdicts.SILENT, verdicts.FALSE)}, "left_out": left_out(table),
            "nobody": nobody(extreme), "unlike": unlike(extreme), "unjudged": int((table.status.isin(GOOD) & table.true_error.isna()).sum()),
            "settings": [(name, len(rows), verdicts.counts(rows)) for name, rows in runs.groupby("setting", sort=False)]}


def nobody(extreme):
    """[(axis, value, {outcome: count})] of cells in which no run is right."""
    tried = extreme[~extreme.status.isin(("excluded", "dropped", "unsupported"))]
    return [(axis, value, rows.status.mask(rows.verdict == verdicts.SILENT, verdicts.SILENT).value_counts().to_dict())
            for (axis, value), rows in tried.groupby(["axis", "value"], sort=False) if not (rows.verdict == verdicts.RIGHT).any()]


def unlike(extreme):
    """Cells where implementations of one setting end differently: axis, value, setting, {status: [names]}."""
    return [{"axis": axis, "value": value, "setting": setting, "outcomes": {
        status: list(group.implementation) for status, group in rows.groupby("status", sort=False)}}
        for (axis, value, setting), rows in battery.ran(extreme).groupby(["axis", "value", "setting"], sort=False) if rows.status.nunique() > 1]


def left_out(table):
    """What was not run and why."""
    found = [f"Left out: {', '.join(dict.fromkeys(rows.implementation))} in {', '.join(dict.fromkeys(rows.axis + ' ' + rows.value))} ({reason})."
             for reason, rows in table[table.status == "excluded"].groupby("reason", sort=False)]
    dropped = int((table.status == "dropped").sum())
    return found + [f"{dropped} runs were left out, as the budget was spent: the more telling ones came first."] * (dropped > 0)


def silent(rows):
    """What is ok or plausible and wrong, a cell an entry: its runs, errors and first command."""
    return [{"axis": axis, "value": value, "runs": len(group), "least": group.true_error.min(skipna=False),
             "most": group.true_error.max(skipna=False), "command": group.command.iloc[0]}
            for (axis, value), group in rows[rows.silent.fillna(False)].groupby(["axis", "value"], sort=False)]


def _ways(table, cost):
    if table.empty:
        return None
    rows = [{"way": way, "folder": folder, "share": ways.share(own), "reason": ways.not_served(own),
             "costs": [(f"N = {one.loops:g}", ways.factor(one), one.passes_per_step, one.processes)
                       for one in cost[(cost.folder == folder) & (cost.way == way)].itertuples()]}
            for way in dict.fromkeys(table.way) for folder in ways.folders(table)
            for own in [table[(table.way == way) & (table.folder == folder)]] if len(own)]
    return {"rows": rows, "silent": silent(table), "dropped": int((table.status == "dropped").sum())}


def _pivots(table, claims):
    lost, table = [f"{row.status}: {row.reason}" for row in table[table.status != "ok"].itertuples()], pivots.timed(table)
    if table.empty:
        return {"lost": lost, "said": []}
    found = []
    for strategy, rows in table.groupby("strategy", sort=False):
        worst = rows.loc[rows.error_worst.idxmax()]
        found.append(f"{strategy}: worst error {number(worst.error_worst, 2)} ({worst.sequence}, {worst.form} form, "
                     f"{worst.pivoting} pivots).")
    found += [f"With default pivots a factorization and solve of {strategy} takes {rows.median():.2f} times that of refactor "
              f"(median over the sequences; {rows.min():.2f} to {rows.max():.2f})." for strategy, rows in overhead(table).items()]
    return {"lost": lost, "said": found, "claims": claims.to_dict("records"), "matrices": int(table.matrices.max())}


def overhead(table):
    """{strategy: times over refactor, of each sequence} with default pivots."""
    default = table[table.pivoting == "default"].dropna(subset=["time_ratio"])
    return {strategy: rows.time_ratio for strategy, rows in default.groupby("strategy", sort=False) if strategy != "refactor"}


def _roundoff(table):
    if table.empty:
        return None
    found = sizes(table)
    return {"sizes": found, "said": jumps(found), "rows": table.to_dict("records")}


def sizes(table):
    """For each form and size medians over the implementations: differences, and how they grow."""
    keys = [f"at_{instant:g}_s" for instant in roundoff.INSTANTS]
    return [{"scheme": form, "loops": loops, "medians": [rows[key].clip(lower=roundoff.FLOOR).median() for key in keys],
             "largest": rows[keys[-1]].max()} | {key: rows[key].median() for key in ("near", "far", "near_time", "with_speed")}
            for (form, loops), rows in table.groupby(["scheme", "loops"], sort=False)]


def jumps(found):
    """What is seen of the growth of roundoff, over all sizes and forms."""
    known = [one for one in found if one["near"] == one["near"]]
    near, far = (sum(one[key] for one in known) for key in ("near", "far"))
    if not near + far > 0:
        return ["No growth was seen."]
    time = numpy.median([one["near_time"] for one in known])
    share = near / (near + far)
    faster = numpy.inf if share == 1 else share / (1 - share) * (1 - time) / time
    verdict = ("it grows in jumps there" if share > 0.5 and faster > 2 else
               f"it grows {faster:.1f} times as fast there as in between" if faster > 1.2
               else "singular positions are no jumps in it")
    said = [f"After the first turn {100 * share:.0f} % of the growth (decades, summed over sizes and forms) happens "
            f"within {roundoff.NEAR:g} s of a singular position, which is {100 * time:.0f} % of the time: {verdict}."]
    powers = [numpy.log(one["medians"][2] / one["medians"][1]) / numpy.log(20 / 5) for one in known
              if one["medians"][1] > roundoff.FLOOR]
    if powers:
        said.append(f"From 5 to 20 s it grows with a power of time between {min(powers):.1f} and {max(powers):.1f}.")
    speeds = [one["with_speed"] for one in known if one["with_speed"] == one["with_speed"]]
    if speeds:
        said.append(f"Its correlation with the speed of the rods (logarithms without trend, second half) is "
                    f"{min(speeds):.2f} to {max(speeds):.2f}: " + (
                        "one motion is late on the same path, by a lag that grows." if min(speeds) > 0.8 else
                        "it is not a lag alone."))
    return said
