"""Multibody simulations from Python: scenes, steppers, tables of a run. harness/python/README.md has examples."""
import math
import numbers
from concurrent.futures import ThreadPoolExecutor

from ._mbs import (BatchStepper, MultiplierUpdate, Precision, Projections, Refused, Saved, Scene, Scheme, StepOutcome,
                   Stepper, TangentReuse, Unsupported, __version__, _scenes, implementations)

__all__ = ["BatchStepper", "MultiplierUpdate", "Precision", "Projections", "Refused", "Saved", "Scene", "Scheme",
           "StepOutcome", "Stepper", "TangentReuse", "Unsupported", "__version__", "implementations", "simulate",
           "simulate_all"]


def simulate(scene, duration, implementation="auto", *, every=1, inputs=None, **settings):
    """The outputs of a run as a DataFrame over t, s.

    Rows: the start, then each `every`-th step. `inputs`: by name, one value a step (of force, torque, stiffness, damping or
    factor), or a row (value, rate, acceleration) a step: what moves a point or a constraint needs all three. `settings`
    are those of Stepper. The frame's attrs say who ran it and how many steps ended at the pass limit; rows are missing from
    where a step failed. Functions of time are checked for the first step only; beyond a table they go straight on.
    """
    import numpy
    import pandas

    stepper = Stepper(scene, implementation, **settings)
    steps = _steps(duration, stepper.dt)
    start = numpy.concatenate([[stepper.t], stepper.values])
    rows, at_limit = stepper.run(steps, every, None if inputs is None else _rows(stepper, inputs, steps))
    frame = pandas.DataFrame(numpy.vstack([start, rows]), columns=["t", *stepper.outputs]).set_index("t")
    frame.attrs.update(implementation=stepper.implementation, steps_at_limit=at_limit)
    return frame


def simulate_all(scenes, duration, implementation="auto", *, every=1, threads=1, lanes=8, **settings):
    """The outputs of a run of each scene, as one DataFrame over (scene, t): batches of `lanes` on `threads`.

    Outputs are not a number from where a step of a scene failed."""
    import pandas

    scenes = _scenes(scenes)
    for name, number in (("threads", threads), ("lanes", lanes)):
        if not isinstance(number, numbers.Integral) or number < 1:
            raise Refused(f"{name}: found {number!r}, allowed is 1 or more")
    batches = [scenes[first:first + lanes] for first in range(0, len(scenes), lanes)]

    def run(batch):
        stepper = BatchStepper(batch, implementation, **settings)
        rows = stepper.run(_steps(duration, stepper.dt), every)
        return [pandas.DataFrame(lane, columns=["t", *stepper.outputs]).set_index("t") for lane in rows]

    with ThreadPoolExecutor(threads) as pool:
        frames = [frame for batch in pool.map(run, batches) for frame in batch]
    return pandas.concat(frames, keys=range(len(frames)), names=["scene", "t"])


def _steps(duration, dt):
    if not isinstance(duration, numbers.Real) or not 0 <= duration < math.inf:
        raise Refused(f"duration: found {duration!r}, allowed is a number of seconds, 0 or more")
    if duration / dt > 2**53:
        raise Refused(f"duration: found {duration!r}, allowed are at most 2**53 steps of {dt!r} s")
    return round(duration / dt)


def _rows(stepper, inputs, steps):
    """(steps, inputs, 3), every input of the scene in its place."""
    import numpy

    if not hasattr(inputs, "keys"):
        raise Refused(f"inputs: found {type(inputs).__name__}, allowed is a dict by name")
    unknown = set(inputs) - set(stepper.inputs)
    if unknown:
        raise Refused(f"the scene has no input {sorted(unknown)}: there are {stepper.inputs}")
    missing = set(stepper.inputs) - set(inputs)
    if missing:
        raise Refused(f"inputs are missing: {sorted(missing)}")
    rows = numpy.zeros((steps, len(stepper.inputs), 3))
    for index, name in enumerate(stepper.inputs):
        try:
            given = numpy.asarray(inputs[name], dtype=float)
        except (TypeError, ValueError):
            raise Refused(f"input {name!r}: found no numbers, allowed are ({steps},) or ({steps}, 3) of them") from None
        if given.shape not in ((steps,), (steps, 3)):
            raise Refused(f"input {name!r} has shape {given.shape}: ({steps},) or ({steps}, 3) is needed")
        rows[:, index, :1 if given.ndim == 1 else 3] = given.reshape(steps, -1)
    return rows
