# Curves of theirs and ours, the common rounds, and what follows at equal error, from the records.
import pandas

from analysis.core.controls import CONTROL, repeated
from analysis.engines import equal_error
from analysis.engines.runs import ENGINE, OURS, ROUND, row
from analysis.engines.subjects import subject_of

COLUMNS = ("subject", "side", "name", "setting", "over", "value", "status", "reason", "error", "time", "round", "key", "record")


def build(records, view):
    engines, ours, rounds, again = (_sorted(frame([row(one) for one in records if one.role == role])) for role in (ENGINE, OURS, ROUND, CONTROL))
    return {"engines": engines.drop(columns=["side", "round", "key"]).rename(columns={"name": "engine"}),
            "ours": ours.drop(columns=["side", "round", "over", "key"]).rename(columns={"name": "implementation", "value": "step"}),
            "rounds": rounds[list(COLUMNS)].drop(columns=["error", "key"]), "native": equal_error.native(engines, rounds),
            "controls": repeated(*map(equal_error.samples, (rounds, again)), "time"),
            "equal_error": equal_error.table(engines, ours, rounds, view.registry.own)}


def _sorted(table):
    places = {name: place for place, name in enumerate(sorted(table.subject.unique(), key=lambda one: subject_of(one).place))}
    return table.sort_values(["subject", "name", "setting", "over", "value", "round"], kind="stable", key=lambda column:
                             column.map(places) if column.name == "subject" else -column if column.name == "value" else column)


def frame(rows):
    """Rows of runs as a table, which has its columns even if there is no row."""
    found = pandas.DataFrame(rows, columns=None if rows else list(COLUMNS))
    return found.assign(**{name: pandas.to_numeric(found[name]).astype(float) for name in ("error", "time", "value")})
