# The map: who is fastest at which size and fill of the N-four-bar. A column is a size; a scene a size at a fill.
# All of it is decided from records, so that a run that was interrupted decides alike.
from analysis.core.files import StudyError
from analysis.map.timed import leaders
from study.core.cell import Cell, Contender, by_environment
from study.core.timing import measure
from study.map.timed import NATURAL, Scene, TimedScene, alternatives, fit

SIZES = {"columns": [int], "processes": int}
SETTINGS = {"processes": int, "process": float, "again": int, "slower": {"natural": float, "filled": float},
            "limits": {"pilot": float, "check": float, "time": float}, "alternatives": [{"implementations": [str], "blas": [str], "columns": [int]}],
            "phases": SIZES, "operations": SIZES, "seeds": SIZES | {"seeds": int},
            "columns": [{"variables": int, "seconds": float, "fills": [(str, float)], "slower?": float}]}
CLOSEST = 0.04  # fills nearer than this have none put between them, share


def columns(settings):
    for entry in settings["columns"]:
        if entry["variables"] < 4 or entry["variables"] % 2 or entry["fills"][:1] != [NATURAL]:
            raise StudyError("profile: map: a column has an even number of variables from 4 on, and fills that start with "
                             f"{NATURAL}: found {entry!r}")
    total = sum(entry["seconds"] for entry in settings["columns"])
    if total > settings["seconds"]:
        raise StudyError(f"profile: map: its columns take {total:g} s, the part has {settings['seconds']:g}")
    return {_name(entry): float(entry["seconds"]) for entry in settings["columns"]}


def _name(entry):
    return f"n{entry['variables']:04d}"


def run(lab, column):
    [entry] = [one for one in lab.settings["columns"] if _name(one) == column]
    natural, *filled = [Scene(entry["variables"], None if fill == NATURAL else fill) for fill in entry["fills"]]
    for one in lab.registry.entries if entry == lab.settings["columns"][0] else ():  # once a record for each that cannot take part at all
        if not one["available"] and (not lab.set.facts["only"] or one["folder"] in lab.set.facts["only"]):
            lab.skip(Cell("bench", natural.name, (Contender(one["folder"], one["folder"]),), role="unavailable"), "unavailable", one["reason"])
    costs, own_fill = fit(lab, natural, [*lab.contenders, *alternatives(lab, natural)])
    timed = [TimedScene(lab, natural, costs, own_fill)]
    timed[0].time(lab.settings["processes"])
    for scene in filled:  # one after the other: if the budget ends, the first ones have times
        if 100 * scene.fill <= own_fill:
            lab.skip(Cell("bench", scene.name, role="not-reached"), "not-reached", f"the mechanism's own fill is {own_fill:.3g} %")
        else:
            timed.append(TimedScene(lab, scene, *fit(lab, scene, lab.contenders)))
            timed[-1].time(lab.settings["processes"])
    _phases(lab, timed)  # what is small comes before `again`, which takes all that is left
    _operations(lab, natural)
    _seeds(lab, timed)
    for one in timed:
        one.again(lab.settings["again"])
    _add_between(lab, timed)


def _seeds(lab, timed):
    """How far a ratio depends on where the artificial positions lie: never ranked."""
    asked = lab.settings["seeds"]
    filled = next((one for one in timed if one.scene.fill and one.scene.fill < 1), None)
    if filled is None or filled.scene.variables not in asked["columns"]:
        return
    names = leaders([filled.rankings["libraries"]])
    chosen = [one for one in filled.costs if one.name in names]
    for seed in range(1, asked["seeds"] + 1) if len(chosen) > 1 else ():
        measure(lab, f"{filled.scene.name},seed={seed}", chosen, processes=asked["processes"], repetitions=3, role="seeds",
                seconds=lab.settings["limits"]["time"])


def _phases(lab, timed):
    asked = lab.settings["phases"]
    for one in timed if timed[0].scene.variables in asked["columns"] else ():
        measure(lab, one.scene.name, [cost for cost in one.costs if cost.ranked], processes=asked["processes"],
                repetitions=1, role="phases", settings=("--phases",), seconds=lab.settings["limits"]["time"])


def _operations(lab, scene):
    """`mbs` checks their results itself, so that a step too slow to be timed excludes nobody."""
    asked = lab.settings["operations"]
    chosen = [one for one in lab.contenders if lab.registry.variants[one.variant].get("operations")]
    for group in by_environment(chosen).values() if scene.variables in asked["columns"] else ():
        lab.run([Cell("bench", scene.name, group, ("--operations", "--benchmark_repetitions=3", "--benchmark_min_time=0.01"),
                      "operations", number, timed=True, seconds=lab.settings["limits"]["time"])
                 for number in range(1, asked["processes"] + 1)], drop=True)


def _add_between(lab, timed):
    """Times the fill half-way in the widest gap between two with other libraries ahead, if the budget has room for one
    more scene like those before."""
    gaps = [(round(high.fill - low.fill, 6), low, high) for low, high in zip(timed, timed[1:]) if high.fill - low.fill >= 100 * CLOSEST
            for first, second in [(low.rankings["libraries"], high.rankings["libraries"])]
            if first and second and second.winner not in first.equivalent and first.winner not in second.equivalent]
    if gaps and lab.left > lab.spent / len(timed):
        _, low, high = max(gaps, key=lambda gap: gap[0])
        scene = Scene(low.scene.variables, round((low.fill + high.fill) / 200, 2))
        found = TimedScene(lab, scene, *fit(lab, scene, lab.contenders))
        found.time(lab.settings["processes"])
        found.again(lab.settings["again"])
        timed.insert(timed.index(high), found)
