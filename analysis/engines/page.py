# What the page and the front page say of the engines, computed from the tables.
import math

from analysis.core.outcomes import FINISHED, finished
from analysis.core.text import between, number, rows_of, span
from analysis.engines.equal_error import ABOUT, SIDES, compared, lacking
from analysis.engines.figures import NOT_MADE, title
from analysis.engines.runs import NATIVE
from analysis.engines.subjects import ANDREWS, DURATION_S, subject_of

CURVE = ["subject", "setting", "over"]
TOO_LONG = ("predicted to take", "the run before it did not end")  # how study/core/curves.py says that the limit of a run cut a curve


def context(tables, view):
    engines, table = tables["engines"], tables["equal_error"]
    names = list(dict.fromkeys(engines.engine[engines.status != "unavailable"]))
    return {"says": [*of_engines(engines)], "measured": not table.empty, "setting_up": "study/setup --engines", "about": ABOUT,
            "sides": {side: what for side, what in SIDES.items() if (table.side == side).any()}, "duration": DURATION_S, "worst": subject_of(ANDREWS).worst,
            "engines": {name: title(name) for name in names}, "title": title, "value": value,
            "subjects": {name: subject_of(name).title for name in dict.fromkeys(engines.subject)},
            "summaries": {side: summary(table[table.side == side], engines, names) for side in SIDES},
            "behind": rows_of(table[(table.ratio < 1)].sort_values("ratio")), "unreached": unreached(table),
            "comparisons": {subject: rows_of(rows) for subject, rows in table.groupby("subject", sort=False)},
            "native": rows_of(tables["native"]), "native_says": of_native(tables["native"]),
            "dropped": {name: int((tables[name].status == "dropped").sum()) for name in ("engines", "ours", "rounds")}}


def summary(rows, runs, engines):
    """{subject: {engine: {"low", "high": lowest and highest ratio, "timed": how many, "lacking"}, or why none}}"""
    found = {key: {"low": mine.ratio.min(), "high": mine.ratio.max(), "timed": mine.ratio.count(), "lacking": lacking(mine)}
             for key, mine in rows.groupby(["subject", "engine"])}
    return {subject: {engine: found.get((subject, engine)) or absent(runs[(runs.subject == subject) & (runs.engine == engine)])
                      for engine in engines} for subject in dict.fromkeys(runs.subject)}


def unreached(table):
    """[(side, subject, reason, errors)] of where ours was not compared, by what is the matter."""
    rows = table[table.ratio.isna() & (table.reason != "none of it takes part")]
    return [(*key, sorted(set(errors), reverse=True)) for key, errors in rows.groupby(["side", "subject", "reason"], sort=False).engine_error]


def answers(tables, view):
    table = tables["equal_error"]
    if table.empty:
        reasons = dict.fromkeys(tables["engines"].reason)
        return [{"text": f"Not measured: {'; '.join(one for one in reasons if one) or 'no engine took part'}.", "anchor": ""}]
    found = {text: "equal" for text in (*(of_side(table, side) for side in SIDES), *of_andrews(table))} | {of_native(tables["native"]): "native"}
    return [{"text": text, "anchor": anchor} for text, anchor in found.items() if text]


def of_side(table, side):
    """A sentence on one side of ours: how often it is faster, by how much, and why it was not compared."""
    rows, timed = table[(table.side == side) & ~table.engine.str.endswith(NATIVE)], compared(table, side)
    if rows.empty or (rows.reason == "none of it takes part").all():
        return ""
    text, single = f"{SIDES[side].capitalize()}: timed at {len(timed)} of {len(rows)} errors that engines reach", (timed.high == math.inf).sum()
    if len(timed):
        worst, single = timed.loc[timed.ratio.idxmin()], f" ({single} have a single round, so nothing is shown)" if single else ""
        where = f"; {title(worst.engine)}, {subject_of(worst.subject).title}, {number(worst.engine_error, 2)} m"
        text += (f", shown to be faster in {(timed.low > 1).sum()} of these{single}; the engines take {medians(timed)} times as long in their "
                 f"medians, at the least {between(worst.ratio, worst.low, worst.high, 2, where)}")
    return "; ".join([text, *lacking(rows)]) + "."


def medians(rows):
    """"4.5 to 190": over engines, of each its median ratio."""
    return span(rows.groupby("engine").ratio.median(), 2)


def of_andrews(table):
    """A sentence for each solver that simulated Andrews' mechanism: its time over that of each side of ours."""
    for engine, rows in table[table.subject == ANDREWS].groupby("engine", sort=False):
        said = [f"{span(mine.ratio.dropna(), 2)} times as long as {SIDES[side]}{f' ({lacks})' if lacks else ''}"
                for side, mine in rows.groupby("side", sort=False) for lacks in [", ".join(lacking(mine))] if mine.ratio.notna().any()]
        if said:
            least, most = (number(one, 2) for one in (rows.engine_error.min(), rows.engine_error.max()))
            yield f"{title(engine)} on Andrews' mechanism, at its errors from {most} to {least} m, takes {'; '.join(said)}."


def of_native(native):
    """How much it matters that packages are built for any processor; "" if it was not measured."""
    if native.empty:
        return ""
    return (f"How much the packages' flags matter is known of {title(native.engine.iloc[0])} alone: from Debian it takes "
            f"{number(native.ratio.median(), 3)} times as long as built with our flags (median of {len(native)} runs, {span(native.ratio)}).")


def value(over, amount):
    """"step 5 ms" or "accuracy 10⁻⁶"."""
    return f"step {number(1e3 * amount)} ms" if over == "step" else f"accuracy {number(amount)}"


def cut_curves(rows):
    """How many values each curve of engines has that the budget or the limit of a run cut."""
    curves = rows.assign(made=~rows.status.isin(NOT_MADE), cut=(rows.status == "dropped") | rows.reason.str.startswith(TOO_LONG)).groupby(CURVE)
    return curves.made.sum()[curves.cut.any()]


def absent(rows):
    """Why an engine is in no comparison of a subject. `rows`: its runs there."""
    if rows.empty or len(finished(rows)):
        return "takes no part" if rows.empty else "not timed in the rounds"
    return f"cut after {span(cut)} value{'' if cut.max() == 1 else 's'}" if len(cut := cut_curves(rows)) else "reaches none"


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
        if len(cut := cut_curves(rows)):
            best += f", {len(cut)} of its {rows.groupby(CURVE).ngroups} curves were cut by the budget or the time limit"
        version = next((one for one in made.version if one), "")
        yield f"{title(engine)} {version}: {len(made)} runs; {best}; not finished: {kinds or 'none'}."
