# What the page says besides its figures.
from analysis.core.text import rows_of
from analysis.engines import sentences
from analysis.engines.equal_error import SIDES, lacking
from analysis.engines.figures import title
from analysis.engines.subjects import ANDREWS, DURATION_S, subject_of


def context(tables, view):
    engines, table = tables["engines"], tables["equal_error"]
    names = list(dict.fromkeys(engines.engine[engines.status != "unavailable"]))
    answers = [one["text"] for one in sentences.answers(tables, view)] if len(table) else []
    return {"answers": answers, "says": [*sentences.of_engines(engines)], "measured": not table.empty, "setting_up": "study/setup --engines",
            "sides": {side: what for side, what in SIDES.items() if (table.side == side).any()}, "duration": DURATION_S, "worst": subject_of(ANDREWS).worst,
            "engines": {name: title(name) for name in names}, "title": title, "value": sentences.value,
            "subjects": {name: subject_of(name).title for name in dict.fromkeys(engines.subject)},
            "summaries": {side: summary(table[table.side == side], engines, names) for side in SIDES},
            "behind": rows_of(table[(table.ratio < 1)].sort_values("ratio")), "unreached": unreached(table),
            "comparisons": {subject: rows_of(rows) for subject, rows in table.groupby("subject", sort=False)},
            "native": rows_of(tables["native"]), "native_says": sentences.of_native(tables["native"]),
            "dropped": {name: int((tables[name].status == "dropped").sum()) for name in ("engines", "ours", "rounds")}}


def summary(rows, runs, engines):
    """{subject: {engine: {"low", "high": lowest and highest ratio, "timed": how many, "lacking"}, or why none}}"""
    found = {key: {"low": mine.ratio.min(), "high": mine.ratio.max(), "timed": mine.ratio.count(), "lacking": lacking(mine)}
             for key, mine in rows.groupby(["subject", "engine"])}
    return {subject: {engine: found.get((subject, engine)) or sentences.absent(runs[(runs.subject == subject) & (runs.engine == engine)])
                      for engine in engines} for subject in dict.fromkeys(runs.subject)}


def unreached(table):
    """[(side, subject, reason, errors)] of where ours was not compared, by what is the matter."""
    rows = table[table.ratio.isna() & (table.reason != "none of it takes part")]
    return [(*key, sorted(set(errors), reverse=True)) for key, errors in rows.groupby(["side", "subject", "reason"], sort=False).engine_error]
