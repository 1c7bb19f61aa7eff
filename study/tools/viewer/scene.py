# What there is to draw: the elements that `mbs describe SCENE --json` lists.
import json
import math
import re
from dataclasses import dataclass
from pathlib import Path

from analysis.core.errors import StudyError

KINDS = ("free", "fixed", "driven", "vector", "marker")
HIDDEN = "hidden"  # a point that the scene does not name and no element needs: not drawn
NO_PLACES = ("vector", HIDDEN)
COMMENTS = re.compile(r'("(?:[^"\\]|\\.)*")|//[^\n]*|/\*.*?\*/', re.DOTALL)  # and texts, which stay


@dataclass
class Body:
    name: str
    points: list  # indices into Scene.points
    vectors: list


@dataclass
class Scene:
    """Points are (name, kind); `start` has their positions at t = 0, one row each, m. Rods and springs are pairs of points, and so is a
    distance, which is drawn like a rod; torsion springs are pairs of directions, each from a point to a point."""
    name: str
    dimension: int
    points: list
    start: list
    rods: list
    bodies: list
    springs: list
    torsion_springs: list
    outputs: list  # names of what the author asked for
    facts: str     # on its size, what the program says of it
    end: float     # s; driven motion is not known beyond
    scheme: str    # the form of the step that `mbs describe` takes


def from_description(description, name):
    """`description` is the object of `mbs describe --json`. Raises StudyError."""
    try:
        elements, dimension = description["elements"], int(description["dimension"])
        points = [(point["name"], point["kind"]) for point in elements["points"]]
        end = description["drivers_end"]
        helpers = [bool(point["helper"]) for point in elements["points"]]
        start = [[float(x) for x in point["position"]] for point in elements["points"]]
        index = {name: place for place, (name, _) in enumerate(points)}
        rods = _pairs(index, elements["rods"])
        rods += [link for link in _pairs(index, elements["distances"]) if link not in rods and link[::-1] not in rods]
        springs = _pairs(index, elements["springs"] + elements.get("force_laws", []))
        bodies = [Body(body["name"], [index[point] for point in body["points"]], [index[vector] for vector in body.get("vectors", [])])
                  for body in elements["bodies"]]
        torsion_springs = [tuple([index[name] for name in spring[side]] for side in ("from", "to"))
                           for kind in ("torsion_springs", "torque_laws") for spring in elements.get(kind, [])]
    except (KeyError, TypeError, ValueError) as error:
        raise StudyError(f"`mbs describe {name} --json` lacks something to draw ({error!r}): "
                         "is the program older than study/view? Build it again") from error
    unknown = sorted({kind for _, kind in points} - set(KINDS))
    if dimension not in (2, 3) or unknown or any(len(row) != dimension for row in start):
        raise StudyError(f"`mbs describe {name} --json` gives dimension {dimension} and kinds of "
                         f"points {', '.join(unknown) or 'known'}: its points do not fit")
    used = {point for element in (*rods, *springs, *(body.points for body in bodies)) for point in element}
    points = [(name, HIDDEN if kind == "free" and helpers[place] and place not in used else kind) for place, (name, kind) in enumerate(points)]
    known = {"n = {}": "variables", "m = {}": "constraints", "degrees of freedom: {}": "degrees_of_freedom"}
    facts = ", ".join(text.format(description[key]) for text, key in known.items() if description.get(key) is not None)
    return Scene(name, dimension, points, start, rods, bodies, springs, torsion_springs, list(elements.get("outputs", [])), facts,
                 math.inf if end is None else float(end), description.get("scheme", {}).get("take", "penalty"))


def _pairs(index, elements):
    return [[index[first], index[second]] for first, second in (one["between"] for one in elements)]


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
