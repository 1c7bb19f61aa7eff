# What the front page says of the engines, computed from the tables.
from analysis.core.outcomes import FINISHED, finished
from analysis.core.text import between, number, span
from analysis.engines.equal_error import SIDES
from analysis.engines.figures import NOT_MADE, title
from analysis.engines.runs import NATIVE
from analysis.engines.subjects import ANDREWS, subject_of


def answers(tables, view):
    table = tables["equal_error"]
    if table.empty:
        reasons = dict.fromkeys(tables["engines"].reason)
        return [{"text": f"Not measured: {'; '.join(one for one in reasons if one) or 'no engine took part'}.", "anchor": ""}]
    found = {text: "equal" for text in (*(of_side(table, side) for side in SIDES), *of_andrews(table))} | {of_native(tables["native"]): "native"}
    return [{"text": text, "anchor": anchor} for text, anchor in found.items() if text]


def of_side(table, side):
    """A sentence on one side of ours: how often it is faster, by how much, and what it does not reach."""
    rows = table[(table.side == side) & ~table.engine.str.endswith(NATIVE)]
    timed = rows[rows.ratio.notna()]
    if rows.empty or (rows.reason == "none of it takes part").all():
        return ""
    text = (f"{SIDES[side].capitalize()}: shown to be faster than the engine in {(timed.low > 1).sum()} of {len(rows)} "
            "comparisons at equal error")
    if len(timed):
        worst = timed.loc[timed.ratio.idxmin()]
        where = f"; {title(worst.engine)}, {subject_of(worst.subject).title}, {number(worst.engine_error, 2)} m"
        text += (f", by {number(timed.ratio.median(), 2)} times in the median, at the least "
                 f"{between(worst.ratio, worst.low, worst.high, 2, where)}")
    if len(timed) < len(rows):
        text += f"; it does not reach {len(rows) - len(timed)} of these errors"
    return text + "."


def of_andrews(table):
    """A sentence for each solver that simulated Andrews' mechanism: its time over that of each side of ours."""
    for engine, rows in table[table.subject == ANDREWS].groupby("engine", sort=False):
        if compared := [text for side in SIDES for text in [_times(rows[rows.side == side], SIDES[side])] if text]:
            errors = rows.engine_error
            yield (f"{title(engine)} on Andrews' mechanism, at its errors from {number(errors.max(), 2)} to "
                   f"{number(errors.min(), 2)} m, takes " + "; ".join(compared) + ".")


def _times(rows, side):
    """"0.4 to 2 times as long as SIDE, which does not reach 1 of 5 errors"; "" if SIDE reaches none."""
    timed = rows[rows.ratio.notna()]
    if timed.empty:
        return ""
    missed = len(rows) - len(timed)
    return f"{span(timed.ratio, 2)} times as long as {side}" + (f", which does not reach {missed} of {len(rows)} of them" if missed else "")


def of_native(native):
    """How much it matters that packages are built for any processor; "" if it was not measured."""
    if native.empty:
        return ""
    return (f"{title(native.engine.iloc[0])} from Debian takes {number(native.ratio.median(), 3)} times as long as built "
            f"with our flags (median of {len(native)} runs, {number(native.ratio.min(), 3)} to {number(native.ratio.max(), 3)}).")


def value(over, amount):
    """"step 5 ms" or "accuracy 10⁻⁶"."""
    return f"step {number(1e3 * amount)} ms" if over == "step" else f"accuracy {number(amount)}"


def of_engines(engines):
    """A sentence for each engine: what it reaches, what it loses."""
    for engine, rows in engines.groupby("engine", sort=False):
        if (rows.status == "unavailable").all():
            yield f"{title(engine)}: left out, {rows.reason.iloc[0]}."
            continue
        made = rows[~rows.status.isin(NOT_MADE)]
        kinds = ", ".join(f"{count} {status}" for status, count in made.status[~made.status.isin(FINISHED)].value_counts().items())
        done = finished(made)
        best = "none finished" if done.empty else (
            f"{number(done.error.min(), 2)} m is the smallest error ({subject_of(done.loc[done.error.idxmin()].subject).title})")
        version = next((one for one in made.version if one), "")
        yield f"{title(engine)} {version}: {len(made)} runs; {best}; not finished: {kinds or 'none'}."
