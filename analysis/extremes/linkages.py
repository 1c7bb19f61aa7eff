# Planar linkages of one freedom whose motion is known: a crank, then points that follow one after the other.
#
# Each point is where two loci meet; `side` says at which of their two meetings. As long as a linkage does not come to the place
# where both meetings are one, its change point, the side stays what it was. That is the closed form.
from collections import namedtuple
from dataclasses import dataclass
from functools import cache

import numpy
from scipy.interpolate import CubicHermiteSpline

from analysis.extremes.motions import Motion, fixed, rod

IMAGINARY = 1e-30  # step along the imaginary axis: a derivative without rounding
CELLS = 4096       # of a quadrature, in a turn at least


def _across(at):
    return numpy.array([-at[1], at[0]])


def _unit(at):
    return at / numpy.sqrt((at * at).sum(axis=0))


class Side(namedtuple("Side", "sign turn", defaults=(1, None))):
    """+1 or -1; with `turn`, the sign changes wherever sin(crank - turn) does: a passage of change points."""
    def at(self, angle):
        return self.sign if self.turn is None else self.sign * numpy.where(numpy.sin(numpy.real(angle) - self.turn) < 0, -1, 1)


class Follower:
    """What a point adds: `joined`, (end, length) of each of its links, rods of 1 kg; the point that 1 kg is at; further lists of the scene."""
    joined, load, lists = (), None, {}
    links = property(lambda self: [(f"{end}-{self.name}", (end, self.name), length) for end, length in self.joined])

    def clearance(self, at):
        """How far it is from its change point: for instance the sine of the angle between two links."""
        return 1.0


class Dyad(namedtuple("Dyad", "name ends lengths side", defaults=(Side(),)), Follower):
    """A point at a distance from each of two others, on the left of the way from the first to the second if side is +1."""
    joined = property(lambda self: zip(self.ends, self.lengths))

    def place(self, at, angle):
        (first, second), (r, s) = (at[end] for end in self.ends), self.lengths
        way = second - first
        far = numpy.sqrt((way * way).sum(axis=0))
        area = numpy.sqrt((far + r + s) * (r + s - far) * (far + r - s) * (far + s - r))  # four times the triangle's
        return first + ((far * far + (r - s) * (r + s)) * way + self.side.at(angle) * area * _across(way)) / (2 * far * far)

    def clearance(self, at):
        first, second = (at[end] - at[self.name] for end in self.ends)
        return abs((_across(first) * second).sum(axis=0)) / (self.lengths[0] * self.lengths[1])


class Slider(namedtuple("Slider", "name end length foot side", defaults=(Side(),)), Follower):
    """A point of 1 kg on the line through `foot` along x, at a distance from another; ahead of that if side is +1."""
    load = property(lambda self: self.name)
    joined = property(lambda self: [(self.end, self.length)])
    lists = property(lambda self: {"masses": [{"point": self.name, "mass": 1.0}], "constraints": [
        {"name": "slides", "type": "on_line", "point": self.name, "line": [self.foot, f"{self.foot}x"]}]})

    def place(self, at, angle):
        (x, y), level = at[self.end], at[self.foot][1]
        return numpy.array([x + self.side.at(angle) * numpy.sqrt((self.length - level + y) * (self.length + level - y)), level])

    def clearance(self, at):
        return abs(at[self.name][0] - at[self.end][0]) / self.length


class Swing(namedtuple("Swing", "name foot through length"), Follower):
    """The end of a link that turns about `foot`, on whose line another point slides."""
    joined = property(lambda self: [(self.foot, self.length)])
    lists = property(lambda self: {"constraints": [{"name": "slides", "type": "on_line", "point": self.through, "line": [self.foot, self.name]}]})

    def place(self, at, angle):
        return at[self.foot] + self.length * _unit(at[self.through] - at[self.foot])

    def clearance(self, at):
        return numpy.hypot(*(at[self.through] - at[self.foot])) / self.length


class Plate(namedtuple("Plate", "name ends along up"), Follower):
    """A point that is fixed to the link between two others, `along` it and `up` from it."""

    def place(self, at, angle):
        way = _unit(at[self.ends[1]] - at[self.ends[0]])
        return at[self.ends[0]] + self.along * way + self.up * _across(way)


class Wheel(namedtuple("Wheel", "name load radius", defaults=(0.3,)), Follower):
    """A point of a wheel that turns about another point, its centre: nothing turns it, so that it keeps its direction."""
    lists = property(lambda self: {"bodies": [{"name": "wheel", "mass": 1.0, "inertia": self.radius**2 / 2,
                                               "points": {self.load: [0, 0], self.name: [self.radius, 0]}}]})

    def place(self, at, angle):
        return at[self.load] + numpy.array([[self.radius], [0.0]])


