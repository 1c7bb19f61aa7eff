# Predicts how long a run takes, before (for --dry-run) and while it runs (for the time left).
#
# The model is deliberately crude. A dense step of n variables takes about DENSE n^3 + OVERHEAD n
# seconds; at natural fill, where dense would be excluded as too slow, a sparse one takes SPARSE n;
# with artificial fill the implementations of a scene take FILLED dense steps on average. A child costs
# START seconds besides its work. While a study runs, the time it took so far corrects the prediction.
from dataclasses import dataclass

START = 0.04
OVERHEAD = 2e-7
DENSE = 1e-10
SPARSE = 1.2e-7
FILLED = 3.0
GATE_STEPS, GATE_MOST, GATE_START = 2500, 15.0, 0.6  # a gate: steps, at most seconds, reference


@dataclass
class Work:
    """One stage of one column."""
    cells: int
    seconds: float
    done: int = 0

    def left(self):
        return self.seconds * (1 - min(1.0, self.done / max(1, self.cells)))


def natural_fill(variables):
    """Fill of the N-four-bar's tangent: block tridiagonal, blocks of 2 x 2 (a share)."""
    return (6 * variables - 8) / variables**2


def work(profile, variants):
    """{(stage, variables): Work}; `variants` is the number of implementations that take part."""
    plan = {}
    for variables, scenes in profile.columns.items():
        reached = [s for s in scenes if s.fill is None or s.fill > natural_fill(variables)]
        penalties = len(profile.accuracy["penalties"])
        pilot = START + min(4 * profile.pilot_steps * _dense_seconds(variables),
                            profile.limits["pilot_seconds"])
        steps = [_step_seconds(profile, scene) for scene in reached]
        gates = sum(GATE_START + variants * min(GATE_STEPS * step, GATE_MOST) for step in steps)
        simulate = START + min(profile.accuracy["duration"] / profile.step * steps[0] / 2,
                               profile.limits["simulate_seconds"])
        plan["verify", variables] = Work(
            len(scenes) * (variants + 1) + variants * penalties,
            variants * (len(reached) * pilot + penalties * simulate) + gates)
        stretches = [_stretch_seconds(profile, *pair) for pair in zip(reached, steps)]
        timing = sum(START + (profile.repetitions + 1) * max(1.5 * profile.min_time, stretch)
                     for stretch in stretches)
        profiling = START + 2 * stretches[0]
        plan["measure", variables] = Work(
            (variants * (len(scenes) + 1) + 1) * profile.rounds,
            variants * profile.rounds * (timing + profiling))
    return plan


def _dense_seconds(variables):
    return OVERHEAD * variables + DENSE * variables**3


def _step_seconds(profile, scene):
    """Of the implementations that are not excluded, on average."""
    dense, sparse = _dense_seconds(scene.variables), SPARSE * scene.variables
    if scene.fill is not None:
        return FILLED * dense
    return sparse if dense > profile.exclusion_factor * sparse else dense


def _stretch_seconds(profile, scene, step):
    """About two thirds of the budget, where the longest stretch does not fit into it."""
    budget = profile.stretch_budget["natural" if scene.fill is None else "filled"]
    longest, shortest = max(profile.stretch_lengths) * step, min(profile.stretch_lengths) * step
    return max(min(longest, 0.67 * budget), 3 * shortest)


def seconds_left(plan, spent, predicted):
    """What is left of `plan`, corrected by seconds `spent` on cells `predicted` to take as long."""
    correction = spent / predicted if spent > 2 and predicted > 0 else 1.0
    return correction * sum(work.left() for work in plan.values())


def duration(seconds):
    """The text "1 min 20 s"."""
    seconds = max(0, round(seconds))
    if seconds < 60:
        return f"{seconds} s"
    if seconds < 3600:
        return f"{seconds // 60} min {seconds % 60} s"
    return f"{seconds // 3600} h {seconds % 3600 // 60} min"
