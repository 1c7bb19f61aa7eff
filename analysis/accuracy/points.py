# Points: an implementation with a setting at a step, on a scene: its error, from a run of its own, and its time.
#
# Time is that of a simulated second. The program times a stretch from the start of the motion; a whole run may need more
# or fewer passes a step, so that the time of a step is that of the stretch times the ratio of passes.
from operator import itemgetter

import numpy
import pandas

from analysis.core import timing
from analysis.core.controls import CONTROL
from analysis.core.gather import gather
from analysis.core.outcomes import FINISHED, of_run
from analysis.accuracy import subjects

KEY = ["scene", "implementation", "setting", "step"]
_key = itemgetter(*KEY)  # of a row
LOOK, ROUNDS, RUN = "look", "rounds", "run"  # where a time is from: one process, several, an untimed run
NOT_JUDGED = "not-judged"                    # the status of a point without a run of its own
ROLES = {"look": LOOK, "time": ROUNDS}       # of timed cells, before the slash
USED = [*KEY, "role", "process", "status", "reason", "step_us", "steps", "passes", "variables", "record"]  # of many counters


def setting_of(record):
    """The name of its setting: roles are "what/setting.with.dots"."""
    return record.role.partition("/")[2].replace(".", " ")


def runs(records, subject, known):
    """A row for each untimed run ("run/SETTING"). `known`: the subject's Reference, or None where it has none."""
    rows = []
    for record in (one for one in records if one.role.startswith("run/")):
        status, reason = of_run(record)
        row = {"scene": record.cell["scene"], "implementation": record.cell["contenders"][0], "setting": setting_of(record),
               "step": record.option("--step"), "duration": record.option("--duration"), "status": status,
               "reason": reason, "record": record.name}
        found = record.output
        if record.done and found["steps"]:
            row |= {"variables": found["variables"], "fill": found["tangent_nonzeros"] / found["variables"]**2,
                    "passes": found["passes_per_step"], "factorizations": found["factorizations_per_step"],
                    "time": 1e-6 * found["step_us"]["median"] / row["step"]}
        if status in FINISHED and known:
            row["error"] = max(subjects.error(subject, known, record), known.own_error)
        rows.append(row)
    return pandas.DataFrame(rows, columns=[*KEY, "duration", "status", "reason", "record", "variables", "fill", "passes", "factorizations",
                                           "time", "error"])


def timed(records):
    """A row for each contender of each process of timed cells ("look/SETTING", …)."""
    chosen = {record.name: record for record in timing.counted([one for one in records if one.role.partition("/")[0] in (*ROLES, CONTROL, "pair")])}
    found = timing.processes(chosen.values())
    of = [chosen[one] for one in found.record]
    return found.assign(
        implementation=[name.partition("+")[0] for name in found.implementation],  # of another pair: the anchor
        setting=[*map(setting_of, of)], step=[one.option("--step") for one in of], role=[one.role.partition("/")[0] for one in of],
        **{name: found.get(name, numpy.nan) for name in ("passes", "steps")}).drop_duplicates([*KEY, "role", "process"])


def points(made, measured):
    """A row for each point that has a run or a time. `made`, `measured`: what `runs` and `timed` give."""
    own = {_key(row): row for row in made.sort_values("duration", kind="stable").to_dict("records")}
    others = {key[2:]: row for key, row in reversed(own.items()) if row["error"] == row["error"]}  # by setting and step: the first
    times, rows = _processes(measured, ROLES), []
    for key in dict.fromkeys([*own, *times]):
        row = dict(zip(KEY, key))
        if key in own:
            row |= own[key] | {"error_of": key[1], "time_from": RUN}
        elif key[2:] in others:
            source = others[key[2:]]
            row |= {name: source[name] for name in ("error", "passes", "variables", "record")} | {
                "status": NOT_JUDGED, "reason": "no run of its own", "error_of": source["implementation"]}
        else:
            row |= {"status": NOT_JUDGED, "reason": "nobody's run tells its error"}
        if key in times:
            row |= _time(times[key], row)
        rows.append(row)
    return pandas.DataFrame(rows, columns=[*KEY, "duration", "status", "reason", "error", "error_of", "passes", "factorizations", "variables",
                                           "fill", "step_us", "time", "time_low", "time_high", "time_from", "processes", "record"])


def _processes(measured, roles):
    """{key: its rows, without what the budget left out}"""
    asked = measured.role.isin(list(roles)) & (measured.status != "dropped")
    return gather((_key(row), row) for row in measured.loc[asked, measured.columns.intersection(USED)].to_dict("records"))


def _time(rows, row):
    """Median over processes, with the least and the largest; of a look, where there are no rounds."""
    kind = "time" if any(one["role"] == "time" for one in rows) else "look"
    mine = [one for one in rows if one["role"] == kind]
    lost = next((one for one in mine if one["status"] != "ok"), None)
    records = " ".join(dict.fromkeys([*filter(None, [row.get("record")]), *(one["record"] for one in mine)]))
    if lost:
        status = {key: lost[key] for key in ("status", "reason")} if row["status"] in (*FINISHED, NOT_JUDGED) else {}
        return status | {"time": numpy.nan, "time_from": ROLES[kind], "record": records}
    seconds = [_seconds(one, row) for one in mine]
    return {"step_us": timing.median([one["step_us"] for one in mine]), "time": timing.median(seconds), "time_low": min(seconds),
            "time_high": max(seconds), "time_from": ROLES[kind], "processes": len(mine), "record": records,
            "variables": mine[0].get("variables", row.get("variables"))}


def _seconds(process, row):
    """A process's time of a step as s of computation for a simulated second."""
    in_stretch = process["passes"] / process["steps"]
    more = row["passes"] / in_stretch if row.get("passes", 0) > 0 and in_stretch > 0 else 1.0
    return 1e-6 / row["step"] * more * process["step_us"]


def rounds(table, measured):
    """The rows of a scene's points in rounds as analysis.core.timing ranks them: "implementation" is a label of the
    point. Processes of one number follow each other on the machine, and count as one process."""
    times = _processes(measured[measured.scene.isin(table.scene)], ("time",))
    rows = [{"implementation": label(point), "process": one["process"], "status": one["status"], "seconds": _seconds(one, point)}
            for point in table[table.time_from == ROUNDS].to_dict("records") for one in times[_key(point)]]
    return timing.apart(pandas.DataFrame(rows, columns=["implementation", "process", "status", "seconds"]), "seconds")


def label(point):
    return f"{point['implementation']}|{point['setting']}|{point['step']:g}"
