# A subject: curves of all settings; of the points on them that may be fastest at a required error, first a look at
# everyone's time, then runs of their own, then processes in turn. On an N-four-bar the same at larger fills.
#
# Artificial fill is stored zeros: it leaves the motion as it is, so that the curves at the mechanism's own fill tell
# which steps to try. Whoever is ranked has met the error in a run of its own on that very scene.
#
# Error over the step: a curve for each setting, of libraries and of code without one, by the implementation that is
# fastest there with the default setting. The error is the setting's; others are held to it by a run of their own.
import numpy

from analysis.accuracy import subjects
from analysis.accuracy.pairs import STEP
from analysis.accuracy.points import NOT_JUDGED
from analysis.accuracy.winners import NEAR, meeting, winners
from analysis.core.controls import CONTROL
from analysis.core.gather import gather
from analysis.core.outcomes import FINISHED, pareto
from study.accuracy.runs import Runs
from study.core import curves

BEHIND = 4.0   # times the fastest with the default setting: who is slower is not tried in others
BETWEEN = 2 / 3  # of the longer of two steps: half-way on a logarithmic scale, nearly; halvings that just miss a
SHARE = 0.5      # of the budget that curves may take: errors without times rank nobody
WORTH = 2.0      # required error would cost a factor of two; tried where the shorter step is so near the fastest
TRIED = {False: 1.6, True: 3.0}  # by whether fill is artificial: settings up to this times the least time on the curves
MOST = 5       # of these, for each required error and layer
JUDGED = 1.5   # times the fastest in the look: they run the motion themselves, and so do
OTHERS = 2     # other implementations than the fastest
SPARE = 0.02   # of the tangent's positions: closer to its own fill a larger one is none of its own


def run(lab, kind, entry):
    runs = Runs(lab, kind, entry)
    scene = runs.subject.scene
    speed = _first_look(runs, scene)
    runs.refer()
    if runs.known is None or not any(speed.values()):
        return
    lab.tell("curves")
    found = _follow(runs, speed)
    if runs.subject.loops:
        found = _between(runs, found)
    scenes = {scene: speed}
    _measure(runs, scene, speed, found)
    for fill in entry.get("fills", ()):
        if fill > runs.made().fill.min() + SPARE:
            filled = subjects.chain(runs.subject.loops, runs.subject.duration, fill).scene
            scenes[filled] = _first_look(runs, filled)
            _measure(runs, filled, scenes[filled], found)
    least, most = lab.settings["processes"]
    for number in range(least + 1, most + 1):
        for one in scenes:
            _rounds(runs, one, number, open_only=True)


def _first_look(runs, scene):
    """{layer: [contenders, the fastest with the default setting first]}; who is far behind, or fails, is not in it."""
    step = STEP if runs.subject.loops else runs.subject.entry.steps[0]
    return {layer: runs.quick(scene, step, contenders, BEHIND) for layer, contenders in runs.layers.items()}


def _follow(runs, speed):
    """{(layer, setting): rows in the order of steps}: all curves, followed from the longest step on. `speed`: of _first_look."""
    found = {}
    for layer, contenders in runs.layers.items():
        for name in runs.settings:
            for one in runs.serving(name, dict.fromkeys([*speed[layer], *contenders]))[:1]:
                found[layer, name] = curves.Curve(layer, [(step, runs.run_cell(one, name, step)) for step in runs.subject.steps], 2.0)
    curves.follow(runs.lab, list(found.values()), runs.row, runs.longest, min(runs.lab.settings["errors"]), SHARE, status="excluded")
    return {key: curve.rows for key, curve in found.items()}


def _between(runs, found):
    """The same with runs between the two steps that bracket a required error, of curves near the fastest of their layer there."""
    cells = {}
    for error in runs.lab.settings["errors"]:
        for layer in runs.layers:
            mine = {key: _longest(rows, error) for key, rows in found.items() if key[0] == layer}
            best = min((row["time"] for row in mine.values() if row), default=numpy.inf)
            for key, row in mine.items():
                longer = [one["step"] for one in found[key] if row and one["step"] > 1.001 * row["step"]]
                if longer and row["time"] <= WORTH * best:
                    step = float(f"{BETWEEN * min(longer):g}")
                    cells[key, step] = runs.run_cell(runs.names[row["implementation"]], key[1], step)
    for (key, _), record in zip(cells, runs.lab.run(list(cells.values()), drop=True)):
        found[key] = sorted([*found[key], runs.row(record)], key=lambda one: -one["step"])
    return found


