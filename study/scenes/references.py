# Solutions that no implementation provides: closed forms, the equations of mechanics.py, and what others
# have published. Functions of times (s), and of the tolerance of what is integrated, return {column of an output file: values}.
#
# [Mazzia, Magherini, 2008] F. Mazzia, C. Magherini: Test set for initial value problem solvers, release 2.4,
# University of Bari: Andrews' squeezing mechanism, reference solution at the end of the interval.
from functools import cache, partial

import numpy
from scipy.special import ellipj, ellipkinc

from study.scenes import mechanics


def turning(times, k, angle, rate):
    """(sin phi, cos phi, phi') of phi'' = k sin phi, from the upward vertical, with `angle` and `rate` (not negative) at t = 0: Eq. (10) of
    paper/README.md. psi = phi - pi is the angle from the downward vertical."""
    half = (angle - numpy.pi) / 2
    bottom = rate**2 + 4 * k * numpy.cos(angle / 2)**2  # psi'^2 where the energy is kinetic
    if rate == 0 and (k == 0 or abs(numpy.sin(angle)) < 1e-12):
        return numpy.full_like(times, numpy.sin(angle)), numpy.full_like(times, numpy.cos(angle)), numpy.zeros_like(times)
    if bottom > 4 * k:  # turns over: sin(psi / 2) = sn
        parameter = 4 * k / bottom
        sn, cn, dn, _ = ellipj(ellipkinc(half, parameter) + bottom**0.5 * times / 2, parameter)
        return -2 * sn * cn, 2 * sn**2 - 1, bottom**0.5 * dn
    kappa = (bottom / (4 * k))**0.5  # swings: sin(psi / 2) = kappa sn
    start = ellipkinc(numpy.arctan2(numpy.sin(half), rate / (2 * k**0.5)), kappa**2)
    sn, cn, dn, _ = ellipj(start + k**0.5 * times, kappa**2)
    return -2 * kappa * sn * dn, 2 * (kappa * sn)**2 - 1, 2 * kappa * k**0.5 * cn


def pendulum(times):
    """A point mass on 1 m, from rest at (-1, 0)."""
    sine, cosine, rate = turning(times, mechanics.GRAVITY, numpy.pi / 2, 0)
    return {"B.x": -sine, "B.y": cosine, "vB.vx": -rate * cosine, "vB.vy": -rate * sine}


def four_bar(times, loops):
    """Eq. (9) of paper/README.md, from the upward vertical with 1 rad/s."""
    sine, cosine, rate = turning(times, 3 * mechanics.GRAVITY * (3 * loops + 1) / (2 * (4 * loops + 1)), 0, 1)
    return {"B0.x": sine, "B0.y": cosine, "vB0.vx": rate * cosine, "vB0.vy": -rate * sine}


def andrews_end():
    """Positions of Andrews' mechanism at 0.03 s from the published angles: [Mazzia, Magherini, 2008], computed there in quadruple precision."""
    angles = 0.1581077119629904e2, 0.4082224013073101e-1, 0.5244099658805304, 0.1048080741042263e1
    beta, gamma, delta, epsilon = numpy.exp(1j * numpy.array(angles))
    a, b = -0.06934 - 0.00227j, -0.03635 + 0.03273j
    at = {"E": 7e-3 * beta, "P": b - 35e-3j * gamma, "S": a + 40e-3 * delta, "U": a - 40e-3j * epsilon}
    return {f"{name}.{axis}": float(value) for name, place in at.items() for axis, value in (("x", place.real), ("y", place.imag))}


# What `known` in problems.yaml may name, by where it comes from.
EXTRAPOLATED = "extrapolated"
CLOSED = {"pendulum": pendulum, "four_bar_2": lambda t: four_bar(t, 2), "four_bar_40": lambda t: four_bar(t, 40)}
INTEGRATED = {"grid_10": partial(mechanics.grid, size=10), "slider_crank": mechanics.slider_crank,
              "spatial_slider_crank": mechanics.spatial_slider_crank, "governor": mechanics.governor, "half_car": mechanics.half_car}
KNOWN = CLOSED | INTEGRATED
PUBLISHED = {"andrews_end": andrews_end}  # at the end of the run; what `published` may name


@cache
def solution(name, times, **tolerance):
    """What KNOWN says of a tuple of times: parts and sets ask for the same, and an integration takes seconds."""
    return KNOWN[name](numpy.array(times), **tolerance)


def kind(name):
    """In words, what a comparison with `name` is worth."""
    return "closed form" if name in CLOSED else "own equations, integrated" if name in INTEGRATED else "self-convergence of two implementations"
