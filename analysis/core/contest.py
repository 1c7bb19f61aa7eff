# Contests on scenes (study/core/contest.py): what is known of each contender of a scene, and who is fastest there.
import math

from analysis.core import timing
from analysis.core.gather import gather


def grouped(records):
    """{role: its records}; those of who was left out of a process are with the others."""
    return gather((record.role.removesuffix(timing.LEFT_OUT).removesuffix(timing.ALONE), record) for record in records)


def contests(by_role, role):
    """(scene, what was timed there, {contender: its cell}, the same of the first look) for each scene of a role; some have no look."""
    said = verdicts_of(by_role.get(f"{role}-gate", []))
    looks, timed = (dict(by_scene(by_role.get(one, []))) for one in (f"{role}-look", role))
    for scene, rows in (looks | timed).items():
        look, rows = looks.get(scene, rows[:0]), timed.get(scene, rows[:0])
        first = cells_of(look, scene, said)
        cells = {name: looked(one) for name, one in first.items()} | cells_of(rows, scene, said)
        yield scene, timing.Paired(rows[rows.status == "ok"]), cells, first


def by_scene(records):
    """(scene, rows of its processes), four-bars by size."""
    rows = timing.processes(timing.counted(records))
    return sorted(rows.groupby("scene"), key=lambda one: (len(one[0]), one[0])) if len(rows) else []


def verdicts_of(records):
    """{(scene, implementation): (verdict, reason)} of the gate. Who was asked alone was so because a process of several ended without verdicts."""
    return {(record.cell["scene"], name): found for record in sorted(records, key=lambda one: -len(one.cell["contenders"]))
            for name, found in record.verdicts.items()}


def cells_of(rows, scene, verdicts):
    groups = gather((row["implementation"], row) for row in rows.to_dict("records"))
    return {name: _cell(groups[name], verdicts.get((scene, name))) for name in sorted(groups)}


def looked(cell):
    """What a first look says of who was not timed further: no time of those whom the gate did not see there."""
    if cell["status"] != "ok":
        return cell
    known = {key: cell[key] for key in ("implementation", "record", "verdict")}
    if cell["verdict"] != "agrees":
        return known | {"status": "dropped", "reason": "looked at, but the budget was spent before the gate"}
    return known | {key: cell[key] for key in ("step_us", "passes", "pass_us")} | {
        "status": "slower", "reason": "in a first look far slower than the fastest library"}


def _cell(rows, verdict):
    """What is known of a contender in a scene. Who failed in one process has failed; a disturbed process may make one
    look slow. Without a verdict the gate was not asked."""
    good = [row for row in rows if row["status"] == "ok"]
    lost = [row for row in rows if row["status"] not in ("ok", "dropped", "slower")]
    first = (lost or good or rows)[0]
    row = {key: first[key] for key in ("implementation", "status", "reason", "record")} | {"verdict": ""}
    if lost or not good:
        return row
    if verdict:
        row["verdict"] = verdict[0]
        if verdict[0] not in ("agrees", "dropped"):
            row |= {"status": verdict[0], "reason": verdict[1]}
    values = lambda key: [one.get(key) for one in good]
    step, passes = timing.median(values("step_us")), first["passes"] / first["steps"]
    row |= {"processes": len(good), "step_us": step, "low_us": min(values("step_us")), "high_us": max(values("step_us")),
            "passes": passes, "pass_us": step / passes, "setup_us": timing.median(values("setup_us")),
            "memory_bytes": timing.median(values("memory_bytes")), "position_error": first.get("position_error")}
    shares = {phase: timing.median(values(f"phase_{phase}")) for phase in timing.PHASES}
    if not math.isnan(shares["other"]):
        row |= {f"{phase}_us": step * share / sum(shares.values()) for phase, share in shares.items()}
    return row


def ratio_to(what, paired, name, other, cell):
    """{what: time of `name` over that of `other`, with its interval}, where both were timed."""
    if cell["status"] != "ok" or other is None or name == other:
        return {what: 1.0} if name == other and cell["status"] == "ok" else {}
    return timing.ratio(paired, name, other).columns(what, f"{what}_")


def agreed(cells, names):
    return [name for name in names if name in cells and cells[name]["status"] == "ok" and cells[name]["verdict"] == "agrees"]


def rival_of(paired, cells, registry):
    """The fastest library of a scene, of those that the gate agrees with; None if there is none."""
    found = timing.rank(paired, agreed(cells, registry.libraries))
    return found.winner if found else None