def _longest(rows, error):
    """The row of the longest step that meets an error, or None."""
    return next((row for row in rows if row["status"] in FINISHED and row["error"] <= error), None)


def _measure(runs, scene, speed, found):
    """Looks, own runs and the first processes of one scene."""
    runs.lab.tell(scene)
    for layer in runs.layers:
        for name, step in _wanted(runs, found, layer, scene != runs.subject.scene):
            if contenders := runs.serving(name, speed[layer]):
                runs.time("look", scene, name, step, contenders)
    _judge(runs, scene)
    _rounds(runs, scene, runs.lab.settings["processes"][0])


def _wanted(runs, found, layer, filled):
    """(setting, step) worth a look: for each required error the longest steps of the fastest settings, and at own fill the
    front of the layer's curves."""
    chosen = []
    for error in runs.lab.settings["errors"]:
        rows = filter(None, (_longest(rows, error) for key, rows in found.items() if key[0] == layer))
        rows = sorted(rows, key=lambda row: row["time"])[:MOST]
        chosen += [row for row in rows if row["time"] <= TRIED[filled] * rows[0]["time"]]
    if not filled:
        made = runs.made()
        mine = made[made.implementation.isin([one.name for one in runs.layers[layer]]) & (made.scene == runs.subject.scene)]
        chosen += mine.loc[pareto(mine)].to_dict("records")
    return dict.fromkeys((row["setting"], row["step"]) for row in chosen)


def _judge(runs, scene):
    """Runs of their own, where they have none, of those near the fastest in the look."""
    table = runs.points().loc[lambda rows: (rows.scene == scene) & rows.time.notna() & rows.error.notna()
                              & rows.status.isin((*FINISHED, NOT_JUDGED)) & rows.time_from.isin(("look", "rounds"))]
    jobs = []
    for error in runs.lab.settings["errors"]:
        for group in runs.layers.values():
            mine = table[table.implementation.isin([one.name for one in group]) & (table.error <= error)].sort_values("time", kind="stable")
            chosen = mine[(mine.time <= JUDGED * mine.time.min()) | mine.index.isin(_others(mine, OTHERS))]
            jobs += [(runs.names[row.implementation], row.setting, row.step, scene, runs.duration(row.time))
                     for row in chosen[chosen.status == NOT_JUDGED].itertuples()]
    runs.simulate(dict.fromkeys(job for job in jobs if job[-1]))


def _rounds(runs, scene, processes, open_only=False):
    """Processes of the points that are near the fastest of their layer, contenders of one setting and step together; with
    `open_only` of those alone whose winner is not settled."""
    table = runs.points().loc[lambda rows: rows.scene == scene]
    if table.empty:
        return
    errors = runs.lab.settings["errors"]
    if open_only:
        won = winners(table, runs.measured(), errors, runs.lab.registry.libraries)
        errors = [error for error in errors if (won[won.required == error].settled == False).any()]  # noqa: E712
    points = gather(((row.setting, row.step), row.implementation) for error in errors for group in runs.layers.values()
                    for row in near(table[table.implementation.isin([one.name for one in group])], error).itertuples())
    chosen = runs.chosen.setdefault(scene, {})
    for point, contenders in points.items():  # the same contenders in all processes, in the order of the registry
        chosen.setdefault(point, [one for one in runs.names.values() if one.name in contenders])
    rounds = [("time", *point) for point in points]
    if scene == runs.subject.scene and not open_only:
        rounds += [(CONTROL, *point) for point in [*points][:1]]
    for number in range(1, processes + 1):  # what drifts falls on all points alike
        for role, *point in rounds:
            runs.time(role, scene, *point, chosen[tuple(point)], number)


def near(table, error):
    """The points that meet an error in nearly the least time, and the fastest of another implementation."""
    found = meeting(table, error)
    return found[(found.time <= NEAR * found.time.min()) | found.index.isin(_others(found, 1))]


def _others(rows, count):
    """Index of the fastest points of `count` implementations beside the fastest one's."""
    return rows.drop_duplicates("implementation").index[1:count + 1]
