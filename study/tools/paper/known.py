# What the paper is built from: the tables of one set, and the other stored sets.
import importlib
from dataclasses import dataclass, field
from functools import cached_property

from analysis.core.files import ROOT
from analysis.core.view import Folder, View
from analysis.map.results import of
from study.tools.merge import agreement, machine


class Tables(dict):
    """{table: DataFrame} of a part of a set, each read when it is asked for; empty where the set lacks it."""

    def __init__(self, folder, part):
        super().__init__()
        self.folder, self.part = folder, part

    def __missing__(self, name):
        self[name] = machine.table(self.folder, self.part, name)
        return self[name]


@dataclass(frozen=True)
class Known(Folder):
    _tables: dict = field(default_factory=dict)

    def tables(self, part):
        return self._tables.setdefault(part, Tables(self.folder, part))

    def view(self, part="map"):
        return View(self.folder, part)

    def said(self, part):
        """The part's own answers, one text."""
        module = importlib.import_module(f"analysis.{part}.sentences")
        return [one["text"] for one in module.answers(self.tables(part), self.view(part))]

    @cached_property
    def results(self):
        """What the map's tables are asked for."""
        return of(self.tables("map"), self.view("map"))

    @property
    def context(self):
        return self.facts["context"]

    @cached_property
    def beside(self):
        """The stored sets of other machines, as Known."""
        found = [Known(path.parent) for path in sorted((ROOT / "results").glob("*/set.json")) if path.parent != self.folder]
        return [one for one in found if one.context["cpu_model"] != self.context["cpu_model"]]

    @cached_property
    def others(self):
        """Those beside it that may be compared with it: of the same commit and build."""
        return [one for one in self.beside if not agreement.unlike(self, one)]

    @property
    def machines(self):
        """This set and the others."""
        return [self, *self.others]

    @cached_property
    def agreed(self):
        """What they say together of libraries; [] of one machine."""
        found = agreement.agreements(self.machines)[0] if self.others else []
        return [one for one in found if one.question.layer == "libraries"]
