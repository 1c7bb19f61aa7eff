# The scenes of the battery that are more than a chain of four-bars: springs, redundant rods.
from analysis.extremes.motions import GRAVITY, Chain, fixed, rod


def unlike_masses(loops, ratio):
    """Every second rod and every second coupler has `ratio` kg, the others 1 kg."""
    masses = tuple(ratio if i % 2 else 1.0 for i in range(loops + 1))
    return Chain(loops, rods=masses, couplers=masses[:-1])


def sprung_pendulum(stiffness):
    """A mass at the end of a rod, another on a spring behind it, released on a horizontal line: nothing pulls
    then, so that a stiff spring starts without vibration."""
    return {"points": [fixed("A", 0, 0), {"name": "B", "position": [1, 0]}, {"name": "C", "position": [2, 0]}],
            "gravity": [0.0, -GRAVITY],
            "rods": [rod("rod", "A", "B", mass=0)],
            "masses": [{"point": "B", "mass": 1.0}, {"point": "C", "mass": 1.0}],
            "springs": [{"name": "spring", "between": ["B", "C"], "stiffness": stiffness, "length": 1.0}]}


def twin_rod(same_points):
    """One loop whose first rod is there twice; the second has a foot of its own at the same place, or not."""
    document = Chain(1).document()
    document["points"] += [] if same_points else [fixed("A", 0, 0)]
    document["rods"].append(rod("twin", "A0" if same_points else "A", "B0", mass=0))
    return document


def shifted_rod(shift):
    """One loop with a third rod, massless, `shift` m beside the first: nearly redundant."""
    document = Chain(1).document()
    document["rods"] = [rod for rod in document["rods"] if rod["name"] != "coupler0"]
    document["bodies"] = [{"name": "coupler0", "mass": 1.0, "centre": [0.5, 0], "inertia": 1 / 12,
                           "points": {"B0": [0, 0], "C": [shift, 0], "B1": [1, 0]}}]
    document["points"].append(fixed("A", shift, 0))
    document["rods"].append(rod("third", "A", "C", mass=0))
    return document
