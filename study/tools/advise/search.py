# Which step each setting needs: error pilots, the setting that promises the fastest run first.
import math
from dataclasses import dataclass, field

from study.tools.advise.choice import allowed, counts, local_order, next_at, next_step
from analysis.core.outcomes import FINISHED

DOMINATED = 1.6  # a setting that promises this times the best one's time is not followed further,
SCHEME = 3.0     # a scheme that promises this times, as its changes may make up for it
LOST = ("diverged", "not-converged", "wrong-branch")  # a shorter step may mend these
HOPE = 0.5       # of its scheme's time a simulated second: what a change is expected to reach at best


@dataclass
class Found:
    """What is known of a setting."""
    setting: object
    pilots: list = field(default_factory=list)
    chosen: float | None = None  # step, s
    reason: str = ""             # why it has none

    @property
    def open(self):
        return self.chosen is None and not self.reason

    def step_us(self):
        """Median time of a step at the shortest step that was run."""
        times = [pilot for pilot in self.pilots if pilot.step_us > 0]
        return min(times, key=lambda pilot: pilot.step).step_us if times else math.nan

    def rung(self):
        """The longest step that was run and is not longer than the chosen one; the shortest without."""
        steps = [pilot.step for pilot in self.pilots]
        return max([step for step in steps if self.chosen and step <= self.chosen * 1.001]
                   or [min(steps)])


class Search:
    """`run(setting, step)` gives a Pilot, or None if no time is left for it."""

    def __init__(self, settings, run, *, error, duration, start, deadline_us=None, step=None):
        self.found = {setting: Found(setting) for setting in settings}
        self.run, self.error, self.duration, self.start = run, error, duration, start
        self.deadline_us = deadline_us or math.inf
        self.step = step  # where only one may be chosen
        self.cut = False

    def search(self):
        """Pilots until every setting has a step, or a reason why it has none; {setting: Found}."""
        while True:
            waiting = [one for one in self.found.values() if one.open]
            best = self.best()
            ready = [one for one in waiting if self._ready(one, best)]
            if not ready:
                break
            self._advance(min(ready, key=self.promise))
        for one in waiting:
            one.reason = (f"promises {self.promise(one) / 1e3:.3g} ms a simulated second at best, the "
                          f"fastest {best / 1e3:.3g}")
        return self.found

    def best(self):
        """Least time of a simulated second among the settings that have a step, us."""
        return min((self.promise(one) for one in self.found.values() if one.chosen), default=math.inf)

    def promise(self, one):
        """Time of a simulated second that a setting may reach, us."""
        if one.chosen:
            return one.step_us() / one.chosen
        if one.pilots:
            return one.step_us() / self._needed(one)
        parent = self._parent(one)
        return HOPE * self.promise(parent) if parent else 0.0

    def _parent(self, one):
        """The scheme without changes, where that is another setting."""
        return self.found.get(one.setting.parent) if one.setting.changes else None

    def _needed(self, one):
        """The step that a setting's estimates ask for."""
        if self.step:
            return self.step
        valid = [pilot for pilot in one.pilots if pilot.valid]
        if not valid:
            return min(pilot.step for pilot in one.pilots) / 2
        finest = min(valid, key=lambda pilot: pilot.step)
        limit = allowed(self.error, one.setting.order)
        slope = local_order(finest.step, one.pilots, one.setting.order)
        return finest.step * min(2.0, (limit / max(finest.estimate, 1e-300)) ** (1 / slope))

    def _ready(self, one, best):
        parent = self._parent(one)
        if parent and parent.open and self._ready(parent, best):
            return False  # the scheme itself first
        return not self.promise(one) > (DOMINATED if parent else SCHEME) * best

    def _advance(self, one):
        parent = self._parent(one)
        start = parent.rung() if parent and parent.pilots else self.start
        limit = allowed(self.error, one.setting.order)
        after = (next_at(self.step, one.pilots, limit, self.duration) if self.step else
                 next_step(one.pilots, limit, one.setting.order, start, self.duration))
        if after.step is None:
            one.chosen, one.reason = after.chosen, after.reason
            return
        pilot = self.run(one.setting, after.step)
        if pilot is None:
            self.cut = True
            self._settle(one)
            return
        one.pilots.append(pilot)
        if pilot.status not in (*FINISHED, *LOST):
            one.reason = f"{pilot.status}: {pilot.reason}"
        elif pilot.step_us > 2 * self.deadline_us:
            one.reason = f"a step takes {pilot.step_us:.3g} us"

    def _settle(self, one):
        """Out of time: the longest step that is known to be good enough, if any."""
        limit = allowed(self.error, one.setting.order)
        good = [pilot.step for pilot in one.pilots
                if pilot.valid and pilot.estimate <= limit and counts(pilot.step, one.pilots, limit)
                and self.step in (None, pilot.step)]
        if good:
            one.chosen = max(good)
        else:
            one.reason = "no time was left for the pilots that it needs"