@dataclass(frozen=True)
class Linkage(Motion):
    feet: tuple            # (name, (x, y)); the first one is the crank's
    crank: float           # m
    followers: tuple
    start: float = 1.0     # rad, of the crank ...
    rate: float = 1.0      # ... and rad/s, of a driven one always
    driven: bool = True
    gravity: float = 0.0
    finest: float = 1.0    # rad of the crank, in which something turns over
    carried: float = 0.0   # m/s, along x, of all feet

    truth = property(lambda self: "closed form" if self.driven else "closed form, its time by quadrature")
    accuracy = property(lambda self: 0.0 if self.driven else 1e-7)
    points = property(lambda self: ["B", *(one.name for one in self.followers)])
    links = property(lambda self: [("crank", (self.feet[0][0], "B"), self.crank), *(link for one in self.followers for link in one.links)])
    shortest = property(lambda self: min(length for _, _, length in self.links))
    columns = property(lambda self: tuple(f"{name}.{axis}" for name in self.points for axis in "xy"))

    def at(self, angle):
        """{point: (x, y)} at crank angles."""
        found = {name: numpy.array(place)[:, None] + 0 * angle for name, place in self.feet}
        found["B"] = found[self.feet[0][0]] + self.crank * numpy.array([numpy.cos(angle), numpy.sin(angle)])
        for one in self.followers:
            found[one.name] = one.place(found, angle)
        return found

    def angles(self, times):
        return self.start + self.rate * times if self.driven else _turned(self, float(max(1.0, numpy.ceil(times[-1]))))(times)

    def solutions(self, times):
        at, way = self.at(self.angles(times)), self.carried * times
        return [{f"{name}.{axis}": at[name][i] + way * (axis == "x") for name in self.points for i, axis in enumerate("xy")}]

    def clearance(self, time):
        """From its nearest change point: the least of its points'."""
        at = self.at(self.angles(numpy.array([time])))
        return min((float(numpy.min(one.clearance(at))) for one in self.followers), default=1.0)

    def energy(self, angle):
        """(I, V): the kinetic energy is I rate^2 / 2."""
        at = self.at(angle + 1j * IMAGINARY)
        inertia = potential = 0 * angle
        for a, b in (*(ends for _, ends, _ in self.links), *((one.load, one.load) for one in self.followers if one.load)):
            u, w = (at[end].imag / IMAGINARY for end in (a, b))
            inertia = inertia + (u * u + u * w + w * w).sum(axis=0) / 3
            potential = potential + self.gravity * (at[a][1].real + at[b][1].real) / 2
        return inertia, potential

    def _foot(self, name, x, y):
        return {"name": name, "position": [x, y], "driven": {"x": {"polynomial": [x, self.carried]}, "y": y}} if self.carried else fixed(name, x, y)

    def document(self):
        at = self.at(numpy.array([self.start + 1j * IMAGINARY]))
        plates = {one.ends: one for one in self.followers if isinstance(one, Plate)}
        lines = {*[self.feet[0][0]] * self.driven, *(one.foot for one in self.followers if isinstance(one, Slider))}
        found = {"gravity": [0.0, -self.gravity], "rods": [], "bodies": [], "masses": [], "constraints": [], "points": [
            *(self._foot(name, x, y) for name, (x, y) in self.feet),
            *(self._foot(f"{name}x", x + 1.0, y) for name, (x, y) in self.feet if name in lines),
            *({"name": name, "position": [float(x) for x in at[name].real[:, 0]],
               "velocity": [float(x) * self.rate / IMAGINARY + way for x, way in zip(at[name].imag[:, 0], (self.carried, 0.0))]} for name in self.points)]}
        for name, ends, length in self.links:
            if plate := plates.get(ends):
                found["bodies"].append({"name": name, "mass": 1.0, "centre": [length / 2, 0], "inertia": length**2 / 12, "points": {
                    ends[0]: [0, 0], ends[1]: [length, 0], plate.name: [plate.along, plate.up]}})
            else:
                found["rods"].append(rod(name, *ends, length=length))
        for one in self.followers:
            for key, more in one.lists.items():
                found[key] += more
        if self.driven:
            foot = self.feet[0][0]
            found["constraints"].append({"name": "drive", "type": "angle", "first": [foot, f"{foot}x"], "second": [foot, "B"],
                                         "value": {"polynomial": [self.start, self.rate]}})
        return {key: value for key, value in found.items() if value}


@cache
def _turned(linkage, end):
    """The angle of a free crank over time until `end`: dt = sqrt(I / 2(E - V)) d angle, by Gauss' rule of four points in each of many cells."""
    sign, (inertia, potential) = numpy.sign(linkage.rate), linkage.energy(numpy.array([linkage.start]))
    total = inertia[0] * linkage.rate**2 / 2 + potential[0]

    def slowness(angle):
        inertia, potential = linkage.energy(angle)
        return numpy.sqrt(inertia / (2 * (total - potential)))
    width = min(2 * numpy.pi / CELLS, linkage.finest / 4)
    nodes, weights = numpy.polynomial.legendre.leggauss(4)
    angles, clock = [linkage.start], [0.0]
    while clock[-1] < end:
        edges = angles[-1] + sign * width * numpy.arange(CELLS + 1)
        took = slowness((edges[:-1, None] + sign * width * (nodes + 1) / 2).ravel()).reshape(-1, 4) @ weights * width / 2
        clock += list(clock[-1] + numpy.cumsum(took))
        angles += list(edges[1:])
    return CubicHermiteSpline(clock, angles, sign / slowness(numpy.array(angles)))
