# Planar linkages of one degree of freedom whose motion is known: a crank, then points that follow one after the other.
#
# Each point is where two loci meet; `side` says at which of their two meetings it is. As long as a linkage does not come
# to the place where both meetings are one (its change point) the side stays what it was: that is the closed form.
from dataclasses import dataclass
from functools import lru_cache

import numpy
from scipy.interpolate import CubicHermiteSpline

from analysis.extremes.motions import GRAVITY

BRANCHING = 1e-30  # of a complex step: the derivative without rounding
CELLS = 4096       # of a quadrature, in a turn at least


def _unit(at):
    return at / numpy.sqrt((at * at).sum(axis=0))


def _across(at):
    return numpy.array([-at[1], at[0]])


@dataclass(frozen=True)
class Side:
    """+1 or -1, with a change of sign wherever sin(crank - turn) changes it: a passage through a change point."""
    sign: int = 1
    turn: float | None = None

    def at(self, angle):
        return self.sign if self.turn is None else self.sign * numpy.where(numpy.sin(numpy.real(angle) - self.turn) < 0, -1, 1)


@dataclass(frozen=True)
class Dyad:
    """A point at a distance from each of two others, on the left of the way from the first to the second if side is +1."""
    name: str
    ends: tuple
    lengths: tuple
    side: Side = Side()

    def place(self, at, angle):
        (first, second), (r, s) = (at[end] for end in self.ends), self.lengths
        way = second - first
        far = numpy.sqrt((way * way).sum(axis=0))
        square = (far + r + s) * (r + s - far) * (far + r - s) * (far + s - r)  # 16 area^2
        return first + ((far * far + (r - s) * (r + s)) * way + self.side.at(angle) * numpy.sqrt(square) * _across(way)) / (2 * far * far)

    links = property(lambda self: [(f"{end}-{self.name}", (end, self.name)) for end in self.ends])

    def more(self):
        return {}


@dataclass(frozen=True)
class Slider:
    """A point on the line through `foot` along x, at a distance from another; ahead of it if side is +1."""
    name: str
    end: str
    length: float
    foot: str
    side: Side = Side()

    def place(self, at, angle):
        end, y = at[self.end], at[self.foot][1]
        up = y - end[1]
        ahead = self.side.at(angle) * numpy.sqrt((self.length - up) * (self.length + up))
        return numpy.array([end[0] + ahead, y + 0 * end[0]])

    links = property(lambda self: [(f"{self.end}-{self.name}", (self.end, self.name))])

    def more(self):
        return {"masses": [{"point": self.name, "mass": 1.0}],
                "constraints": [{"name": f"{self.name} slides", "type": "on_line", "point": self.name, "line": [self.foot, f"{self.foot}x"]}]}


@dataclass(frozen=True)
class Swing:
    """The end of a link that turns about `foot` and on whose line another point slides; on the side of it if side is +1."""
    name: str
    foot: str
    through: str
    length: float
    side: Side = Side()

    def place(self, at, angle):
        return at[self.foot] + self.side.at(angle) * self.length * _unit(at[self.through] - at[self.foot])

    links = property(lambda self: [(f"{self.foot}-{self.name}", (self.foot, self.name))])

    def more(self):
        return {"constraints": [{"name": f"{self.through} slides", "type": "on_line", "point": self.through, "line": [self.foot, self.name]}]}


@dataclass(frozen=True)
class Plate:
    """A point that is fixed to the link between two others: `along` it and `up` from it, from the first."""
    name: str
    ends: tuple
    along: float
    up: float

    def place(self, at, angle):
        way = _unit(at[self.ends[1]] - at[self.ends[0]])
        return at[self.ends[0]] + self.along * way + self.up * _across(way)

    links = ()

    def more(self):
        return {}


