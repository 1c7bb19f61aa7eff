# What there is to draw: the elements that `mbs describe` lists; runs `mbs simulate` for the viewer, passing errors on.
import json
import math
import re
from collections import namedtuple
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from analysis.core.files import StudyError
from study.core import child
from study.core.executor import program_of

HIDDEN = "hidden"  # a point that the scene does not name and no element needs: not drawn
NO_PLACES = ("vector", HIDDEN)
COMMENTS = re.compile(r'("(?:[^"\\]|\\.)*")|//[^\n]*|/\*.*?\*/', re.DOTALL)  # and texts, which stay
STEPS = (1.25e-3, 1.25e-4, 1.25e-5, 1.25e-6)  # s; tried in this order until the run is right
STEPS_AT_MOST = 8000     # of an automatic step: 10 s of the first
SECONDS_AT_MOST = 60     # of computing, where the duration is not asked for
TRIAL_STEPS = 20
STEPS_OF_A_RUN = 1e8     # at most: mbs refuses more


Body = namedtuple("Body", "name points vectors")  # points and vectors: indices into Scene.points


@dataclass(frozen=True)
class Scene:
    name: str
    dimension: int
    points: list           # (name, kind: free, fixed, driven, vector, marker or HIDDEN)
    start: list            # their positions at t = 0, one row each, m
    rods: list             # pairs of points, and so is a distance, which is drawn like a rod
    bodies: list           # each a Body
    springs: list          # pairs of points
    torsion_springs: list  # pairs of directions, each from a point to a point
    outputs: list          # names of what the author asked for
    facts: str             # on its size, what the program says of it
    end: float             # s; driven motion is not known beyond
    scheme: str            # the form of the step that `mbs describe` takes


def from_description(description, name):
    """`description` is the object of `mbs describe --json`. Raises StudyError."""
    try:
        elements, dimension = description["elements"], int(description["dimension"])
        points = [(point["name"], point["kind"]) for point in elements["points"]]
        end = description["drivers_end"]
        helpers = [bool(point["helper"]) for point in elements["points"]]
        start = [[float(x) for x in point["position"]] for point in elements["points"]]
        index = {name: place for place, (name, _) in enumerate(points)}
        pairs = lambda elements: [[index[first], index[second]] for first, second in (one["between"] for one in elements)]
        rods = pairs(elements["rods"])
        rods += [link for link in pairs(elements["distances"]) if link not in rods and link[::-1] not in rods]
        springs = pairs(elements["springs"] + elements.get("force_laws", []))
        bodies = [Body(body["name"], [index[point] for point in body["points"]], [index[vector] for vector in body.get("vectors", [])])
                  for body in elements["bodies"]]
        torsion_springs = [tuple([index[name] for name in spring[side]] for side in ("from", "to"))
                           for kind in ("torsion_springs", "torque_laws") for spring in elements.get(kind, [])]
    except (KeyError, TypeError, ValueError) as error:
        raise StudyError(f"`mbs describe {name} --json` lacks something to draw ({error!r}): "
                         "is the program older than study/view? Build it again") from error
    used = {point for element in (*rods, *springs, *(body.points for body in bodies)) for point in element}
    points = [(name, HIDDEN if kind == "free" and helpers[place] and place not in used else kind) for place, (name, kind) in enumerate(points)]
    known = {"n = {}": "variables", "m = {}": "constraints", "degrees of freedom: {}": "degrees_of_freedom"}
    facts = ", ".join(text.format(description[key]) for text, key in known.items() if description.get(key) is not None)
    return Scene(name, dimension, points, start, rods, bodies, springs, torsion_springs, list(elements.get("outputs", [])), facts,
                 math.inf if end is None else float(end), description.get("scheme", {}).get("take", "penalty"))


def upward(path):
    """Of a scene file in space: the unit vector, of those along an axis, that points most against its gravity; y where it has none."""
    try:
        text = COMMENTS.sub(lambda found: found[1] or " ", Path(path).read_text(encoding="utf-8"))
        gravity = [float(x) for x in json.loads(text).get("gravity", [])]
    except (OSError, ValueError):
        gravity = []  # an expression, or no file of this kind: `mbs describe` says what is wrong with it
    axis = max(range(len(gravity)), key=lambda i: abs(gravity[i]), default=1)
    sign = -1 if gravity and gravity[axis] > 0 else 1
    return [sign * (i == axis) for i in range(3)] if any(gravity) else [0, 1, 0]


def simulate(place, scene, options, frames, csv, outputs, say):
    """Writes the trajectory `csv` of `scene`, which is at `place`, in about `frames` rows, and its outputs at the same times to `outputs`
    unless that is None; returns a line on what was run. A step or duration that is not given is chosen. `say` tells the user."""
    run = partial(_run, "simulate", place, "--implementation", options.implementation, "--scheme", scene.scheme)
    for step in (options.step,) if options.step else STEPS:
        duration = options.duration or _affordable(run, step, min(10.0, STEPS_AT_MOST * step, scene.end), say)
        say(f"simulating {duration:g} s in steps of {step:g} s with {options.implementation}, {scene.scheme} form")
        code, _, words = run("--step", repr(step), "--duration", repr(duration), "--trajectory", csv, "--every", _every(duration / step, frames),
                             *(["--output", outputs] if outputs else []))
        if code != 1 or options.step:
            break
        say(f"  {words[-1].strip() if words else 'without a word'}")
    if code != 0:
        ended = f"mbs simulate ended with {f'signal {-code}' if code < 0 else f'status {code}'}, without a word"
        raise StudyError((words[-1].strip() if words else ended) + ("" if options.step else " (choose a --step)" if code == 1 else ""))
    for line in words:  # warnings, and what is not accurate
        say(f"  {line}")
    return f"{options.implementation}, {scene.scheme} form, step {step:g} s"


def _every(steps, frames):
    """Write every so many steps: the fewest that make at most `frames` rows, better a divisor of `steps`, so that the last is written too."""
    steps = max(1, round(min(steps, STEPS_OF_A_RUN)))
    most = min(frames, steps)
    return next((steps // rows for rows in range(most, most // 2, -1) if steps % rows == 0), math.ceil(steps / frames))


def _affordable(run, step, duration, say):
    """`duration`, or as much of it as a trial says can be computed in SECONDS_AT_MOST."""
    code, out, _ = run("--step", repr(step), "--duration", repr(TRIAL_STEPS * step), "--json")
    if code != 0:
        return duration  # the run itself will say what is wrong
    seconds_a_step = json.loads(out)["step_us"]["median"] * 1e-6
    fits = SECONDS_AT_MOST / max(seconds_a_step, 1e-9) * step
    if fits >= duration:
        return duration
    fits = float(f"{max(fits, TRIAL_STEPS * step):.1g}")
    say(f"{duration:g} s would take about {duration / step * seconds_a_step / 60:.0f} minutes: only {fits:g} s of it (ask for more with --duration)")
    return fits


def _run(*words):
    """(exit status, standard output, lines of standard error)"""
    ended = child.run([program_of(), *map(str, words)])
    return ended.code, ended.stdout, [line for line in ended.stderr.splitlines() if line.strip()]
