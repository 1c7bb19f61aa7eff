#!/usr/bin/python3
# Stands in for `mbs` in the viewer's tests: motions by formula. Scenes are crank (planar), top
# (spatial), chain:N, old (describe without elements), stiff (needs small steps), slow and
# short (driven until 0.5 s).
import json
import math
import sys

PLACES = {"crank": 2, "top": 3, "stiff": 2, "slow": 2, "short": 2}


def crank(t):
    """A slider-crank whose coupler is a plate, springs to the ground and to a driven point."""
    e = (0.3 * math.cos(4 * t), 0.3 * math.sin(4 * t))
    p = (e[0] + math.sqrt(1 - e[1] ** 2), 0.0)
    along = (p[0] - e[0], p[1] - e[1])
    d = (e[0] + 0.5 * along[0] - 0.4 * along[1], e[1] + 0.5 * along[1] + 0.4 * along[0])
    return {"O": ("fixed", (0, 0)), "E": ("free", e), "P": ("free", p), "D": ("marker", d),
            "C": ("fixed", (0.2, 1.1)), "R": ("driven", (1.9, 0.15 * math.sin(7 * t)))}


def top(t):
    """A tetrahedron that precesses about O, a rod that hangs from it, a spring to the ground."""
    spin, lean = 2 * t, 0.5 + 0.1 * math.sin(5 * t)
    axis = (math.sin(lean) * math.cos(spin), math.cos(lean), math.sin(lean) * math.sin(spin))
    side = (-math.sin(spin), 0.0, math.cos(spin))
    third = tuple(axis[(i + 1) % 3] * side[(i + 2) % 3] - axis[(i + 2) % 3] * side[(i + 1) % 3]
                  for i in range(3))

    def at(along, out, turned):
        return tuple(along * axis[i] + out * (math.cos(turned + 3 * t) * side[i]
                                              + math.sin(turned + 3 * t) * third[i])
                     for i in range(3))
    corners = {name: ("free", at(0.8, 0.4, k * 2 * math.pi / 3)) for k, name in enumerate("TUV")}
    tip = corners["T"][1]
    hang = (tip[0] + 0.4 * math.sin(0.3), tip[1] - 0.4 * math.cos(0.3), tip[2])
    return {"O": ("fixed", (0, 0, 0)), **corners, "W": ("free", hang),
            "G": ("fixed", (1.1, -0.2, 0)), "a": ("vector", axis)}


def chain(links, t):
    points = {"A": ("fixed", (0, 0))}
    for k in range(1, links + 1):
        s = k / links
        points[f"B{k}"] = ("free", (s * math.cos(0.3 * math.sin(t - 2 * s)),
                                    -s + 0.2 * s * math.sin(3 * t + 9 * s)))
    return points


def place(scene, t):
    if scene.startswith("chain:"):
        return chain(int(scene[6:]), t)
    return top(t) if scene == "top" else crank(t)


def elements(scene):
    points = place(scene, 0.0)
    names = list(points)
    listed = {"points": [{"name": name, "kind": kind, "helper": False, "position": list(at)}
                         for name, (kind, at) in points.items()],
              "rods": [], "distances": [], "bodies": [], "springs": [], "torsion_springs": [], "outputs": []}
    if scene.startswith("chain:"):
        listed["rods"] = [{"name": "", "between": [a, b]} for a, b in zip(names, names[1:])]
    elif scene == "top":
        listed["bodies"] = [{"name": "K", "points": list("OTUV"), "vectors": ["a"]}]
        listed["rods"] = [{"name": "hanging", "between": ["T", "W"]}]
        listed["springs"] = [{"name": "s", "between": ["W", "G"]}]
        listed["torsion_springs"] = [{"name": "", "from": ["O", "T"], "to": ["O", "a"]}]
    else:
        listed["bodies"] = [{"name": "plate", "points": ["E", "P", "D"], "vectors": []}]
        listed["rods"] = [{"name": "crank", "between": ["O", "E"]}]
        listed["springs"] = [{"name": "a", "between": ["C", "D"]},
                             {"name": "b", "between": ["R", "P"]}]
        listed["torsion_springs"] = [{"name": "", "from": ["O", "C"], "to": ["O", "E"]}]
        listed["outputs"] = ["slider", "turned"]
    return listed


def option(name, default=None):
    return sys.argv[sys.argv.index(name) + 1] if name in sys.argv else default


def simulate(scene):
    step, duration = float(option("--step")), float(option("--duration"))
    if scene == "short" and duration > 0.5:
        print(f"mbs: --duration: the run would end at {duration:g} s, but a driver's table ends at "
              "0.5 s", file=sys.stderr)
        sys.exit(2)
    if scene == "stiff" and step > 2e-5:
        sys.exit("mbs: any/one on stiff: diverged at t = 0.1 s: energy")
    if scene == "stiff":
        print("mbs: degraded: local errors add up to 1 m", file=sys.stderr)
    if "--json" in sys.argv:
        print(json.dumps({"step_us": {"median": 1e6 if scene == "slow" else 1.0}}))
    if "--trajectory" not in sys.argv:
        return
    every, axes = int(option("--every", "1")), "xyz"[:len(place(scene, 0.0)["O" if scene in PLACES
                                                                          else "A"][1])]
    with open(option("--trajectory"), "w") as file:
        names = [f"{name}.{v}{axis}" for name in place(scene, 0.0) for v in ("", "v")
                 for axis in axes]
        print(",".join(["t", *names, "kinetic_energy", "potential_energy",
                        "constraint_violation"]), file=file)
        for k in range(0, round(duration / step) + 1, every):
            t = k * step
            values = [x for _, at in place(scene, t).values() for x in (*at, *[0] * len(at))]
            print(",".join(map(str, [t, *values, 2 + math.sin(8 * t), 3 - math.sin(8 * t),
                                     1e-9 * (1.1 + math.sin(40 * t))])), file=file)


    if "--output" in sys.argv:
        with open(option("--output"), "w") as file:
            print("t,slider.x,slider.y,turned", file=file)
            for k in range(0, round(duration / step) + 1, every):
                print(k * step, *crank(k * step)["P"][1], 4 * k * step, sep=",", file=file)


def main():
    command, scene = sys.argv[1], sys.argv[2]
    known = scene in PLACES or scene.startswith("chain:") or scene == "old"
    if not known:
        print(f"mbs: cannot open {scene}: No such file or directory", file=sys.stderr)
        sys.exit(2)
    if command == "simulate":
        return simulate(scene)
    description = {"dimension": PLACES.get(scene, 2), "variables": 4, "constraints": 3,
                   "degrees_of_freedom": 1, "drivers_end": 0.5 if scene == "short" else None}
    if scene != "old":
        description["elements"] = elements(scene)
    print(json.dumps(description))


if __name__ == "__main__":
    main()
