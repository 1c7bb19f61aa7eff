# Predicts how long a run takes, before (for --dry-run) and while it runs (for the time left).
#
# The model is deliberately crude. A dense step of n variables takes about DENSE n^3 + OVERHEAD n
# seconds; at natural fill, where dense would be excluded as too slow, a sparse one takes SPARSE n on
# average; with artificial fill the implementations of a scene take FILLED dense steps. Of those that
# take part in a filled scene a SURVIVING share is not excluded. A child costs START seconds besides
# its work. While a study runs, the time it took so far corrects the prediction.
from dataclasses import dataclass

from study.pipeline.measure import processes
from study.pipeline.verify import accuracy_runs_of

START = 0.03
OVERHEAD = 2e-7
DENSE = 1e-10
SPARSE = 5e-7
FILLED = 1.2
SURVIVING = 0.45
GATE_STEPS, GATE_MOST, GATE_START = 2500, 15.0, 0.5  # a gate: steps, at most seconds, reference


@dataclass
class Work:
    """One stage of one column."""
    cells: float
    seconds: float
    done: float = 0

    def left(self):
        return self.seconds * (1 - min(1.0, self.done / max(1, self.cells)))


def natural_fill(variables):
    """Fill of the N-four-bar's tangent: block tridiagonal, blocks of 2 x 2 (a share)."""
    return (6 * variables - 8) / variables**2


def work(profile, contenders):
    """{(stage, variables): Work}; `contenders` are those that take part."""
    plan = {}
    for variables, scenes in profile.columns.items():
        plan["verify", variables] = _verify(profile, contenders, variables, scenes)
        plan["measure", variables] = _measure(profile, contenders, variables, scenes)
    seconds = profile.refine["seconds"]
    plan["refine", 0] = Work(max(seconds, 1), seconds)
    return plan


def _reached(scenes):
    return [s for s in scenes if s.fill is None or s.fill > natural_fill(s.variables)]


def _verify(profile, contenders, variables, scenes):
    pilot = START + min(4 * profile.pilot_steps * _dense_seconds(variables),
                        profile.limits["pilot_seconds"])
    cells, seconds = 1, pilot
    for scene in scenes:
        present = sum(one.at(scene) for one in contenders)
        cells += present + 1
        if scene in _reached(scenes):
            environments = len({one.environment for one in contenders if one.at(scene)})
            gate = min(GATE_STEPS * _step_seconds(profile, scene), GATE_MOST)
            seconds += (present * pilot + environments * GATE_START
                        + _timed(contenders, scene) * gate)
    runs = len(accuracy_runs_of(profile, scenes[0], contenders))
    simulate = START + min(profile.accuracy["duration"] / profile.step
                           * _step_seconds(profile, scenes[0]), profile.limits["simulate_seconds"])
    return Work(cells + runs, seconds + runs * simulate)


def _measure(profile, contenders, variables, scenes):
    cells, seconds = profile.rounds, 0.0
    for scene in _reached(scenes):
        timed = _timed(contenders, scene)
        stretch = _stretch_seconds(profile, scene, _step_seconds(profile, scene))
        cells += timed * profile.rounds
        seconds += timed * profile.rounds * (
            START + (profile.repetitions + 1) * max(1.5 * profile.min_time, stretch))
        if scene.fill is None:
            profiled = len(processes(profile.phases, variables)) * sum(
                one.at(scene) and one.ranked for one in contenders)
            operating = len(processes(profile.operations, variables)) * sum(
                one.operations for one in contenders)
            cells += profiled + operating
            seconds += profiled * (START + 2 * stretch) + operating * (
                START + 6 * profile.repetitions * profile.min_time)
    return Work(cells, seconds)


def _timed(contenders, scene):
    present = sum(one.at(scene) for one in contenders)
    return present if scene.fill is None else SURVIVING * present


def _dense_seconds(variables):
    return OVERHEAD * variables + DENSE * variables**3


def _step_seconds(profile, scene):
    """Of the implementations that are not excluded, on average."""
    dense, sparse = _dense_seconds(scene.variables), SPARSE * scene.variables
    if scene.fill is not None:
        return FILLED * dense
    return sparse if dense > profile.exclusion(scene) * sparse / 5 else max(dense, sparse)


def _stretch_seconds(profile, scene, step):
    """About a third of the budget, where the longest stretch does not fit into it."""
    budget = profile.stretch_budget["natural" if scene.fill is None else "filled"]
    longest, shortest = max(profile.stretch_lengths) * step, min(profile.stretch_lengths) * step
    return max(min(longest, 0.33 * budget), shortest)


def seconds_left(plan, spent, predicted):
    """What is left of `plan`, corrected by seconds `spent` on cells `predicted` to take as long."""
    correction = spent / predicted if spent > 2 and predicted > 0 else 1.0
    return sum(work.left() * (1.0 if stage == "refine" else correction)
               for (stage, _), work in plan.items())
