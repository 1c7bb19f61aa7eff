# The settings of settings.yaml: what they pass to an engine's program, and what changes along their curve.
from dataclasses import dataclass
from pathlib import Path

import yaml

from analysis.core.errors import StudyError

LIST = Path(__file__).with_name("settings.yaml")


@dataclass(frozen=True)
class EngineSetting:
    engine: str
    over: str          # "step" (s) or "accuracy"
    values: tuple      # of `over`, the coarsest first
    options: tuple = ()

    def words(self, value):
        return ("--setting", *(f"{key}={text}" for key, text in (*self.options, (self.over, f"{value:g}"))))


def read_list(path=LIST):
    """{engine: [EngineSetting]}"""
    listed = yaml.safe_load(path.read_text(encoding="utf-8"))
    values = {over: tuple(map(float, found)) for over, found in listed["values"].items()}
    for over, found in values.items():
        if list(found) != sorted(found, reverse=True):
            raise StudyError(f"{path}: values of {over}: the coarsest must be the first")
    found = {engine: [] for engine in listed["engines"]}
    for engine, settings in found.items():
        for entry in listed["engines"][engine]:
            if set(entry) - {"over", "options"} or entry.get("over") not in values:
                raise StudyError(f"{path}: {engine}: {entry} must have over (one of {', '.join(values)}), may have options, "
                                 "no more")
            settings.append(EngineSetting(engine, entry["over"], values[entry["over"]], tuple(entry.get("options", {}).items())))
        if len(set(settings)) < len(settings):
            raise StudyError(f"{path}: {engine}: settings must differ")
    return found
