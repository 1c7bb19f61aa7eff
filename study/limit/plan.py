# Steps beside the limit code and its bounds; own code beside libraries, scene by scene; growth; batches; sweeps.
from dataclasses import replace

from analysis.core.files import ROOT
from analysis.core.timing import LEFT_OUT, processes as rows_of
from analysis.limit.tables import LIMIT
from study.core.cell import Cell
from study.core.contest import CHECK_S, Asked, Form, about, contests, controls_of, elsewhere, near, usual, verdicts
from study.core.profile import by_share
from study.core.setting import Setting
from study.core.timing import measure
from study.scenes.problems import read_list

SETTINGS = {"loops": [int], "large": [int], "problems": [str], "examples": [str], "fills": [float], "batches": [int], "sets": [int], "swept": int,
            "patience": float, "processes": int, "samples": int}
FIRST = ("--start", 0, "--steps", 40, "--patience", 1)  # the same passes at all sizes
BATCH_S = 0.02  # a process of batches lasts about ten times that
SWEPT = {  # scene: the implementation that sweeps it, and what varies; lanes of a tenth of a second
    "four-bar:10": ("compiled_chains/sweeps", "rods/A0-B0/mass=uniform:0.5:2", "gravity/1=normal:-9.81:0.5"),
    "vehicle:4": ("csc_ldl/uplooking", "springs/0/stiffness=uniform:120e3:180e3", "bodies/chassis/mass=normal:8000:400")}
SWEEP = "../study/limit/sweep_process"  # as seen from the build


def sizes(lab):
    known, lost = lab.settings["loops"], {}
    if every := sorted({*known, *lab.settings["large"]}):
        lab.one(Cell("limit", "", (), tuple(every), "bounds", timed=True, seconds=300))
    limit_code = [replace(one, name=LIMIT, variant=LIMIT) for one in usual(lab)[:1]]  # in the processes of most others
    for loops in every:
        here = [*limit_code, *(lab.contenders if loops in known else own(lab))]
        patience = ("--patience", lab.settings["patience"]) if loops in known else ()
        rows = timed(lab, loops, here, lost, "size", ("--phases", *patience))
        if loops in known:
            asked = near(rows, here, {LIMIT, *lab.registry.own}, always=True)
            verdicts(lab, [Asked(f"four-bar:{loops}", asked, "size-gate")], each=CHECK_S, drop=True)


def growth(lab):
    """In the saddle-point form, over the first steps: the same passes at all sizes. A dense matrix would take the time of all others."""
    setting, lost = Setting("saddle-point"), {}
    here = [one for one in own(lab) if lab.registry.serves(one.variant, *setting.needs) and one.variant not in lab.registry.dense]
    for loops in sorted(lab.settings["large"]):
        timed(lab, loops, here, lost, "growth", (*setting.words(), *FIRST))


def listed(settings):
    """[(scene, kind, settings of the step)] that own code and libraries meet on, most worth first: problems at their own steps, the others
    at the program's."""
    problems = [(one.scene, "problem", ("--step", f"{one.steps[0]:g}", *one.settings)) for one in read_list()[1] if one.name in settings["problems"]]
    files = {path.stem: path.relative_to(ROOT).as_posix() for path in (ROOT / "harness/scenes/examples").glob("*.json")}
    return [*problems, *((f"four-bar:49,fill={fill:g}", "fill", ()) for fill in settings["fills"]),
            *((files[name], "example", ()) for name in settings["examples"])]


def scenes(lab):
    here = usual(lab)
    chosen = listed(lab.settings) if here else []
    about(lab, [scene for scene, _, _ in chosen])
    controls = controls_of([scene for scene, _, _ in chosen])
    for scene, kind, settings in chosen:
        elsewhere(lab, Cell("bench", scene, role=f"{kind}-look"))
        contests(lab, scene, [Form(kind, here, lab.settings["processes"], lab.settings["samples"], settings)],
                 own={LIMIT, *lab.registry.own}, always=True, control=scene in controls)


def batches(lab):
    """Processes take turns over all cells: what disturbs the machine for some seconds is not all of a cell."""
    here = tuple(usual(lab))
    for loops in lab.settings["batches"]:
        for sets in lab.settings["sets"]:
            elsewhere(lab, Cell("bench", f"four-bar:{loops}", (), ("--batch", "--sets", sets), "batch"))
    for number in range(1, lab.settings["processes"] + 1):
        lab.run([Cell("bench", f"four-bar:{loops}", here, ("--batch", "--sets", sets, f"--benchmark_min_time={BATCH_S}"),
                      "batch", number, timed=True)
                 for loops in lab.settings["batches"] for sets in lab.settings["sets"] if here], drop=True)


def sweeps(lab):
    """Processes take turns over the scenes, and each has both numbers of jobs."""
    for number in range(1, lab.settings["processes"] + 1):
        for scene, (name, *varied) in SWEPT.items():
            if one := lab.contender(name):
                words = [word for each in varied for word in ("--vary", each)]
                lab.run([Cell("", scene, (one,), (*words, "--lanes", lab.settings["swept"], "--duration", 0.1), "sweep", number,
                              SWEEP, timed=True, seconds=600)], drop=True)


def timed(lab, loops, contenders, lost, role, settings):
    """The rows of a size's processes. `lost`: {name: why}; who is not timed at one size is not tried at a larger one."""
    scene = f"four-bar:{loops}"
    for one in [one for one in contenders if one.name in lost]:
        lab.skip(Cell("bench", scene, (one,), role=f"{role}{LEFT_OUT}"), "excluded", lost[one.name])
    rows = rows_of(measure(lab, scene, [one for one in contenders if one.name not in lost], processes=lab.settings["processes"],
                           repetitions=lab.settings["samples"], settings=settings, role=role))
    timed_once = set(rows.implementation[rows.status == "ok"])
    lost |= {row.implementation: f"not timed at N = {loops}: {row.status}" for row in rows.itertuples()
             if row.implementation not in timed_once and row.status != "dropped"}
    return rows


def own(lab):
    return [one for one in lab.contenders if one.variant in lab.registry.own]


columns, run = by_share({"sizes": (0.27, sizes), "growth": (0.08, growth), "scenes": (0.39, scenes), "batches": (0.08, batches),
                         "sweeps": (0.18, sweeps)})
