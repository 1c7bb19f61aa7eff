# A setting of a step: the scheme and what is changed beside it, as options of `mbs simulate`, `bench` and `check`.
from dataclasses import dataclass, field

from analysis.core.files import ROOT, StudyError, read_yaml

LIST = ROOT / "study" / "settings.yaml"
ORDERS = {"rattle4": 4, "rattle6": 6, "multistep6": 6}  # of a scheme; the others are of second order
EVERYONE = {"scheme", "penalty", "tolerance", "max-passes", "projections", "half-step", "scale-equations", "judge-every"}  # all serve these
LOOSENED = {"loose": 1e3, "one-pass": 1e6}  # tolerances: so many times the automatic one of the scheme, which the caller of `words` knows


@dataclass(frozen=True)
class Setting:
    scheme: str = "penalty"
    changes: tuple = ()  # (option, value) pairs; an option without a value has ""
    title: str = field(default="", compare=False)

    # Its title, or "saddle-point, tangent kept".
    name = property(lambda self: self.title or ", ".join([self.scheme, *(f"{option} {value}".strip() for option, value in self.changes)]))
    file_name = property(lambda self: self.name.replace(", ", "-").replace(" ", "."))
    order = property(lambda self: ORDERS.get(self.scheme, 2))
    parent = property(lambda self: Setting(self.scheme))  # the scheme without changes: what this is compared with first

    @property
    def needs(self):
        """The words of "settings" in `mbs list --json` that a variant must have: of Registry.serves."""
        asked = (value if option == "precision" else option for option, value in self.changes if option not in EVERYONE)
        return {self.scheme.rstrip("46"), *asked} - {"penalty", "double"}

    # As one types it, without what is the default.
    typed = property(lambda self: " ".join(self.words()).removeprefix("--scheme penalty").strip())

    # How many times the automatic tolerance its own is; None if it does not refer to that.
    loosened = property(lambda self: LOOSENED.get(dict(self.changes).get("tolerance")))

    def words(self, base=(), tolerance=None):
        """Of the command line. `base`: (option, value) pairs that the setting's own go before; `tolerance`, m: what
        one that is loosened stands for."""
        pairs = dict(base) | {"scheme": self.scheme} | dict(self.changes)
        if self.loosened:
            pairs["tolerance"] = f"{tolerance:.3g}"
        return [word for option, value in pairs.items() for word in (f"--{option}", f"{value}") if word]


def read_settings(path=LIST):
    """[Setting] of study/settings.yaml, the default one first."""
    found = []
    for entry in read_yaml(path, settings=[{"name": str, "options?": dict}])["settings"]:
        options = {option: "" if value is True else str(value) for option, value in entry.get("options", {}).items()}
        found.append(Setting(options.pop("scheme", "penalty"), tuple(options.items()), entry["name"]))
    if len({one.name for one in found}) < len(found) or found[0] != Setting():
        raise StudyError(f"{path}: names must differ, and the first setting must be the default one")
    return found
