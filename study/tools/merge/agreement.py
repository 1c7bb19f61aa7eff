# What several sets say of the same question: per scene and layer, who is among the best on each machine, and on all.
import math
import re
from collections import namedtuple
from functools import cached_property

import numpy
import pandas

from analysis.core import schema
from analysis.core.gather import gather
from analysis.core.timing import CONFIDENCE, EQUIVALENT, NONE, Ranking, Ratio, error, holm, outside
from analysis.core.view import View, contexts_in
from analysis.map.results import Results
from study.core import executor
from study.core.timing import LAYOUTS
from study.tools.merge import machine

SOURCES = {"day": "sets of one kind of machine", "processor": "kinds of machines"}  # of a ratio's spread between sets
LAYERS = {"libraries": "libraries", "all": "all, own code included"}
ALIKE = ("commit", "compiler", "flags", "build_type", "libraries", "blas", "blas_loaded")  # of sets that may be compared
UNTIMED = ("dropped", "timeout", "crashed", "out-of-memory")  # say nothing of how long someone takes, where no other status does
LEFT = {"decided": 1, "differs": 0}  # contenders that a verdict leaves
SYSTEM = re.compile(r"[\w-]+-linux-gnu")  # in paths: a library of another architecture is the same one


Question = namedtuple("Question", "part scene form layer variables")  # form: of the step


def unlike(first, other):
    """What differs between two sets that are not to be compared, in words; "" if they may be."""
    for one in (first, other):
        if why := machine.no_evidence(one):
            return f"{one.folder} is no evidence: {why}"
        if any(str(context.get("dirty")).lower() != "false" for context in contexts(one).values()):
            return f"{one.folder} was measured from a tree with changes"
    mine, its = ({path.name: context for path, context in contexts(one).items()} for one in (first, other))
    for name in [name for name in mine if name in its]:
        if differs := executor.differing(mine[name], its[name], ALIKE):
            return f"{other.folder} is of another build than {first.folder}: {differs[0]} is '{differs[2]}', not '{differs[1]}' ({name})"
    return ""


def contexts(studyset):
    """{path: the context in it} of a set and of its environments."""
    found = {studyset.folder / "set.json": studyset.facts["context"]} | contexts_in(studyset.folder)
    return {path: one | {"blas_loaded": SYSTEM.sub("", str(one.get("blas_loaded")))} for path, one in found.items()}


def compared(first, others):
    """Of a set and others those that processors are compared by: `first` with one of its build from each other processor; [] if there is none."""
    alike = [first, *(one for one in others if not unlike(first, one))]
    found = gather((one.facts["context"]["cpu_model"], one) for one in alike)
    return [one for one, *_ in found.values()] if len(found) > 1 else []


def questions(studyset):
    """{Question: Ranking} of one set's map and mechanisms; what both ask is one question, of the mechanisms."""
    return dict({one[1:4]: (one, ranking) for one, ranking in (*_map(studyset), *_families(studyset))}.values())


def _map(studyset):
    if not (studyset.folder / "map" / "cells.csv").exists():
        return
    results = Results({"tidy": schema.read_table(studyset.folder, "map", "tidy")}, View(studyset.folder, "map"))
    for layer in LAYERS:
        for scene, rows in results.timing.groupby("scene"):
            if ranking := results.rank(scene, results.layer(layer)):
                mine = rows[rows.implementation.isin(results.layer(layer))]
                yield Question("map", scene, "penalty", layer, rows.variables.iloc[0]), _of_all(ranking, mine)


def _families(studyset):
    """Of libraries alone: the table has ratios to the best library."""
    if not (studyset.folder / "families" / "scenes.csv").exists():
        return
    rows = schema.read_table(studyset.folder, "families", "scenes")
    rows = rows[rows.implementation.isin(studyset.registry.libraries)]
    for (scene, form), group in rows.groupby(["scene", "scheme"]):
        timed = group[(group.status == "ok") & group.to_rival.notna()].sort_values("to_rival")
        if timed.to_rival_low.notna().any():
            layouts = timed.processes.clip(upper=min(timed.processes.iloc[0], LAYOUTS))  # of whose processes a ratio to the first is
            ratios = {row.implementation: Ratio(1.0, 1.0, 1.0) if row.to_rival == 1 else
                      Ratio(row.to_rival, row.to_rival_low, row.to_rival_high, freedom=of - 1) for row, of in zip(timed.itertuples(), layouts)}
            yield Question("families", scene, form, "libraries", group.variables.iloc[0]), _of_all(Ranking(next(iter(ratios)), ratios), group)


def _of_all(ranking, rows):
    """A Ranking with who has rows of its scene, and was neither timed beside others nor shown to be slow or not to serve it."""
    told = rows.implementation[~rows.status.isin([*UNTIMED, "ok"])]
    return ranking._replace(untimed=tuple(sorted({*rows.implementation} - {*told, *ranking.ratios})))


