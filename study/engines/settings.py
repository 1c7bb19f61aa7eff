# The named settings of settings.yaml: what they pass to an engine's program, and what changes along their curve.
from dataclasses import dataclass
from pathlib import Path

import yaml

from study.pipeline.errors import StudyError

LIST = Path(__file__).with_name("settings.yaml")


@dataclass(frozen=True)
class Setting:
    engine: str
    name: str
    over: str          # "step" (s) or "accuracy"
    values: tuple      # of `over`, the coarsest first
    options: tuple = ()

    @property
    def file_name(self):
        return self.name.replace(",", "").replace(" ", "-").lower()

    def words(self, value):
        pairs = [*self.options, (self.over, f"{value:g}")]
        return ["--setting", *(f"{key}={text}" for key, text in pairs)]


def need_known(engines):
    """StudyError if one is not in the list."""
    listed = read_list()
    for name in engines:
        if name not in listed:
            raise StudyError(f"--engines: unknown engine '{name}'; known: {', '.join(listed)}")


def read_list(path=LIST):
    """{engine: [Setting]}"""
    listed = yaml.safe_load(path.read_text())
    values = {over: tuple(map(float, found)) for over, found in listed["values"].items()}
    for over, found in values.items():
        if list(found) != sorted(found, reverse=True):
            raise StudyError(f"{path}: values of {over}: the coarsest must be the first")
    return {engine: _settings(path, engine, entries, values)
            for engine, entries in listed["engines"].items()}


def _settings(path, engine, entries, values):
    found = []
    for entry in entries:
        unknown = set(entry) - {"name", "over", "options"}
        if unknown or not isinstance(entry.get("name"), str) or entry.get("over") not in values:
            raise StudyError(f"{path}: {engine}: {entry} must have a name and over (one of "
                             f"{', '.join(values)}), may have options, no more")
        found.append(Setting(engine, entry["name"], entry["over"], values[entry["over"]],
                             tuple(entry.get("options", {}).items())))
    if len({one.file_name for one in found}) < len(found):
        raise StudyError(f"{path}: {engine}: names must differ")
    return found