@dataclass(frozen=True)
class Linkage:
    feet: tuple                 # (name, (x, y)); the first one is the crank's
    crank: float                # m
    followers: tuple            # Dyad, Slider, Swing, Plate
    start: float = 1.0          # rad, of the crank ...
    rate: float = 1.0           # ... and rad/s, of a driven one always
    driven: bool = True
    gravity: float = 0.0
    finest: float = 1.0         # of a free one: what is small in it, rad

    loops = 1

    @property
    def truth(self):
        return "closed form" if self.driven else "closed form, time by quadrature"

    @property
    def accuracy(self):
        return 0.0 if self.driven else 1e-7

    def at(self, angle):
        """{point: (x, y)} at crank angles."""
        found = {name: numpy.array(place)[:, None] + 0 * angle for name, place in self.feet}
        found["B"] = found[self.feet[0][0]] + self.crank * numpy.array([numpy.cos(angle), numpy.sin(angle)])
        for one in self.followers:
            found[one.name] = one.place(found, angle)
        return found

    @property
    def links(self):
        return [("crank", (self.feet[0][0], "B")), *(link for one in self.followers for link in one.links)]

    @property
    def points(self):
        return ["B", *(one.name for one in self.followers)]

    @property
    def shortest(self):
        at = self.at(numpy.array([self.start]))
        return float(min(numpy.hypot(*(at[b] - at[a]))[0] for _, (a, b) in self.links))

    def columns(self, most):
        return tuple(f"{name}.{axis}" for name in self.points for axis in "xy")

    def angles(self, times):
        times = numpy.asarray(times, dtype=float)
        return self.start + self.rate * times if self.driven or not len(times) else _turned(self, float(numpy.ceil(times[-1])))(times)

    def energy(self, angle):
        """(I, V): kinetic energy is I rate^2 / 2."""
        at = self.at(angle + 1j * BRANCHING)
        inertia = potential = 0 * angle.real
        for a, b in [ends for _, ends in self.links] + [(one.name, one.name) for one in self.followers if isinstance(one, Slider)]:
            u, w = (at[end].imag / BRANCHING for end in (a, b))
            inertia = inertia + (u * u + u * w + w * w).sum(axis=0) / 3
            potential = potential + self.gravity * (at[a][1].real + at[b][1].real) / 2
        return inertia, potential

    def solutions(self, times):
        at = self.at(self.angles(times))
        return [{f"{name}.{axis}": at[name][i] for name in self.points for i, axis in enumerate("xy")}]

    def document(self):
        angle = numpy.array([self.start])
        at = {name: [float(x[0]) for x in place] for name, place in self.at(angle).items()}
        turn = {name: [float(x[0].imag / BRANCHING * self.rate) for x in place] for name, place in self.at(angle + 1j * BRANCHING).items()}
        plates = {one.ends: one for one in self.followers if isinstance(one, Plate)}
        lines = [one.foot for one in self.followers if isinstance(one, Slider)]
        foot = self.feet[0]
        found = {"gravity": [0.0, -self.gravity], "rods": [], "bodies": [],
                 "points": [*({"name": name, "position": list(place), "fixed": True} for name, place in self.feet),
                            *({"name": f"{name}x", "position": [dict(self.feet)[name][0] + 1.0, dict(self.feet)[name][1]], "fixed": True} for name in lines),
                            {"name": "X", "position": [foot[1][0] + 1.0, foot[1][1]], "fixed": True},
                            *({"name": name, "position": at[name], "velocity": turn[name]} for name in self.points)],
                 "masses": [], "constraints": []}
        for name, ends in self.links:
            length = float(numpy.hypot(*(numpy.array(at[ends[1]]) - at[ends[0]])))
            length = self._length(ends, length)
            if ends in plates:
                one = plates[ends]
                found["bodies"].append({"name": name, "mass": 1.0, "centre": [length / 2, 0], "inertia": length**2 / 12,
                                        "points": {ends[0]: [0, 0], ends[1]: [length, 0], one.name: [one.along, one.up]}})
            else:
                found["rods"].append({"name": name, "between": list(ends), "mass": 1.0, "length": length})
        for one in self.followers:
            for key, more in one.more().items():
                found[key] += more
        if self.driven:
            found["constraints"].append({"name": "drive", "type": "angle", "first": [foot[0], "X"], "second": [foot[0], "B"],
                                         "value": {"polynomial": [self.start, self.rate]}})
        else:
            del found["points"][len(self.feet) + len(lines)]
        return {key: value for key, value in found.items() if value}

    def _length(self, ends, measured):
        """As it is given: what was measured differs by rounding."""
        for one in self.followers:
            known = dict(zip([link[1] for link in one.links], getattr(one, "lengths", (getattr(one, "length", None),))))
            if ends in known:
                return known[ends]
        return self.crank if ends[1] == "B" else measured


@lru_cache(maxsize=64)
def _turned(linkage, end):
    """The angle of a free crank over time until `end`: dt = sqrt(I / 2(E - V)) d angle, by Gauss' rule of four points in each
    of many cells."""
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
