# Solutions that no implementation provides: closed forms, and one small set of equations.
#
# Each function takes times (s) and returns {column of an output file: values}.
import numpy
from scipy.integrate import solve_ivp
from scipy.special import ellipj, ellipk

GRAVITY = 9.81  # m/s^2


def pendulum(times):
    """A point mass on 1 m, from rest at (-1, 0): theta'' = -g sin theta from -pi/2."""
    rate, parameter = GRAVITY**0.5, 0.5  # parameter sin^2(45 degrees)
    sn, cn, dn, _ = ellipj(ellipk(parameter) - rate * times, parameter)
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


def grid(times, size, lean=0.5):
    """The grid of four-bars as a chain of `size` links: all rods of a row are parallel, so that the
    points of a row share one displacement, with the masses of the row's rods on it."""
    upright, couplers = size + 1, size  # rods of 1 kg in each row
    last = numpy.arange(size) == size - 1
    mass = numpy.diag(upright / 3 * numpy.where(last, 1, 2) + couplers)
    mass += numpy.diag([upright / 6] * (size - 1), 1) + numpy.diag([upright / 6] * (size - 1), -1)
    weight = GRAVITY * (upright / 2 * numpy.where(last, 1, 2) + couplers)
    below = numpy.tril(numpy.ones((size, size)))  # displacement of row r: sum over links 0..r

    def derivative(_, state):
        theta, rate = state[:size], state[size:]
        across, down = below * numpy.cos(theta), below * numpy.sin(theta)  # d x, d y by d theta
        inertia = across.T @ mass @ across + down.T @ mass @ down
        bend_x, bend_y = -below @ (numpy.sin(theta) * rate**2), below @ (numpy.cos(theta) * rate**2)
        force = -across.T @ mass @ bend_x - down.T @ (mass @ bend_y + weight)
        return numpy.concatenate([rate, numpy.linalg.solve(inertia, force)])
    start = numpy.concatenate([numpy.full(size, lean), numpy.zeros(size)])
    solution = solve_ivp(derivative, (0, times[-1]), start, "DOP853", times, rtol=1e-12, atol=1e-12)
    x = below @ numpy.sin(solution.y[:size])
    y = -below @ numpy.cos(solution.y[:size])
    middle = size // 2 - 1
    return {"corner.x": size + x[-1], "corner.y": y[-1],
            "middle.x": size // 2 + x[middle], "middle.y": y[middle]}


KNOWN = {"pendulum": pendulum, "four_bar_2": lambda t: four_bar(t, 2),
         "four_bar_40": lambda t: four_bar(t, 40), "grid_10": lambda t: grid(t, 10)}
