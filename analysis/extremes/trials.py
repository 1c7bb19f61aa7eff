# The trials: mechanisms whose motion is known, where simulations jump, lag or hide an error. Is every wrong run told, and no right one?
import math
import random
from dataclasses import replace
from functools import cache
from itertools import product
from pathlib import Path

import numpy
from scipy.optimize import minimize_scalar

from analysis.core.files import from_yaml
from analysis.extremes.cells import FORMS, STEP, Extreme
from analysis.extremes.linkages import Dyad, Linkage, Plate, Side, Slider, Swing, Wheel
from analysis.extremes.mechanisms import Beside, Damped, LightEnd, Standard, TwoDrives, TwoPendulums, Uneven
from analysis.extremes.motions import Chain
from study.core.setting import Setting
from study.scenes.problems import read_list
from study.scenes.references import EXTRAPOLATED

DISTANCES = (1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2)  # from the change point, in lengths of about a link
STEPS = (1e-2, STEP, 2e-4)                        # s
MASSES = tuple(10.0**-power for power in range(3, 13))
SIZES = (1e-1, 1e-2, 1e-3)                        # m, of mechanisms beside a rod of 1 m
UNEVEN = (1e-9, 1e-6, 1e-3, 1e-2)                 # shares by which speeds disagree
DRAWN = 4                                         # four-bars whose lengths are drawn by lot
MORE = ("crank-rocker", "double crank", "offset", "Watt")  # of which two freedoms, and feet that move, are tried too
LONG = 100.0                                      # s
HALF = ("half-step", "")
DRIVEN = tuple(Setting(form.scheme, changes) for changes in ((), (HALF,), (("tangent", "kept"),)) for form in FORMS)
FREE = (*DRIVEN, *map(Setting, ("rattle", "rattle4", "rattle6", "multistep6")))  # these take no drivers
LOOSE = tuple(Setting(form.scheme, (("projections", "none"), ("tolerance", "1e-4"))) for form in FORMS)  # as study/advise may name
PASSAGE, REGULAR = ("wrong-branch",), ("wrong-branch", "diverged", "not-converged")  # what is no outcome of a motion that is right
STANDARD = ("standard problem", "example or family")
EXAMPLES = from_yaml(Path(__file__).with_name("examples.yaml").read_text())


def four_bar(crank, coupler, rocker, ground, side=Side()):
    return Linkage((("A", (0.0, 0.0)), ("D", (ground, 0.0))), crank, (Dyad("C", ("B", "D"), (coupler, rocker), side),))


def slider_crank(crank, rod, offset=0.0, side=Side()):
    return Linkage((("A", (0.0, 0.0)), ("D", (0.0, offset))), crank, (Slider("C", "B", rod, "D", side),))


def quick_return(crank, ground, swing):
    return Linkage((("A", (0.0, 0.0)), ("D", (ground, 0.0))), crank, (Swing("C", "D", "B", swing),))


def _longer(base, foot, plate, gap, share):
    """`base` with a plate on it and a dyad from that to one more foot, which is stretched but for `gap` where it is farthest."""
    base = replace(base, feet=(*base.feet, ("F", foot)), followers=(*base.followers, plate))

    def far(angle):
        at = base.at(numpy.atleast_1d(angle))
        return numpy.hypot(*(at[plate.name] - at["F"]))
    turn = numpy.linspace(0, 2 * math.pi, 3601)
    around = turn[far(turn).argmax()]
    most = -minimize_scalar(lambda angle: -far(angle)[0], bounds=(around - 0.01, around + 0.01), method="bounded", options={"xatol": 1e-12}).fun
    first = share * most
    return replace(base, followers=(*base.followers, Dyad("E", (plate.name, "F"), (first, most - first + gap))))


def drawn(number, gap):
    """A four-bar drawn by lot whose crank turns fully, by Grashof's rule with `gap` to spare."""
    lot = random.Random(number)
    short = lot.uniform(0.3, 0.6)
    other, another = (lot.uniform(short + 0.2, 1.5) for _ in range(2))
    long = other + another - short - gap
    links = lot.sample([other, another, long], 3)
    side = Side(lot.choice((1, -1)))
    return four_bar(short, *links, side) if number % 2 else four_bar(*links, short, side)


