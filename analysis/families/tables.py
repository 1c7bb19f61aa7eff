# Rows of scenes and of winners, scene by scene, and of other tools' defaults.
import pandas

from analysis.core import timing
from analysis.families import defaults
from analysis.limit.tables import agreed, by_scene, cells_of, looked, ratio_to, rival_of, verdicts_of

COLUMNS = ("implementation", "status", "reason", "verdict", "processes", "step_us", "low_us", "high_us", "passes", "pass_us", "record")


def build(records, view):
    registry, order = view.registry, {name: place for place, name in enumerate(view.registry.variants)}
    by_role = {}
    for record in records:
        by_role.setdefault(record.role.removesuffix(timing.LEFT_OUT).removesuffix(timing.ALONE), []).append(record)
    about = {record.cell["scene"]: record.output for record in by_role.get("about", []) if record.done}
    said, timed = verdicts_of(by_role.get("gate", [])), dict(by_scene(by_role.get("time", [])))
    layers = {"libraries": registry.libraries, "all": [name for name in registry.variants if name not in registry.examples]}
    scenes, winners = [], []
    for scene, look in by_scene(by_role.get("look", [])):
        rows = timed.get(scene, look[:0])
        cells = {name: looked(one) for name, one in cells_of(look, scene, said).items()} | cells_of(rows, scene, said)
        known = {"family": scene.partition(":")[0], "scene": scene, "variables": about.get(scene, {}).get("variables")}
        more = {key: about.get(scene, {}).get(key) for key in ("constraints", "dimension")}
        more["fill"] = 100 * about[scene]["tangent"]["fill"] if scene in about else None
        rival = rival_of(rows, cells, registry)
        scenes += [known | more | {key: value for key, value in cells[name].items() if key in COLUMNS}
                   | ratio_to("to_rival", rows, name, rival, cells[name]) for name in sorted(cells.keys() & order, key=order.get)]
        winners += [known | {"layer": layer} | _winner(rows, cells, names) for layer, names in layers.items()]
    place = {scene: at for at, scene in enumerate(view.settings["scenes"])}
    return {"scenes": _sorted(scenes, place), "winners": _sorted(winners, place), "defaults": defaults.table(scenes, winners)}


def _winner(rows, cells, names):
    there = agreed(cells, names)
    found = timing.rank(rows[rows.status == "ok"], there) if len(rows) else None
    if found is None:
        lost = next((one for one in cells.values() if one["status"] != "ok"), None)
        return {"winner": "", "reason": f"{lost['status']}: {lost['reason']}" if lost else "nobody takes part",
                "record": lost["record"] if lost else ""}
    both = [name for name in (found.winner, found.second) if name]
    return {"winner": found.winner, "step_us": cells[found.winner]["step_us"], "second": found.second or "",
            "margin": found.margin.value, "low": found.margin.low, "high": found.margin.high, "decided": found.decided,
            "settled": found.settled, "equivalent": " ".join(found.equivalent),
            "record": " ".join(dict.fromkeys(cells[name]["record"] for name in both))}


def _sorted(rows, place):
    return pandas.DataFrame(sorted(rows, key=lambda row: place.get(row["scene"], len(place))))
