# Which step each setting needs: error pilots, the setting that promises the fastest run first.
import math
from dataclasses import dataclass, field

from analysis.core.outcomes import FINISHED
from study.tools.advise.choice import counts, enough, local_order, next_at, next_step
from study.tools.advise.runner import FORCES_LOST
from study.tools.advise.timing import beyond, in_time

SCHEME = 2.0     # a scheme is followed while it promises less than this times the best one's time, as its changes may
NEAR = 1.15      # make up for it; a change of it while it promises less than that
ROOM = 2, 16     # times the step of the best: how long another scheme's may be, of second order and of a higher one
AHEAD = 4        # times the step of a pilot: how long the one is at most that it promises
DOUBT = 2        # times its promise: what goes before a setting of which no run has come to its end
LOST = (*FINISHED, "diverged", "not-converged", "wrong-branch", "refused", FORCES_LOST)  # another step may mend what is wrong


@dataclass
class Found:
    """What is known of a setting."""
    setting: object
    pilots: list = field(default_factory=list)
    chosen: float | None = None  # step, s
    reason: str = ""             # why it has none
    quick_us: float = math.nan   # of a step, in a short run before any pilot
    chosen_us: float = math.nan  # of the chosen step
    late: float | None = None    # step, s, that it would have but for the deadline
    out: bool = False            # it has a step, but all its candidates dropped out
    parent: object = None        # the Found of its scheme without changes, where that is another setting

    open = property(lambda self: self.chosen is None and not self.reason)

    def step_us(self):
        """Time of a step: of the run at the chosen step, else the median at the shortest one that was tried, else of the short run."""
        times = [pilot for pilot in self.pilots if pilot.step_us > 0]
        pilot = min(times, key=lambda pilot: pilot.step).step_us if times else self.quick_us
        return pilot if math.isnan(self.chosen_us) else self.chosen_us

    def rung(self):
        """The longest step that was run and is not longer than the chosen one; the shortest without."""
        steps = [pilot.step for pilot in self.pilots]
        return max((step for step in steps if self.chosen and step <= self.chosen * 1.001), default=min(steps))