class Agreement(namedtuple("Agreement", "question machines day", defaults=(0.0,))):
    """`machines`: for each set its Ranking; `day`: a variance that days add to a ratio's logarithm. A contender is inside on a machine if it is not
    shown to be over 5 % behind the fastest there, where all ratios that the cell has on all machines are asked at once [Holm]."""
    winners = property(lambda self: [one.winner for one in self.machines])
    settled = property(lambda self: all(one.settled for one in self.machines))
    chances = cached_property(lambda self: outside(self.machines, self.day))
    # Of each machine, those inside.
    sets = property(lambda self: [[name for name, chance in one.items() if chance > 1 - CONFIDENCE] for one in self.chances])
    # Those inside on all machines: the equivalence set that holds on all.
    common = property(lambda self: [name for name in self.sets[0] if all(name in one for one in self.sets)])
    # Whether each winner is as fast as the winner on every other machine.
    alike = property(lambda self: all(mine.winner in its.equivalent for mine in self.machines for its in self.machines))
    # Whom to take where nobody knows the machine: the least worst loss, of those inside on all, else of all.
    robust = property(lambda self: next((name for name in self.worst if name in self.common), next(iter(self.worst), "")))

    @cached_property
    def everywhere(self):
        """{contender timed on a machine: the least of its `chances`}. Without a time it is outside, unless nothing is known of it there."""
        return {name: min(chances.get(name, float(name in ranking.untimed)) for chances, ranking in zip(self.chances, self.machines))
                for name in dict.fromkeys(name for one in self.chances for name in one)}

    @property
    def verdict(self):
        """"decided" where the machines leave one alone; "open" where another one may be left that lacks a time on one of them."""
        if len(self.common) > 1:
            return "several"
        left = {name for name, chance in self.everywhere.items() if chance > 1 - CONFIDENCE}
        return "open" if left - {*self.common} else "decided" if left else "differs"

    def chance(self, verdict):
        """To find so few left, or fewer, where more are."""
        return sorted([0.0, *self.everywhere.values()])[-1 - LEFT[verdict]]

    @property
    def worst(self):
        """{contender timed on all machines: its largest ratio to the fastest there}, the least first."""
        shared = set.intersection(*(set(one.ratios) for one in self.machines))
        found = {name: max(one.ratios[name].value for one in self.machines) for name in shared}
        return dict(sorted(found.items(), key=lambda one: one[1]))


def agreements(sets, asked=questions):
    """Agreements on the questions that all sets answer; and how many only some of them have."""
    found = [asked(one) for one in sets]
    shared = [one for one in found[0] if all(one in other for other in found)]
    return [Agreement(one, tuple(other[one] for other in found)) for one in shared], len(set().union(*found)) - len(shared)


def sure(agreed):
    """The questions whose "decided" or "differs" stays where all cells of a layer are asked at once [Holm]."""
    found = [{"question": one.question, "chance": one.chance(verdict), "decided": one.verdict == verdict, "asked": (verdict, one.question.layer)}
             for verdict in LEFT for one in agreed]
    return {row["question"] for row in holm(found, "asked") if row.get("holm")}


def components(agreed, machines):
    """{"day", "processor": (standard deviation of a ratio in %, cells that tell it)}: what sets of one kind of machine, and kinds, add to
    what a set's intervals say of the ratio of two contenders. `machines`: of each set its fingerprint, which hosts of one kind share."""
    found = {"day": [], "processor": []}
    for one in agreed:
        both = [[ranking.ratios.get(name, NONE) for name in (one.winners[0], one.machines[0].second)] for ranking in one.machines]
        if not all(0 < ratio.low <= ratio.high < math.inf for pair in both for ratio in pair):
            continue  # not told by all
        own = numpy.mean([sum(error(ratio) ** 2 for ratio in pair) for pair in both])
        logs = pandas.Series([math.log(second.value / first.value) for first, second in both]).groupby(list(machines))
        day = logs.var().mean() if logs.size().max() > 1 else own  # which no machine with one set tells
        found["day"] += [day - own] if logs.size().max() > 1 else []
        found["processor"] += [logs.mean().var() - day * (1 / logs.size()).mean()] if logs.ngroups > 1 else []
    # A cell may tell less than nothing; if it counted as nothing, chance alone would make a mean above that.
    return {source: (100 * math.sqrt(max(0.0, numpy.mean(some))), len(some)) for source, some in found.items() if some}


def mechanisms(sets, agreed=None):
    """Agreements on libraries, one a mechanism at its own fill: in the penalty form, or in the other if not all have that. `agreed`: all."""
    if agreed is None:
        agreed, _ = agreements(sets, lambda one: dict(_families(one)))
    return list({one.question.scene: one for one in sorted(agreed, key=lambda one: one.question.form, reverse=True)  # the penalty form is the last
                 if one.question.part == "families" and "fill=" not in one.question.scene}.values())


def shares(agreed):
    """{"all", "same", "common", "differ"}: on how many all machines have the same winner, another one within the margin on all, none. Of the rest
    nobody knows, as someone lacks a time."""
    same = sum(len(set(one.winners)) == 1 for one in agreed)
    return {"all": len(agreed), "same": same, "common": sum(len(one.common) > 0 for one in agreed) - same,
            "differ": sum(one.verdict == "differs" for one in agreed)}


def held(agreed, fresh):
    """{layer: (decided cells that a further set answers; of these with its winner in their set; and where it shows that theirs is far behind)}."""
    known = questions(fresh)
    behind = lambda name, ranking: name in ranking.ratios and ranking.ratios[name].low > EQUIVALENT  # shown to be more than that
    found = gather((one.question.layer, (ranking.winner in one.common, all(behind(name, ranking) for name in one.common)))
                   for one in agreed if one.verdict == "decided" for ranking in [known.get(one.question)] if ranking)
    return {layer: (len(cells), *map(sum, zip(*cells))) for layer, cells in found.items()}
