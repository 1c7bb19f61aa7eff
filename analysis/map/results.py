# What figures, claims and pages ask the tables of a set: who was timed, ratios and rankings of a scene.
from collections import namedtuple
from functools import cache

from analysis.core.registry import NULL, TWIN
from analysis.core.timing import NO_VARIANCE, NONE, ratio
from analysis.map import carry, timed

FAILURES = ("disagrees", "crashed", "timeout", "out-of-memory", "unsupported", "diverged", "failed", "refused")
COVERED = 82  # variables that a run has to reach to speak of the paper's figures of 10 to 160
# Time of `slow` over that of `fast`, with its interval, and where it was taken: fill in %.
Versus = namedtuple("Versus", "value low high slow fast size fill record")


def of(tables, view):
    """The Results of these tables: figures and page share what has been computed."""
    if not _last or _last[0] is not tables["tidy"]:
        _last[:] = [tables["tidy"], Results(tables, view)]
    return _last[1]


_last = []


def with_samples(rows):
    return rows.assign(samples=[tuple(map(float, text.split())) for text in rows.samples_us])


class Results:
    def __init__(self, tables, view):
        self.tidy, self.view = tables["tidy"], view
        self.registry, self.variants = view.registry, view.registry.variants
        present = set(self.tidy.implementation)
        self.implementations = [name for name in self.variants if name in present]  # that take part in rankings, in the registry's order
        self.timing = with_samples(self.tidy[self.tidy.kind == "timing"])  # rows of timed processes and of what was not timed
        self._scenes = dict(list(self.timing.groupby("scene")))
        self._of_seeds = carry.of_seeds(with_samples(self.tidy[self.tidy.kind == "seeds"]))
        self.sizes = sorted(self.samples(natural_only=True).variables.unique())  # that were timed at their own fill

    def rows(self, scene):
        return self._scenes.get(scene, self.timing[:0])

    @cache
    def paired(self, scene):
        """What statistics need of a scene's rows: wide tables are slow to walk through."""
        return timed.Scene(self.rows(scene), self.beyond(scene))

    def beyond(self, scene):
        """What timing.Paired takes: artificial fill is placed elsewhere by another seed."""
        return self._of_seeds if self.rows(scene).fill_asked.notna().any() else NO_VARIANCE

    def layer(self, name):
        """Names of those that are ranked in a layer and took part."""
        return [one for one in timed.layers(self.registry)[name] if one in self.implementations]

    def samples(self, natural_only=False):
        """Rows of processes that timed ranked contenders."""
        rows = self.timing
        chosen = (rows.status == "ok") & rows.implementation.isin(list(self.variants))
        return rows[chosen & rows.fill_asked.isna()] if natural_only else rows[chosen]

    def natural(self, size):
        return f"four-bar:{round(size) // 2 - 1}"

    @cache
    def alternatives(self, variant):
        """Rows of `variant` at natural fill on all pairs that it was timed on."""
        rows = self.timing
        return rows[(rows.status == "ok") & (rows.implementation.str.partition("+")[0] == variant) & rows.fill_asked.isna() &
                    ~rows.implementation.str.endswith(TWIN)]

    def rank(self, scene, names):
        return self._rank(scene, frozenset(names) - {NULL})

    @cache
    def _rank(self, scene, names):
        return self.paired(scene).rank(names)

    def fastest(self, scene, names):
        found = self.rank(scene, names)
        return found.winner if found else None

    @cache
    def versus(self, scene, slow, fast):
        """The Versus of two; None if they cannot be compared."""
        found = NONE if None in (slow, fast) or slow == fast else ratio(self.paired(scene).of(slow, fast), slow, fast)
        if found.value != found.value:
            return None
        rows = self.rows(scene)
        record = next(iter(rows[(rows.implementation == slow) & (rows.status == "ok")].record), "")
        return Versus(found.value, found.low, found.high, slow, fast, float(rows.variables.iloc[0]), float(rows.fill_percent.iloc[0]), record)

    def best(self, scene, slow, fast):
        """Versus of the fastest of the names `slow` and the fastest of the names `fast`."""
        return self.versus(scene, self.fastest(scene, slow), self.fastest(scene, fast))

    def over_sizes(self, slow, fast, low=0, high=float("inf"), reaching=0):
        """[Versus] of the best of two groups at natural fill, by size; none if they do not reach so many variables."""
        found = [one for size in self.sizes if low <= size <= high and (one := self.best(self.natural(size), slow, fast))]
        return found if found and found[-1].size >= reaching else []

    def lost(self, scene, names):
        """(those of `names` that were too slow in a scene, those that failed)"""
        rows = self.rows(scene)
        slow, failed = (set(rows.implementation[rows.status.isin(some)]) for some in (("excluded", "slower"), FAILURES))
        return tuple(name for name in names if name in slow - failed), tuple(name for name in names if name in failed)
