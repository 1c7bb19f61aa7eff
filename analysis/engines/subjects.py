# What is simulated: the N-four-bar past its singular positions, the same before the first one, a double pendulum, and
# Andrews' mechanism.
#
# Scenes without singular positions need a motion that is known. Until 0.6 s the N-four-bar is one (cos phi = 0 first
# at 0.71 s or later for every N): its closed form is exact, and it has loops of every size. The double pendulum is an
# open chain, where joint coordinates have no constraints at all: the engines at their best. Its motion is integrated
# here from its two angles, that of Andrews' mechanism in andrews.py, independently of every program.
import functools
import math
from dataclasses import dataclass

import numpy
from scipy.integrate import solve_ivp

from analysis.engines import andrews

DURATION_S, REGULAR_S, PENDULUM_S = 5.0, 0.6, 2.0
PENDULUM, ANDREWS = "double-pendulum", "andrews"
SCENES = {PENDULUM: "study/engines/double_pendulum.json", ANDREWS: "harness/scenes/problems/a03_andrews.json"}
SOLVERS = ("ida",)  # who is given our equations, and so any scene; engines have models of rods alone
FLOOR = 1e-13      # m: no error is shown below it; the references' own are below 2e-14
GRAVITY = 9.81
LONGEST = 1e-3     # s, a step of the integration of the double pendulum: rounding alone is left


@dataclass(frozen=True)
class Subject:
    """`name`: "four-bar-10", "four-bar-10-regular", "double-pendulum" or "andrews", which is a column of the part too."""
    name: str

    @property
    def loops(self):
        return 0 if self.name in SCENES else int(self.name.split("-")[2])

    @property
    def place(self):
        """In tables and figures."""
        return self.name == ANDREWS, self.name == PENDULUM, self.regular, self.loops

    @property
    def regular(self):
        """Whether the motion passes no singular position."""
        return self.name in SCENES or self.name.endswith("-regular")

    @property
    def duration(self):
        known = {PENDULUM: PENDULUM_S, ANDREWS: andrews.DURATION_S}
        return known.get(self.name, REGULAR_S if self.regular else DURATION_S)

    @property
    def judged(self):
        """s: errors are evaluated so often, as the engines' programs do."""
        return self.duration / 300 if self.name == ANDREWS else 1e-2

    @property
    def steps(self):
        """s, the longest and the shortest of ours."""
        return (4e-4, 1e-7) if self.name == ANDREWS else (2e-2, 1e-5)

    @property
    def title(self):
        known = {PENDULUM: "double pendulum", ANDREWS: "Andrews' mechanism"}
        return known.get(self.name) or f"N = {self.loops}" + (f", first {REGULAR_S:g} s" if self.regular else "")

    @property
    def scene(self):
        """Of ours."""
        return SCENES.get(self.name) or f"four-bar:{self.loops}"

    @property
    def points(self):
        """Outputs of the scene that are compared, where not the program itself knows the motion."""
        return {PENDULUM: "BC", ANDREWS: "EPSU"}.get(self.name, "")

    def asks(self, engine):
        """Whether an engine's program models it."""
        return self.name != ANDREWS or engine in SOLVERS

    @property
    def words(self):
        """That tell an engine's program what to simulate."""
        known = {PENDULUM: ("--pendulum",), ANDREWS: ("--scene", self.scene)}
        return known.get(self.name) or ("--loops", self.loops)

    def engine_error(self, output):
        """Position error of an engine's run, m."""
        if self.loops:
            return output["position_error_max"]
        places = numpy.array(output["outputs"]["points"], dtype=float)
        return self.distance(numpy.array(output["outputs"]["t"]),
                             places.reshape(-1, len(self.points), 2).transpose(1, 2, 0))  # from time, point, axis

    def our_error(self, record):
        """Position error of a run of ours, m."""
        if self.loops:
            return record.output["position_error_max"]
        places = [[record.series[f"{point}.{axis}"] for axis in "xy"] for point in self.points]
        return self.distance(numpy.array(record.series["t"], dtype=float), numpy.array(places, dtype=float))

    def distance(self, times, places):
        """Largest distance of `places` (point, axis, time) from where they should be."""
        known = (andrews.positions if self.name == ANDREWS else positions)(times)
        return float(numpy.hypot(*(places - known).swapaxes(0, 1)).max())


def positions(times, longest=LONGEST):
    """Of B and C at `times`: (point, axis, time). Angles from +x, rods of 1 m, 1 kg and 1.5 m, 1.5 kg."""
    angles = _motion(longest)(times)
    first, second = (numpy.array([numpy.cos(angle), numpy.sin(angle)]) for angle in angles[:2])
    return numpy.array([first, first + 1.5 * second])


@functools.cache
def _motion(longest):
    """The state at any times; between its steps it is interpolated in the seventh order. A little beyond the end, where
    the last sample of a rounded step may lie."""
    return solve_ivp(_rates, (0, 1.05 * PENDULUM_S), [0.0, 0.0, 0.0, 2.0], "DOP853", rtol=1e-13, atol=1e-14,
                     max_step=longest, dense_output=True).sol


def _rates(_, state):
    first, second, first_rate, second_rate = state
    coupling = 1.5 * 1.0 * 1.5 / 2  # m2 L1 L2 / 2
    cosine, sine = math.cos(first - second), math.sin(first - second)
    a, b, c = 1 / 3 + 1.5, coupling * cosine, 1.5 * 1.5**2 / 3
    right = (-coupling * sine * second_rate**2 - GRAVITY * (0.5 + 1.5) * math.cos(first),
             coupling * sine * first_rate**2 - GRAVITY * 1.5 * 0.75 * math.cos(second))
    determinant = a * c - b * b
    return [first_rate, second_rate, (c * right[0] - b * right[1]) / determinant,
            (a * right[1] - b * right[0]) / determinant]
