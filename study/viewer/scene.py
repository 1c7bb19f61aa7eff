# What there is to draw: the elements that `mbs describe SCENE --json` lists.
import math
from dataclasses import dataclass, field

from study.pipeline.errors import StudyError

KINDS = ("free", "fixed", "driven", "vector", "marker")


@dataclass
class Element:
    """A rod, a spring (two points) or a body; indices into Scene.points."""
    name: str
    points: list
    vectors: list = field(default_factory=list)


@dataclass
class Scene:
    """Points are (name, kind); `start` has their positions at t = 0, one row each, m."""
    name: str
    dimension: int
    points: list
    start: list
    rods: list
    bodies: list
    springs: list
    facts: str
    end: float = math.inf  # s; driven motion is not known beyond


def from_description(description, name):
    """`description` is the object of `mbs describe --json`. Raises StudyError."""
    try:
        elements, dimension = description["elements"], int(description["dimension"])
        points = [(point["name"], point["kind"]) for point in elements["points"]]
        start = [[float(x) for x in point["position"]] for point in elements["points"]]
        index = {name: place for place, (name, _) in enumerate(points)}
        rods = [_pair(index, rod) for rod in elements["rods"]]
        springs = [_pair(index, spring) for spring in elements["springs"]]
        bodies = [Element(body["name"], [index[point] for point in body["points"]],
                          [index[vector] for vector in body.get("vectors", [])])
                  for body in elements["bodies"]]
    except (KeyError, TypeError, ValueError) as error:
        raise StudyError(f"`mbs describe {name} --json` lacks something to draw ({error!r}): "
                         "is the program older than study/view? Build it again") from error
    unknown = sorted({kind for _, kind in points} - set(KINDS))
    if dimension not in (2, 3) or unknown or any(len(row) != dimension for row in start):
        raise StudyError(f"`mbs describe {name} --json` gives dimension {dimension} and kinds of "
                         f"points {', '.join(unknown) or 'known'}: its points do not fit")
    end = description.get("drivers_end")
    return Scene(name, dimension, points, start, rods, bodies, springs, _facts(description),
                 math.inf if end is None else float(end))


def _pair(index, element):
    a, b = element["between"]
    return Element(element.get("name", ""), [index[a], index[b]])


def _facts(description):
    """One line on the size of the scene; what the program does not say is left out."""
    names = (("variables", "coordinate"), ("constraints", "constraint"),
             ("degrees_of_freedom", "degree of freedom"))
    plurals = {"degree of freedom": "degrees of freedom"}
    counts = [(description.get(key), name) for key, name in names]
    return ", ".join(f"{count} {name if count == 1 else plurals.get(name, name + 's')}"
                     for count, name in counts if count is not None)
