# Steps beside the limit code and its bounds; own code beside libraries, scene by scene; growth; batches.
from collections import Counter
from dataclasses import dataclass, replace

from analysis.core.files import ROOT
from analysis.core.timing import LEFT_OUT, processes as rows_of
from analysis.limit.tables import LIMIT
from study.core.cell import Cell
from study.core.setting import Setting
from study.core.timing import measure
from study.scenes.problems import read_list

SETTINGS = {"loops": list,     # sizes of the N-four-bar for everyone
            "large": list,     # sizes for the limit code and code of our own alone, in both forms
            "problems": list,  # standard problems, by name ...
            "examples": list,  # ... examples, by file ...
            "fills": list,     # ... and fills of the four-bar of 100 variables, on which own code meets libraries
            "batches": list,   # sizes of the N-four-bar for batches
            "sets": list,      # of parameters in a batch
            "patience": float, # s of the first stretch of a size: whoever is slower is not timed
            "processes": int,  # of a scene
            "samples": int}    # of a process and contender
SHARES = {"sizes": 0.33, "growth": 0.1, "scenes": 0.47, "batches": 0.1}  # of the budget
NEAR = 2.0  # times the fastest library: who is near may be the rival of a lead; the others are not timed in scenes
LOOK = ("--steps", 40, "--patience", 1.0)  # first, of everyone
FIRST = ("--start", 0, "--steps", 40)  # the same passes at all sizes
CHECK_S = 60
BATCH_S = 0.02  # a process of batches lasts about ten times that


def columns(settings, studyset):
    return {name: share * settings["seconds"] for name, share in SHARES.items()}


def run(lab, column):
    {"sizes": sizes, "growth": growth, "scenes": scenes, "batches": batches}[column](lab)


def sizes(lab):
    """Who is not timed at one size is not tried at a larger one."""
    known, lost = lab.settings["loops"], {}
    every = sorted({*known, *lab.settings["large"]})
    if every:
        lab.one(Cell("limit", "", (), tuple(every), "bounds", timed=True, seconds=300))
    for loops in every:
        here = [*limit_code(lab), *(lab.contenders if loops in known else own(lab))]
        scene = f"four-bar:{loops}"
        for one in here:
            if one.name in lost:
                lab.skip(Cell("bench", scene, (one,), role=f"size{LEFT_OUT}"), "excluded", lost[one.name])
        patience = ("--patience", lab.settings["patience"]) if loops in known else ()
        rows = timed(lab, scene, [one for one in here if one.name not in lost], "size", ("--phases", *patience))
        timed_once = set(rows.implementation[rows.status == "ok"])
        lost |= {row.implementation: f"not timed at N = {loops}: {row.status}" for row in rows.itertuples()
                 if row.implementation not in timed_once and row.status != "dropped"}
        if loops in known:
            ask_gate(lab, scene, rows, here, "size-gate")


def growth(lab):
    """In the saddle-point form, over the first steps: the same passes at all sizes."""
    setting = Setting("saddle-point")
    here = [one for one in own(lab) if lab.registry.serves(one.variant, *setting.needs)]
    for loops in sorted(lab.settings["large"]):
        timed(lab, f"four-bar:{loops}", here, "growth", (*setting.words(), *FIRST))


@dataclass(frozen=True)
class Scene:
    name: str      # as the program takes it
    kind: str      # problem, example or fill
    settings: tuple = ()


def listed(settings):
    """What own code and libraries meet on, most worth first: problems at their own steps, the others at the program's."""
    problems = [Scene(one.scene, "problem", ("--step", f"{one.steps[0]:g}", *one.settings))
                for one in read_list()[1] if one.name in settings["problems"]]
    files = {path.stem: path.relative_to(ROOT).as_posix() for path in (ROOT / "harness/scenes/examples").glob("*.json")}
    return [*problems, *(Scene(f"four-bar:49,fill={fill:g}", "fill") for fill in settings["fills"]),
            *(Scene(files[name], "example") for name in settings["examples"])]


def scenes(lab):
    """First a look at everyone; then those on whom a lead may stand, as far as the gate agrees with them."""
    here = [one for one in lab.contenders if one.environment == environment(lab)]
    for scene in listed(lab.settings) if here else []:
        lab.one(Cell("describe", scene.name, role="about"))
        elsewhere(lab, Cell("bench", scene.name, role=f"{scene.kind}-look{LEFT_OUT}"))
        look = rows_of(measure(lab, scene.name, here, processes=1, repetitions=1, settings=(*LOOK, *scene.settings),
                               role=f"{scene.kind}-look", drop=True))
        timed(lab, scene.name, ask_gate(lab, scene.name, look, here, f"{scene.kind}-gate", scene.settings), scene.kind,
              scene.settings)


def batches(lab):
    """Processes take turns over all cells: what disturbs the machine for some seconds is not all of a cell."""
    here = tuple(one for one in lab.contenders if one.environment == environment(lab))
    for loops in lab.settings["batches"]:
        for sets in lab.settings["sets"]:
            elsewhere(lab, Cell("bench", f"four-bar:{loops}", (), ("--batch", "--sets", sets), "batch"))
    for number in range(1, lab.settings["processes"] + 1):
        lab.run([Cell("bench", f"four-bar:{loops}", here, ("--batch", "--sets", sets, f"--benchmark_min_time={BATCH_S}"),
                      "batch", number, timed=True)
                 for loops in lab.settings["batches"] for sets in lab.settings["sets"] if here], drop=True)


def elsewhere(lab, cell):
    """Records of those who take no part in a cell, as they have processes of their own."""
    for one in lab.contenders:
        if one.environment != environment(lab):
            lab.skip(replace(cell, contenders=(one,)), "excluded", "on another BLAS pair: timed with the sizes alone")


def timed(lab, scene, contenders, role, settings=()):
    """The rows of a scene's processes."""
    return rows_of(measure(lab, scene, contenders, processes=lab.settings["processes"], repetitions=lab.settings["samples"],
                           settings=settings, role=role, drop=True))


def ask_gate(lab, scene, rows, contenders, role, settings=()):
    """Those on whom a lead or a multiple may stand, own code and what is near the fastest library, as far as the gate
    agrees with them."""
    times = rows[rows.status == "ok"].groupby("implementation").step_us.median()
    mine = {LIMIT, *lab.registry.own}
    best = min((time for name, time in times.items() if name not in mine), default=0.0)
    asked = [one for one in contenders if one.name in times and (one.name in mine or times[one.name] <= NEAR * best)]
    found = lab.run([Cell("check", scene, (one,), (*settings, "--time-limit", CHECK_S), role, seconds=2 * CHECK_S)
                     for one in asked], drop=True)
    return [one for one, record in zip(asked, found) if record.verdicts[one.name][0] == "agrees"]


def own(lab):
    return [one for one in lab.contenders if one.variant in lab.registry.own]


def environment(lab):
    """That of most contenders: they share processes."""
    found = Counter(one.environment for one in lab.contenders).most_common(1)
    return found[0][0] if found else ""


def limit_code(lab):
    """The code written for the N-four-bar alone, in the processes of most others."""
    usual = next((one for one in lab.contenders if one.environment == environment(lab)), None)
    return [replace(usual, name=LIMIT, variant=LIMIT)] if usual else []
