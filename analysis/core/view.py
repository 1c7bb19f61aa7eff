# What tables, figures and pages of a part may know of their set besides its records.
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import yaml

from analysis.core.files import read_json
from analysis.core.registry import Registry


@dataclass(frozen=True)
class View:
    folder: Path
    part: str

    @cached_property
    def facts(self):
        """set.json: profile, only, parts, context (machine, commit, compiler …), date."""
        return read_json(self.folder / "set.json")

    @cached_property
    def registry(self):
        return Registry(read_json(self.folder / "registry.json"))

    @cached_property
    def settings(self):
        """The profile's of this part."""
        profile = yaml.safe_load((self.folder / "profile.yaml").read_text(encoding="utf-8"))
        return profile["parts"][self.part]

    @property
    def context(self):
        return self.facts["context"]
