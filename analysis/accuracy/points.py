# Points: an implementation with a setting at a step, on a scene: its error, from a run of its own, and its time.
#
# Time is that of a simulated second. The program times a stretch from the start of the motion; a whole run may need more
# or fewer passes a step, so that the time of a step is that of the stretch times the ratio of passes.
import numpy
import pandas

from analysis.core import timing
from analysis.core.outcomes import FINISHED, of_run
from analysis.accuracy import subjects

KEY = ["scene", "implementation", "setting", "step"]
LOOK, ROUNDS, RUN = "look", "rounds", "run"  # where a time is from: one process, several, an untimed run
ROLES = {"look": LOOK, "time": ROUNDS}       # of timed cells, before the slash


def setting_of(record):
    """The name of its setting: roles are "what/setting.with.dots"."""
    return record.role.partition("/")[2].replace(".", " ")


def option(record, name):
    """The value of an option of its cell."""
    words = list(map(str, record.cell["settings"]))
    return float(words[words.index(name) + 1])


def runs(records, subject, known):
    """A row for each untimed run ("run/SETTING"). `known`: the subject's Reference, or None where it has none."""
    rows = []
    for record in records:
        if not record.role.startswith("run/"):
            continue
        status, reason = of_run(record)
        row = {"scene": record.cell["scene"], "implementation": record.cell["contenders"][0], "setting": setting_of(record),
               "step": option(record, "--step"), "duration": option(record, "--duration"), "status": status,
               "reason": reason, "seconds": record.seconds, "record": record.name}
        found = record.output
        if record.done and found["steps"]:
            row |= {"variables": found["variables"], "fill": found["tangent_nonzeros"] / found["variables"]**2,
                    "passes": found["passes_per_step"], "factorizations": found["factorizations_per_step"],
                    "steps": found["steps"], "time": 1e-6 * found["step_us"]["median"] / row["step"]}
        if status in FINISHED and known:
            error = subjects.error(subject, known, record)
            row |= {"error": max(error, known.own_error), "at_most": bool(error <= known.own_error)}
        rows.append(row)
    return pandas.DataFrame(rows, columns=[*KEY, "duration", "status", "reason", "seconds", "record", "variables", "fill",
                                           "passes", "factorizations", "steps", "time", "error", "at_most"])


def timed(records):
    """A row for each contender of each process of timed cells ("look/SETTING", "time/SETTING", "pair/SETTING")."""
    chosen = {record.name: record for record in records if record.role.partition("/")[0] in (*ROLES, "pair")}
    found = timing.processes(chosen.values())
    found["implementation"] = found.implementation.str.partition("+")[0]  # of another pair: the anchor
    for name, value in (("setting", setting_of), ("step", lambda record: option(record, "--step")),
                        ("role", lambda record: record.role.partition("/")[0])):
        found[name] = [value(chosen[one]) for one in found.record]
    if "passes" not in found:
        found[["passes", "steps"]] = numpy.nan
    return found.drop_duplicates([*KEY, "role", "process"])


def points(made, measured):
    """A row for each point that has a run or a time. `made`, `measured`: what `runs` and `timed` give."""
    own = made.sort_values("duration", kind="stable").drop_duplicates(KEY, keep="last").set_index(KEY)
    counted = measured[measured.role.isin(ROLES) & (measured.status != "dropped")]
    times = dict(list(counted.groupby(KEY, sort=False)))
    others = own[own.error.notna()].reset_index().drop_duplicates(["setting", "step"]).set_index(["setting", "step"])
    rows = []
    for key in dict.fromkeys([*own.index, *times]):
        row = dict(zip(KEY, key))
        if key in own.index:
            row |= own.loc[key].drop(["seconds", "steps"]).to_dict() | {"error_of": key[1], "time_from": RUN}
        elif key[2:] in others.index:
            source = others.loc[key[2:]]
            row |= {"status": "not-judged", "reason": "no run of its own", "error": source.error,
                    "error_of": source.implementation, "passes": source.passes, "at_most": source.at_most,
                    "variables": source.variables, "record": source.record}
        else:
            row |= {"status": "not-judged", "reason": "nobody's run tells its error"}
        if key in times:
            row |= _time(times[key], row)
        rows.append(row)
    found = pandas.DataFrame(rows, columns=[*KEY, "duration", "status", "reason", "error", "error_of", "at_most", "passes",
                                            "factorizations", "variables", "fill", "step_us", "time", "time_low",
                                            "time_high", "time_from", "processes", "record"])
    return found.astype({"at_most": "boolean"})


def _time(rows, row):
    """Median over processes, with the least and the largest; of a look, where there are no rounds."""
    kind = "time" if (rows.role == "time").any() else "look"
    mine = rows[rows.role == kind]
    lost = mine[mine.status != "ok"]
    records = " ".join(dict.fromkeys([*filter(None, [row.get("record")]), *mine.record]))
    if len(lost):
        first = lost.iloc[0]
        status = {"status": first.status, "reason": first.reason} if row["status"] in (*FINISHED, "not-judged") else {}
        return status | {"time": numpy.nan, "time_from": ROLES[kind], "record": records}
    seconds = [float(numpy.median(one)) for one in _seconds(mine, row)]
    return {"step_us": float(mine.step_us.median()), "time": float(numpy.median(seconds)), "time_low": min(seconds),
            "time_high": max(seconds), "time_from": ROLES[kind], "processes": len(mine), "record": records,
            "variables": mine.variables.iloc[0] if "variables" in mine else row.get("variables")}


def _seconds(rows, row):
    """Samples of each process as s of computation for a simulated second."""
    for one in rows.itertuples():
        in_stretch = one.passes / one.steps
        more = row["passes"] / in_stretch if row.get("passes", 0) > 0 and in_stretch > 0 else 1.0
        yield 1e-6 / row["step"] * more * numpy.array(one.samples)


def rounds(table, measured):
    """The rows of a scene's points in rounds as analysis.core.timing ranks them: "implementation" is a label of the
    point. Processes of one number follow each other on the machine, and count as one process."""
    rows = []
    mine = measured[(measured.role == "time") & (measured.status != "dropped")].set_index(KEY).sort_index()
    for point in table[table.time_from == ROUNDS].to_dict("records"):
        key = tuple(point[name] for name in KEY)
        chosen = mine.loc[[key]]
        good = chosen[chosen.status == "ok"]
        rows += [{"implementation": label(point), "environment": "", "process": number, "status": "ok",
                  "samples": tuple(values)} for number, values in zip(good.process, _seconds(good, point))]
        rows += [{"implementation": label(point), "environment": "", "process": one.process, "status": one.status}
                 for one in chosen[chosen.status != "ok"].itertuples()]
    return pandas.DataFrame(rows, columns=["implementation", "environment", "process", "status", "samples"])


def label(point):
    return f"{point['implementation']}|{point['setting']}|{point['step']:g}"
