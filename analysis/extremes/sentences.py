# The sentences of extremes.html, computed from its tables.
import numpy

from analysis.accuracy.front import GOOD
from analysis.extremes.numbers import FLOOR, INSTANTS, NEAR, growth, later, ran, with_speed
from analysis.text import number

SHORT = 1.0  # s of a motion of size or step: the first two singular positions are near 0.7 and 1.2 s


def battery(table):
    """Where all are right, where none is, who fails where others do not."""
    found, nobody, runs = [], [], ran(table)
    tried = table[~table.status.isin(["not run", "unsupported"])]
    for (axis, value), rows in tried.groupby(["axis", "value"], sort=False):
        good = rows.status.isin(GOOD)
        if not (good & ~rows.silent).any():
            outcomes = rows.status.mask(rows.silent, "silently wrong").value_counts()
            counts = ", ".join(f"{count} {status}" for status, count in outcomes.items())
            nobody.append(f"{axis}, {value}: {counts}")
    good = (runs.status.isin(GOOD) & ~runs.silent).sum()
    found.append(f"{good} of {len(runs)} runs are ok or plausible, and right; {int(runs.silent.sum())} are ok or plausible, and wrong.")
    for setting, rows in runs.groupby("setting", sort=False):
        found.append(f"{setting}: ok or plausible, and right, in {(rows.status.isin(GOOD) & ~rows.silent).sum()} of {len(rows)}.")
    return found, nobody


def left_out(table):
    """What was not run and why, and the cells of extreme size and step whose motions are short."""
    found = []
    for reason, rows in table[table.status == "not run"].groupby("reason", sort=False):
        cells = ", ".join(dict.fromkeys(rows.axis + " " + rows.value))
        found.append(f"Not run in {cells}: {', '.join(dict.fromkeys(rows.implementation))} ({reason}).")
    cells = table.dropna(subset=["steps", "step"]).drop_duplicates(["axis", "value"])
    seconds = cells.steps * cells.step
    short = cells[cells.axis.isin(["loops", "step"]) & (seconds < SHORT)]
    if len(short):
        told = "; ".join(f"{row.value}: {row.steps:.0f} steps of {row.step:g} s, {row.steps * row.step:.3g} s"
                         for row in short.itertuples())
        found.append(f"Motions last {seconds.mode().iloc[0]:g} s in most cells. Those of extreme size and step that are "
                     f"shorter than {SHORT:g} s may miss what happens later: {told}.")
    return found


def silent(rows):
    """What is ok or plausible and wrong, a cell of battery.csv or ways.csv an entry: its runs, errors and first command."""
    return [{"axis": axis, "value": value, "runs": len(group), "least": group.true_error.min(),
             "most": group.true_error.max(), "implementation": group.implementation.iloc[0],
             "command": group.command.iloc[0]}
            for (axis, value), group in rows[rows.silent == True].groupby(["axis", "value"], sort=False)]  # noqa: E712


def unlike(table):
    """Cells where implementations of one setting end differently: [(axis, value, setting, {status: [names]})]."""
    tried = table[~table.status.isin(["not run", "unsupported"])]
    found = []
    for (axis, value, setting), rows in tried.groupby(["axis", "value", "setting"], sort=False):
        if rows.status.nunique() > 1:
            found.append({"axis": axis, "value": value, "setting": setting, "outcomes": {
                status: list(group.implementation) for status, group in rows.groupby("status", sort=False)}})
    return found


def pivots(table):
    """What kept pivots lose, and what the guard costs."""
    found = []
    for strategy, rows in table.groupby("strategy", sort=False):
        worst = rows.loc[rows.error_worst.idxmax()]
        found.append(f"{strategy}: worst error {number(worst.error_worst, 2)} ({worst.sequence}, {worst.form} form, "
                     f"{worst.pivoting} pivots).")
    default = table[table.pivoting == "default"]
    kept = default[(default.strategy == "refactor")].set_index(["sequence", "form"]).time_us_median
    for strategy in ("guarded", "factor"):
        ratio = default[default.strategy == strategy].set_index(["sequence", "form"]).time_us_median / kept
        if ratio.notna().any():
            found.append(f"With default pivots a factorization and solve of {strategy} takes {ratio.median():.2f} times "
                         f"that of refactor (median over the sequences; {ratio.min():.2f} to {ratio.max():.2f}).")
    return found


def scaling(table):
    """Who gives the same solution for T and D T D."""
    found = []
    for solver, rows in table.groupby("solver", sort=False):
        differ = int((rows.components_that_differ > 0).sum())
        found.append(f"{solver}: the same bit for bit in all {len(rows)} systems." if not differ else
                     f"{solver}: differs in {differ} of {len(rows)} systems, by up to "
                     f"{number(rows.largest_difference.max(), 2)} of the largest component.")
    return found


def roundoff(table, lines, singular):
    """For each form and size: the differences, how much of their growth is at singular positions, and whether
    they follow the speed."""
    found = []
    for (form, loops), rows in table.groupby(["scheme", "loops"], sort=False):
        at = singular[singular.loops == loops].t.to_numpy()
        own = [line for _, line in lines[(lines.scheme == form) & (lines.loops == loops)].groupby("implementation")
               if len(line) > 1]
        grown = [growth(rest, at) for rest in (later(line, at) for line in own) if len(rest) > 1]
        near, far, time = numpy.median(grown, axis=0) if grown else [float("nan")] * 3
        found.append({"scheme": form, "loops": loops, "near": near, "far": far, "time": time,
                      "with_speed": float(numpy.median([with_speed(line) for line in own])) if own else float("nan"),
                      "medians": [rows[key].clip(lower=FLOOR).median() for key in INSTANTS],
                      "largest": [rows[key].max() for key in INSTANTS]})
    return found


def jumps(found):
    """What is seen, over all sizes and forms."""
    near, far = (sum(one[key] for one in found if one[key] == one[key]) for key in ("near", "far"))
    if not near + far > 0:
        return ["No growth was seen."]
    time = numpy.nanmedian([one["time"] for one in found])
    share = near / (near + far)
    faster = numpy.inf if share == 1 else share / (1 - share) * (1 - time) / time
    verdict = ("it grows in jumps there" if share > 0.5 and faster > 2 else
               f"it grows {faster:.1f} times as fast there as in between" if faster > 1.2
               else "singular positions are no jumps in it")
    said = [f"After the first turn {100 * share:.0f} % of the growth (decades, summed over sizes and forms) happens "
            f"within {NEAR:g} s of a singular position, which is {100 * time:.0f} % of the time: {verdict}."]
    powers = [numpy.log(one["medians"][2] / one["medians"][1]) / numpy.log(20 / 5) for one in found
              if one["medians"][1] > FLOOR]
    if powers:
        said.append(f"From 5 to 20 s it grows with a power of time between {min(powers):.1f} and {max(powers):.1f}.")
    speeds = [one["with_speed"] for one in found if one["with_speed"] == one["with_speed"]]
    if speeds:
        said.append(f"Its correlation with the speed of the rods (logarithms without trend, second half) is "
                    f"{min(speeds):.2f} to {max(speeds):.2f}: " + (
                        "one motion is late on the same path, by a lag that grows." if min(speeds) > 0.8 else
                        "it is not a lag alone."))
    return said
