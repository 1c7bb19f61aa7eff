# What each piece of modelling costs and buys: the N-four-bar, modelled in more ways than it needs.
#
# Every case is the same motion, known in closed form, so that each has an error (a whole run, untimed) and a time
# (the stretch of its first second). Contenders take turns within a process, but cases are scenes: they take turns
# by processes, in an order shuffled anew in each round, and are compared round by round.
import random
from collections import namedtuple
from dataclasses import replace

from analysis.core.registry import TWIN
from study.core.cell import Cell, by_environment
from study.scenes import metric

IMPLEMENTATIONS = ("csc_klu/refactor", "csc_cholmod/simplicial", "eigen_dense/llt")
STEP, DURATION = 1.25e-3, 10.0
STRETCH, EARLY = 800, 400  # steps; the first singular position comes at 0.708 s or later
SEED = 20080101
FAINT = 1e-9  # stiffness (N/m) and damping (N s/m) that cost like any other and move nothing
PLAIN = "plain"


class Case(namedtuple("Case", "name piece scene options steps base", defaults=(PLAIN, (), STRETCH, PLAIN))):
    """`piece`: what it is compared for; `scene`: one of scenes(); `steps`: of the stretch, and of the run, where that is the early one; `base`: the
    case that it is compared with."""
    file_name = property(lambda self: slug(self.name))


BEFORE = "plain, before singular"
CASES = (
    Case(PLAIN, ""),
    Case("fixed points as unknowns", "points", "unknown grounds"),
    Case("in three dimensions", "dimension", "spatial"),
    Case("springs of no stiffness", "K and C", "zero springs"),
    Case("springs", "K and C", "springs"),
    Case("springs and dampers", "K and C", "dampers"),
    Case("redundant rods", "constraints", "redundant"),
    Case("velocities projected only", "projections", options=("--projections", "velocity")),
    Case("no projections", "projections", options=("--projections", "none")),
    Case(BEFORE, "early", steps=EARLY, base=BEFORE),
    Case("velocities only, before singular", "early", options=("--projections", "velocity"), steps=EARLY, base=BEFORE),
    Case("no projections, before singular", "early", options=("--projections", "none"), steps=EARLY, base=BEFORE))
AGAIN = Case(PLAIN + TWIN, "")  # a control: timed only


def scenes(loops):
    """{name: scene as a JSON value}"""
    ground = [{"name": f"A{i}", "position": [i, 0], "fixed": True} for i in range(loops + 1)]
    moving = [{"name": f"B{i}", "position": [i, 1], "velocity": [1, 0]} for i in range(loops + 1)]
    rods = [{"between": [f"A{i}", f"B{i}"], "mass": 1} for i in range(loops + 1)]
    rods += [{"between": [f"B{i - 1}", f"B{i}"], "mass": 1} for i in range(1, loops + 1)]
    plain = {"points": ground + moving, "rods": rods, "outputs": [{"name": "B0", "position": "B0"}]}

    def held(axis, point, value):
        return {"type": "linear", "value": value, "terms": [{"point": point, "axis": axis, "coefficient": 1}]}

    def springs(**more):
        return [{"between": [f"A{i - 1}", f"B{i}"], "length": 1.0} | more for i in range(1, loops + 1)]
    return {
        PLAIN: plain,
        "unknown grounds": plain | {
            "points": [{"name": p["name"], "position": p["position"]} for p in ground] + moving,
            "constraints": [held(axis, f"A{i}", value) for i in range(loops + 1) for axis, value in (("x", i), ("y", 0))]},
        "spatial": plain | {
            "dimension": 3, "gravity": [0, -9.81, 0],
            "points": [p | {key: p[key] + [0] for key in ("position", "velocity") if key in p} for p in ground + moving],
            "constraints": [held("z", f"B{i}", 0) for i in range(loops + 1)]},
        "zero springs": plain | {"springs": springs(stiffness=0)},
        "springs": plain | {"springs": springs(stiffness=FAINT)},
        "dampers": plain | {"springs": springs(stiffness=FAINT, damping=FAINT)},
        "redundant": plain | {"rods": rods + [{"between": [f"B{i - 2}", f"B{i}"], "mass": 0} for i in range(2, loops + 1)]}}


def slug(name):
    """A case's or scene's name in those of files."""
    return name.replace(",", "").replace(" ", "-")


def run(lab):
    those = [one for name in IMPLEMENTATIONS if (one := lab.contender(name))]
    groups = by_environment(those)
    motions, timed = [], []
    for loops in lab.settings["loops"]:
        paths = {name: lab.scene(f"{loops}-{slug(name)}", scene) for name, scene in scenes(loops).items()}
        for case in (*CASES, AGAIN):
            duration = DURATION if case.steps == STRETCH else EARLY * STEP
            motions += [Cell("simulate", paths[case.scene], (one,), ("--step", f"{STEP:g}", "--duration", f"{duration:g}", *case.options),
                             f"motion.{case.file_name}", seconds=120, keep=("outputs",), every=round(duration / STEP) // metric.SAMPLES)
                        for one in those if case != AGAIN]
            words = ("--step", f"{STEP:g}", "--steps", case.steps, *case.options, f"--benchmark_repetitions={lab.settings['samples']}")
            timed += [Cell("bench", paths[case.scene], group, words, f"time.{case.file_name}", timed=True, seconds=60) for group in groups.values()]
    lab.run(motions)
    for number in range(1, lab.settings["rounds"] + 1):
        lab.tell(f"round {number} of {lab.settings['rounds']}")
        cells = [replace(cell, number=number, settings=(*cell.settings, "--seed", number)) for cell in timed]
        lab.run(random.Random(f"{SEED}:{number}").sample(cells, len(cells)), drop=True)
