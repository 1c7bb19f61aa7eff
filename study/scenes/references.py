# Solutions that no implementation provides: closed forms, the equations of mechanics.py, and what others
# have published. Functions of times (s), and of the tolerance of what is integrated, return {column of an output file: values}.
#
# [Mazzia, Magherini, 2008] F. Mazzia, C. Magherini: Test set for initial value problem solvers, release 2.4,
# University of Bari: Andrews' squeezing mechanism, reference solution at the end of the interval.
from functools import partial

import numpy
from scipy.special import ellipj, ellipk

from study.scenes import mechanics
from study.scenes.mechanics import GRAVITY


def pendulum(times):
    """A point mass on 1 m, from rest at (-1, 0): theta'' = -g sin theta from -pi/2."""
    rate, parameter = GRAVITY**0.5, 0.5  # parameter sin^2(45 degrees)
    sn, cn, _, _ = ellipj(ellipk(parameter) - rate * times, parameter)
    half = parameter**0.5 * sn  # sin(|theta| / 2)
    theta = -2 * numpy.arcsin(half)
    theta_rate = 2 * rate * parameter**0.5 * cn
    return {"B.x": numpy.sin(theta), "B.y": -numpy.cos(theta),
            "vB.vx": theta_rate * numpy.cos(theta), "vB.vy": theta_rate * numpy.sin(theta)}


def four_bar(times, loops):
    """Eq. (10) of paper/README.md."""
    k = 3 * GRAVITY * (3 * loops + 1) / (2 * (4 * loops + 1))
    w = (1 + 4 * k) ** 0.5
    parameter = 4 * k / w**2
    sn, cn, dn, _ = ellipj(ellipk(parameter) + w * times / 2, parameter)
    sine, cosine, rate = -2 * sn * cn, 2 * sn**2 - 1, w * dn
    return {"B0.x": sine, "B0.y": cosine, "vB0.vx": rate * cosine, "vB0.vy": -rate * sine}


def andrews_end():
    """Positions of Andrews' mechanism at 0.03 s from the published angles: [Mazzia, Magherini, 2008],
    computed there in quadruple precision."""
    beta, gamma = 0.1581077119629904e2, 0.4082224013073101e-1
    delta, epsilon = 0.5244099658805304, 0.1048080741042263e1
    a, b = numpy.array([-0.06934, -0.00227]), numpy.array([-0.03635, 0.03273])
    cos, sin = numpy.cos, numpy.sin
    at = {"E": 7e-3 * numpy.array([cos(beta), sin(beta)]),
          "P": b + 35e-3 * numpy.array([sin(gamma), -cos(gamma)]),
          "S": a + 40e-3 * numpy.array([cos(delta), sin(delta)]),
          "U": a + 40e-3 * numpy.array([sin(epsilon), -cos(epsilon)])}
    return {f"{name}.{axis}": float(value) for name, place in at.items() for axis, value in zip("xy", place)}


# What `known` in problems.yaml may name, by where it comes from.
EXTRAPOLATED = "extrapolated"
CLOSED = {"pendulum": pendulum, "four_bar_2": lambda t: four_bar(t, 2), "four_bar_40": lambda t: four_bar(t, 40)}
INTEGRATED = {"grid_10": partial(mechanics.grid, size=10), "slider_crank": mechanics.slider_crank,
              "spatial_slider_crank": mechanics.spatial_slider_crank, "governor": mechanics.governor, "half_car": mechanics.half_car}
KNOWN = CLOSED | INTEGRATED
PUBLISHED = {"andrews_end": andrews_end}  # at the end of the run; what `published` may name


def kind(name):
    """In words, what a comparison with `name` is worth."""
    return ("closed form" if name in CLOSED else "own equations, integrated" if name in INTEGRATED
            else "self-convergence of two implementations")
