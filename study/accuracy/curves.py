# Error over the step: a curve for each setting, of libraries and of code without one, by the implementation that is
# fastest there with the default setting. The error is the setting's; others are held to it by a run of their own.
import numpy

from analysis.accuracy.pairs import STEP
from analysis.core.outcomes import FINISHED
from study.core.curves import of_no_use, too_long

BEHIND = 4.0   # times the fastest with the default setting: who is slower is not tried in others
BETWEEN = 2 / 3  # of the longer of two steps: half-way on a logarithmic scale, nearly; halvings that just miss a
WORTH = 2.0      # required error would cost a factor of two; tried where the shorter step is so near the fastest


def first_look(runs, scene):
    """{layer: [contenders, the fastest with the default setting first]}; who is far behind, or fails, is not in it."""
    step = STEP if runs.subject.loops else runs.subject.entry.steps[0]
    return {layer: runs.quick(scene, step, contenders, BEHIND) for layer, contenders in runs.layers.items()}


def follow(runs, speed):
    """Simulates all curves, a step after the other from the longest one on. `speed`: of first_look."""
    active = {}
    for layer, contenders in runs.layers.items():
        for name in runs.settings:
            serving = runs.serving(name, [*speed[layer], *(one for one in contenders if one not in speed[layer])])
            if serving:
                active[layer, name] = serving[0]
    curves = dict.fromkeys(active, ())
    for step in runs.subject.steps:
        for key in list(active):
            layer = [row for (name, _), rows in curves.items() if name == key[0] for row in rows]
            reason = too_long(curves[key], runs.longest, 2.0) or of_no_use(curves[key], layer, min(runs.lab.settings["errors"]))
            if reason:
                runs.leave_out(active.pop(key), key[1], step, reason)
        runs.simulate([(one, name, step, runs.subject.scene, None) for (_, name), one in active.items()])
        curves = _curves(runs, curves, active)
    return curves


def between(runs, curves):
    """Runs between the two steps that bracket a required error, of curves near the fastest of their layer there."""
    by_name = {one.name: one for group in runs.layers.values() for one in group}
    jobs = []
    for error in runs.lab.settings["errors"]:
        for layer in runs.layers:
            mine = {key: meeting(rows, error) for key, rows in curves.items() if key[0] == layer}
            best = min((row["time"] for row in mine.values() if row), default=numpy.inf)
            for key, row in mine.items():
                longer = [one["step"] for one in curves[key] if row and one["step"] > 1.001 * row["step"]]
                if longer and row["time"] <= WORTH * best:
                    step = float(f"{BETWEEN * min(longer):g}")
                    jobs.append((by_name[row["implementation"]], key[1], step, runs.subject.scene, None))
    runs.simulate(dict.fromkeys(jobs))
    return _curves(runs, curves, {})


def _curves(runs, curves, active):
    """{(layer, setting): rows in the order of steps}"""
    made = {}
    for row in runs.made().sort_values("step", ascending=False, kind="stable").to_dict("records"):
        if row["status"] not in ("dropped", "excluded"):
            made.setdefault((row["implementation"], row["setting"]), []).append(row)
    names = {key: rows[0]["implementation"] for key, rows in curves.items() if rows} | {
        key: one.name for key, one in active.items()}
    return {key: made.get((names.get(key), key[1]), []) for key in curves}


def meeting(rows, error):
    """The row of the longest step that meets an error, or None."""
    return next((row for row in rows if row["status"] in FINISHED and row["error"] <= error), None)
