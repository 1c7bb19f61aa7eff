# What the paper is built from: the tables of one set, and the other stored sets.
from functools import cache, cached_property

from analysis.core.files import ROOT
from analysis.core.view import Folder, View
from analysis.map.results import of
from study.tools.merge import agreement, machine


class Known(Folder):
    # What the map's tables are asked for.
    results = cached_property(lambda self: of(self.tables("map"), self.view("map")))
    # The other stored sets, as Known.
    stored = cached_property(lambda self: [
        Known(path.parent) for path in sorted((ROOT / "results").glob("*/set.json")) if path.parent != self.folder])
    # The sets that processors are compared by: this one and those of its build; [] if it is alone.
    compared = cached_property(lambda self: agreement.compared(self, self.stored))
    # All that the paper is of: this one, and those beside it that are compared.
    sets = property(lambda self: self.compared or [self])
    # What the compared ones say together of libraries.
    agreed = cached_property(lambda self: [one for one in agreement.agreements(self.compared)[0] if one.question.layer == "libraries"]
                             if self.compared else [])
    # {scene of the map: verdict} of these.
    on_the_map = cached_property(lambda self: {one.question.scene: one.verdict for one in self.agreed if one.question.form == "penalty"
                                               and one.question.scene in {*self.tables("map")["cells"].scene}})

    @cache
    def tables(self, part):
        """{table: DataFrame} of a part of a set; empty where the set lacks it."""
        return machine.tables(self.folder, part)

    def view(self, part):
        return View(self.folder, part)
