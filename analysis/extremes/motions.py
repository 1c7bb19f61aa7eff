# The exact motion of N-four-bars with any lengths, masses and start, and the scenes that have it; scenes that are more: springs, redundant rods.
#
# All rods are `length` long and parallel, so the mechanism has one angle phi from the upward vertical. A rod of mass m turns about its foot: m
# length^2 / 3 of inertia, weight at length / 2. A coupler of mass m moves with its ends without turning: m length^2, weight at length; how long it is
# does not matter. With the sums R of the rods' and C of the couplers' masses the energy is
#     length^2 (R/3 + C) phi'^2 / 2 + g length (R/2 + C) cos phi,
# hence phi'' = k sin phi, k = (g / length) (R/2 + C) / (R/3 + C): Eq. (9) of paper/README.md for equal masses.
# Multiplying all masses by one number leaves k; a length L stretches time by sqrt(L).
from dataclasses import dataclass

import numpy

from study.scenes.mechanics import GRAVITY
from study.scenes.references import turning

POINTS = 6      # of a chain, whose places are kept, at most: all of them up to five loops


class Motion:
    """A mechanism whose motion is known. `solutions(times)`, at some times: the motions that are possible, each {column of a trajectory: values};
    `document()`: its scene as JSON."""
    loops, shortest = 1, 1.0              # shortest: m, of its links
    truth, accuracy = "closed form", 0.0  # what `solutions` are; their error beside rounding, m

    columns = property(lambda self: tuple(self.solutions(numpy.zeros(1))[0]))  # of a trajectory: those that judge it

    def clearance(self, time):
        """How far it is from a change point, where anything may jump; 0 where nobody knows."""
        return 0.0


def fixed(name, x, y):
    return {"name": name, "position": [x, y], "fixed": True}


def rod(name, first, second, mass=1.0, length=1.0):
    return {"name": name, "between": [first, second], "mass": mass, "length": length}


@dataclass(frozen=True)
class Chain(Motion):
    loops: int
    length: float = 1.0         # m, of the rods
    gravity: float = GRAVITY
    rods: tuple = ()            # kg; empty: 1 kg each
    couplers: tuple = ()        # kg; empty: 1 kg each
    offset: float = 0.0         # m, of all x and y
    angle: float = 0.0          # rad, at t = 0
    rate: float = 1.0           # rad/s, at t = 0, not negative

    truth = "exact"
    shortest = property(lambda self: self.length)
    masses = property(lambda self: (self.rods or (1.0,) * (self.loops + 1), self.couplers or (1.0,) * self.loops))  # kg
    feet = property(lambda self: self.offset + self.length * numpy.arange(self.loops + 1))  # x of the ground points, m

    @property
    def k(self):
        rods, couplers = map(sum, self.masses)
        return self.gravity / self.length * (rods / 2 + couplers) / (rods / 3 + couplers)

    def solutions(self, times):
        sine, cosine, _ = turning(times, self.k, self.angle, self.rate)
        return [{f"B{i}.{axis}": values for i, foot in enumerate(self.feet) for axis, values in (
            ("x", foot + self.length * sine), ("y", self.offset + self.length * cosine))}]

    @property
    def columns(self):
        spread = numpy.linspace(0, self.loops, min(self.loops + 1, POINTS)).round().astype(int)
        return tuple(f"B{i}.{axis}" for i in spread for axis in "xy")

    def document(self):
        sine, cosine = (round(float(f(self.angle)), 15) for f in (numpy.sin, numpy.cos))
        speed, (rods, couplers) = self.length * self.rate, self.masses
        points = [point for i, foot in enumerate(map(float, self.feet)) for point in (
            fixed(f"A{i}", foot, self.offset),
            {"name": f"B{i}", "position": [foot + self.length * sine, self.offset + self.length * cosine],
             "velocity": [speed * cosine, -speed * sine]})]
        return {"gravity": [0.0, -self.gravity], "points": points, "rods": [
            *(rod(f"rod{i}", f"A{i}", f"B{i}", mass, self.length) for i, mass in enumerate(rods)),
            *(rod(f"coupler{i}", f"B{i}", f"B{i + 1}", mass, self.length) for i, mass in enumerate(couplers))]}


@dataclass(frozen=True)
class Flat(Chain):
    """One loop released with its rods on a line: two motions are possible. Either it swings as a parallelogram,
    or rod 0 lies still, as B0 is A1, and coupler and rod 1 swing about A1 as one (k = 3 g / (2 length))."""

    def solutions(self, times):
        [swing] = Chain(1, self.length, self.gravity, self.rods, (1e-300,), angle=self.angle, rate=0.0).solutions(times)
        still = {"B0.x": numpy.full_like(times, self.length), "B0.y": numpy.zeros_like(times), "B1.x": swing["B1.x"], "B1.y": swing["B1.y"]}
        return [*super().solutions(times), still]


def unlike_masses(loops, ratio):
    """Every second rod and every second coupler has `ratio` kg, the others 1 kg."""
    masses = tuple(ratio if i % 2 else 1.0 for i in range(loops + 1))
    return Chain(loops, rods=masses, couplers=masses[:-1])


def sprung_pendulum(stiffness):
    """A mass at the end of a rod, another on a spring behind it, released on a horizontal line: nothing pulls
    then, so that a stiff spring starts without vibration."""
    return {"points": [fixed("A", 0, 0), {"name": "B", "position": [1, 0]}, {"name": "C", "position": [2, 0]}],
            "gravity": [0.0, -GRAVITY],
            "rods": [rod("rod", "A", "B", mass=0)],
            "masses": [{"point": "B", "mass": 1.0}, {"point": "C", "mass": 1.0}],
            "springs": [{"name": "spring", "between": ["B", "C"], "stiffness": stiffness, "length": 1.0}]}


def twin_rod(same_points):
    """One loop whose first rod is there twice; the second has a foot of its own at the same place, or not."""
    document = Chain(1).document()
    document["points"] += [] if same_points else [fixed("A", 0, 0)]
    document["rods"].append(rod("twin", "A0" if same_points else "A", "B0", mass=0))
    return document


def shifted_rod(shift):
    """One loop with a third rod, massless, `shift` m beside the first: nearly redundant."""
    document = Chain(1).document()
    document["rods"] = [rod for rod in document["rods"] if rod["name"] != "coupler0"]
    document["bodies"] = [{"name": "coupler0", "mass": 1.0, "centre": [0.5, 0], "inertia": 1 / 12,
                           "points": {"B0": [0, 0], "C": [shift, 0], "B1": [1, 0]}}]
    document["points"].append(fixed("A", shift, 0))
    document["rods"].append(rod("third", "A", "C", mass=0))
    return document
