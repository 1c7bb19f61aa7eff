# Who takes part: a variant of an implementation in one build of the program on one BLAS and LAPACK pair.
from dataclasses import dataclass, replace

from analysis.core.registry import NULL, TWIN

SYSTEM = "system"  # no pair is asked for: what the loader finds


@dataclass(frozen=True)
class Contender:
    """On its usual pair in the study's own build it has the variant's name; elsewhere "variant+PAIR" or
    "variant+BUILD", which is measured beside the others and never ranked."""
    name: str
    variant: str
    blas: str = SYSTEM
    build: str = ""  # "" is the study's own

    @property
    def ranked(self):
        return "+" not in self.name

    @property
    def file_name(self):
        return self.name.replace("/", ".")

    @property
    def environment(self):
        """What its processes share with those of others."""
        return f"{self.build or 'own'}|{self.blas}"


CONTROL = Contender(NULL, NULL)
REFERENCE = Contender("reference/reference", "reference/reference")


def twin_of(one):
    """The same once more, to be timed beside it: nothing differs."""
    return replace(one, name=one.name + TWIN, variant=one.variant + TWIN)


def on_usual_pairs(registry, pairs, names):
    """[Contender] of variants by name; `pairs`: {folder or "all": pair}, as a profile has them."""
    return [Contender(name, name, usable(registry, pairs.get(name.split("/")[0], pairs["all"])))
            for name in names]


def usable(registry, pair):
    """The pair, or the system's where it is not installed."""
    return pair if registry.pairs.get(pair, "unknown") == "" else SYSTEM


def control(registry, pairs):
    """CONTROL on the pair of most; `pairs`: as on_usual_pairs has them."""
    return replace(CONTROL, blas=usable(registry, pairs["all"]))


def by_environment(contenders):
    """{environment: its contenders, which processes may have in common}"""
    found = {}
    for one in contenders:
        found[one.environment] = (*found.get(one.environment, ()), one)
    return found
