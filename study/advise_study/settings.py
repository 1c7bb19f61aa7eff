# The settings that advice considers, as options of `mbs simulate`, and who serves them.
from dataclasses import dataclass

LOOSE = 10  # a loose tolerance is this times the automatic one of the scheme
ORDERS = {"rattle4": 4, "rattle6": 6, "multistep6": 6}  # of a scheme; the others are of second order

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


@dataclass(frozen=True)
class Setting:
    scheme: str
    changes: tuple = ()  # (option, value) pairs

    @property
    def order(self):
        return ORDERS.get(self.scheme, 2)

    @property
    def loose(self):
        return ("tolerance", "loose") in self.changes

    @property
    def label(self):
        return ", ".join([self.scheme, *(f"{option} {value}".strip() for option, value in self.changes)])

    @property
    def file_name(self):
        return "-".join([self.scheme, *(f"{option}.{value}".strip(".")
                                        for option, value in self.changes)])

    @property
    def parent(self):
        """The scheme without changes: what this is compared with first."""
        return Setting(self.scheme)

    def options(self, tolerance=None):
        """Of `mbs simulate`; `tolerance` in m where it is loose."""
        words = ["--scheme", self.scheme]
        for option, value in self.changes:
            value = f"{tolerance:.3g}" if (option, value) == ("tolerance", "loose") else value
            words += [f"--{option}", value] if value else [f"--{option}"]
        return words

    def needs(self):
        """The words of "settings" in `mbs list --json` that a variant must have."""
        found = {self.scheme.rstrip("46")} - {"penalty"}
        for option, value in self.changes:
            found |= {value} if option == "precision" else {option} - {"projections", "tolerance", "half-step"}
        return found


def catalogue():
    """All settings, a scheme's own before what changes it."""
    return [Setting(scheme, tuple(changes.items())) for scheme, all_changes in CHANGES.items()
            for changes in all_changes]


def fits(setting, scene):
    """Why a scheme cannot be used for a scene (`mbs describe --json`), or ""."""
    terms = scene["terms"]
    if setting.scheme.startswith(("rattle", "multistep")):
        if (terms["driven_constraints"] or scene["driven_points"] or scene["driven_vectors"]):
            return "not for scenes with drivers"
        if terms["damping"]:
            return "not for scenes with dampers"
    return ""


def serving(setting, variants):
    """Names of the `variants` ({name: what `mbs list --json` says}) that serve a setting."""
    return [name for name, said in variants.items() if setting.needs() <= set(said["settings"])]
