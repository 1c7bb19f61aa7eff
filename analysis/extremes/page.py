# What the page says besides its figures: counts, who ends how, what is left out; sentences of each section.
import numpy

from analysis.core.outcomes import GOOD
from analysis.core.text import number
from analysis.extremes import battery, judge, pivots, roundoff, told, ways

SHORT = 1.0  # s of a motion of size or step: the first two singular positions are near 0.7 and 1.2 s


def context(tables, view):
    return {"settings": view.settings, "trials": _trials(tables["trials"]), "battery": _battery(tables["battery"]), "ways": _ways(tables["ways"], tables["ways_cost"]),
            "pivots": _pivots(tables["pivots"], tables["claims"]), "roundoff": _roundoff(tables["roundoff"])}


def _trials(table):
    """None where there is nothing to show."""
    runs = told.judged(table)
    if runs.empty:
        return None
    return {"counts": told.counts(runs), "kinds": told.kinds(runs), "verdicts": told.VERDICTS, "runs": len(runs),
            "mechanisms": len(runs[["axis", "value"]].drop_duplicates()), "silent": told.listed(runs, judge.SILENT),
            "false": told.listed(runs, judge.FALSE), "unserved": len(table) - len(runs), "dropped": int((table.status == "dropped").sum())}


def _battery(table):
    """None where there is nothing to show."""
    if table.empty:
        return None
    runs, tried = battery.ran(table), table[~table.status.isin(("excluded", "dropped", "unsupported"))]
    return {"total": len(runs), "rows": len(table), "right": int(right(runs).sum()), "silent": silent(table),
            "left_out": left_out(table), "nobody": nobody(tried), "unlike": unlike(tried),
            "statuses": list(dict.fromkeys([*GOOD, "degraded", *sorted(table.status.unique())])),
            "counts": [(name, int(right(rows).sum()), len(battery.ran(rows)), rows.status.value_counts().to_dict())
                       for name, rows in table.groupby("setting", sort=False)],
            "unjudged": table[table.status.isin(GOOD) & table.true_error.isna()].to_dict("records")}


def right(rows):
    """Which are ok or plausible, and right."""
    return rows.status.isin(GOOD) & ~rows.silent


def nobody(tried):
    """[(axis, value, {outcome: count})] of cells in which no run is right."""
    found = []
    for (axis, value), rows in tried.groupby(["axis", "value"], sort=False):
        if not right(rows).any():
            found.append((axis, value, rows.status.mask(rows.silent, "silently wrong").value_counts().to_dict()))
    return found


def unlike(tried):
    """Cells where implementations of one setting end differently: axis, value, setting, {status: [names]}."""
    return [{"axis": axis, "value": value, "setting": setting, "outcomes": {
        status: list(group.implementation) for status, group in rows.groupby("status", sort=False)}}
        for (axis, value, setting), rows in tried.groupby(["axis", "value", "setting"], sort=False) if rows.status.nunique() > 1]


def left_out(table):
    """What was not run and why, and the cells of extreme size and step whose motions are short."""
    found = []
    for reason, rows in table[table.status == "excluded"].groupby("reason", sort=False):
        cells = ", ".join(dict.fromkeys(rows.axis + " " + rows.value))
        found.append(f"Left out in {cells}: {', '.join(dict.fromkeys(rows.implementation))} ({reason}).")
    dropped = table[table.status == "dropped"]
    if len(dropped):
        found.append(f"{len(dropped)} runs were left out, as the budget was spent: the cheap ones of the most telling cells came first.")
    cells = table.drop_duplicates(["axis", "value"])
    seconds = cells.steps * cells.step
    short = cells[cells.axis.isin(["loops", "step"]) & (seconds < SHORT)]
    if len(short):
        told = "; ".join(f"{row.value}: {row.steps:.0f} steps of {row.step:g} s, {row.steps * row.step:.3g} s"
                         for row in short.itertuples())
        found.append(f"Motions last {seconds.mode().iloc[0]:g} s in most cells. Those of extreme size and step that are "
                     f"shorter than {SHORT:g} s may miss what happens later: {told}.")
    return found


def silent(rows):
    """What is ok or plausible and wrong, a cell an entry: its runs, errors and first command."""
    return [{"axis": axis, "value": value, "runs": len(group), "least": group.true_error.min(skipna=False),
             "most": group.true_error.max(skipna=False), "command": group.command.iloc[0]}
            for (axis, value), group in rows[rows.silent.fillna(False)].groupby(["axis", "value"], sort=False)]


def _ways(table, cost):
    if table.empty:
        return None
    rows = [{"way": way, "folder": folder, "share": ways.share(own), "reason": ways.not_served(own),
             "costs": list(cost[(cost.folder == folder) & (cost.way == way)].itertuples())}
            for way in dict.fromkeys(table.way) for folder in ways.folders(table)
            for own in [table[(table.way == way) & (table.folder == folder)]] if len(own)]
    for row in rows:
        row["costs"] = [(f"N = {one.loops:g}", ways.factor(one), one.passes_per_step, one.processes) for one in row["costs"]]
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
