# Writes the scenes of this folder whose numbers follow from formulas: python3 generate.py
import json
from math import cos, pi, sin
from pathlib import Path

HERE = Path(__file__).parent


def write(name, comment, scene):
    """One member a line, and one entry a line within the lists, so that differences can be read."""
    lines = [f"// {line}" for line in comment.split("\n")] + ["{"]
    members = list(scene.items())
    for key, value in members:
        end = "," if key != members[-1][0] else ""
        if isinstance(value, list) and value and isinstance(value[0], dict):
            rows = ",\n".join("    " + json.dumps(entry) for entry in value)
            lines.append(f'  "{key}": [\n{rows}\n  ]{end}')
        else:
            lines.append(f'  "{key}": {json.dumps(value)}{end}')
    (HERE / name).write_text("\n".join(lines + ["}"]) + "\n")


def point(name, position, **more):
    return {"name": name, "position": [float(x) for x in position]} | more


def andrews():
    beta, gamma = -0.0617138900142764496, 0.455279819163070380
    phi, delta = 0.222668390165885885, 0.487364979543842550
    omega, epsilon = -0.222668390165885885, 1.23054744454982119

    def away(start, length, direction):
        return [start[0] + length * direction[0], start[1] + length * direction[1]]

    O, A, B, C = (0, 0), (-0.06934, -0.00227), (-0.03635, 0.03273), (0.014, 0.072)
    E = away(O, 7e-3, (cos(beta), sin(beta)))
    P = away(E, 28e-3, (-cos(beta), -sin(beta)))
    S = away(A, 40e-3, (cos(delta), sin(delta)))
    U = away(A, 40e-3, (sin(epsilon), -cos(epsilon)))
    loops = {"B": away(B, 35e-3, (sin(gamma), -cos(gamma))),
             "S": away(S, 20e-3, (sin(phi + delta), -cos(phi + delta))),
             "U": away(U, 20e-3, (cos(omega + epsilon), sin(omega + epsilon)))}
    for name, end in loops.items():
        assert max(abs(end[0] - P[0]), abs(end[1] - P[1])) < 1e-15, (name, end, P)

    def body(name, ends, length, mass, centre, inertia, **more):
        return {"name": name, "mass": mass, "centre": list(centre), "inertia": inertia,
                "points": {ends[0]: [0, 0], ends[1]: [length, 0]} | more}

    write("a03_andrews.json",
          "A03, Andrews' squeezing mechanism: seven bodies of the size of a relay, driven by a\n"
          "constant torque from rest, 0.03 s. Angles at the start as published; the loops close.",
          {"gravity": [0, 0],
           "points": [point("O", O, fixed=True), point("A", A, fixed=True),
                      point("B", B, fixed=True), point("C", C, fixed=True),
                      point("E", E), point("P", P), point("S", S), point("U", U)],
           "bodies": [body("K1", "OE", 7e-3, 0.04325, (9.2e-4, 0), 2.194e-6),
                      body("K2", "EP", 28e-3, 0.00365, (11.5e-3, 0), 4.410e-7),
                      body("K3", "BP", 35e-3, 0.02373, (18.74e-3, 10.43e-3), 5.255e-6,
                           D=[18e-3, 20e-3]),
                      body("K4", "SP", 20e-3, 0.00706, (5.79e-3, 0), 5.667e-7),
                      body("K5", "AS", 40e-3, 0.07050, (23.08e-3, 9.16e-3), 1.169e-5),
                      body("K6", "UP", 20e-3, 0.00706, (5.79e-3, 0), 5.667e-7),
                      body("K7", "AU", 40e-3, 0.05498, (12.28e-3, -4.49e-3), 1.912e-5)],
           "springs": [{"name": "spring", "between": ["C", "D"], "stiffness": 4530,
                        "length": 77.85e-3}],
           "torques": [{"body": "K1", "torque": 0.033}],
           "outputs": [{"name": name, "position": name} for name in "EPSU"]})


