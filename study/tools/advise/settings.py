# The settings that advice considers, as options of `mbs simulate`, and who serves them.
from itertools import product

from study.core.setting import LOOSENED, Setting

PROJECTIONS = {"penalty": ("both", "velocity", "none"), "saddle-point": ("both", "velocity", "none")}
SCHEMES = ("penalty", "saddle-point", "rattle", "rattle4", "rattle6", "multistep6")
CHEAP = (("projections", "velocity"), ("tolerance", "one-pass"))
OTHERS = [Setting("saddle-point", (("tangent", "every-step"),)), *(Setting(scheme, (change, *CHEAP)) for scheme, change in (
    ("saddle-point", ("tangent", "kept")), ("penalty", ("precision", "single")), ("penalty", ("geometric-stiffness", ""))))]


def catalogue():
    """Scheme × projections × tolerance, a scheme's own first; of what else changes a step, what was the fastest somewhere (README.md)."""
    found = []
    for scheme in SCHEMES:
        for projections, tolerance in product(PROJECTIONS.get(scheme, ("both",)), ("auto", *LOOSENED)):
            asked = {"projections": projections, "tolerance": tolerance}
            found.append(Setting(scheme, tuple(one for one in asked.items() if one[1] not in ("both", "auto"))))
    return [*found, *OTHERS]


def fits(setting, scene):
    """Why a scheme cannot be used for a scene (`mbs describe --json`), or ""."""
    terms = scene["terms"]
    if not setting.scheme.startswith(("rattle", "multistep")):
        return ""
    if terms["driven_constraints"] or terms["factors"] or scene["driven_points"] or scene["driven_vectors"]:
        return "not for scenes with drivers"
    return "not for scenes with dampers" if terms["damping"] else ""


def serving(setting, variants):
    """Names of the `variants` ({name: what `mbs list --json` says}) that serve a setting."""
    return [name for name, said in variants.items() if setting.needs <= set(said["settings"])]
