# Rows of what was tried, by form of the step, variant and scene.
from collections import namedtuple

from analysis.core import timing
from analysis.core.contest import cells_of, verdicts_of
from analysis.core.controls import controls

# By form: what roles of its records begin with, and its key in the settings.
Form = namedtuple("Form", "prefix scenes")
FORMS = {"penalty": Form("", "scenes"), "saddle-point": Form("saddle-point-", "saddle_point")}


def build(records, view):
    found, twins = [], []
    for form, (prefix, key) in FORMS.items():
        mine = [one for one in records if one.role.startswith(prefix or ("gate", "time"))]
        gate = [one for one in mine if one.role == f"{prefix}gate"]
        said = verdicts_of(gate)
        rows = timing.processes(timing.counted([one for one in mine if one.role != f"{prefix}gate"]))
        twins += controls(rows)
        for scene in view.settings.get(key, []):
            here = rows[rows.scene == scene]
            cells = cells_of(here, scene, said)
            for name, one in view.registry.tried.items():
                known = {"scene": scene, "scheme": form, "base": one["tried_for"], "alternative": name, "description": one["description"]}
                row = _row(here, cells, name, one["tried_for"]) or _unasked(gate, scene, name)
                found += [known | row] if row else []
    return {"alternatives": found, "controls": twins}


def _row(rows, cells, name, base):
    lost = next((cells[one] for one in (base, name) if one in cells and cells[one]["status"] != "ok"), None)
    if lost is not None or not {name, base} <= cells.keys():
        return {key: lost[key] for key in ("status", "reason", "record")} if lost else None
    return timing.ratio(rows, name, base).columns() | {
        "status": "ok", "reason": "", "base_us": cells[base]["step_us"], **{key: cells[name][key] for key in ("processes", "step_us", "record")}}


def _unasked(gate, scene, name):
    """Of one that was not timed: what the gate said of it, or how the gate ended. None: it took no part."""
    for record in gate:
        if record.cell["scene"] == scene and name in record.cell["contenders"]:
            status, reason = record.verdicts[name]
            if status == "agrees":  # then its own variant did not, or the budget was spent
                status, reason = "dropped", "not timed, or not beside the variant itself"
            return {"status": status, "reason": reason, "record": record.name}
    return None
