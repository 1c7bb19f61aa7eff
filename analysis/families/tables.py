# Rows of mechanisms, of contenders and of winners, scene by scene and form by form; how time grows with size; what each order of
# elimination leaves to do.
from collections import Counter

from analysis.core import timing
from analysis.core.contest import agreed, contests, grouped, ratio_to, rival_of
from analysis.core.controls import controls_in
from analysis.core.schema import conform, of_part
from analysis.families.rule import judged

SCHEMES = ("penalty", "saddle-point")  # the two forms of the step; roles of their records begin with them
LEAST = 2  # sizes, that a power is fitted to


def build(records, view):
    registry, by_role, schema = view.registry, grouped(records), of_part("families")
    order = {name: place for place, name in enumerate(registry.variants)}
    place = {scene: at for at, scene in enumerate(view.settings["scenes"])}
    about = {record.cell["scene"]: record for record in by_role.get("about", []) if record.done}
    layers = {"libraries": registry.libraries, "all": [name for name in registry.variants if name not in registry.examples]}
    scenes, winners, twins = [], [], []
    for scheme in SCHEMES:
        for scene, timed, cells, looks in contests(by_role, scheme):
            known = {"family": family_of(scene), "scene": scene, "scheme": scheme,
                     "variables": about[scene].output.get("variables") if scene in about else None}
            rival = rival_of(timed, cells, registry)
            scenes += [known | {key: value for key, value in cells[name].items() if key in schema["scenes"]}
                       | {"look_us": looks[name].get("step_us") if name in looks and looks[name]["verdict"] == "agrees" else None}
                       | ratio_to("to_rival", timed, name, rival, cells[name]) for name in sorted(cells.keys() & order, key=order.get)]
            winners += [known | {"layer": layer} | _winner(timed, cells, names) for layer, names in layers.items()]
        twins += [{"scheme": scheme} | row for row in controls_in(by_role.get(scheme, []))]
    timing.holm(winners, "scheme", "layer")
    mechanisms = [{"family": family_of(scene), "scene": scene, "dimension": record.output.get("dimension")}
                  | {name: value for name, value in record.output.get("features", {}).items() if name in schema["mechanisms"]}
                  | {"record": record.name} for scene, record in about.items()]
    tables = {name: conform(sorted(rows, key=lambda row: place.get(row["scene"], len(place))), schema[name], f"families/{name}.csv")
              for name, rows in (("mechanisms", mechanisms), ("scenes", scenes), ("winners", winners))}
    return tables | judged(tables, registry) | {
        "growth": growth(tables["scenes"], tables["mechanisms"]), "orderings": orderings(about), "controls": twins}


def family_of(scene):
    """The four-bar with artificial fill is no mechanism: a family of its own."""
    name, _, options = scene.partition(":")
    return f"{name}, filled" if "fill=" in options else name


def _winner(timed, cells, names):
    if (found := timing.rank(timed, agreed(cells, names))) is None:
        lost = [one for name, one in cells.items() if name in names and one["status"] != "ok"]
        out_of_time = [one for one in lost if one["status"] == "dropped"]  # who might have won
        said = Counter(f"{one['status']}: {one['reason']}" for one in out_of_time or lost).most_common(1)  # of most
        return {"winner": "", "reason": said[0][0] if said else "nobody takes part", "record": lost[0]["record"] if lost else ""}
    both = [name for name in (found.winner, found.second) if name]
    within = timing.within(timed, found.second, found.winner) if found.second else ()
    return {"winner": found.winner, "step_us": cells[found.winner]["step_us"], "second": found.second or "",
            "margin": found.margin.value, "low": found.margin.low, "high": found.margin.high, **dict(zip(("within_low", "within_high"), within)),
            "chance": found.chance, "holm": False, "decided": found.decided, "settled": found.settled, "equivalent": " ".join(found.equivalent),
            "inside": " ".join(found.inside), "record": " ".join(dict.fromkeys(cells[name]["record"] for name in both))}


def growth(scenes, mechanisms):
    """A row for each family, form and implementation with at least LEAST sizes: t ~ n^a, t ~ flops^b."""
    known = mechanisms.set_index("scene")[["n", "flops"]].astype(float)
    timed = scenes[scenes.status.isin(["ok", "slower"]) & scenes.step_us.notna() & ~scenes.family.str.contains("filled")]
    for (family, scheme, name), group in timed.groupby(["family", "scheme", "implementation"], sort=False):
        group = group[group.scene.isin(known.index)]
        sizes = known.loc[group.scene]
        if sizes.n.nunique() < LEAST:
            continue
        exponent, low, high = timing.power_law(sizes.n.to_numpy(), group.step_us.to_numpy())
        yield {"family": family, "scheme": scheme, "implementation": name, "sizes": len(group), "least": sizes.n.min(), "most": sizes.n.max(),
               "exponent": exponent, "low": low, "high": high, "per_flop": timing.power_law(sizes.flops.to_numpy(), group.step_us.to_numpy())[0],
               "record": " ".join(dict.fromkeys(group.record))}


def orderings(about):
    """A row for each scene and order of elimination, as `mbs describe` computes them."""
    return [
        {"scene": scene, "n": record.output.get("variables"), "ordering": name, "factor": one["factor_nonzeros"],
         "per_column": one["per_column"], "flops": one["flops"], "height": one["height"], "record": record.name}
        for scene, record in about.items()
        for name, one in (record.output.get("elimination") or {}).get("orderings", {}).items() if one]
