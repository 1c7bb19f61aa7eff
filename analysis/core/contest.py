# Contests on scenes (study/core/contest.py): what is known of each contender of a scene, and who is fastest there.
import pandas

from analysis.core import timing
from analysis.core.statistics import median
from analysis.core.timing import PHASES


def grouped(records):
    """{role: its records}; those of who was left out of a process are with the others."""
    found = {}
    for record in records:
        found.setdefault(record.role.removesuffix(timing.LEFT_OUT).removesuffix(timing.ALONE), []).append(record)
    return found


def contests(by_role, role):
    """(scene, rows of its timed processes, {contender: its cell}) for each scene of a role; of some there is a first look."""
    said = verdicts_of(by_role.get(f"{role}-gate", []))
    looks, timed = (dict(by_scene(by_role.get(one, []))) for one in (f"{role}-look", role))
    for scene, rows in (looks | timed).items():
        look, rows = looks.get(scene, rows[:0]), timed.get(scene, rows[:0])
        yield scene, rows, {name: looked(one) for name, one in cells_of(look, scene, said).items()} | cells_of(rows, scene, said)


def by_scene(records):
    """(scene, rows of its processes), four-bars by size."""
    rows = timing.processes(timing.counted(records))
    return sorted(rows.groupby("scene"), key=lambda one: (len(one[0]), one[0])) if len(rows) else []


def verdicts_of(records):
    """{(scene, implementation): (verdict, reason)} of the gate. Who was asked alone was so because a process of several
    ended without verdicts."""
    return {(record.cell["scene"], name): found for record in sorted(records, key=lambda one: -len(one.cell["contenders"]))
            for name, found in record.verdicts.items()}


def cells_of(rows, scene, verdicts):
    return {name: _cell(group, verdicts.get((scene, name))) for name, group in rows.groupby("implementation")}


def looked(cell):
    """What a first look says of who was not timed further."""
    if cell["status"] != "ok":
        return cell
    cell = {key: cell[key] for key in ("implementation", "record", "verdict", "step_us", "passes", "pass_us")}
    if cell["verdict"]:
        return cell | {"status": "dropped", "reason": "the budget was spent"}
    return cell | {"status": "slower", "reason": "in a first look far slower than the fastest library"}


def _cell(rows, verdict):
    """What is known of a contender in a scene. Who failed in one process has failed; a disturbed process may make one
    look slow. Without a verdict the gate was not asked."""
    good, lost = rows[rows.status == "ok"], rows[~rows.status.isin(["ok", "dropped", "slower"])]
    first = lost.iloc[0] if len(lost) else good.iloc[0] if len(good) else rows.iloc[0]
    row = {"implementation": rows.implementation.iloc[0], "status": "ok", "reason": "", "verdict": "", "record": first.record}
    if len(lost) or good.empty:
        return row | {"status": first.status, "reason": first.reason}
    if verdict:
        row["verdict"] = verdict[0]
        if verdict[0] not in ("agrees", "dropped"):
            row |= {"status": verdict[0], "reason": verdict[1]}
    step, passes = median(good.step_us), good.passes.iloc[0] / good.steps.iloc[0]
    row |= {"processes": len(good), "step_us": step, "low_us": good.step_us.min(),
            "high_us": good.step_us.max(), "passes": passes, "pass_us": step / passes, "setup_us": median(good.setup_us),
            "memory_bytes": median(good.memory_bytes), "position_error": good.get("position_error", pandas.Series([None])).iloc[0]}
    if "phase_other" in good and good.phase_other.notna().all():
        shares = {phase: median(good[f"phase_{phase}"]) for phase in PHASES}
        row |= {f"{phase}_us": step * share / sum(shares.values()) for phase, share in shares.items()}
    return row


def ratio_to(what, rows, name, other, cell):
    """{what: time of `name` over that of `other`, with its interval}, where both were timed."""
    if cell["status"] != "ok" or other is None or name == other:
        return {what: 1.0} if name == other and cell["status"] == "ok" else {}
    found = timing.ratio(rows, name, other)
    return {what: found.value, f"{what}_low": found.low, f"{what}_high": found.high}


def agreed(cells, names):
    return [name for name in names if name in cells and cells[name]["status"] == "ok" and cells[name]["verdict"] == "agrees"]


def rival_of(rows, cells, registry):
    """The fastest library of a scene, of those that the gate agrees with; None if there is none."""
    found = timing.rank(rows[rows.status == "ok"], agreed(cells, registry.libraries))
    return found.winner if found else None
