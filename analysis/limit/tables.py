# Rows of bounds, steps, growth, scenes, leads, batches, sweeps, and of what own code is held to.
import pandas

from analysis.core import timing
from analysis.core.contest import agreed, contests, grouped, ratio_to, rival_of
from analysis.core.controls import controls_in
from analysis.core.schema import conform, of_part
from analysis.limit.held import must_hold

LIMIT = "limit/limit"
LANES, NODES = 1e6, 100  # what sweeps are projected to
KINDS = ("problem", "fill", "example")  # of scenes; roles of their records too
FORMS = {"size": "penalty", "growth": "saddle-point"}  # roles of the N-four-bar's records


def build(records, view):
    registry, by_role = view.registry, grouped(records)
    about = {record.cell["scene"]: record.output for record in by_role.get("about", []) if record.done}
    found = {"bounds": [row | {"status": record.status, "reason": record.reason, "record": record.name}
                        for record in by_role.get("bounds", []) for row in record.output.get("rows", [{}])],
             "steps": [], "scenes": [], "leads": [], "batches": [*_batches(by_role.get("batch", []))],
             "sweeps": [*_sweeps(by_role.get("sweep", []))],
             "controls": [row for kind in KINDS for row in controls_in(by_role.get(kind, []))]}
    for role in (*FORMS, *KINDS):
        for scene, timed, cells, _ in contests(by_role, role):
            names = [name for name in (LIMIT, *registry.variants) if name in cells]  # without anchors of other pairs
            rival = rival_of(timed, cells, registry)
            if role in FORMS:
                loops = int(scene.partition(":")[2])
                known = {"scene": scene, "kind": "four-bar", "dimension": 2, "variables": 2 * loops + 2}
                found["steps"] += [{"form": FORMS[role], "loops": loops, "variables": known["variables"]} | cells[name]
                                   | ratio_to("multiple", timed, name, LIMIT, cells[name]) | ratio_to("to_rival", timed, name, rival, cells[name])
                                   for name in names]
            else:
                known = {"scene": scene, "kind": role} | {key: about.get(scene, {}).get(key) for key in ("dimension", "variables")}
                found["scenes"] += [known | cells[name] | ratio_to("to_rival", timed, name, rival, cells[name]) for name in names]
            if role in KINDS or set(registry.libraries) & set(cells):
                found["leads"] += [known | one for one in _leads(timed, cells, registry)]
    known = of_part("limit")
    tables = {name: conform(rows, known[name], f"limit/{name}.csv") for name, rows in found.items()}
    return tables | {"held": must_hold(registry.own, tables) if registry.own else ()}


def _leads(timed, cells, registry):
    """A row for each variant of our own: how many times faster than the fastest library it is; or why that is not known."""
    found = timing.rank(timed, agreed(cells, registry.libraries))
    rival, equivalent = (found.winner, " ".join(found.equivalent)) if found else (None, "")
    for name in (name for name in registry.variants if name in registry.own and name in cells):
        row = {"implementation": name, "rival": rival, "equivalent": equivalent} | {key: cells[name][key] for key in ("status", "reason", "record")}
        if not agreed(cells, [name]):
            yield row | ({"status": "dropped", "reason": "the gate was not asked, as the budget was spent"} if row["status"] == "ok" else {})
        elif rival is None:
            yield row | {"status": "dropped", "reason": "no library was timed that the gate agrees with"}
        else:
            yield row | timing.ratio(timed, rival, name).columns("lead")


def _batches(records):
    """A row for each scene, number of sets and implementation."""
    rows = pandas.DataFrame([row for record in records for row in _batch(record)])
    for (scene, sets, name), group in rows.groupby(["scene", "sets", "implementation"], sort=False) if len(rows) else ():
        good, lost = group[group.status == "ok"], group[~group.status.isin(["ok", "dropped"])]
        first = lost.iloc[0] if len(lost) else group.iloc[0]
        row = {"scene": scene, "sets": sets, "implementation": name} | first[["status", "reason", "record"]].to_dict()
        if len(good) and lost.empty:
            sides = pandas.concat([timing.apart(good.assign(implementation=side), f"{side}_us") for side in ("alone", "step")])
            row |= timing.ratio(sides, "alone", "step").columns("gain") | {
                "status": "ok", "reason": "", "processes": len(good), "variables": good.variables.iloc[0], "lanes": good.lanes.iloc[0],
                "step_us": timing.median(good.step_us), "alone_us": timing.median(good.alone_us), "least": good.gain.min(), "most": good.gain.max()}
        yield row


def _batch(record):
    cell = record.cell
    for name in cell["contenders"]:
        found = record.output.get("rows", {}).get(f"{name}/{cell['scene']}/batch")
        status, reason = timing.outcome(record, found)
        yield {"scene": cell["scene"], "sets": int(record.option("--sets")), "implementation": name,
               "process": cell["number"], "status": status, "reason": reason, "record": record.name} | {
               key: found[key] for key in ("variables", "lanes", "step_us", "alone_us", "gain") if status == "ok"}


def _sweeps(records):
    """A row for each scene and number of jobs."""
    for scene in dict.fromkeys(record.cell["scene"] for record in records):
        mine = [record for record in records if record.cell["scene"] == scene]
        good = [record for record in mine if record.done]
        known = {"scene": scene, "implementation": mine[0].cell["contenders"][0]}
        if not good:
            yield known | {"status": mine[0].status, "reason": mine[0].reason, "record": mine[0].name}
            continue
        lanes = good[0].output["lanes"]
        rows = pandas.DataFrame([row | {"process": process} for process, record in enumerate(good) for row in record.output["rows"]])
        rows = rows.join(rows[rows.jobs == 1].set_index("process").cpu_s, on="process", rsuffix="_alone")
        sides = timing.Paired(timing.apart(rows.assign(implementation=rows.jobs, status="ok"), "wall_s"))
        merge = lanes / rows.merge_s.median()
        for jobs, each in rows.groupby("jobs", sort=False):
            rates = lanes / each.wall_s
            rate = rates.median()
            yield known | {
                "jobs": jobs, "status": "ok", "reason": "", "processes": len(good), "lanes": lanes, "lanes_per_s": rate, "least": rates.min(),
                "most": rates.max(), "lane_us": 1e6 / lanes * each.cpu_s.median(), **timing.ratio(sides, 1, jobs).columns("gain"),
                "work": (each.cpu_s / each.cpu_s_alone).median(), "memory_mb": each.memory_mb.max(), "merged_per_s": merge,
                "million_s": LANES / rate + LANES / merge, "nodes_s": LANES / rate / NODES + LANES / merge, "record": good[0].name}
