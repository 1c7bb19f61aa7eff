# The motion of Andrews' squeezing mechanism, in the angles of its seven bodies: neither the coordinates nor the
# constraints of `mbs`, nor its program. Numbers: harness/scenes/problems/a03_andrews.json.
#
# Points are complex numbers. With u_j = exp(i angle_j), every centre of mass is ground + Z u and the three loops are
# L u = const: derivatives by the angles are i Z diag(u) and i L diag(u).
import functools
import math

import numpy
from scipy.integrate import solve_ivp

DURATION_S = 0.03
TOLERANCE = 1e-13
A, B, C = -0.06934 - 0.00227j, -0.03635 + 0.03273j, 0.014 + 0.072j  # O is 0
LENGTHS = numpy.array([7e-3, 28e-3, 35e-3, 20e-3, 40e-3, 20e-3, 40e-3])  # of K1 ... K7, from joint to joint
MASS = numpy.array([0.04325, 0.00365, 0.02373, 0.00706, 0.0705, 0.00706, 0.05498])
INERTIA = numpy.array([2.194e-6, 4.41e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5])
CENTRES = numpy.diag([0.92e-3, 11.5e-3, 18.74e-3 + 10.43e-3j, 5.79e-3, 23.08e-3 + 9.16e-3j, 5.79e-3, 12.28e-3 - 4.49e-3j])
for body, before in ((1, 0), (3, 4), (5, 6)):  # K2 begins at the end of K1, K4 of K5, K6 of K7; the others at the ground
    CENTRES[body, before] = LENGTHS[before]
LOOPS = numpy.zeros((3, 7))  # O-E-P = B-P, A-S-P and A-U-P
LOOPS[:, :2], LOOPS[0, 2] = LENGTHS[:2], -LENGTHS[2]
LOOPS[1, [4, 3]], LOOPS[2, [6, 5]] = -LENGTHS[[4, 3]], -LENGTHS[[6, 5]]
SPRING, STIFFNESS, FREE_LENGTH, TORQUE = 18e-3 + 20e-3j, 4530.0, 77.85e-3, 33e-3  # from C to this place on K3; on K1
START = -0.0617138900142764496, 0.455279819163070380, 0.222668390165885885, 0.487364979543842550, 1.23054744454982119


def positions(times):
    """Of E, P, S and U at `times`: (point, axis, time), m."""
    u = numpy.exp(1j * _motion()(times)[:7])
    places = numpy.array([LENGTHS[0] * u[0], B + LENGTHS[2] * u[2], A + LENGTHS[4] * u[4], A + LENGTHS[6] * u[6]])
    return numpy.stack([places.real, places.imag], axis=1)


@functools.cache
def _motion():
    """The state at any times, a little beyond the end too: angles from +x of the bodies' x axes, then their rates. It starts as published,
    with Theta = 0 and Omega = -phi."""
    beta, gamma, phi, delta, epsilon = START
    start = beta, beta + math.pi, gamma - math.pi / 2, phi + delta - math.pi / 2, delta, epsilon - phi, epsilon - math.pi / 2
    return solve_ivp(_rates, (0, 1.02 * DURATION_S), [*start, *numpy.zeros(7)], "DOP853", rtol=TOLERANCE,
                     atol=1e-2 * TOLERANCE, dense_output=True).sol


def _rates(_, state):
    angles, rates = state[:7], state[7:]
    u = numpy.exp(1j * angles)
    of_centres, of_loops = 1j * CENTRES * u, 1j * LOOPS * u
    turned = u * rates**2
    stretch = B + SPRING * u[2] - C
    pull = STIFFNESS * (1 - FREE_LENGTH / abs(stretch)) * stretch
    force = (of_centres.conj().T @ (MASS * (CENTRES @ turned))).real
    force[0] += TORQUE
    force[2] -= ((1j * SPRING * u[2]).conjugate() * pull).real
    rows = numpy.vstack([of_loops.real, of_loops.imag])
    bent = LOOPS @ turned
    matrix = numpy.zeros((13, 13))
    matrix[:7, :7] = (of_centres.conj().T @ (MASS[:, None] * of_centres)).real + numpy.diag(INERTIA)
    matrix[:7, 7:], matrix[7:, :7] = rows.T, rows
    return numpy.concatenate([rates, numpy.linalg.solve(matrix, [*force, *bent.real, *bent.imag])[:7]])
