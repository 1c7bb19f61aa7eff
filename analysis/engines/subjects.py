# What is simulated: the N-four-bar past its singular positions, the same before the first one, a double pendulum, and Andrews' mechanism.
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
from study.scenes.mechanics import double_pendulum

DURATION_S, REGULAR_S, PENDULUM_S = 5.0, 0.6, 2.0
PENDULUM, ANDREWS = "double-pendulum", "andrews"
ANDREWS_SCENE = "harness/scenes/problems/a03_andrews.json"
SOLVERS = ("ida",)  # who is given our equations, and so any scene; engines have models of rods alone
FLOOR = 1e-13      # m: no error is shown below it; the references' own are below 2e-14
LONGEST = 1e-3     # s, a step of the integration of the double pendulum: rounding alone is left


@dataclass(frozen=True)
class Subject:
    name: str            # a column of the part too
    title: str           # in tables and figures
    scene: str           # of ours
    duration: float      # s
    words: tuple         # that tell an engine's program what to simulate
    regular: bool = True  # whether the motion passes no singular position
    loops: int = 0       # of the four-bar, whose error the programs tell
    points: str = ""     # outputs that are compared where they do not
    judged: float = 1e-2  # s: errors are evaluated so often, as the engines' programs do
    steps: tuple = (2e-2, 1e-5)  # s, the longest and the shortest of ours
    worst: float = 0.1   # m, a tenth of its shortest rod: who is farther off has lost the motion

    place = property(lambda self: (self.name == ANDREWS, self.name == PENDULUM, self.regular, self.loops))  # in tables and figures

    def error(self, record, engine):
        """Position error of a run, of an engine's or of ours, m: the largest distance of a point from where it should be."""
        output, series = record.output, record.series
        if self.loops:
            return output["position_error_max"]
        if engine:
            times, places = output["outputs"]["t"], numpy.array(output["outputs"]["points"], dtype=float)
            places = places.reshape(-1, len(self.points), 2).transpose(1, 2, 0)  # from time, point, axis
        else:
            times, places = series["t"], [[series[f"{point}.{axis}"] for axis in "xy"] for point in self.points]
        away = numpy.array(places, dtype=float) - _known(self.name, tuple(times))
        return float(numpy.hypot(*away.swapaxes(0, 1)).max())


OTHERS = {one.name: one for one in (
    Subject(PENDULUM, "double pendulum", "study/engines/double_pendulum.json", PENDULUM_S, ("--pendulum",), points="BC"),
    Subject(ANDREWS, "Andrews' mechanism", ANDREWS_SCENE, andrews.DURATION_S, ("--scene", ANDREWS_SCENE), points="EPSU",
            judged=andrews.DURATION_S / 300, steps=(4e-4, 1e-7), worst=float(min(andrews.LENGTHS)) / 10))}


def subject_of(name):
    """The Subject called "four-bar-10", "four-bar-10-regular", "double-pendulum" or "andrews"."""
    if name in OTHERS:
        return OTHERS[name]
    loops, regular = int(name.split("-")[2]), name.endswith("-regular")
    return Subject(name, f"N = {loops}" + (f", first {REGULAR_S:g} s" if regular else ""), f"four-bar:{loops}",
                   REGULAR_S if regular else DURATION_S, ("--loops", loops), regular, loops)


# Where the points of a subject should be; most runs are judged at the same times.
_known = functools.cache(lambda name, times: (andrews.positions if name == ANDREWS else positions)(numpy.array(times)))


def positions(times, longest=LONGEST):
    """Of B and C at `times`: (point, axis, time). Rods of 1 m, 1 kg and 1.5 m, 1.5 kg, released along +x."""
    first, second = (numpy.array([numpy.sin(angle), -numpy.cos(angle)]) for angle in _motion(longest)(times)[:2])
    return numpy.array([first, first + 1.5 * second])


@functools.cache
def _motion(longest):
    """The state at any times; between its steps it is interpolated in the seventh order. A little beyond the end, where
    the last sample of a rounded step may lie."""
    return solve_ivp(double_pendulum((1.0, 1.5), (1.0, 1.5)), (0, 1.05 * PENDULUM_S), [math.pi / 2, math.pi / 2, 0.0, 2.0], "DOP853",
                     rtol=1e-13, atol=1e-14, max_step=longest, dense_output=True).sol
