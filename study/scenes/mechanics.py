# Equations of motion in as few coordinates as a mechanism has freedoms, written down by hand for it and
# integrated with step control: they share neither coordinates, mass matrix nor constraints with `mbs`.
#
# Each function takes times (s) and returns {column of an output file: values}; numbers are the scenes'.
from contextlib import contextmanager

import numpy
from scipy.integrate import solve_ivp

GRAVITY = 9.81  # m/s^2
TOLERANCE = 1e-12  # relative and absolute, of the integrations


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
    theta = _integrate(derivative, times, start)[:size]
    x, y = below @ numpy.sin(theta), -below @ numpy.cos(theta)
    middle = size // 2 - 1
    return {"corner.x": size + x[-1], "corner.y": y[-1], "middle.x": size // 2 + x[middle], "middle.y": y[middle]}


def slider_crank(times):
    at_pin, at_slider = _slider_crank(
        times, pivot=[0, 0, 0], radius=0.5, length=1.5, masses=(2, 3, 4), first=[1, 0, 0],
        second=[0, 1, 0], start=(numpy.pi / 2, 0), torque=10, gravity=[0, -GRAVITY, 0])
    return _columns("xy", crank=at_pin, slider=at_slider)


def spatial_slider_crank(times):
    at_pin, at_slider = _slider_crank(
        times, pivot=[0, 0.1, 0.12], radius=0.08, length=0.3, masses=(0.12, 0.5, 2),
        first=[0, 0, 1], second=[0, -1, 0], start=(0, 6), torque=0, gravity=[0, 0, -GRAVITY])
    return _columns("xyz", crank=at_pin, slider=at_slider)


def _slider_crank(times, pivot, radius, length, masses, first, second, start, torque, gravity):
    """One freedom: the crank's angle from `first` to `second`; the slider is on the x axis. With places
    r(angle), inertia I = sum m |dr|^2: I angle'' + 1/2 dI angle'^2 = torque + sum m g.dr. Thin rods move
    with their middle and turn about it. Returns places of pin and slider, (times, 3) each."""
    pivot, first, second, gravity = map(numpy.array, (pivot, first, second, gravity))
    crank, rod, slider = masses

    def joints(angle):
        """Pin and slider: place, first and second derivative with respect to the angle."""
        along = radius * (first * numpy.cos(angle) + second * numpy.sin(angle))
        pin = pivot + along, radius * (second * numpy.cos(angle) - first * numpy.sin(angle)), -along
        (_, *a), (_, *da), (_, *dda) = map(numpy.array, pin)
        ahead = (length**2 - numpy.dot(a, a)) ** 0.5
        d_ahead = -numpy.dot(a, da) / ahead
        dd_ahead = -(numpy.dot(da, da) + numpy.dot(a, dda) + d_ahead**2) / ahead
        return pin, [numpy.array([at[0] + more, 0, 0]) for at, more in zip(pin, (ahead, d_ahead, dd_ahead))]

    def derivative(_, state):
        angle, rate = state
        (_, da, dda), (_, db, ddb) = joints(angle)
        inertia = (crank * da @ da / 3 + slider * db @ db
                   + rod * ((da + db) @ (da + db) / 4 + (db - da) @ (db - da) / 12))
        half_change = slider * db @ ddb + rod * ((da + db) @ (dda + ddb) / 4 + (db - da) @ (ddb - dda) / 12)
        force = torque + gravity @ (crank * da / 2 + rod * (da + db) / 2 + slider * db)
        return [rate, (force - half_change * rate**2) / inertia]
    angles = _integrate(derivative, times, start)[0]
    return [numpy.array([joints(angle)[which][0] for angle in angles]) for which in (0, 1)]


def governor(times):
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
        return [spin, down_rate,
                (change * spin**2 / 4 + GRAVITY * cos * (arm / 2 + ball) - pull * by_down)
                / about_hinge,
                height_rate, -GRAVITY - 2 * pull * by_height / cube]
    turned, down, _, height, _ = _integrate(derivative, times, (0, numpy.pi / 6, 0, 0.5, 0), method="LSODA")
    out, none = hinge + numpy.cos(down), numpy.zeros(len(times))
    return _columns("xyz", slider=numpy.stack([none, height, none], axis=1),
                    P1=numpy.stack([out * numpy.cos(turned), top - numpy.sin(down),
                                    -out * numpy.sin(turned)], axis=1))


def half_car(times):
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

    def places(state):
        return 0.8 + 1j * state[0] + offsets @ numpy.exp(1j * state[1:4])

    def derivative(t, state):
        turned, rates = numpy.exp(1j * state[1:4]), state[4:]
        at = places(state)
        by = 1j * numpy.hstack([numpy.ones((len(at), 1)), offsets * turned])
        velocity, bend = by @ rates, -offsets @ (turned * rates[1:]**2)
        force = -1j * GRAVITY * masses - masses * bend
        for hub, mount, road, phase in ((3, 5, 1.2, 0), (4, 6, -1.4, -1.6336281798666925)):
            wave = 3 * numpy.pi * t + phase
            ground = road + 0.05j * numpy.sin(wave)
            strut = _pull(at[mount] - at[hub], velocity[mount] - velocity[hub], 22000, 1500, 0.45)
            tyre = _pull(ground - at[hub], 0.15j * numpy.pi * numpy.cos(wave) - velocity[hub], 180000, 200, 0.3)
            force[hub] += strut + tyre
            force[mount] -= strut
        matrix = (by.conj().T @ (masses[:, None] * by)).real + inertia
        return [*rates, *numpy.linalg.solve(matrix, (by.conj().T @ force).real)]
    start = [0.35, 0, numpy.angle(front), numpy.angle(rear), 0, 0, 0, 0]
    at = numpy.array([places(state) for state in _integrate(derivative, times, start).T])
    return {f"{name}.{axis}": part for name, k in (("body", 0), ("front", 3), ("rear", 4))
            for axis, part in (("x", at[:, k].real), ("y", at[:, k].imag))}


def _pull(between, rate, stiffness, damping, free):
    """The force of a spring towards its other end, which is at `between` and moves at `rate`."""
    length = abs(between)
    along = between / length
    return along * (stiffness * (length - free) + damping * (along.conjugate() * rate).real)


@contextmanager
def tolerance(value):
    """Inside, solutions are integrated to another tolerance: what that changes is about their error."""
    global TOLERANCE
    usual, TOLERANCE = TOLERANCE, value
    try:
        yield
    finally:
        TOLERANCE = usual


def _integrate(derivative, times, start, method="DOP853"):
    return solve_ivp(derivative, (0, times[-1]), start, method, times, rtol=TOLERANCE, atol=TOLERANCE).y


def _columns(axes, **places):
    return {f"{name}.{axis}": at[:, k] for name, at in places.items() for k, axis in enumerate(axes)}
