# The rows of the tidy table, of the scenes and of the gate, from records.
import pandas

from analysis.core.timing import PHASES, processes
from analysis.map.timed import timed_rows

COUNTERS = ("passes", "steps", "steps_at_limit", "setup_us", "position_error", "constraint_violation", "energy_drift",
            *(f"phase_{phase}" for phase in PHASES))
QUESTION = ("constraints", "start", "steps", "step", "passes", "penalty", "tolerance", "fill_seed")
SKIPPED = ("excluded", "unavailable")  # roles


def tidy(records):
    pilots = processes([one for one in records if one.role == "pilot"])
    costs = {(row.scene, row.implementation): row.step_us for row in pilots.itertuples() if row.status == "ok"}
    excluded = {(one.cell["scene"], name) for one in records if one.role == "excluded" for name in one.cell["contenders"]}
    lost = [row for row in pilots.to_dict("records")  # a pilot that ran out of time may tell enough to exclude it
            if row["status"] != "ok" and not (row["status"] == "timeout" and (row["scene"], row["implementation"]) in excluded)]
    rows = [_common(row, "timing") for row in timed_rows(records).to_dict("records")]
    skipped = processes([one for one in records if one.role in SKIPPED]).to_dict("records")
    rows += [_common(row | {"process": None}, "timing") for row in [*lost, *_rejected(records), *skipped]]
    rows += [_common(row, kind) for kind in ("phases", "seeds")
             for row in processes([one for one in records if one.role == kind]).to_dict("records")]
    rows += [row for one in records if one.role == "operations" for row in _operations(one)]
    timed = {(row["scene"], row["implementation"]) for row in rows if row["status"] == "ok" and row["kind"] == "timing"}
    rows = [row for row in rows if row["status"] != "timeout" or row["process"] or
            (row["scene"], row["implementation"]) not in timed]
    fills = {row.scene: row.fill_percent for row in pilots.itertuples() if row.status == "ok"}
    for row in rows:
        row["fill_percent"] = fills.get(row["scene"])
        row["pilot_us"] = costs.get((row["scene"], row["implementation"]))
    return pandas.DataFrame(rows)


def scene_of(name):
    """{"scene", "variables", "fill_asked"} of the N-four-bar's name."""
    loops, _, fill = name.removeprefix("four-bar:").partition(",seed=")[0].partition(",fill=")
    return {"scene": name, "variables": 2 * int(loops) + 2, "fill_asked": float(fill) if fill else None}


def _common(row, kind):
    folder, _, variant = row["implementation"].partition("+")[0].partition("/")
    build, _, blas = row["environment"].partition("|")
    samples = row.get("samples")
    timed = {"samples": len(samples), "samples_us": " ".join(f"{one:.6g}" for one in samples)} if isinstance(samples, tuple) else {}
    return {"kind": kind, "folder": folder, "variant": variant, "build": "" if build == "own" else build, "blas": blas} | {
        key: row.get(key) for key in ("implementation", "environment", "status", "reason", "process", "layout", "step_us", "low_us",
                                      "high_us", "clock_us", "record", *COUNTERS)} | scene_of(row["scene"]) | timed


def _rejected(records):
    """A row for each verdict of the gate that is not "agrees", and for each gate that ended without one."""
    for one, cell in ((one, one.cell) for one in records if one.role == "gate"):
        for name, (status, reason) in one.verdicts.items():
            if status == "agrees" or not one.done and len(cell["contenders"]) > 1:
                continue  # one by one they are checked again
            yield {"scene": cell["scene"], "implementation": name, "environment": cell["environment"], "status": status,
                   "reason": reason, "record": one.name}


def _operations(record):
    cell = record.cell
    base = {"scene": cell["scene"], "environment": cell["environment"], "process": cell["number"], "record": record.name}
    if not record.done:
        for name in cell["contenders"]:
            yield _common(base | {"implementation": name, "status": record.status, "reason": record.reason}, "operations")
    for name, row in record.output.get("rows", {}).items():
        contender = next((one for one in cell["contenders"] if name.startswith(f"{one.partition('+')[0]}/")), "")
        common = base | {"implementation": contender, "status": "ok", "reason": ""}
        if row.get("error_occurred"):
            yield _common(common | {"status": "failed", "reason": row.get("error_message", "")}, "operations")
        else:
            times = row["cpu_us"]
            yield _common(common | {"samples": tuple(times)}, "operations") | {
                "operation": name.rsplit("/", 1)[-1], "operation_us": float(pandas.Series(times).median())}


def scenes(records):
    """What each scene asks: counters that its contenders share, of the first that was timed."""
    found = {}
    for row in processes([one for one in records if one.role == "pilot"]).to_dict("records"):
        if row["status"] == "ok":
            found.setdefault(row["scene"], scene_of(row["scene"]) | {
                "fill_percent": row["fill_percent"], "constraints": row["constraints"], "reason": "", "record": row["record"]})
    for row in timed_rows(records).to_dict("records"):
        if row["status"] == "ok" and row["implementation"] != "null/null" and "start" not in found.get(row["scene"], {}):
            found.setdefault(row["scene"], scene_of(row["scene"]))
            found[row["scene"]] |= {key: row.get(key) for key in QUESTION} | {"record": row["record"]}
    for one in records:
        if one.role == "not-reached":
            found[one.cell["scene"]] = scene_of(one.cell["scene"]) | {"reason": one.reason, "record": one.name}
    order = lambda row: (row["variables"], row["fill_asked"] or 0.0)
    return pandas.DataFrame(sorted(found.values(), key=order))


def verification(records):
    rows = []
    for one in records:
        for row in one.output.get("rows", []) if one.role == "gate" else ():
            base = {"environment": one.cell["environment"], "record": one.name} | {
                key: row[key] for key in ("scene", "implementation", "verdict", "reason")}
            rows += [base | {"check": check.get("name")} | {
                key: check.get(key) for key in ("value", "tolerance", "passed", "detail")} for check in row["checks"] or [{}]]
    return pandas.DataFrame(rows)