def near(gap):
    """{(kind, name): linkage} at `gap` from its change point."""
    return {("four-bar", "rhombus"): four_bar(1.0, 1.0, 1.0, 1 - gap),
            ("four-bar", "crank-rocker"): four_bar(0.4 - gap, 1.0, 0.4, 1.0),
            ("four-bar", "kite"): four_bar(0.5, 1.0, 1.0, 0.5 - gap),
            ("four-bar", "double crank"): four_bar(1.2, 0.9, 1.0, 0.7 - gap, Side(-1)),
            **{("four-bar", f"drawn {number}"): drawn(number, gap) for number in range(1, DRAWN + 1)},
            ("slider-crank", "centric"): slider_crank(0.5, 0.5 + gap),
            ("slider-crank", "offset"): slider_crank(0.4, 0.55 + gap, 0.15),
            ("slider-crank", "offset, behind"): slider_crank(0.6, 0.8 + gap, -0.2, Side(-1)),
            ("slider-crank", "quick return"): quick_return(0.5, 0.5 + gap, 0.8),
            ("six-bar", "Watt"): _longer(four_bar(0.5, 1.1, 0.9, 1.2), (2.4, 0.1), Plate("P", ("D", "C"), 0.5, -0.4), gap, 0.55),
            ("six-bar", "Stephenson"): _longer(four_bar(0.4, 1.0, 0.9, 1.1), (0.3, -1.0), Plate("P", ("B", "C"), 0.6, 0.5), gap, 0.6),
            ("six-bar", "Stephenson, bent"): _longer(four_bar(0.3, 0.9, 0.8, 1.0), (1.5, 1.2), Plate("P", ("B", "C"), 0.4, -0.3), gap, 0.4)}


PASSING = {"parallelogram": four_bar(0.5, 1.0, 0.5, 1.0, Side(1, 0.0)), "antiparallelogram": four_bar(0.5, 1.0, 0.5, 1.0, Side(-1, 0.0)),
           "Cardan": slider_crank(0.5, 0.5, side=Side(1, -math.pi / 2))}
FAR = {"double crank": four_bar(1.2, 1.1, 1.0, 0.4), "crank-rocker": four_bar(0.3, 1.0, 0.8, 0.9), "slider-crank": slider_crank(0.3, 0.9, 0.1),
       "quick return": quick_return(0.3, 0.7, 0.9)}


@cache
def all_trials():
    return [*_standard(), *_near(), *_passing(), *_worked(), *_uneven(), *_small(), *_long()]


def few(trials, standard, others):
    """[(trial, setting)]: first `standard` of the standard problems' runs, then a sample of `others` of the others; all with 0."""
    known, rest = ([(trial, setting) for trial in trials if (trial.axis in STANDARD) == those for setting in trial.settings]
                   for those in (True, False))
    return known[:standard or None] + (random.Random(1).sample(rest, min(others, len(rest))) if others else rest)


def _trials(kind, label, motion, steps, seconds, settings, **more):
    return [Extreme(kind, label, "", motion, motion.document(), step=step, steps=round(seconds / step), length=motion.shortest,
                    settings=settings, **more) for step in steps]


def _near():
    for gap in DISTANCES:
        for (kind, name), linkage in near(gap).items():
            label = f"{name} at {gap:g}"
            for rate in (1.0, -2.0):
                driven = replace(linkage, rate=rate)
                yield from _trials(f"driven {kind}", f"{label}, {rate:g} per s", driven, STEPS, 6.4 / abs(rate), DRIVEN + LOOSE, near=gap)
            narrow = name in ("rhombus", "kite", "quick return")  # what follows the crank turns over within this angle
            if gap >= 1e-3 or not narrow:
                free = replace(linkage, driven=False, finest=gap if narrow else 1.0)
                yield from _trials(f"free {kind}", label, free, STEPS, 3.2, FREE + LOOSE, near=gap)
            if name in MORE:
                wheel = replace(free, followers=(*free.followers, Wheel("W", free.points[-1])))
                yield from _trials("free, with a wheel", label, wheel, STEPS[:2], 3.2, FREE, near=gap)
                yield from _trials("free, carried", label, replace(free, carried=0.5), STEPS[:2], 3.2, DRIVEN, near=gap)


