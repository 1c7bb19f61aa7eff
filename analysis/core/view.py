# What tables, figures and pages of a part may know of their set besides its records.
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import yaml

from analysis.core.files import StudyError, from_yaml, read_object
from analysis.core.parts import parts
from analysis.core.registry import Registry


def facts_of(folder):
    """set.json: profile, selection, parts, date, context of the usual environment, digests of the programs."""
    found = read_object(folder / "set.json", profile=str, only=list, parts=list, programs=dict, context=dict, date=str)
    if unknown := [part for part in found["parts"] if part not in [*parts()]]:
        raise StudyError(f"{folder / 'set.json'} is damaged (parts: {unknown[0]!r} is none of {', '.join(parts())})")
    return found


@dataclass(frozen=True)
class Folder:
    """A set's, with what the set says of itself."""
    folder: Path

    facts = cached_property(lambda self: facts_of(self.folder))
    context = property(lambda self: self.facts["context"])
    registry = cached_property(lambda self: Registry(read_object(self.folder / "registry.json", implementations=list)))


@dataclass(frozen=True)
class View(Folder):
    part: str

    @cached_property
    def settings(self):
        """The profile's of this part."""
        path = self.folder / "profile.yaml"
        try:
            return from_yaml(path.read_text(encoding="utf-8"))["parts"][self.part]
        except (OSError, UnicodeDecodeError, yaml.YAMLError, KeyError, TypeError) as error:
            raise StudyError(f"{path} is damaged: {' '.join(str(error).split())[:200]}") from error
