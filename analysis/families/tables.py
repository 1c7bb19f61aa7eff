# Rows of mechanisms, of contenders and of winners, scene by scene and form by form.
import pandas

from analysis.core import timing
from analysis.core.contest import agreed, by_scene, cells_of, contests, grouped, ratio_to, rival_of
from analysis.core.schema import of_part
from analysis.families import defaults
from analysis.families.growth import growth, orderings
from analysis.families.rule import judged

SCHEMES = ("penalty", "saddle-point")  # the two forms of the step; roles of their records begin with them
COLUMNS = ("implementation", "status", "reason", "verdict", "processes", "step_us", "low_us", "high_us", "passes", "pass_us", "record")


def build(records, view):
    registry, by_role = view.registry, grouped(records)
    order = {name: place for place, name in enumerate(registry.variants)}
    place = {scene: at for at, scene in enumerate(view.settings["scenes"])}
    about = {record.cell["scene"]: record for record in by_role.get("about", []) if record.done}
    layers = {"libraries": registry.libraries, "all": [name for name in registry.variants if name not in registry.examples]}
    scenes, winners = [], []
    for scheme in SCHEMES:
        looks = {scene: cells_of(rows, scene, {}) for scene, rows in by_scene(by_role.get(f"{scheme}-look", []))}
        for scene, rows, cells in contests(by_role, scheme):
            known = {"family": family_of(scene), "scene": scene, "scheme": scheme,
                     "variables": about[scene].output.get("variables") if scene in about else None}
            rival = rival_of(rows, cells, registry)
            scenes += [known | {key: value for key, value in cells[name].items() if key in COLUMNS}
                       | {"look_us": looks[scene].get(name, {}).get("step_us")}
                       | ratio_to("to_rival", rows, name, rival, cells[name]) for name in sorted(cells.keys() & order, key=order.get)]
            winners += [known | {"layer": layer} | _winner(rows, cells, names) for layer, names in layers.items()]
    numbers = of_part("families")["mechanisms"]
    mechanisms = [{"family": family_of(scene), "scene": scene, "dimension": record.output.get("dimension")}
                  | {name: value for name, value in record.output.get("features", {}).items() if name in numbers} | {"record": record.name}
                  for scene, record in about.items()]
    tables = {name: pandas.DataFrame(sorted(rows, key=lambda row: place.get(row["scene"], len(place))))
              for name, rows in (("mechanisms", mechanisms), ("scenes", scenes), ("winners", winners))}
    fills, first = {row["scene"]: row.get("fill") for row in mechanisms}, SCHEMES[0]
    filled = [row | {"fill": fills[row["scene"]]} for row in scenes if row["scheme"] == first and fills.get(row["scene"]) is not None]
    return tables | {"defaults": defaults.table(filled, [row for row in winners if row["scheme"] == first and fills.get(row["scene"]) is not None]), "growth": growth(tables["scenes"], tables["mechanisms"]) if len(scenes) else pandas.DataFrame(),
                     "orderings": orderings(about)} | judged(tables, registry)


def family_of(scene):
    """The four-bar with artificial fill is no mechanism: a family of its own."""
    name, _, options = scene.partition(":")
    return f"{name}, filled" if "fill=" in options else name


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
