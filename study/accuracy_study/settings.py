# The named settings of study/settings.yaml: what they pass to `mbs`, and which variants serve them.
from dataclasses import dataclass, replace
from pathlib import Path

import yaml

from study.pipeline.errors import StudyError

LIST = Path(__file__).resolve().parent.parent / "settings.yaml"


@dataclass(frozen=True)
class Setting:
    name: str
    options: tuple = ()  # (name, value) pairs; True: an option without a value
    needs: tuple = ()

    @property
    def file_name(self):
        return self.name.replace(" ", "-")

    def words(self, base=()):
        """Words of the command line; this setting's options go before those of `base`."""
        merged = dict(base) | dict(self.options)
        return [word for name, value in merged.items()
                for word in ([f"--{name}"] if value is True else [f"--{name}", f"{value}"])]


@dataclass(frozen=True)
class Entries:
    """Who is compared: dictionaries by the name of the variant."""
    contenders: dict  # Contender
    dense: dict       # whether it is
    settings: dict    # [Setting] that it serves, the default one first
    refused: dict     # {(variant, setting): why the gate excludes it}
    own: frozenset = frozenset()  # variants that stand on no library

    def families(self):
        """[Entries] of the variants with a library, and of those without: each is measured as if the other were
        not there, so that the fast code of one does not hide which library to take."""
        names = [[name for name in self.settings if (name in self.own) == own] for own in (False, True)]
        return [replace(self, settings={name: self.settings[name] for name in family})
                for family in names if family]

    def setting(self, variant, name):
        return next(one for one in self.settings[variant] if one.name == name)

    def admitted(self):
        """[(variant, Setting)] that the gate lets pass."""
        return [(variant, setting) for variant, settings in self.settings.items()
                for setting in settings if (variant, setting.name) not in self.refused]


def read_list(path=LIST):
    """[Setting], the default one first."""
    listed = []
    for entry in yaml.safe_load(path.read_text())["settings"]:
        unknown = set(entry) - {"name", "options", "needs"}
        if unknown or not isinstance(entry.get("name"), str):
            raise StudyError(f"{path}: {entry} must have a name, may have options and needs, no more")
        listed.append(Setting(entry["name"], tuple(entry.get("options", {}).items()),
                              tuple(entry.get("needs", ()))))
    names = [setting.name for setting in listed]
    if len(set(names)) < len(names) or listed[0].options or listed[0].needs:
        raise StudyError(f"{path}: names must differ, and the first setting must be the default one")
    return listed


def served(known, listed, names):
    """{name of a variant: [the settings it serves]} by `mbs list --json`."""
    offers = {name: variant.get("settings", ()) for name, variant in variants(known).items()}
    return {name: [setting for setting in listed if set(setting.needs) <= set(offers[name])]
            for name in names}


def variants(known):
    """{name: what `mbs list --json` says of it}"""
    return {variant["name"]: variant for entry in known["implementations"]
            for variant in entry["variants"]}