class Search:
    """Fills `advice.found`. `run(setting, step)` gives a Pilot, `quick(setting, step)` a short run's time of a step, us; None if it
    has none. Each gives False if no time is left."""

    def __init__(self, advice, settings, run, quick):
        self.found = advice.found = {setting: Found(setting) for setting in settings}
        for one in self.found.values():
            one.parent = self.found.get(one.setting.parent) if one.setting.changes else None
        self.asked, self.step, self.error, self.duration = advice.question, advice.question.step, advice.pilot_error, advice.pilot_duration
        self.run, self.quick, self.cut = run, quick, False

    def search(self):
        """Pilots until every setting has a step, or a reason why it has none."""
        while ready := [one for one in self.found.values() if one.open and self._ready(one)]:
            self._advance(min(ready, key=lambda one: self.promise(one) * (1 if self._tells(one) or self._leads(one) else DOUBT)))
        for one in self.found.values():
            if one.open and one.quick_us == math.inf:
                one.reason = "its steps take far longer than those of other settings"
            elif one.open:
                one.reason = f"promises {self.promise(one) / 1e3:.3g} ms a simulated second at best, the fastest {self.best() / 1e3:.3g}"

    def best(self):
        """Least time of a simulated second among the settings that have a step, us."""
        return min((self.promise(one) for one in self.found.values() if one.chosen and not one.out), default=math.inf)

    def again(self):
        """Where nothing of what has a step may be advised: steps for what promised less."""
        for one in self.found.values():
            one.out, one.reason = bool(one.chosen), "" if one.reason.startswith("promises") else one.reason
        self.search()

    def promise(self, one):
        """Time of a simulated second that a setting may reach, us; 0 where nothing is known."""
        if one.chosen:
            return one.step_us() / one.chosen
        parent = one.parent
        if one.pilots:
            return one.step_us() / self._needed(one)
        if self._leads(one):
            at = where = parent.chosen or self._needed(parent)
        elif self.step:
            at = where = self.step
        else:
            best = min((other for other in self.found.values() if other.chosen), key=self.promise, default=None)
            at, where = ROOM[one.setting.order > 2] * (best.chosen if best else self.asked.first_step), self.asked.first_step
        if math.isnan(one.quick_us):  # errors of a change are hardly less than those of its scheme: times decide
            one.quick_us = math.inf if parent and parent.quick_us == math.inf else self.quick(one.setting, where)
            if one.quick_us is None:
                one.quick_us = parent.step_us() if parent and parent.pilots else 0.0
        return one.quick_us / at

    def _tells(self, one):
        """Whether a setting's pilots tell which step it needs. Where one was lost, estimates must count: what is lost at a singular position may
        be lost there again at the next step."""
        valid = [pilot for pilot in one.pilots if pilot.valid] if one else []
        return bool(valid) and (len(valid) == len(one.pilots) or any(counts(pilot.step, valid, self.error) for pilot in valid))

    def _leads(self, one):
        """Whether the pilots of its scheme tell which step a change needs: none of them was lost, as the change may pass where it was."""
        return bool(one.parent and one.parent.pilots) and all(pilot.valid for pilot in one.parent.pilots)

    def _needed(self, one):
        """The step that a setting's estimates ask for."""
        if self.step:
            return self.step
        valid = [pilot for pilot in one.pilots if pilot.valid]
        if not valid:
            return min(pilot.step for pilot in one.pilots) / 2
        finest = min(valid, key=lambda pilot: pilot.step)
        slope = local_order(finest.step, one.pilots, one.setting.order)
        return finest.step * min(AHEAD, (self.error / max(finest.estimate, 1e-300)) ** (1 / slope))

    def _ready(self, one):
        if one.parent and one.parent.open and self._ready(one.parent):
            return False  # the scheme itself first
        return not self.promise(one) > (NEAR if self._leads(one) else SCHEME) * self.best()

    def _advance(self, one):
        parent, order = one.parent, one.setting.order
        start = parent.rung() if self._leads(one) else self.asked.first_step
        after = (next_at(self.step, one.pilots, self.error, order, self.duration) if self.step else
                 next_step(one.pilots, self.error, order, start, self.duration))
        if after.step is None:
            self._end(one, after.chosen, after.reason)
            return
        if not (pilot := self.run(one.setting, after.step)):
            self.cut = True
            self._settle(one, "no time was left for the pilots that it needs")
        elif pilot.status == "unsupported":
            one.reason = f"unsupported: {pilot.reason}"
        else:
            one.pilots.append(pilot)
            beside = [other for other in parent.pilots if other.valid and other.step == pilot.step] if parent else []
            if pilot.status not in LOST or (pilot.status == FORCES_LOST and beside):  # the change is to blame, not the step
                self._settle(one, f"{pilot.status}: {pilot.reason}")
            elif pilot.valid and beside and pilot.estimate > 3.0**order * beside[0].estimate:  # a step of less than a third would mend it
                self._settle(one, f"estimate {pilot.estimate:.2g} m at step {pilot.step:g} s, far above that of "
                                  f"{parent.setting.name} without the change")

    def _settle(self, one, reason):
        """Nothing more is tried: the longest step that is known to be good enough, if any."""
        good = (pilot.step for pilot in enough(one.pilots, self.error, one.setting.order) if self.step in (None, pilot.step))
        self._end(one, next(good, None), reason)

    def _end(self, one, chosen, reason):
        """Gives a setting its step, or the reason why it has none."""
        one.chosen, one.reason = chosen, "" if chosen else reason
        if chosen:
            quick = self.quick(one.setting, chosen)
            one.chosen_us = quick if quick and math.isfinite(quick) else one.step_us()
            if one.chosen_us > in_time(chosen, self.asked.deadline_us):
                one.chosen, one.late = None, chosen
                one.reason = f"a step takes {one.chosen_us:.3g} us, {beyond(chosen, one.chosen_us, self.asked.deadline_us)}"
