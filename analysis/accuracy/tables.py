# The tables of accuracy from its records: a column of the part is a subject with its runs, times and winners.
import pandas

from analysis.accuracy import pairs, subjects
from analysis.accuracy.points import KEY, points, runs, timed
from analysis.accuracy.winners import LAYERS, meeting, of_layer, winners
from analysis.core.controls import CONTROL, repeated
from analysis.core.files import StudyError
from analysis.core.outcomes import pareto


def build(records, view):
    found = {"points": [], "winners": [], "pairs": [], "references": [], "left_out": [], "controls": []}
    for column, (kind, entry) in subjects.columns(view.settings).items():
        subject = subjects.of(kind, entry, view.settings)
        if not (mine := [record for record in records if record.column == column]):
            continue
        known, row = reference_of(subject, mine)
        found["references"].append(row)
        for name, table in of_column(kind, subject, known, mine, view).items():
            found[name].append(table)
        found["left_out"] += [{"column": column, "what": record.role, "status": record.status, "reason": record.reason,
                               "record": record.name} for record in mine
                              if record.status in ("dropped", "refused", *(("excluded",) if kind == "pairs" else ()))]
    return {name: (pandas.concat(rows, ignore_index=True) if rows and isinstance(rows[0], pandas.DataFrame)
                   else pandas.DataFrame(rows)) for name, rows in found.items()}


def reference_of(subject, records):
    """(the Reference of a subject or None, its row)"""
    finest = sorted((record for record in records if record.role == "reference"), key=lambda record: -record.option("--step"))
    row = {"subject": subject.name, "title": subject.title, "unit": subject.unit, "duration": subject.duration,
           "record": " ".join(record.name for record in finest or records[:1])}
    try:
        known = subjects.reference(subject, finest)
    except StudyError as error:
        return None, row | {"reference": f"none: {error}"}
    return known, row | {"reference": known.kind, "own_error": known.own_error, "own_error_from": known.origin}


def of_column(kind, subject, known, records, view):
    """{table: DataFrame} of one column."""
    made, measured = runs(records, subject, known), timed(records)
    named = {"subject": subject.name, "loops": subject.loops}
    if kind == "pairs":
        table = pairs.table(subject.scene, made, measured)
        return {"pairs": table.assign(**named)} if len(table) else {}
    table = points(made, measured)
    if table.empty:
        return {}
    libraries = view.registry.libraries
    for layer in LAYERS:
        chosen = meeting(of_layer(table, layer, libraries), float("inf"))
        table[f"front_{layer}"] = table.index.isin([index for _, rows in chosen.groupby("scene") for index in pareto(rows)])
    won = winners(table, measured, view.settings["errors"], libraries)
    for one in (table, won):
        one["fill_asked"] = [float(scene.partition("fill=")[2] or "nan") for scene in one.scene]
    won["variables"] = table.variables.max()
    won = won.sort_values(["fill_asked", "layer", "required"], ascending=[True, False, False], na_position="first")
    again = measured[measured.role == CONTROL]
    rows = measured[measured.role == "time"].merge(again[KEY].drop_duplicates())
    return {"points": table.assign(library=table.implementation.isin(libraries), **named), "winners": won.assign(**named),
            "controls": pandas.DataFrame(repeated(rows, again))}
