# Rows of bounds, steps, growth, scenes, leads, batches, and of what own code is held to.
import pandas

from analysis.core import timing
from analysis.core.statistics import median
from analysis.core.timing import PHASES
from analysis.limit.held import must_hold

LIMIT = "limit/limit"
KINDS = ("problem", "fill", "example")  # of scenes; roles of their records too
FORMS = {"size": "penalty", "growth": "saddle-point"}  # roles of the N-four-bar's records


def build(records, view):
    registry = view.registry
    by_role = {}
    for record in records:
        by_role.setdefault(record.role.removesuffix(timing.LEFT_OUT).removesuffix(timing.ALONE), []).append(record)
    order = {name: place for place, name in enumerate([LIMIT, *registry.variants])}
    about = {record.cell["scene"]: record.output for record in by_role.get("about", []) if record.done}
    found = {"bounds": [row | {"status": record.status, "reason": record.reason, "record": record.name}
                        for record in by_role.get("bounds", []) for row in record.output.get("rows", [{}])],
             "steps": [], "scenes": [], "leads": [], "batches": _batches(by_role.get("batch", []))}
    for role in FORMS:
        said = verdicts_of(by_role.get(f"{role}-gate", []))
        for scene, rows in by_scene(by_role.get(role, [])):
            cells, loops = cells_of(rows, scene, said), int(scene.partition(":")[2])
            found["steps"] += [{"form": FORMS[role], "loops": loops, "variables": 2 * loops + 2} | cells[name]
                               | ratio_to("multiple", rows, name, LIMIT, cells[name]) for name in _ordered(cells, order)]
            if set(registry.libraries) & set(cells):
                known = {"scene": scene, "kind": "four-bar", "dimension": 2, "variables": 2 * loops + 2}
                found["leads"] += [known | one for one in _leads(rows, cells, registry)]
    for kind in KINDS:
        said, timed = verdicts_of(by_role.get(f"{kind}-gate", [])), dict(by_scene(by_role.get(kind, [])))
        for scene, look in by_scene(by_role.get(f"{kind}-look", [])):
            known = {"scene": scene, "kind": kind} | {key: about.get(scene, {}).get(key) for key in ("dimension", "variables")}
            rows = timed.get(scene, look[:0])
            cells = {name: looked(one) for name, one in cells_of(look, scene, said).items()} | cells_of(rows, scene, said)
            rival = rival_of(rows, cells, registry)
            found["scenes"] += [known | cells[name] | ratio_to("to_rival", rows, name, rival, cells[name])
                                for name in _ordered(cells, order)]
            found["leads"] += [known | one for one in _leads(rows, cells, registry)]
    tables = {name: pandas.DataFrame(rows) for name, rows in found.items()}
    tables["held"] = pandas.DataFrame(must_hold(registry.own, tables) if registry.own else [])
    return tables


def by_scene(records):
    """(scene, rows of its processes), four-bars by size."""
    rows = timing.processes(timing.counted(records))
    return sorted(rows.groupby("scene"), key=lambda one: (len(one[0]), one[0])) if len(rows) else []


def verdicts_of(records):
    """{(scene, implementation): (verdict, reason)} of the gate."""
    return {(record.cell["scene"], name): found for record in records for name, found in record.verdicts.items()}


def cells_of(rows, scene, verdicts):
    return {name: _cell(group, verdicts.get((scene, name))) for name, group in rows.groupby("implementation")}


def _ordered(cells, order):
    """Without anchors of other pairs."""
    return sorted((name for name in cells if name in order), key=order.get)


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


def _leads(rows, cells, registry):
    """A row for each variant of our own: how many times faster than the fastest library it is; or why that is not known."""
    rival = rival_of(rows, cells, registry)
    for name in (name for name in registry.variants if name in registry.own and name in cells):
        cell = cells[name]
        row = {"implementation": name, "rival": rival, "status": cell["status"],
               "reason": cell["reason"], "record": cell["record"]}
        if not agreed(cells, [name]):
            why = {"status": "dropped", "reason": "the gate was not asked, as the budget was spent"}
            yield row | (why if cell["status"] == "ok" else {})
        elif rival is None:
            yield row | {"status": "dropped", "reason": "no library was timed that the gate agrees with"}
        else:
            found = timing.ratio(rows, rival, name)
            yield row | {"lead": found.value, "low": found.low, "high": found.high}


def _batches(records):
    """A row for each scene, number of sets and implementation."""
    rows = pandas.DataFrame([row for record in records for row in _batch(record)])
    if rows.empty:
        return []
    found = []
    for (scene, sets, name), group in rows.groupby(["scene", "sets", "implementation"], sort=False):
        good, lost = group[group.status == "ok"], group[~group.status.isin(["ok", "dropped"])]
        first = lost.iloc[0] if len(lost) else group.iloc[0]
        row = {"scene": scene, "sets": sets, "implementation": name, "status": first.status, "reason": first.reason,
               "record": first.record}
        if len(good) and lost.empty:
            sides = pandas.concat([good.assign(implementation=side, samples=[(time,) for time in good[f"{side}_us"]])
                                   for side in ("alone", "step")])
            gain = timing.ratio(sides, "alone", "step")
            row |= {"status": "ok", "reason": "", "processes": len(good), "variables": good.variables.iloc[0],
                    "lanes": good.lanes.iloc[0], "step_us": median(good.step_us), "alone_us": median(good.alone_us),
                    "gain": gain.value, "low": gain.low, "high": gain.high, "least": good.gain.min(), "most": good.gain.max()}
        found.append(row)
    return found


def _batch(record):
    cell = record.cell
    for name in cell["contenders"]:
        row = {"scene": cell["scene"], "sets": int(record.option("--sets")), "implementation": name, "environment": "",
               "process": cell["number"], "status": record.status, "reason": record.reason, "record": record.name}
        found = record.output.get("rows", {}).get(f"{name}/{cell['scene']}/batch", {})
        if record.done and (found.get("error_occurred") or not found):
            status, _, reason = found.get("error_message", "crashed: mbs bench gave no row of it").partition(": ")
            row |= {"status": status, "reason": reason}
        elif record.done:
            row |= {"status": "ok"} | {key: found[key] for key in ("variables", "lanes", "step_us", "alone_us", "gain")}
        yield row
