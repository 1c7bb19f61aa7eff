# What the page says besides its figures.
from analysis.core.outcomes import FINISHED, finished
from analysis.core.text import rows_of
from analysis.engines import sentences
from analysis.engines.equal_error import SIDES
from analysis.engines.figures import NOT_MADE, title
from analysis.engines.subjects import DURATION_S, subject_of

SETTING_UP = "study/setup --engines"


def context(tables, view):
    engines, table = tables["engines"], tables["equal_error"]
    names = list(dict.fromkeys(engines.engine[engines.status != "unavailable"]))
    answers = [one["text"] for one in sentences.answers(tables, view)] if len(table) else []
    return {"answers": answers, "says": sentences.of_engines(engines), "measured": not table.empty, "setting_up": SETTING_UP,
            "sides": {side: what for side, what in SIDES.items() if (table.side == side).any()},
            "engines": {name: title(name) for name in names}, "duration": DURATION_S, "subjects": {
                name: subject_of(name).title for name in dict.fromkeys(engines.subject)},
            "summaries": {side: summary(table[table.side == side], names) for side in SIDES},
            "behind": rows_of(table[(table.ratio < 1)].sort_values("ratio")),
            "unreached": unreached(table), "comparisons": {subject: rows_of(rows) for subject, rows in
                                                           table.groupby("subject", sort=False)},
            "native": rows_of(tables["native"]), "native_says": sentences.of_native(tables["native"]),
            "reached": reached(engines), "complaints": complaints(engines), "value": sentences.value, "title": title,
            "dropped": {name: int((tables[name].status == "dropped").sum()) for name in ("engines", "ours", "rounds")}}


def summary(rows, engines):
    """{subject: {engine: (lowest ratio, highest ratio, errors, errors that are not reached) or None}}"""
    found = {}
    for subject, mine in rows.groupby("subject", sort=False):
        found[subject] = {}
        for engine in engines:
            one = mine[mine.engine == engine]
            ratios = one.ratio.dropna()
            found[subject][engine] = None if one.empty else (
                ratios.min() if len(ratios) else None, ratios.max() if len(ratios) else None, len(one),
                int(one.ratio.isna().sum()))
    return found


def unreached(table):
    """[(side, subject, reason, errors)] of what ours does not reach, by what is the matter."""
    rows = table[table.ratio.isna() & (table.reason != "none of it takes part")]
    return [(*key, sorted(set(errors), reverse=True)) for key, errors in
            rows.groupby(["side", "subject", "reason"], sort=False).engine_error]


def reached(engines):
    """[(engine, setting, {subject: cell})]: the smallest error of each setting, or how its runs were lost."""
    made = engines[engines.over != ""]
    return [(engine, setting or "its own values", over, {subject: _cell(mine) for subject, mine in rows.groupby("subject", sort=False)})
            for (engine, over, setting), rows in made.groupby(["engine", "over", "setting"], sort=False)]


def _cell(rows):
    made = rows[~rows.status.isin(NOT_MADE)]
    done, lost = finished(made), made[~made.status.isin(FINISHED)]
    reasons = "; ".join(f"{sentences.value(row.over, row.value)}: {row.status}, {row.reason}" for row in lost.itertuples())
    return {"error": None if done.empty else done.error.min(), "why": reasons,
            "lost": ", ".join(f"{count} {status}" for status, count in lost.status.value_counts().items())}


def complaints(engines):
    """[(engine, runs, first)]: what engines said while they ran."""
    said = engines[engines.first_complaint != ""]
    return [(title(engine), len(rows), rows.first_complaint.iloc[0]) for engine, rows in said.groupby("engine", sort=False)]
