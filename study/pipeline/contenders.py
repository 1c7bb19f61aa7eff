# Who takes part: variants on their usual BLAS, and alternatives to compare one library or compiler.
#
# A contender is a variant of an implementation on one BLAS + LAPACK pair in one build of the program.
# On its usual pair in the study's own build it has the variant's name and is ranked; otherwise it is
# an alternative, "variant+NAME", measured beside it at natural fill and never ranked.
from dataclasses import asdict, dataclass, replace

from study.pipeline.builds import BUILDS
from study.pipeline.errors import StudyError
from study.pipeline.layout import NULL, program

SYSTEM = "system"  # no pair is asked for: what the loader finds


@dataclass(frozen=True)
class Contender:
    name: str
    variant: str
    blas: str = SYSTEM
    build: str = ""       # "" is the study's own
    columns: tuple = ()   # sizes at which it is measured; empty: all
    operations: bool = False
    missing: str = ""     # why it cannot run: it is then a row with this reason

    @property
    def ranked(self):
        return "+" not in self.name

    @property
    def file_name(self):
        return self.name.replace("/", ".")

    @property
    def environment(self):
        """What its processes share with those of others: a build on a pair."""
        return f"{self.build or 'own'}|{self.blas}"

    def call(self, command, *arguments):
        """The command line of `mbs COMMAND ARGUMENTS` in its build on its pair."""
        pair = [] if self.blas == SYSTEM else ["--blas", self.blas]
        return [program(self.build), command, *arguments, *pair]

    def at(self, scene):
        """Whether it takes part in this scene at all."""
        if self.missing or (not self.ranked and scene.fill is not None):
            return False
        return not self.columns or scene.variables in self.columns


def contenders(profile, known, variants, broken_builds):
    """All of them, ranked ones first. `known`: `mbs list --json`; `variants`: names;
    `broken_builds`: {build: why it failed}."""
    pairs = {pair["name"]: "" if pair["available"] else pair["reason"] for pair in known["blas"]}
    offers = {variant["name"]: variant["operations"] for entry in known["implementations"]
              for variant in entry["variants"]}
    ranked, others = {}, {}
    for name in variants:
        wanted = profile.blas.get(name.split("/")[0], profile.blas["all"])
        missing = _pair(profile, pairs, wanted)
        ranked[name] = Contender(name, name, SYSTEM if missing else wanted,
                                 operations=offers[name])
        if missing:
            others[f"{name}+{wanted}"] = Contender(f"{name}+{wanted}", name, wanted,
                                                   missing=missing)
    for entry, own in ((entry, own) for entry in profile.alternatives for own in ranked.values()
                       if _listed(own.name, entry["implementations"])):
        usual = replace(own, columns=tuple(entry["columns"]), operations=False)
        for pair in entry.get("blas", []):
            if pair != own.blas:
                name = f"{own.name}+{pair}"
                others[name] = replace(usual, name=name, blas=pair,
                                       missing=_pair(profile, pairs, pair))
        for build in entry.get("builds", []):
            if build not in BUILDS:
                raise StudyError(f"profile {profile.name}: unknown build '{build}'; known: "
                                 f"{', '.join(BUILDS)}")
            name = f"{own.name}+{build}"
            others[name] = replace(usual, name=name, build=build,
                                   missing=broken_builds.get(build, ""))
    return [*ranked.values(), *others.values()]


def control(profile, known):
    """The harness's own contender, which does nothing."""
    available = {pair["name"] for pair in known["blas"] if pair["available"]}
    wanted = profile.blas["all"]
    return Contender(NULL, NULL, wanted if wanted in available else SYSTEM)


def own(known):
    """Names of the variants that stand on no library, of `mbs list --json`."""
    return {variant["name"] for entry in known["implementations"]
            if entry["available"] and entry.get("library") == "none" for variant in entry["variants"]}


def wanted_builds(profile, variants):
    """Names of the builds that alternatives of these variants need."""
    return list(dict.fromkeys(
        build for entry in profile.alternatives for build in entry.get("builds", [])
        if build in BUILDS and any(_listed(name, entry["implementations"]) for name in variants)))


def to_json(found):
    return [asdict(contender) | {"columns": list(contender.columns)} for contender in found]


def from_json(records):
    return {record["name"]: Contender(**record | {"columns": tuple(record["columns"])})
            for record in records}


def _pair(profile, pairs, name):
    """Why a BLAS pair cannot be used, or ""; StudyError if it does not exist."""
    if name not in pairs:
        raise StudyError(f"profile {profile.name}: unknown BLAS pair '{name}'; known: "
                         f"{', '.join(pairs)}")
    return pairs[name]


def _listed(name, implementations):
    return name in implementations or name.split("/")[0] in implementations
