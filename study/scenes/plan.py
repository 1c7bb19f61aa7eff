# The standard problems: the gate of everyone, runs of the two that are compared; then what modelling costs.
from study.core.cell import Cell, by_environment
from study.core.profile import by_share
from study.scenes import metric, modelling
from study.scenes.problems import compared_of, read_list

SETTINGS = {"problems": [str], "loops": [int], "rounds": int, "samples": int}
CHECK_S, RUN_S = 120, 600  # limits of a process


def problems(lab):
    preferred, listed = read_list()
    chosen = [one for one in listed if one.name in lab.settings["problems"]]
    compared = compared_of(preferred, [one.name for one in lab.contenders])
    runs, gates = [], []
    for problem in chosen:
        for one in lab.contenders:
            runs += [Cell("simulate", problem.scene, (one,), ("--step", f"{step:g}", "--duration", f"{problem.duration:g}", *problem.settings),
                          "compared" if one.name in compared else "everyone", seconds=RUN_S, keep=("outputs",),
                          every=round(problem.duration / step) // metric.SAMPLES)
                     for step in problem.steps if one.name in compared or (problem.everyone and step == problem.steps[0])]
        words = ("--step", f"{problem.check_step:g}") if problem.check_step else ("--step", f"{problem.steps[0]:g}", *problem.settings)
        gates += [Cell("check", problem.scene, group, (*words, "--time-limit", CHECK_S), "gate", seconds=2 * CHECK_S)
                  for group in by_environment(lab.contenders).values()]  # a process runs the reference once for all of its contenders
    sizes = {record.cell["scene"]: record.output.get("variables", 0) for record in lab.run(runs)}
    lab.run(sorted(gates, key=lambda cell: sizes.get(cell.scene, 0)), drop=True)  # what costs least goes first


columns, run = by_share({"problems": (0.55, problems), "modelling": (0.45, modelling.run)})
