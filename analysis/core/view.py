# What tables, figures and pages of a part may know of their set besides its records; the one list of parts, study/parts.yaml.
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

from analysis.core.files import ANY, ROOT, damaged, from_yaml, need_kind, read_json, read_object, read_yaml
from analysis.core.gather import gather
from analysis.core.registry import Registry

LIST = ROOT / "study" / "parts.yaml"
CONTEXT = dict.fromkeys(("machine", "commit", "cpu_model", "kernel", "compiler", "flags"), str) | {"dirty": (str, bool), "num_cpus": int,
                                                                                                   ...: (str, int, float, bool)}
VARIANT = ANY | {"name": str, "description": str, "terms?": [str], "settings?": [str], "library?": str, "tried_for?": str}
ENTRY = ANY | dict.fromkeys(("folder", "library", "version", "licence", "reason"), str) | {
    "available": bool, "variants": [VARIANT], "lacking?": {...: str}}
REGISTRY = {"implementations": [ENTRY], "blas?": [ANY | {"name": str, "available": bool, "reason": str}]}


def parts():
    """{name: its question}, in order."""
    return _listed(LIST)["parts"]


def pages():
    """{name: its folder in analysis/ and its title}, of pages beside those of parts whose parts are there."""
    return {name: one for name, one in _listed(LIST)["pages"].items() if parts().keys() >= set(one["parts"])}


@cache
def _listed(path):
    return from_yaml(path.read_text(encoding="utf-8"))


# What a set says of itself is read here and nowhere else: each function returns what is whole, or names the file in a StudyError.

def facts_of(folder):
    """set.json: profile, selection, parts, date, context of the usual environment, digests of the programs."""
    found = read_object(folder / "set.json", profile=str, only=[str], parts=list, programs={...: str}, context=CONTEXT, date=str)
    if unknown := [part for part in found["parts"] if part not in [*parts()]]:
        raise damaged(folder / "set.json", f"parts: {unknown[0]!r} is none of {', '.join(parts())}")
    return found


def others(folder):
    """Of each other processor a stored set beside this one, of the same commit where there is one."""
    mine = facts_of(folder)["context"]
    contexts = {path.parent: facts_of(path.parent)["context"] for path in sorted(folder.parent.glob("*/set.json"))
                if any((path.parent / "raw").glob("*.tar.xz"))}
    found = gather((contexts[one].get("cpu_model"), one)
                   for one in sorted(contexts, key=lambda one: contexts[one].get("commit") != mine.get("commit")))
    return [first for model, (first, *_) in found.items() if model not in (None, "", mine.get("cpu_model"))]


def context_in(path):
    """A file of contexts/: machine, build and BLAS of an environment."""
    return need_kind(path, read_json(path), CONTEXT)


def contexts_in(folder):
    """{path: the context in it}"""
    return {path: context_in(path) for path in sorted((folder / "contexts").glob("*.json"))}


def settings_in(path):
    """{part: its settings} of a profile. Which they must be depends on the part's plan, and a set may be older than that."""
    return read_yaml(path, parts={...: ANY | {"seconds": float}})["parts"]


@dataclass(frozen=True)
class Folder:
    """A set's, with what the set says of itself."""
    folder: Path

    facts = cached_property(lambda self: facts_of(self.folder))
    context = property(lambda self: self.facts["context"])
    registry = cached_property(lambda self: Registry(read_object(self.folder / "registry.json", **REGISTRY)))

    def need_whole(self):
        """StudyError naming a file that is damaged, before anything is made of the set; the Folder itself."""
        known = settings_in(self.folder / "profile.yaml")
        if missing := [part for part in self.facts["parts"] if part not in known]:
            raise damaged(self.folder / "profile.yaml", f"parts: {missing[0]} is missing")
        _ = self.registry, contexts_in(self.folder)
        return self


@dataclass(frozen=True)
class View(Folder):
    part: str

    @cached_property
    def settings(self):
        """The profile's of this part."""
        path = self.folder / "profile.yaml"
        return need_kind(path, settings_in(path), ANY | {self.part: dict})[self.part]
