# More mechanisms whose motion is known: with a light part, with speeds that do not agree, and the standard problems.
from collections import namedtuple
from dataclasses import dataclass

import numpy

from analysis.extremes.linkages import Dyad, Linkage, Side
from analysis.extremes.motions import GRAVITY, Chain, Motion, fixed, rod, shifted_rod, twin_rod
from study.scenes.mechanics import double_pendulum, integrate
from study.scenes.references import CLOSED, solution


def _of_rods(motion, *rods):
    """The scene of rods that hang from A, at rest where a motion of B and C begins."""
    at = {key: float(values[0]) for key, values in motion.solutions(numpy.zeros(1))[0].items()}
    return {"gravity": [0.0, -GRAVITY], "points": [
        fixed("A", 0, 0), *({"name": name, "position": [at[f"{name}.x"], at[f"{name}.y"]]} for name in "BC")], "rods": list(rods)}


class LightEnd(namedtuple("LightEnd", "mass"), Motion):
    """A double pendulum of two rods of 1 m, the upper one of 1 kg, the lower one of `mass` kg, released at rest on a line."""
    truth, accuracy = "equations of its own, integrated", 1e-8
    start = 1.0  # rad

    def solutions(self, times):
        a, b, _, _ = integrate(double_pendulum((1, 1), (1, self.mass)), times, [self.start, self.start, 0, 0])
        x, y = numpy.sin(a), -numpy.cos(a)
        return [{"B.x": x, "B.y": y, "C.x": x + numpy.sin(b), "C.y": y - numpy.cos(b)}]

    def document(self):
        return _of_rods(self, rod("upper", "A", "B"), rod("lower", "B", "C", self.mass))


class Damped(namedtuple("Damped", "damping"), Motion):
    """A rod of 1 m and 1 kg that turns about its foot without gravity and is braked in proportion to its rate; damping: N m s/rad."""
    start, rate = 0.3, 3.0  # rad, rad/s

    def solutions(self, times):
        decay = 3 * self.damping  # over the inertia
        angle = self.start - self.rate * numpy.expm1(-decay * times) / decay
        return [{"B.x": numpy.cos(angle), "B.y": numpy.sin(angle)}]

    def document(self):
        x, y = numpy.cos(self.start), numpy.sin(self.start)
        return {"gravity": [0.0, 0.0], "rods": [rod("rod", "A", "B")],
                "points": [fixed("A", 0, 0), fixed("X", 1, 0), {"name": "B", "position": [x, y], "velocity": [-self.rate * y, self.rate * x]}],
                "torsion_springs": [{"name": "brake", "from": ["A", "X"], "to": ["A", "B"], "stiffness": 0.0, "damping": self.damping, "angle": 1.0}]}


class TwoPendulums(namedtuple("TwoPendulums", "mass"), Motion):
    """Two rods that have nothing to do with each other, of 1 m and 1 kg and of 0.5 m and `mass`, released at rest."""
    shortest = 0.5

    def solutions(self, times):
        found = {}
        for name, length, angle in (("B", 1.0, 2.0), ("C", 0.5, 1.2)):  # one rod alone: as good as no coupler, nor a second rod
            [one] = Chain(1, length, rods=(1.0, 1.0), couplers=(1e-300,), angle=angle, rate=0.0).solutions(times)
            found |= {f"{name}.{axis}": one[f"B0.{axis}"] for axis in "xy"}
        return [found]

    def document(self):
        return _of_rods(self, rod("heavy", "A", "B"), rod("light", "A", "C", self.mass, 0.5))


class Beside(namedtuple("Beside", "small"), Motion):
    """A motion, and a rod of 1 m that swings and has nothing to do with it."""
    truth, accuracy, shortest, solutions, clearance = (property(lambda self, name=name: getattr(self.small, name)) for name in (
        "truth", "accuracy", "shortest", "solutions", "clearance"))

    def document(self):
        found = self.small.document()
        return found | {"rods": [*found["rods"], rod("large", "P", "Q")], "points": [
            *found["points"], fixed("P", 3, 0), {"name": "Q", "position": [4, 0], "velocity": [0.0, 2.0]}]}


@dataclass(frozen=True)
class Uneven(Chain):
    """One loop with a redundant rod whose second crank is given a speed greater by a share. The least change, weighted with
    the masses, makes it the mean of both."""
    share: float = 0.0
    same_points: bool | None = None  # of the redundant rod, as in twin_rod; None: a third crank in the middle

    def solutions(self, times):
        return Chain(1, rate=1 + self.share / 2).solutions(times)

    def document(self):
        document = shifted_rod(0.5) if self.same_points is None else twin_rod(self.same_points)
        [point] = [point for point in document["points"] if point["name"] == "B1"]
        point["velocity"] = [value * (1 + self.share) for value in point["velocity"]]
        return document


class TwoDrives(namedtuple("TwoDrives", "share"), Motion):
    """A parallelogram whose cranks are both driven, the second one faster and faster: it can obey neither, one, or something between.
    share: rad/s^2."""
    shortest = 0.5
    linkage = Linkage((("A", (0.0, 0.0)), ("D", (1.0, 0.0))), 0.5, (Dyad("C", ("B", "D"), (1.0, 0.5), Side(1, 0.0)),))

    def solutions(self, times):
        both = [self.linkage.at(self.linkage.start + times + share * times**2) for share in (0.0, self.share)]
        return [{f"{name}.{axis}": at[name][i] for name in "BC" for i, axis in enumerate("xy")} for at in both]

    def document(self):
        found = self.linkage.document()
        return found | {"constraints": [*found["constraints"], {
            "name": "second drive", "type": "angle", "first": ["A", "Ax"], "second": ["D", "C"], "value": {"polynomial": [self.linkage.start, 1.0, self.share]}}]}


class Standard(namedtuple("Standard", "known"), Motion):
    """A standard problem with a reference that `mbs` has no part in: of study/scenes/references.py."""
    truth = property(lambda self: "closed form" if self.known in CLOSED else "equations of its own, integrated")
    accuracy = property(lambda self: 0.0 if self.known in CLOSED else 1e-8)

    def solutions(self, times):
        return [{column: values for column, values in solution(self.known, tuple(times)).items() if column.endswith((".x", ".y", ".z"))}]
