# Which processes of a timed scene count, and who is fastest there: a few of all ("time"), and then more of those who lead ("again"), with more
# samples. Leaders are compared by the latter alone: they are the better ones, and nobody was chosen by them.
from dataclasses import replace

from analysis.core import timing

ROLES = ("time", "again")  # of timed cells, before what timing.measure adds to them
AFTER = 100   # added to the numbers of the processes of role "again"
LEADING, PERHAPS = 1.3, 1.6  # whoever takes at most so many times the fastest's time leads; or so many, if not shown to be slower


def layers(registry):
    """{layer: names of the variants that are ranked in it}; own code and libraries are two layers of every result."""
    return {"libraries": registry.libraries, "all": list(registry.variants)}


def timed_rows(records):
    """Rows as `analysis.core.timing.processes` gives them, of the timed scenes among `records` that count."""
    chosen = [one for one in records if one.role.partition("-")[0] in ROLES]
    return timing.processes([replace(one, cell=one.cell | {"number": AFTER + one.cell["number"]}) if one.role == "again" else one
                             for one in timing.counted(chosen)])


class Scene:
    """The timed rows of one scene: all of its processes, and those of role "again" alone. `beyond`: of timing.Paired."""

    def __init__(self, rows, beyond=timing.NO_VARIANCE):
        self.all, self.again = timing.Paired(rows, beyond), timing.Paired(rows[rows.process > AFTER], beyond)

    def rank(self, names):
        found, lead = timing.rank(self.all, names), set(self.again.logs)
        if found is None or found.winner not in lead or len(set(found.ratios) & lead) < 2:
            return found  # who is fastest far ahead of all leads nobody, and has no further processes
        first = timing.rank(self.again, set(found.ratios))
        others = {name: timing.ratio(self.all, name, first.winner) for name in found.ratios if name not in first.ratios}
        return timing.Ranking(first.winner, timing.by_time(first.winner, first.ratios | others))

    def of(self, slow, fast):
        """The processes that the ratio of two contenders is taken of."""
        both = [set(self.again.logs.get(name, ())) for name in (slow, fast)]
        return self.again if len(both[0] & both[1]) > 1 else self.all


def leaders(rankings):
    """Names of those who lead in one of several Rankings, where they are more than one."""
    found = [[name for name, one in ranking.ratios.items() if one.value <= (PERHAPS if one.low <= 1 else LEADING)] for ranking in rankings if ranking]
    return {name for names in found if len(names) > 1 for name in names}
