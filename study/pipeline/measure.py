# Measures one column: every planned cell in fresh processes, in random order within each round.
import random
import sys

from study.pipeline import cells
from study.pipeline.layout import read_json, write_json
from study.pipeline.progress import Progress


def measure(study, variables):
    plan = read_json(study.layout.plan(variables))
    progress = Progress(study.layout, "measure", variables)
    reached = [scene for scene in study.profile.columns[variables]
               if plan["scenes"][scene.name]["reached"]]
    timed = [(one, scene) for scene in reached
             for one in planned(study, plan["scenes"][scene.name])]
    timed.append((study.control, reached[0]))
    alone = [(one, scene) for one, scene in timed
             if scene.fill is None and one.ranked and one != study.control]
    seed, orders = f"{plan['seed']}:{variables}", []
    for number in range(1, study.profile.rounds + 1):
        order = shuffled(timed, f"{seed}:{number}")
        orders.append([f"{one.name}/{scene.name}" for one, scene in order])
        for one, scene in order:
            time_cell(study, one, scene, plan["scenes"][scene.name], number)
            progress.done()
    for number in processes(study.profile.phases, variables):
        for one, scene in shuffled(alone, f"{seed}:phases:{number}"):
            _profile(study, one, scene, plan["scenes"][scene.name], number)
            progress.done()
    cases = [(one, reached[0]) for one in operating(study, plan["scenes"][reached[0].name])]
    for number in processes(study.profile.operations, variables):
        for one, scene in shuffled(cases, f"{seed}:operations:{number}"):
            _operate(study, one, scene, number)
            progress.done()
    files = sorted(map(study.layout.relative, study.layout.column(variables).rglob("*.json")))
    write_json(study.layout.measured(variables), {"orders": orders, "files": files})


def planned(study, scene_plan):
    """The contenders that verify found fit to be timed in a scene."""
    return [study.contenders[name] for name, cell in scene_plan["cells"].items()
            if cell["status"] == "measure"]


def operating(study, scene_plan):
    """Those whose operations of Table 2 are timed one by one: `mbs` checks their results itself, so
    that a step too slow to be timed excludes nobody; a failed one does."""
    return [study.contenders[name] for name, cell in scene_plan["cells"].items()
            if study.contenders[name].operations and cell["status"] in ("measure", "excluded")]


def shuffled(cases, seed):
    return random.Random(seed).sample(cases, len(cases))


def processes(setting, variables):
    """Numbers of the processes that `phases` or `operations` of a profile ask for at a size."""
    return range(1, 1 + setting["rounds"]) if variables in setting["columns"] else ()


def time_cell(study, contender, scene, scene_plan, number):
    # The control's stretch is so short that going back to its start takes most of the time.
    shorter = 0.1 if contender == study.control else 1.0
    cells.bench(study.layout.cell(f"round{number}", contender, scene), contender, scene, study,
                more=["--steps", str(scene_plan["stretch_steps"])],
                repetitions=study.profile.repetitions, min_time=shorter * study.profile.min_time)


def _profile(study, contender, scene, scene_plan, number):
    cells.bench(study.layout.cell(f"phases{number}", contender, scene), contender, scene, study,
                more=["--steps", str(scene_plan["stretch_steps"]), "--phases"])


def _operate(study, contender, scene, number):
    cells.bench(study.layout.cell(f"operations{number}", contender, scene), contender, scene, study,
                more=["--operations"], repetitions=study.profile.repetitions,
                min_time=study.profile.min_time)


if __name__ == "__main__":
    from study.pipeline.job import column_job
    sys.exit(column_job(measure))
