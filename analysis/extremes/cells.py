# The cells of the battery: scene, what is extreme in it, and what the motion is known to be.
import math
import unicodedata
from dataclasses import dataclass, field

from analysis.extremes.motions import Chain, Flat, shifted_rod, sprung_pendulum, twin_rod, unlike_masses
from study.core.setting import Setting

STEP, STEPS = 1.25e-3, 2000
INSTANTS = 20        # of a run at least, at which it is judged ...
TURN = 2             # ... and in a turn of about 2 s, where a run has many
LONGEST = 5.0        # s of simulated time where the step is what is varied
SIZES = {1: STEPS, 10: STEPS, 100: 1200, 1000: 100, 10000: 24}  # loops: steps; 1.25 s are past two singular positions
JSON_LOOPS = 1000    # up to this size the scene is a file: the program knows the exact motion of `four-bar:N`
LOOPS = 5            # where size is not what is varied

FORMS = (Setting("penalty"), Setting("saddle-point"))  # of every cell
OTHERS = (Setting("rattle"), Setting("rattle4"), Setting("rattle6"), Setting("multistep6"),  # of the telling ones
          *(Setting(form.scheme, (change,)) for change in (
              ("tangent", "kept"), ("precision", "single"), ("precision", "mixed"), ("geometric-stiffness", "")) for form in FORMS),
          Setting("penalty", (("scale-equations", ""),)), Setting("penalty", (("multipliers", "converged"),)),
          *(Setting(form.scheme, (*change, ("half-step", ""))) for change in ((), (("tangent", "kept"),)) for form in FORMS),
          Setting("rattle4", (("half-step", ""),)))  # of which alone a scene whose motion nobody knows is `ok`
TELLING = {  # axis: labels of its most telling cells, these in order
    "loops": ("N = 10", "N = 1", "N = 100"),
    "step": tuple(f"Δt = 1e{power} s" for power in (-2, -5, -1, -4, -3)),
    "penalty": ("α = 1e12", "α = 1e4"),
    "mass ratio": ("1e6", "1e3", "1e-6"),
    "length": ("1e-6 m", "1e6 m", "100 m, usual step"),
    "offset": ("1000 m",),
    "spring": ("pendulum, 1e8 N/m", "loop, 1e8 N/m"),
    "redundant": ("third rod at 1e-5 m", "rod doubled"),
    "start": ("singular, at rest", "singular, moving", "zero gravity", "hanging at rest"),
    "denormal": ("lengths 1e-160 m",)}


