# Equations of motion in as few coordinates as a mechanism has freedoms, written down by hand for it and
# integrated with step control: they share neither coordinates, mass matrix nor constraints with `mbs`.
#
# Each function takes times (s) and the tolerance of its integration, and returns {column of an output file: values}; numbers are the scenes'.
import math
from functools import partial

import numpy
from scipy.integrate import solve_ivp

GRAVITY = 9.81  # m/s^2
TOLERANCE = 1e-12  # relative and absolute


def grid(times, size, lean=0.5, tolerance=TOLERANCE):
    """The grid of four-bars as a chain of `size` links: all rods of a row are parallel, so that the points of a row share one
    displacement, a complex number down + i across. A rod of m kg is as good as m/6 at each end and 4 m/6 in its middle."""
    rows = numpy.tril(numpy.ones((size, size)))  # the displacement of row r is the sum over links 0..r
    offsets = numpy.vstack([rows, rows - numpy.eye(size) / 2])  # of rows, of middles of upright rods
    upright, couplers = size + 1, size  # rods of 1 kg in each row
    masses = numpy.repeat([upright / 3 + couplers, 4 / 6 * upright], size)
    masses[size - 1] -= upright / 6

    def derivative(_, state):
        turned, rates = numpy.exp(1j * state[:size]), state[size:]
        return [*rates, *_accelerations(1j * offsets * turned, masses, masses * (GRAVITY + offsets @ (turned * rates**2)))]
    at = rows @ numpy.exp(1j * integrate(derivative, times, [lean] * size + [0] * size, tolerance)[:size])
    return {f"{name}.{axis}": part for name, links in (("corner", size), ("middle", size // 2))
            for axis, part in (("x", links + at[links - 1].imag), ("y", -at[links - 1].real))}


def _accelerations(by, masses, force, inertia=0.0):
    """Of coordinates. `by`: derivatives of places, complex numbers, by these; `force`: on the places' masses, less what bends their ways;
    `inertia`: beside that of the masses."""
    return numpy.linalg.solve((by.conj().T @ (masses[:, None] * by)).real + inertia, (by.conj().T @ force).real)


def _slider_crank(times, tolerance=TOLERANCE, *, axes, pivot, radius, length, masses, first, second, start, torque, gravity):
    """One freedom: the crank's angle from `first` to `second`; the slider is on the x axis. With places r(angle) of pin and slider and
    the mass matrix M of thin rods between them, inertia I = dr.M dr: I angle'' + dr.M ddr angle'^2 = torque + sum m g.dr."""
    pivot, first, second, gravity = map(numpy.array, (pivot, first, second, gravity))
    crank, rod, slider = masses
    mass = numpy.array([[(crank + rod) / 3, rod / 6], [rod / 6, rod / 3 + slider]])
    weight = numpy.outer([(crank + rod) / 2, rod / 2 + slider], gravity)

    def joints(angle):
        """Pin and slider: places, first and second derivatives with respect to the angle."""
        along, turned = (radius * (first * numpy.cos(at) + second * numpy.sin(at)) for at in (angle, angle + numpy.pi / 2))
        (_, *a), (_, *da), (_, *dda) = pin = pivot + along, turned, -along
        ahead = (length**2 - numpy.dot(a, a)) ** 0.5
        d_ahead = -numpy.dot(a, da) / ahead
        dd_ahead = -(numpy.dot(da, da) + numpy.dot(a, dda) + d_ahead**2) / ahead
        return [numpy.array([at, [at[0] + more, 0, 0]]) for at, more in zip(pin, (ahead, d_ahead, dd_ahead))]

    def derivative(_, state):
        angle, rate = state
        _, d, dd = joints(angle)
        return [rate, (torque + numpy.vdot(d, weight) - numpy.vdot(d, mass @ dd) * rate**2) / numpy.vdot(d, mass @ d)]
    places = numpy.array([joints(angle)[0] for angle in integrate(derivative, times, start, tolerance)[0]])
    return {f"{name}.{axis}": places[:, i, k] for i, name in enumerate(("crank", "slider")) for k, axis in enumerate(axes)}


slider_crank = partial(_slider_crank, axes="xy", pivot=[0, 0, 0], radius=0.5, length=1.5, masses=(2, 3, 4), first=[1, 0, 0],
                       second=[0, 1, 0], start=(numpy.pi / 2, 0), torque=10, gravity=[0, -GRAVITY, 0])
spatial_slider_crank = partial(_slider_crank, axes="xyz", pivot=[0, 0.1, 0.12], radius=0.08, length=0.3, masses=(0.12, 0.5, 2),
                               first=[0, 0, 1], second=[0, -1, 0], start=(0, 6), torque=0, gravity=[0, 0, -GRAVITY])


def governor(times, tolerance=TOLERANCE):
    """Both arms fall alike, so that there are three freedoms: the shaft's angle, the arms' angle below the
    horizontal, the slider's height. No torque about the shaft: J(down) spin is constant."""
    arm, ball, cube, shaft = 0.3, 5.0, 3.0, 0.3
    thin, long, cube_inertia = 2 * 0.01**2 / 12, (1 + 0.01**2) / 12, 3.0 * 2 * 0.1**2 / 12
    hinge, top, stiffness, damping, free = 0.05, 1.0, 8e5, 4e4, 0.5
    about_hinge = arm * (long + 0.25) + ball

    def about_shaft(down):
        """Moment of inertia and its derivative."""
        cos, sin = numpy.cos(down), numpy.sin(down)
        inertia = arm * (thin * sin**2 + long * cos**2 + (hinge + cos / 2) ** 2) + ball * (hinge + cos) ** 2
        change = -2 * sin * (arm * ((long - thin) * cos + (hinge + cos / 2) / 2) + ball * (hinge + cos))
        return shaft * thin + cube_inertia + 2 * inertia, 2 * change

    momentum = about_shaft(numpy.pi / 6)[0] * 2 * numpy.pi

    def derivative(_, state):
        _, down, down_rate, height, height_rate = state
        cos, sin = numpy.cos(down), numpy.sin(down)
        inertia, change = about_shaft(down)
        across, above = cos / 2, top - sin / 2 - height  # from the slider to the middle of the arm
        length = (across**2 + above**2) ** 0.5
        by_down, by_height = (-across * sin - above * cos) / 2 / length, -above / length
        pull = stiffness * (length - free) + damping * (by_down * down_rate + by_height * height_rate)
        spin = momentum / inertia
        return [spin, down_rate, (change * spin**2 / 4 + GRAVITY * cos * (arm / 2 + ball) - pull * by_down) / about_hinge,
                height_rate, -GRAVITY - 2 * pull * by_height / cube]
    turned, down, _, height, _ = integrate(derivative, times, (0, numpy.pi / 6, 0, 0.5, 0), tolerance, "LSODA")
    out = hinge + numpy.cos(down)
    return {"slider.x": 0 * height, "slider.y": height, "slider.z": 0 * height,
            "P1.x": out * numpy.cos(turned), "P1.y": top - numpy.sin(down), "P1.z": -out * numpy.sin(turned)}


def half_car(times, tolerance=TOLERANCE):
    """Four freedoms: the height of the front pivot, the angles of body and both arms. Places are complex
    numbers, x + iy = 0.8 + i height + sum of offset e^(i angle)."""
    pivot, behind = 0.8 - 0.15j, -1.0 - 0.15j  # in the body's axes, as the mounts
    front, rear = 0.4 - 0.05j, -0.4 - 0.05j    # arms at the start, where the body's angle is 0
    offsets = numpy.array([                     # of body, front arm, rear arm
        [-pivot, 0, 0], [0, abs(front) / 2, 0], [behind - pivot, 0, abs(rear) / 2],
        [0, abs(front), 0], [behind - pivot, 0, abs(rear)],                           # hubs
        [1.2 + 0.25j - pivot, 0, 0], [-1.4 + 0.25j - pivot, 0, 0]])                   # mounts
    masses = numpy.array([600, 8, 8, 40, 40, 0, 0])
    inertia = numpy.diag([0, 900, 8 * abs(front)**2 / 12, 8 * abs(rear)**2 / 12])
    hubs, mounts, roads, phases = slice(3, 5), slice(5, 7), numpy.array([1.2, -1.4]), numpy.array([0, -1.6336281798666925])

    def derivative(t, state):
        turned, rates = numpy.exp(1j * state[1:4]), state[4:]
        at = 0.8 + 1j * state[0] + offsets @ turned
        by = numpy.full((len(at), 4), 1j)
        by[:, 1:] *= offsets * turned
        velocity, force = by @ rates, masses * (offsets @ (turned * rates[1:]**2) - 1j * GRAVITY)
        wave = 3 * numpy.pi * t + phases
        strut = _pull(at[mounts] - at[hubs], velocity[mounts] - velocity[hubs], 22000, 1500, 0.45)
        tyre = _pull(roads + 0.05j * numpy.sin(wave) - at[hubs], 0.15j * numpy.pi * numpy.cos(wave) - velocity[hubs], 180000, 200, 0.3)
        force[hubs] += strut + tyre
        force[mounts] -= strut
        return [*rates, *_accelerations(by, masses, force, inertia)]
    height, *angles = integrate(derivative, times, [0.35, 0, numpy.angle(front), numpy.angle(rear), 0, 0, 0, 0], tolerance)[:4]
    at = 0.8 + 1j * height + offsets @ numpy.exp(1j * numpy.array(angles))
    return {f"{name}.{axis}": part for name, k in (("body", 0), ("front", 3), ("rear", 4)) for axis, part in (("x", at[k].real), ("y", at[k].imag))}


def double_pendulum(lengths, masses):
    """Of two thin rods, whatever they weigh: what integrates their angles from the downward vertical, then the rates of these."""
    (upper, lower), (mass, end) = lengths, masses

    def derivative(_, state):
        a, b, da, db = state.tolist()  # numbers of Python's own, ten times as fast
        sine, cosine = upper * lower / 2 * math.sin(a - b), upper * lower / 2 * math.cos(a - b)
        (p, q), (r, s) = (upper**2 * (mass / 3 + end), end * cosine), (cosine, lower**2 / 3)  # that of the lower rod divided by its mass
        force = -end * sine * db**2 - GRAVITY * upper * (mass / 2 + end) * math.sin(a)
        other = sine * da**2 - GRAVITY * lower / 2 * math.sin(b)
        return [da, db, (s * force - q * other) / (p * s - q * r), (p * other - r * force) / (p * s - q * r)]
    return derivative


def _pull(between, rate, stiffness, damping, free):
    """The forces of springs towards their other ends, which are at `between` and move at `rate`."""
    length = abs(between)
    along = between / length
    return along * (stiffness * (length - free) + damping * (along.conjugate() * rate).real)


def integrate(derivative, times, start, tolerance=TOLERANCE, method="DOP853"):
    span = 0, max(times[-1], 1e-9)  # the start alone may be asked for
    return solve_ivp(derivative, span, start, method, times, rtol=tolerance, atol=tolerance).y