def _passing():
    for kind, linkages, harmless in (("passage", PASSING, PASSAGE), ("far", FAR, REGULAR)):
        for (name, linkage), rate in product(linkages.items(), (1.0, -2.0)):
            driven, label = replace(linkage, rate=rate), f"{name}, {rate:g} per s"
            yield from _trials(f"{kind}, driven", label, driven, STEPS[1:], 20 / abs(rate), DRIVEN[:4], harmless=harmless)
            yield from _trials(f"{kind}, free", label, replace(driven, driven=False), STEPS[1:], 6.4, FREE, harmless=harmless)


def _worked():
    """Where drivers or dampers do work, so that energy is not conserved."""
    for step in (1e-2, 5e-3, STEP):
        for speed, (rate, gravity) in product((0.5, 5.0), ((1.0, 0.0), (4.0, 3.0))):
            carried = Linkage((("A", (0.0, 0.0)),), 1.0, (), rate=rate, driven=False, gravity=gravity, carried=speed)
            yield from _trials("carried pendulum", f"at {speed:g} m/s, gravity {gravity:g} m/s²", carried, [step], 5.0, DRIVEN, harmless=REGULAR)
        for damping in (0.4, 1.0, 10.0):
            yield from _trials("damped rod", f"{damping:g} N m s", Damped(damping), [step], 5.0, DRIVEN, harmless=REGULAR)


def _uneven():
    """Parts of which one is far lighter, drives of which one is a little faster."""
    for mass, step in product(MASSES, STEPS[:2]):
        yield from _trials("light part", f"lower rod of {mass:g} kg", LightEnd(mass), [step], 8.0, FREE, near=mass)
        yield from _trials("light part", f"pendulum of {mass:g} kg beside one of 1 kg", TwoPendulums(mass), [step], 8.0, FREE, near=mass)
    for share in UNEVEN:
        yield from _trials("uneven speeds", f"three cranks, by {share:g}", Uneven(1, share=share), [STEP], 5.0, FREE, near=share)
        yield from _trials("uneven speeds", f"crank doubled, by {share:g}", Uneven(1, share=share, same_points=False), [STEP], 5.0, FREE, near=share)
        yield from _trials("uneven speeds", f"two drives, by {share:g}", TwoDrives(share), [STEP], 6.4, DRIVEN, near=share)


def _small():
    """Beside something large, by which they must not be measured."""
    for size in SIZES:
        linkages = {"rhombus": four_bar(size, size, size, (1 - 1e-5) * size), "crank-rocker": four_bar(0.39999 * size, size, 0.4 * size, size),
                    "far": four_bar(0.3 * size, size, 0.8 * size, 0.9 * size)}
        for (name, linkage), step in product(linkages.items(), STEPS[:2]):
            yield from _trials("small part, driven", f"{name} of {size:g} m", Beside(linkage), [step], 6.4, DRIVEN, near=size)
            if name != "rhombus":
                yield from _trials("small part, free", f"{name} of {size:g} m", Beside(replace(linkage, driven=False)), [step], 3.2, FREE, near=size)


def _long():
    for step in STEPS[:2]:
        for loops in (1, 2, 5):
            yield from _trials("100 s", f"{loops} loops", Chain(loops), [step], LONG, FREE)
        for (kind, settings), (name, linkage) in product((("driven", DRIVEN[:2]), ("free", FREE)), FAR.items()):
            yield from _trials("100 s", f"{name}, {kind}", replace(linkage, driven=kind == "driven"), [step], LONG, settings)


def _standard():
    for scene, length in EXAMPLES.items():
        yield Extreme(STANDARD[1], scene.rpartition("/")[2].removesuffix(".json"), scene, None, steps=1600, length=length,
                      kept=("all",), settings=FORMS, harmless=REGULAR)
    for one in read_list()[1]:
        own = tuple(option for option in one.options if option not in (("penalty", "auto"), ("tolerance", "auto"), ("max-passes", "20")))
        yield Extreme(STANDARD[0], one.name, one.scene, None if one.known == EXTRAPOLATED else Standard(one.known), step=one.steps[0],
                      steps=round(one.duration / one.steps[0]), length=one.link,
                      kept=("B0.x", "B0.y") if one.scene.startswith("four-bar") else ("outputs",),
                      settings=(Setting("penalty", own),) if own else FORMS, harmless=REGULAR)
