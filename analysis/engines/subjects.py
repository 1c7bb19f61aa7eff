# What is simulated: the N-four-bar past its singular positions, the same before the first one, a double pendulum.
#
# Scenes without singular positions need a motion that is known. Until 0.6 s the N-four-bar is one (cos phi = 0 first
# at 0.71 s or later for every N): its closed form is exact, and it has loops of every size. The double pendulum is an
# open chain, where joint coordinates have no constraints at all: the engines at their best. Its motion is integrated
# here from its two angles, independently of every program.
import functools
import math
from dataclasses import dataclass

import numpy
from scipy.integrate import solve_ivp

DURATION_S, REGULAR_S, PENDULUM_S = 5.0, 0.6, 2.0
PENDULUM = "double-pendulum"
SCENE = "study/engines/double_pendulum.json"
JUDGED_S = 1e-2    # errors are evaluated so often, as the engines' programs do
FLOOR = 1e-13      # m: no error is shown below it; the references' own are below 2e-14
GRAVITY = 9.81
LONGEST = 1e-3     # s, a step of the integration of the double pendulum: rounding alone is left


@dataclass(frozen=True)
class Subject:
    """`name`: "four-bar-10", "four-bar-10-regular" or "double-pendulum", which is a column of the part too."""
    name: str

    @property
    def loops(self):
        return 0 if self.name == PENDULUM else int(self.name.split("-")[2])

    @property
    def place(self):
        """In tables and figures."""
        return self.name == PENDULUM, self.regular, self.loops

    @property
    def regular(self):
        """Whether the motion passes no singular position."""
        return self.name == PENDULUM or self.name.endswith("-regular")

    @property
    def duration(self):
        return PENDULUM_S if self.name == PENDULUM else REGULAR_S if self.regular else DURATION_S

    @property
    def title(self):
        return "double pendulum" if not self.loops else f"N = {self.loops}" + (
            f", first {REGULAR_S:g} s" if self.regular else "")

    @property
    def scene(self):
        """Of ours."""
        return f"four-bar:{self.loops}" if self.loops else SCENE

    def engine_error(self, output):
        """Position error of an engine's run, m."""
        if self.loops:
            return output["position_error_max"]
        points = numpy.array(output["outputs"]["points"], dtype=float).reshape(-1, 2, 2)  # time, point, axis
        return distance(numpy.array(output["outputs"]["t"]), points.transpose(1, 2, 0))

    def our_error(self, record):
        """Position error of a run of ours, m."""
        if self.loops:
            return record.output["position_error_max"]
        places = [[record.series[f"{point}.{axis}"] for axis in "xy"] for point in "BC"]
        return distance(numpy.array(record.series["t"], dtype=float), numpy.array(places, dtype=float))


def distance(times, places):
    """Largest distance of `places` (point, axis, time) of the double pendulum from where they should be."""
    return float(numpy.hypot(*(places - positions(times)).swapaxes(0, 1)).max())


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
