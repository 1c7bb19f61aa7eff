# Error over the step: a curve for each setting, of libraries and of code without one, by the implementation that is
# fastest there with the default setting. The error is the setting's; others are held to it by a run of their own.
import numpy

from analysis.accuracy.pairs import STEP
from analysis.core.outcomes import FINISHED
from study.core import curves

BEHIND = 4.0   # times the fastest with the default setting: who is slower is not tried in others
BETWEEN = 2 / 3  # of the longer of two steps: half-way on a logarithmic scale, nearly; halvings that just miss a
SHARE = 0.5      # of the budget that curves may take: errors without times rank nobody
WORTH = 2.0      # required error would cost a factor of two; tried where the shorter step is so near the fastest


def first_look(runs, scene):
    """{layer: [contenders, the fastest with the default setting first]}; who is far behind, or fails, is not in it."""
    step = STEP if runs.subject.loops else runs.subject.entry.steps[0]
    return {layer: runs.quick(scene, step, contenders, BEHIND) for layer, contenders in runs.layers.items()}


def follow(runs, speed):
    """{(layer, setting): rows in the order of steps}: all curves, followed from the longest step on. `speed`: of first_look."""
    found = {}
    for layer, contenders in runs.layers.items():
        for name in runs.settings:
            serving = runs.serving(name, [*speed[layer], *(one for one in contenders if one not in speed[layer])])
            if serving:
                found[layer, name] = curves.Curve(layer, [(step, runs.run_cell(serving[0], name, step)) for step in runs.subject.steps], 2.0)
    curves.follow(runs.lab, list(found.values()), runs.row, runs.longest, min(runs.lab.settings["errors"]), SHARE, status="excluded")
    return {key: curve.rows for key, curve in found.items()}


def between(runs, found):
    """The same with runs between the two steps that bracket a required error, of curves near the fastest of their layer there."""
    cells = {}
    for error in runs.lab.settings["errors"]:
        for layer in runs.layers:
            mine = {key: meeting(rows, error) for key, rows in found.items() if key[0] == layer}
            best = min((row["time"] for row in mine.values() if row), default=numpy.inf)
            for key, row in mine.items():
                longer = [one["step"] for one in found[key] if row and one["step"] > 1.001 * row["step"]]
                if longer and row["time"] <= WORTH * best:
                    step = float(f"{BETWEEN * min(longer):g}")
                    cells[key, step] = runs.run_cell(runs.names[row["implementation"]], key[1], step)
    for (key, _), record in zip(cells, runs.lab.run(list(cells.values()), drop=True)):
        found[key] = sorted([*found[key], runs.row(record)], key=lambda one: -one["step"])
    return found


def meeting(rows, error):
    """The row of the longest step that meets an error, or None."""
    return next((row for row in rows if row["status"] in FINISHED and row["error"] <= error), None)
