# Mechanisms that are no chain of four-bars and whose motion is known: near-singular and with a light end.
from dataclasses import dataclass

import numpy
from scipy.integrate import solve_ivp

from analysis.extremes.motions import GRAVITY


@dataclass(frozen=True)
class DragLink:
    """A four-bar with links of 1 m on a ground that is shorter by `gap`, whose crank turns evenly through its ground
    line. Its two assemblies never meet; on that line they are `gap` from each other, and the rocker turns over."""
    gap: float

    loops, truth, accuracy = 1, "exact", 0.0
    start, rate = numpy.pi / 2, -1.0  # of the crank, rad and rad/s

    def columns(self, most):
        return "B0.x", "B0.y", "B1.x", "B1.y"

    def solutions(self, times):
        angle = self.start + self.rate * numpy.asarray(times, dtype=float)
        x, y = numpy.cos(angle), numpy.sin(angle)
        # From B0 to A1. Near the ground line 1 - gap - cos(angle) is made of small numbers.
        along, up = 2 * numpy.sin(angle / 2)**2 - self.gap, -y
        square = along**2 + up**2
        aside = numpy.sqrt((1 - square / 4) / square)
        return [{"B0.x": x, "B0.y": y, "B1.x": x + along / 2 - aside * up, "B1.y": y + up / 2 + aside * along}]

    def document(self):
        at = {key: float(values[0]) for key, values in self.solutions([0.0])[0].items()}
        return {"points": [{"name": "A0", "position": [0, 0], "fixed": True}, {"name": "X", "position": [2, 0], "fixed": True},
                           {"name": "A1", "position": [1 - self.gap, 0], "fixed": True},
                           *({"name": name, "position": [at[f"{name}.x"], at[f"{name}.y"]]} for name in ("B0", "B1"))],
                "rods": [{"name": name, "between": ends, "mass": 1.0, "length": 1.0} for name, ends in (
                    ("crank", ["A0", "B0"]), ("coupler", ["B0", "B1"]), ("rocker", ["A1", "B1"]))],
                "constraints": [{"name": "drive", "type": "angle", "first": ["A0", "X"], "second": ["A0", "B0"],
                                 "value": {"polynomial": [self.start, self.rate]}}]}


@dataclass(frozen=True)
class LightEnd:
    """A double pendulum of two rods of 1 m, the upper one of 1 kg, released at rest on a line. Its two equations of
    motion in the angles from the downward vertical, that of the lower rod divided by its mass, are integrated."""
    mass: float                 # kg, of the lower rod

    loops, truth, accuracy = 1, "equations of its own, integrated", 1e-8
    start, tolerance = 1.0, 1e-12  # rad

    def columns(self, most):
        return "B.x", "B.y", "C.x", "C.y"

    def solutions(self, times):
        def derivative(_, state):
            a, b, da, db = state
            sine, cosine = numpy.sin(a - b), numpy.cos(a - b)
            matrix = [[1 / 3 + self.mass, self.mass / 2 * cosine], [cosine / 2, 1 / 3]]
            return [da, db, *numpy.linalg.solve(matrix, [
                -self.mass / 2 * sine * db**2 - GRAVITY * (1 / 2 + self.mass) * numpy.sin(a),
                sine / 2 * da**2 - GRAVITY / 2 * numpy.sin(b)])]
        times = numpy.asarray(times, dtype=float)
        if not len(times):
            return [dict.fromkeys(self.columns(2), times)]
        a, b = solve_ivp(derivative, (0, max(times[-1], 1e-9)), [self.start, self.start, 0, 0], "DOP853", times,
                         rtol=self.tolerance, atol=self.tolerance).y[:2]
        x, y = numpy.sin(a), -numpy.cos(a)
        return [{"B.x": x, "B.y": y, "C.x": x + numpy.sin(b), "C.y": y - numpy.cos(b)}]

    def document(self):
        at = {key: float(values[0]) for key, values in self.solutions([0.0])[0].items()}
        return {"gravity": [0.0, -GRAVITY],
                "points": [{"name": "A", "position": [0, 0], "fixed": True},
                           *({"name": name, "position": [at[f"{name}.x"], at[f"{name}.y"]]} for name in "BC")],
                "rods": [{"name": "upper", "between": ["A", "B"], "mass": 1.0, "length": 1.0},
                         {"name": "lower", "between": ["B", "C"], "mass": self.mass, "length": 1.0}]}