def bricard():
    corners = [(0, 0, 0), (1, 0, 0), (1, -1, 0), (1, -1, 1), (0, -1, 1), (0, 0, 1)]
    axes = "yzxyzx"
    unit = {"x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, 1]}
    about, across = (0.01 + 0.01) / 12, (1 + 0.01) / 12
    bodies = []
    for i in range(5):
        start, end = corners[i], corners[i + 1]
        half = [(e - s) / 2 for s, e in zip(start, end)]
        bodies.append({"name": f"rod{i + 1}", "mass": 1.0,
                       "inertia": [about if h else across for h in half],
                       "points": {f"P{i}": [-h for h in half], f"P{i + 1}": half},
                       "vectors": {f"u{i}": unit[axes[i]], f"u{i + 1}": unit[axes[i + 1]]}})
    ends = (0, 5)
    write("a04_bricard.json",
          "A04, Bricard's mechanism: five rods of square section, six revolute joints, one degree of\n"
          "freedom although counting says none. Corners and axes in order; the first and last are\n"
          "fixed to the ground. 10 s from rest; the energy is conserved.",
          {"dimension": 3,
           "points": [point(f"P{i}", corner, **({"fixed": True} if i in ends else {}))
                      for i, corner in enumerate(corners)],
           "vectors": [{"name": f"u{i}", "direction": unit[axis]}
                       | ({"fixed": True} if i in ends else {}) for i, axis in enumerate(axes)],
           "bodies": bodies,
           "outputs": [{"name": "P3", "position": "P3"}, {"name": "energy", "energy": "total"}]})


def governor():
    density, rate = 3000.0, 2 * pi
    down = pi / 6  # arms at the start, below the horizontal
    shaft, arm, cube = 0.3, 0.3, density * 0.1 ** 3
    thin, long = (0.01 ** 2 + 0.01 ** 2) / 12, (1 + 0.01 ** 2) / 12

    def spin(r):
        return [rate * r[2], 0.0, -rate * r[0]]

    def moving(name, r):
        return point(name, r, velocity=spin(r))

    points = [point("O", (0, 0, 0), fixed=True)]
    bodies = [{"name": "shaft", "mass": shaft, "centre": [0, 0.5, 0],
               "inertia": [shaft * long, shaft * thin, shaft * long],
               "points": {"O": [0, 0, 0], "H1": [0.05, 1, 0], "H2": [-0.05, 1, 0]},
               "vectors": {"up": [0, 1, 0], "u": [1, 0, 0], "w": [0, 0, 1]}}]
    for i, side in ((1, 1), (2, -1)):
        hinge = (side * 0.05, 1.0, 0.0)
        along = (side * cos(down), -sin(down), 0.0)
        points += [moving(f"H{i}", hinge),
                   moving(f"M{i}", [h + 0.5 * a for h, a in zip(hinge, along)]),
                   moving(f"P{i}", [h + a for h, a in zip(hinge, along)]),
                   moving(f"E{i}", (side * 0.05, 0.5, 0.0))]
        bodies.append({"name": f"arm{i}", "mass": arm, "centre": [0.5, 0, 0],
                       "inertia": [arm * thin, arm * long, arm * long],
                       "points": {f"H{i}": [0, 0, 0], f"M{i}": [0.5, 0, 0], f"P{i}": [1, 0, 0]},
                       "vectors": {"w": [0, 0, side]}})
    points.append(point("S", (0, 0.5, 0)))
    inertia = cube * (0.1 ** 2 + 0.1 ** 2) / 12
    bodies.append({"name": "slider", "mass": cube, "inertia": [inertia] * 3,
                   "points": {"S": [0, 0, 0], "E1": [0.05, 0, 0], "E2": [-0.05, 0, 0]},
                   "vectors": {"up": [0, 1, 0], "u": [1, 0, 0], "w": [0, 0, 1]}})
    write("a05_governor.json",
          "A05, stiff flyball governor: the shaft turns about y at 2 pi rad/s at the start; each arm\n"
          "is hinged 0.05 m beside its top, 30 degrees below the horizontal, so that the springs to\n"
          "the slider's sides start without force; 5 kg at the arms' ends. 10 s.",
          {"dimension": 3,
           "points": points,
           "vectors": [{"name": "up", "direction": [0, 1, 0], "fixed": True},
                       {"name": "u", "direction": [1, 0, 0], "velocity": spin((1, 0, 0))},
                       {"name": "w", "direction": [0, 0, 1], "velocity": spin((0, 0, 1))}],
           "bodies": bodies,
           "masses": [{"point": "P1", "mass": 5.0}, {"point": "P2", "mass": 5.0}],
           "constraints": [{"type": "on_line", "point": "S", "line": "O", "direction": "up",
                            "name": "slider on shaft"}],
           "springs": [{"name": f"spring{i}", "between": [f"M{i}", f"E{i}"], "stiffness": 8e5,
                        "damping": 4e4, "length": 0.5} for i in (1, 2)],
           "outputs": [{"name": "slider", "position": "S"}, {"name": "P1", "position": "P1"}]})


def chain(links=200):
    length, span = 0.1, 12.0
    # A curve of the right length: assembled onto the links' lengths when it is read.
    sag = 6.0
    points = []
    for i in range(links + 1):
        x = span * (i / links - 0.5)
        y = sag * (abs(2 * x / span) ** 2 - 1) * 0.8 + 0.6 * cos(3 * pi * x / span)
        points.append([x, y])
    ends = [0, links]
    shift = 0.6 * cos(1.5 * pi)
    write("chain_200.json",
          "A chain of 200 links of 0.1 m and 0.05 kg between two fixed points 12 m apart, released\n"
          "from a symmetric wave. Energy is conserved, and left and right mirror each other.",
          {"points": [point(f"P{i}", (round(x, 6), round(y - shift, 6)),
                            **({"fixed": True} if i in ends else {}))
                      for i, (x, y) in enumerate(points)],
           "rods": [{"between": [f"P{i}", f"P{i + 1}"], "mass": 0.05, "length": length}
                    for i in range(links)],
           "assembly": {"largest_correction": 5.0},
           "outputs": [{"name": name, "position": name} for name in
                       (f"P{links // 4}", f"P{links // 2}", f"P{links - links // 4}")]
           + [{"name": "energy", "energy": "total"}]})


def grid(size=10):
    lean = 0.5  # rad from the vertical at the start
    points, rods = [], []
    for row in range(size + 1):
        for column in range(size + 1):
            fixed = {"fixed": True} if row == 0 else {}
            points.append(point(f"P{row}_{column}",
                                (column + row * sin(lean), -row * cos(lean)), **fixed))
    for row in range(1, size + 1):
        for column in range(size + 1):
            rods.append({"between": [f"P{row - 1}_{column}", f"P{row}_{column}"], "mass": 1.0})
            if column:
                rods.append({"between": [f"P{row}_{column - 1}", f"P{row}_{column}"], "mass": 1.0})
    last = f"P{size}_{size}"
    write("grid_10.json",
          "A 10 x 10 grid of four-bars hanging from a fixed row, all rods 1 m and 1 kg, released at\n"
          "rest and leaning. The rods of a row stay parallel: a chain of ten, which is the reference.",
          {"points": points, "rods": rods,
           "outputs": [{"name": "corner", "position": last},
                       {"name": "middle", "position": f"P{size // 2}_{size // 2}"},
                       {"name": "energy", "energy": "total"}]})


for scene in (andrews, bricard, governor, chain, grid):
    scene()
