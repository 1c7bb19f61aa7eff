# Measures one column: every planned cell in fresh processes, in random order within each round.
import random
import sys

from study.pipeline import cells
from study.pipeline.layout import NULL, read_json, write_json
from study.pipeline.progress import Progress


def measure(study, variables):
    plan = read_json(study.layout.plan(variables))
    profile, progress = study.profile, Progress(study.layout, "measure", variables)
    scenes = [scene for scene in profile.columns[variables]
              if plan["scenes"][scene.name]["reached"]]
    timed = [(name, scene) for scene in scenes
             for name, cell in plan["scenes"][scene.name]["cells"].items()
             if cell["status"] == "measure"]
    lost = (len(study.variants) * len(profile.columns[variables])) - len(timed)
    progress.done(lost * profile.rounds)
    timed += [(NULL, scenes[0])]
    orders = []
    for round_number in range(1, profile.rounds + 1):
        shuffled = random.Random(f"{plan['seed']}:{variables}:{round_number}")
        order = shuffled.sample(timed, len(timed))
        orders.append([f"{name}/{scene.name}" for name, scene in order])
        for name, scene in order:
            _time(study, f"round{round_number}", name, scene, plan)
            progress.done()
        for name, scene in order:
            if scene.fill is None and name != NULL:
                _profile(study, f"phases{round_number}", name, scene, plan)
                progress.done()
    files = sorted(map(study.layout.relative, study.layout.column(variables).rglob("*.json")))
    write_json(study.layout.measured(variables), {"orders": orders, "files": files})


def _time(study, kind, name, scene, plan):
    cells.bench(study.layout.cell(kind, name, scene), name, scene, study.profile, study.context,
                steps=plan["scenes"][scene.name]["stretch_steps"],
                repetitions=study.profile.repetitions, min_time=study.profile.min_time)


def _profile(study, kind, name, scene, plan):
    cells.bench(study.layout.cell(kind, name, scene), name, scene, study.profile, study.context,
                steps=plan["scenes"][scene.name]["stretch_steps"], more=["--phases"])


if __name__ == "__main__":
    from study.pipeline.job import column_job
    sys.exit(column_job(measure))
