# What each piece of modelling costs and buys: the N-four-bar, modelled in more ways than it needs.
#
# Every case is the same motion, known in closed form, so that each has a time and an error. Cases run in
# rounds, in an order shuffled anew in each; the cost of a case is the median over rounds of its ratio to
# the plain model in the same round.
import random
from dataclasses import dataclass

import numpy
import pandas

from study.pipeline import runs
from study.pipeline.layout import write_json
from study.scenes import metric
from study.scenes.references import four_bar

IMPLEMENTATIONS = ("csc_klu/refactor", "csc_cholmod/simplicial", "eigen_dense/llt")
LOOPS = (10, 40)
STEP, DURATION = 1.25e-3, 10.0
EARLY = 0.5  # s; the first singular position comes at 0.708 s or later
SEED = 20080101
FAINT = 1e-9  # stiffness (N/m) and damping (N s/m) that cost like any other and move nothing
PLAIN = "plain"


@dataclass(frozen=True)
class Case:
    name: str
    piece: str             # what it is compared for
    scene: str = PLAIN     # which of scenes()
    options: tuple = ()
    output: str = "B0"     # "B0", "nothing" or "everything"
    duration: float = DURATION
    base: str = PLAIN      # the case that it is compared with


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
    Case("plain, before singular", "early", duration=EARLY, base="plain, before singular"),
    Case("velocities only, before singular", "early", options=("--projections", "velocity"),
         duration=EARLY, base="plain, before singular"),
    Case("no projections, before singular", "early", options=("--projections", "none"),
         duration=EARLY, base="plain, before singular"),
    Case("no output", "output", output="nothing"),
    Case("output of everything", "output", output="everything"),
)


def scenes(loops):
    """{name: scene as a JSON value}"""
    ground = [{"name": f"A{i}", "position": [i, 0], "fixed": True} for i in range(loops + 1)]
    moving = [{"name": f"B{i}", "position": [i, 1], "velocity": [1, 0]} for i in range(loops + 1)]
    rods = [{"between": [f"A{i}", f"B{i}"], "mass": 1} for i in range(loops + 1)]
    rods += [{"between": [f"B{i - 1}", f"B{i}"], "mass": 1} for i in range(1, loops + 1)]
    plain = {"points": ground + moving, "rods": rods,
             "outputs": [{"name": "B0", "position": "B0"}]}

    def held(axis, point, value):
        return {"type": "linear", "value": value,
                "terms": [{"point": point, "axis": axis, "coefficient": 1}]}

    def springs(**more):
        return [{"between": [f"A{i - 1}", f"B{i}"], "length": 1.0} | more
                for i in range(1, loops + 1)]
    return {
        PLAIN: plain,
        "unknown grounds": plain | {
            "points": [{"name": p["name"], "position": p["position"]} for p in ground] + moving,
            "constraints": [held(axis, f"A{i}", value) for i in range(loops + 1)
                            for axis, value in (("x", i), ("y", 0))]},
        "spatial": plain | {
            "dimension": 3, "gravity": [0, -9.81, 0],
            "points": [p | {key: p[key] + [0] for key in ("position", "velocity") if key in p}
                       for p in ground + moving],
            "constraints": [held("z", f"B{i}", 0) for i in range(loops + 1)]},
        "zero springs": plain | {"springs": springs(stiffness=0)},
        "springs": plain | {"springs": springs(stiffness=FAINT)},
        "dampers": plain | {"springs": springs(stiffness=FAINT, damping=FAINT)},
        "redundant": plain | {"rods": rods + [{"between": [f"B{i - 2}", f"B{i}"], "mass": 0}
                                              for i in range(2, loops + 1)]},
    }


def label(name):
    """A case's name in those of files."""
    return name.replace(",", "").replace(" ", "-")


def measure(raw, contenders, contexts, rounds, tell, stored=False):
    """{(implementation, loops, case, round): record}; raw files and the scenes beside them."""
    folder = raw / "modelling"
    for loops in LOOPS if rounds and not stored else ():
        for name, scene in scenes(loops).items():
            path = folder / "scenes" / f"{loops}-{name.replace(' ', '-')}.json"
            write_json(path, scene)
    found = {}
    work = [(one, loops, case) for one in contenders if one.name in IMPLEMENTATIONS
            for loops in LOOPS for case in CASES]
    for number in range(1, rounds + 1):
        for done, (one, loops, case) in enumerate(random.Random(f"{SEED}:{number}").sample(work, len(work))):
            tell(f"round {number} of {rounds}: {case.name}, N = {loops}, {one.name}",
                 (number - 1 + done / len(work)) / rounds)
            found[one.name, loops, case.name, number] = _run(
                folder, one, loops, case, number, contexts[one.environment], stored)
    return found


def _run(folder, contender, loops, case, number, context, stored):
    scene = folder / "scenes" / f"{loops}-{case.scene.replace(' ', '-')}.json"
    path = folder / f"round{number}" / (
        f"{contender.file_name}-{loops}-{label(case.name)}.json")
    steps = round(case.duration / STEP)
    every = {"B0": max(1, steps // metric.SAMPLES), "nothing": 0, "everything": 0}[case.output]
    more = list(case.options)
    trajectory = path.with_name(path.name + ".trajectory.csv")
    if case.output == "everything":
        path.parent.mkdir(parents=True, exist_ok=True)
        more += ["--trajectory", str(trajectory)]
    record = runs.simulate(path, contender, str(scene), step=STEP, duration=case.duration, every=every,
                           context=context, seconds=120, more=more, stored=stored)
    trajectory.unlink(missing_ok=True)
    return record


def rows(found, relative):
    """The rows of modelling.csv: one a run."""
    result = []
    by_name = {case.name: case for case in CASES}
    for (name, loops, case, number), record in found.items():
        status, reason = runs.status(record)
        row = {"implementation": name, "loops": loops, "case": case, "piece": by_name[case].piece,
               "base": by_name[case].base,
               "round": number, "status": status, "reason": reason, "step": STEP,
               "duration": by_name[case].duration, "run_seconds": record["seconds"]}
        if "summary" in record:
            summary = record["summary"]
            row |= {key: summary[key] for key in (
                "variables", "constraints", "tangent_nonzeros", "penalty", "tolerance",
                "passes_per_step", "energy_drift_max", "constraint_violation_max")}
            row["step_us"] = summary["step_us"]["median"]
        outputs = record.get("outputs", {})
        if status in runs.GOOD and "B0.x" in outputs:
            exact = four_bar(numpy.array(outputs["t"]), loops)
            row["position_error"] = max(float(numpy.max(numpy.abs(
                numpy.array(outputs[column]) - exact[column]))) for column in ("B0.x", "B0.y"))
        row["raw_file"] = relative(name, loops, case, number)
        result.append(row)
    order = [case.name for case in CASES]
    result.sort(key=lambda row: (row["round"], row["implementation"], row["loops"],
                                 order.index(row["case"])))
    return pandas.DataFrame(result)


