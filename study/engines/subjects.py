# What is simulated: the N-four-bar past its singular positions, the same before the first one, a double pendulum.
#
# Scenes without singular positions need a motion that is known. Until 0.6 s the N-four-bar is one (cos phi = 0 first
# at 0.71 s or later for every N): its closed form is exact, and it has loops of every size. The double pendulum is an
# open chain, where joint coordinates have no constraints at all: the engines at their best. Its motion is integrated
# here from its two angles, independently of every program.
import functools
import math
from dataclasses import dataclass, replace

import numpy
from scipy.integrate import solve_ivp

from study.accuracy_study import subjects
from study.accuracy_study.subjects import JUDGED_S, STEPS, Subject

REGULAR_S = 0.6   # s
PENDULUM_S = 2.0  # s
PENDULUM = "study/engines/double_pendulum.json"
FINER = (2e-5, 1e-5)  # s: steps of ours beyond those of study/accuracy, since engines reach smaller errors there
GRAVITY = 9.81
LONGEST = 1e-3    # s, a step of the integration of the double pendulum: rounding alone is left


@dataclass(frozen=True)
class Chain(Subject):
    """A subject whose error is the largest distance of a point from its known place, m."""

    def every(self, step):
        return max(1, round(JUDGED_S / step))

    def error(self, record):
        outputs = record["outputs"]
        places = [[outputs[f"{point}.{axis}"] for axis in "xy"] for point in "BC"]
        return distance(numpy.array(outputs["t"]), numpy.array(places))


def all_of(loops, duration):
    """[Subject]: N-four-bars of all sizes, the short ones of these, the double pendulum."""
    chains = [subjects.chain(count, duration) for count in loops]
    short = [replace(subjects.chain(count, REGULAR_S), name=f"four-bar:{count} regular",
                     title=f"N = {count}, first {REGULAR_S:g} s") for count in loops]
    return [replace(one, steps=(*one.steps, *FINER)) for one in (*chains, *short, pendulum())]


def is_regular(name):
    """Whether a subject's motion passes no singular position."""
    return name == "double pendulum" or name.endswith(" regular")


def pendulum():
    times = numpy.linspace(0, PENDULUM_S, 201)
    own = float(numpy.hypot(*(positions(times) - positions(times, 2 * LONGEST)).swapaxes(0, 1)).max())
    return Chain("double pendulum", "double pendulum", PENDULUM, PENDULUM_S, STEPS, "m", "integrated angles",
                 own, "steps twice as long")


def error(subject, record):
    """Position error of an engine's record, m."""
    summary = record["summary"]
    if subject.loops:
        return summary["position_error_max"]
    outputs = summary["outputs"]
    points = numpy.array(outputs["points"]).reshape(-1, 2, 2)  # time, point, axis
    return distance(numpy.array(outputs["t"]), points.transpose(1, 2, 0))


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
    the last sample of a rounded step may lie: the last step, however short, does not extrapolate."""
    return solve_ivp(_rates, (0, 1.01 * PENDULUM_S), [0.0, 0.0, 0.0, 2.0], "DOP853", rtol=1e-13, atol=1e-14,
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
