# The settings that the battery runs: both forms everywhere, what serves fewer variants in some of the cells.
from study.advise_study.settings import Setting
from study.extremes_study import tools

FORMS = tuple(map(Setting, tools.FORMS))
OTHERS = (Setting("rattle"), Setting("rattle4"), Setting("rattle6"), Setting("multistep6"),
          *(Setting(form.scheme, (change,)) for change in (
              ("tangent", "kept"), ("precision", "single"), ("precision", "mixed")) for form in FORMS),
          *(Setting(form.scheme, (*change, ("half-step", ""))) for change in ((), (("tangent", "kept"),)) for form in FORMS),
          Setting("rattle4", (("half-step", ""),)))  # of which alone a scene whose motion nobody knows is `ok`
CELLS = {  # axis: labels of the cells that run in OTHERS too
    "loops": ("N = 1", "N = 10", "N = 100"),
    "step": tuple(f"Δt = 1e{power} s" for power in range(-5, 0)),
    "penalty": ("α = 1e4", "α = 1e12"),
    "mass ratio": ("1e-6", "1e3", "1e6"),
    "length": ("1e-6 m", "1e6 m", "100 m, usual step"),
    "offset": ("1000 m",),
    "spring": ("loop, 1e8 N/m", "pendulum, 1e8 N/m"),
    "redundant": ("rod doubled", "third rod at 1e-5 m"),
    "start": ("singular, at rest", "singular, moving", "zero gravity", "hanging at rest"),
    "duration": ("200 s",),
    "denormal": ("lengths 1e-160 m",)}


def of(axis, label):
    """The settings that a cell runs in."""
    return FORMS + OTHERS * (label in CELLS.get(axis, ()))
