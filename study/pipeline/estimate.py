# Predicts how long a run takes, before (for --dry-run) and while it runs (for the time left).
#
# The model is deliberately crude: a dense step of n variables takes about
# SECONDS_A_CUBE n^3 + SECONDS_A_VARIABLE n; a child process costs START_SECONDS besides its work.
# While a study runs, the time it took so far corrects the prediction.
from dataclasses import dataclass

START_SECONDS = 0.04
SECONDS_A_VARIABLE = 2e-7
SECONDS_A_CUBE = 1.5e-10
GATE_STEPS = 2500  # a gate costs about as much as this many dense steps, plus GATE_SECONDS
GATE_SECONDS = 0.6


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
        step = SECONDS_A_VARIABLE * variables + SECONDS_A_CUBE * variables**3
        reached = [s for s in scenes if s.fill is None or s.fill > natural_fill(variables)]
        penalties = len(profile.accuracy["penalties"])
        pilot = variants * (START_SECONDS + 4 * profile.pilot_steps * step)
        gate = GATE_SECONDS + min(GATE_STEPS * step, profile.limits["check_seconds"])
        steps = profile.accuracy["duration"] / profile.step
        simulate = START_SECONDS + min(steps * step / 2, profile.limits["simulate_seconds"])
        plan["verify", variables] = Work(
            len(scenes) * (variants + 1) + variants * penalties,
            len(reached) * (pilot + gate) + variants * penalties * simulate)
        timing = sum(_cell_seconds(profile, scene, step) for scene in reached)
        profiling = START_SECONDS + 2 * _stretch_seconds(profile, reached[0], step)
        plan["measure", variables] = Work(
            (variants * (len(scenes) + 1) + 1) * profile.rounds,
            variants * profile.rounds * (timing + profiling))
    return plan


def _cell_seconds(profile, scene, step):
    """One process that times one cell: a warm-up and the repetitions, each of whole stretches."""
    stretch = _stretch_seconds(profile, scene, step)
    sample = max(1.5 * profile.min_time, stretch)
    return START_SECONDS + (profile.repetitions + 1) * sample


def _stretch_seconds(profile, scene, step):
    """About two thirds of the budget, where the longest stretch does not fit into it."""
    budget = profile.stretch_budget["natural" if scene.fill is None else "filled"]
    longest, shortest = max(profile.stretch_lengths) * step, min(profile.stretch_lengths) * step
    return max(min(longest, 0.67 * budget), 3 * shortest)


def seconds_left(plan, spent, predicted):
    """What is left of `plan`, corrected by what was `spent` on cells `predicted` to take so long."""
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
