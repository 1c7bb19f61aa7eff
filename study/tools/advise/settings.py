# The settings that advice considers, as options of `mbs simulate`, and who serves them.
from study.core.setting import Setting

# What is changed beside the scheme, one combination a line. Measured on the N-four-bar: the penalty
# form bears neither a loose tolerance nor missing projections, whatever the step.
CHANGES = {
    "penalty": [
        {}, {"multipliers": "converged"}, {"tangent": "every-step"}, {"tangent": "kept"},
        {"projections": "velocity"}, {"precision": "mixed"}, {"precision": "single"},
        {"geometric-stiffness": ""},
        {"multipliers": "converged", "tangent": "every-step"}],
    "saddle-point": [
        {}, {"tolerance": "loose"}, {"projections": "velocity"}, {"projections": "none"},
        {"tangent": "every-step"}, {"tangent": "kept"}, {"precision": "mixed"},
        {"precision": "single"}, {"geometric-stiffness": ""},
        {"tolerance": "loose", "projections": "velocity"},
        {"tolerance": "loose", "projections": "none"},
        {"tolerance": "loose", "tangent": "every-step"},
        {"tolerance": "loose", "tangent": "kept"},
        {"tolerance": "loose", "geometric-stiffness": ""}],
    "rattle": [{}], "rattle4": [{}], "rattle6": [{}], "multistep6": [{}]}


def catalogue():
    """All settings, a scheme's own before what changes it."""
    return [Setting(scheme, tuple(changes.items())) for scheme, all_changes in CHANGES.items()
            for changes in all_changes]


def fits(setting, scene):
    """Why a scheme cannot be used for a scene (`mbs describe --json`), or ""."""
    terms = scene["terms"]
    if setting.scheme.startswith(("rattle", "multistep")):
        if (terms["driven_constraints"] or terms["factors"] or scene["driven_points"] or scene["driven_vectors"]):
            return "not for scenes with drivers"
        if terms["damping"]:
            return "not for scenes with dampers"
    return ""


def serving(setting, variants):
    """Names of the `variants` ({name: what `mbs list --json` says}) that serve a setting."""
    return [name for name, said in variants.items() if setting.needs <= set(said["settings"])]
