# The price of a simple choice: how much is lost everywhere by always using one implementation.
from dataclasses import dataclass

import numpy


@dataclass(frozen=True)
class Regret:
    """Time of one implementation over the best of each cell."""
    name: str
    ratios: dict       # {scene: ratio}; NaN: excluded without a pilot's ratio
    rough: frozenset   # scenes whose ratio is a pilot's, or its least value
    failed: frozenset  # scenes

    @property
    def mean(self):
        """Geometric mean over the cells that have a ratio; infinite if there is none."""
        known = [ratio for ratio in self.ratios.values() if numpy.isfinite(ratio)]
        return float(numpy.exp(numpy.mean(numpy.log(known)))) if known else numpy.inf

    @property
    def worst(self):
        return max(self.ratios.values(), key=_known, default=numpy.inf)

    @property
    def where(self):
        """The scene of the worst ratio; "" if there is none."""
        return max(self.ratios, key=lambda scene: _known(self.ratios[scene]), default="")

    @property
    def unknown(self):
        """Cells at which it was not even tried, being too slow at a smaller size already."""
        return sum(not numpy.isfinite(ratio) for ratio in self.ratios.values())


def _known(ratio):
    return ratio if numpy.isfinite(ratio) else -numpy.inf


def regrets(results, cells):
    """One Regret an implementation, the lowest geometric mean first; after all others those that
    fail in some cell, as nobody can always use them, and those with cells of unknown ratio."""
    found = [_regret(name, cells) for name in results.implementations]
    return sorted(found, key=lambda regret: (bool(regret.failed), bool(regret.unknown),
                                             regret.mean))


def _regret(name, cells):
    ratios, rough, failed = {}, set(), set()
    for cell in cells:
        times = cell.times
        if name in cell.failed:
            failed.add(cell.scene)
        elif name in times:
            ratios[cell.scene] = times[name] / min(times.values())
        elif name in cell.excluded:
            pilots = cell.rows[cell.rows.implementation == name].pilot_ratio
            ratios[cell.scene] = float(pilots.max())
            rough.add(cell.scene)
    return Regret(name, ratios, frozenset(rough), frozenset(failed))