@dataclass(frozen=True)
class Extreme:
    axis: str
    label: str
    scene: str                # of `mbs`, or "": a file of this name
    motion: object            # Chain, Linkage or what else has `solutions`; None: the reference in shorter steps
    document: dict | None = field(default=None, compare=False)
    step: float = STEP
    steps: int = STEPS
    penalty: str = "auto"
    length: float = 1.0       # m, of a link, the shortest: what errors are relative to
    kept: tuple = ()          # columns of the trajectory; empty: those of the motion
    # Of trials:
    settings: tuple = FORMS
    near: float = math.nan    # distance from the change point, m; a light mass, kg; a size, m; a share of speed
    harmless: tuple = ()      # outcomes that no motion of it deserves

    @property
    def name(self):
        """Of its scene: what tells its records from those of others."""
        if self.scene:
            return self.scene
        words = f"{self.axis} {self.label}".replace("/", " per ").replace("Δ", "d").replace("α", "alpha")
        words = unicodedata.normalize("NFKD", words)  # a raised 2 becomes 2
        return "-".join("".join(c if c.isalnum() or c in "-+." else " " for c in words).split())

    columns = property(lambda self: self.kept or self.motion.columns)  # of its motion: those that are kept
    loops = property(lambda self: self.motion.loops if self.motion else 1)
    work = property(lambda self: self.loops * self.steps)  # what its runs cost, about: the cheap ones of equal worth come first

    @property
    def every(self):
        """Steps between two instants at which it is judged."""
        turns = self.step * self.steps / (2.0 * self.length**0.5)
        return max(1, self.steps // max(INSTANTS, round(TURN * turns)))

    @property
    def place(self):
        """Among the most telling ones of its axis; None if it is none of them."""
        telling = TELLING.get(self.axis, ())
        return telling.index(self.label) if self.label in telling else None


def _short(value):
    """1e6 for 1000000, 1e-160 for 1e-160, 0.01 for 0.01."""
    mantissa, _, power = f"{value:g}".partition("e")
    return f"{mantissa}e{int(power)}" if power else mantissa


def extremes():
    """All cells that are extreme in one respect, in the order of the picture."""
    return [*_of_chains(), *_constraints(), *_starts()]


def _chain(axis, label, chain, **more):
    return Extreme(axis, label, "", chain, chain.document(), length=chain.length, **more)


def _of_chains():
    for loops, steps in SIZES.items():
        yield (_chain("loops", f"N = {loops}", Chain(loops), steps=steps) if loops <= JSON_LOOPS else
               Extreme("loops", f"N = {loops}", f"four-bar:{loops}", Chain(loops), steps=steps))
    for power in range(-6, 0):
        yield _chain("step", f"Δt = 1e{power} s", Chain(LOOPS), step=10.0**power, steps=min(STEPS, round(LONGEST / 10.0**power)))
    for power in range(2, 17, 2):
        yield _chain("penalty", f"α = 1e{power}", Chain(LOOPS), penalty=f"1e{power}")
    for power in (-9, -6, -3, 3, 6, 9):
        yield _chain("mass ratio", f"1e{power}", unlike_masses(LOOPS, 10.0**power))
    long = lambda length: Chain(LOOPS, length=length, rate=length**-0.5)
    for power in range(-6, 7, 2):  # steps in proportion to sqrt(length), as the motion is ...
        yield _chain("length", f"{_short(10.0**power)} m", long(10.0**power), step=STEP * 10.0**(power // 2))
    for length in (1e-2, 1e2):     # ... and two with the usual step
        yield _chain("length", f"{_short(length)} m, usual step", long(length))
    for offset in (1e3, 1e6):
        yield _chain("offset", f"{_short(offset)} m", Chain(LOOPS, offset=offset))


def _constraints():
    for stiffness in (1e6, 1e8, 1e10, 1e12):
        spring = {"name": "spring", "between": ["B0", "B1"], "stiffness": stiffness, "length": 1.0}  # beside a coupler, at its free length
        yield Extreme("spring", f"loop, {_short(stiffness)} N/m", "", Chain(2), Chain(2).document() | {"springs": [spring]})
        yield Extreme("spring", f"pendulum, {_short(stiffness)} N/m", "", None, sprung_pendulum(stiffness), steps=800,
                      kept=("B.x", "B.y", "C.x", "C.y"))
    yield Extreme("redundant", "rod given twice", "", Chain(1), twin_rod(same_points=True))
    yield Extreme("redundant", "rod doubled", "", Chain(1), twin_rod(same_points=False))
    for shift in (1e-3, 1e-5, 1e-7, 1e-9):
        yield Extreme("redundant", f"third rod at {_short(shift)} m", "", Chain(1), shifted_rod(shift))


def _starts():
    flat, moving = math.pi / 2, math.sqrt(1 + 2 * Chain(2).k)  # as fast as four-bar:2 gets there
    # At 1 s the first one rests on a line again, and other motions become possible.
    yield _chain("start", "singular, at rest", Flat(1, angle=flat, rate=0.0), steps=600)
    yield _chain("start", "singular, moving", Chain(2, angle=flat, rate=moving))
    yield _chain("start", "zero gravity", Chain(LOOPS, gravity=0.0))
    yield _chain("start", "zero gravity, at rest", Chain(LOOPS, gravity=0.0, rate=0.0))
    yield _chain("start", "hanging at rest", Chain(LOOPS, angle=math.pi, rate=0.0))
    yield _chain("start", "upright at rest", Chain(LOOPS, rate=0.0))
    tiny, short = 1e-310, 1e-160  # denormal numbers
    yield _chain("denormal", f"masses {_short(tiny)} kg", Chain(1, rods=(tiny, tiny), couplers=(tiny,)))
    yield _chain("denormal", f"a rod of {_short(tiny)} kg", Chain(1, rods=(1.0, tiny)))
    yield Extreme("denormal", f"a force of {_short(tiny)} N", "", Chain(1), Chain(1).document() | {
        "forces": [{"name": "push", "point": "B0", "force": [tiny, 0.0]}]})
    yield _chain("denormal", f"gravity {_short(tiny)} m/s²", Chain(1, gravity=tiny))
    yield _chain("denormal", f"lengths {_short(short)} m", Chain(1, length=short, rate=short**-0.5), step=STEP * short**0.5)
