# How long study/accuracy may take, roughly: what was left out as slow or of no use is an average of past runs.
from study.accuracy_study import regions, subjects

START = 0.06                # s a process, with the repeats of short runs
SPARSE = 2.5e-7             # s a step and variable, an average of settings
DENSE = 1e-10               # s a step and cubed variable, more than that
GATE = 0.4                  # s an implementation and setting
LEFT = {False: 0.32, True: 0.06}  # share of the work of all sparse, all dense curves that is done
REPEATS = 1.4               # curves with the runs between steps and the repeated ones near the front
SCENE_CURVE = 0.2           # s a curve of a standard problem, and
SCENE_REFERENCE = 6.0       # its reference
CELL, PAIR = 20.0, 6.0      # s a size and fill of the regions; a pair of settings


def total(choice):
    """(curves, seconds)"""
    each = [choice.dense[name] for name, served in choice.served.items() for _ in served]
    loops = {count for part in ("work", "regions") if part in choice.parts
             for count in choice.loops[part]}
    seconds = GATE * len(each) + REPEATS * sum(
        LEFT[dense] * _curve(count, dense, choice) for count in loops for dense in each)
    seconds += len(choice.problems) * (SCENE_REFERENCE + SCENE_CURVE * len(each))
    if "regions" in choice.parts:
        seconds += CELL * (1 + len(regions.FILLS)) * len(choice.loops["regions"])
    if "pairs" in choice.parts:
        pairs = sum(setting.name in ("saddle", "mixed", "single", "saddle mixed")
                    for served in choice.served.values() for setting in served)
        seconds += PAIR * pairs * len(choice.loops["forms"])
    return len(each) * (len(loops) + len(choice.problems)), seconds


def _curve(loops, dense, choice):
    variables, seconds = 2 * loops + 2, 0.0
    for step in subjects.STEPS:
        one = choice.duration / step * (SPARSE * variables + (DENSE * variables**3 if dense else 0))
        if one > choice.time_limit:
            break
        seconds += START + one
    return seconds
