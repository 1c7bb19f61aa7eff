# A cell, whatever runs a program: a small value with one identity; executor.py runs it. Its contenders: variants of an implementation,
# each in one build of the program on one BLAS and LAPACK pair.
import json
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

from analysis.core.files import ROOT, digest
from analysis.core.gather import gather
from analysis.core.registry import NULL, TWIN

LAYOUT = "layouts/mbs-"  # `mbs` with its functions in other places: + seed
SYSTEM = "system"  # no pair is asked for: what the loader finds


@dataclass(frozen=True)
class Contender:
    """On its usual pair in the study's own build it has the variant's name; elsewhere "variant+PAIR" or
    "variant+BUILD", which is measured beside the others and never ranked."""
    name: str
    variant: str
    blas: str = SYSTEM
    build: str = ""  # "" is the study's own

    ranked = property(lambda self: "+" not in self.name)
    environment = property(lambda self: f"{self.build or 'own'}|{self.blas}")  # what its processes share with those of others


CONTROL = Contender(NULL, NULL)
REFERENCE = Contender("reference/reference", "reference/reference")


def twin_of(one):
    """The same once more, to be timed beside it: nothing differs."""
    return replace(one, name=one.name + TWIN, variant=one.variant + TWIN)


def on_usual_pairs(registry, pairs, names):
    """[Contender] of variants by name; `pairs`: {folder or "all": pair}, as a profile has them. Where one is not installed: the system's."""
    usual = [pairs.get(name.split("/")[0], pairs["all"]) for name in names]
    return [Contender(name, name, pair if registry.pairs.get(pair) == "" else SYSTEM) for name, pair in zip(names, usual)]


def control(registry, pairs):
    """CONTROL on the pair of most; `pairs`: as on_usual_pairs has them."""
    return on_usual_pairs(registry, pairs, [NULL])[0]


def by_environment(contenders):
    """{environment: its contenders, which processes may have in common}"""
    return {name: tuple(group) for name, group in gather((one.environment, one) for one in contenders).items()}


def scene_name(text):
    """A scene as programs that run in ROOT find it; a file in the repository without the machine's path."""
    if not Path(text).is_file():
        return text
    path = Path(text).resolve()
    return str(path.relative_to(ROOT)) if path.is_relative_to(ROOT) else str(path)


@dataclass(frozen=True)
class Cell:
    kind: str               # subcommand of the program: simulate, check, bench, describe, limit; "" if it has none
    scene: str = ""         # as the program takes it: a name, or a file relative to the repository
    contenders: tuple = ()  # of one environment
    settings: tuple = ()    # further words of the command line
    role: str = ""          # what the part wants it for: a folder of its records
    number: int = 0         # of equal cells: the process
    program: str = "mbs"    # or another one of the build: mbs_reference, or a layout of `mbs`
    timed: bool = False     # has the machine for itself, and stays on one of its processors
    seconds: float = 60.0   # limit
    memory_mb: int = 4096   # limit
    keep: tuple = ()        # columns of the motion that the record keeps ("outputs": those of the scene) ...
    every: int = 0          # ... and steps between two of its instants
    inputs: str = field(default="", compare=False)  # digest of the scene's file; filled by `settled`

    def settled(self):
        """With words as text and the digest of the scene's file: what its identity is made of."""
        path = ROOT / self.scene
        return replace(self, settings=tuple(map(str, self.settings)),
                       inputs=digest(path)[:12] if self.scene.endswith(".json") and path.exists() else "")

    environment = property(lambda self: self.contenders[0].environment if self.contenders else "own|system")
    own = property(lambda self: self.program == "mbs" or self.program.startswith(LAYOUT))  # whether its program is `mbs`, in whatever layout

    @property
    def built(self):
        """Its program: "mbs", or "mbs@BUILD" of another build."""
        build = self.contenders[0].build if self.contenders else ""
        return f"{self.program}@{build}" if build else self.program

    def document(self):
        found = asdict(self)
        found["contenders"] = [one.name for one in self.contenders]
        return found | {"environment": self.environment}

    def file_name(self):
        """ROLE/WHO@WHAT-ID.json: readable, and its own for every cell."""
        identity = digest(json.dumps(self.document(), sort_keys=True))[:10]
        who = self.contenders[0].name.replace("/", ".") if len(self.contenders) == 1 else "all" if self.contenders else "harness"
        what = Path(self.scene).name.removesuffix(".json") or self.program
        safe = "".join(c if c.isalnum() or c in "-+=,.:" else "_" for c in what)[:60].replace(":", "-")
        return f"{self.role or self.kind or 'run'}/{who}@{safe}-{identity}.json"
