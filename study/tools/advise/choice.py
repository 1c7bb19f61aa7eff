# From error estimates at some steps: which of them count, which step comes next, which step is chosen.
import math
from dataclasses import dataclass

from analysis.core.outcomes import FINISHED

LEAST_STEPS = 10   # of a whole run
MOST_STEPS = 10**7
NEGLIGIBLE = 0.01  # of the limit
AIM = 0.9          # of the limit: what the step between two pilots is chosen for
TIDY = 0.05        # share that a step may become shorter to be a tidy number
JUMP = 8           # a pilot's step is at least this part of the one before it


@dataclass(frozen=True)
class Pilot:
    """A run at a step, with half the step beside it."""
    step: float
    status: str
    estimate: float | None     # of the position error, m
    step_us: float = math.nan  # median time of a step: one run must do, even on a busy machine
    p99_us: float = math.nan
    reason: str = ""

    @property
    def valid(self):
        return self.status in FINISHED and self.estimate is not None


@dataclass(frozen=True)
class Next:
    """What a setting's pilots ask for: another one at `step`; or nothing, if they have chosen a step or
    given up for a reason."""
    step: float | None = None
    chosen: float | None = None
    reason: str = ""


def allowed(error, order):
    """The largest estimate, m, that is good enough for `error`. An estimate assumes that halving the
    step divides the error by 2^order; this one still holds if it only halves it."""
    return error / (2 * (1 - 2.0**-order))


def interval(estimate, order, observed):
    """The error that a run may have whose order is between `observed` (at least 1) and infinite."""
    difference = estimate * (1 - 2.0**-order)  # to the run with half the step
    return difference, difference / (1 - 2.0 ** -min(max(observed, 1.0), order))


def halvings(pilots):
    """{step: log2(estimate there / estimate at half of it)}, where both runs are valid."""
    valid = {pilot.step: max(pilot.estimate, 1e-300) for pilot in pilots if pilot.valid}
    return {step: math.log2(valid[step] / valid[half])
            for step in valid for half in valid if close(half, step / 2)}


def close(one, other):
    return abs(one - other) < 1e-3 * other


def counts(step, pilots, limit=0.0):
    """Whether the estimate at a step counts: the halving that begins there, or if that is not known the one
    that ends there, shows an order of at least 1, or leaves both estimates below a hundredth of `limit` (a
    motion that steps hardly change shows no order)."""
    small = {pilot.step for pilot in pilots if pilot.valid and pilot.estimate <= NEGLIGIBLE * limit}
    begins = ends = None
    for at, order in halvings(pilots).items():
        shown = order >= 1 or (at in small and any(close(at / 2, other) for other in small))
        begins = shown if close(at, step) else begins
        ends = shown if close(at, 2 * step) else ends
    return bool(ends if begins is None else begins)


def local_order(step, pilots, order):
    """The order observed nearest above a step, or below it; the scheme's own where none is."""
    found = halvings(pilots)
    longer = [at for at in found if at > step * 1.001]
    shorter = [at for at in found if at <= step * 1.001]
    at = min(longer) if longer else max(shorter) if shorter else None
    return order if at is None else min(max(found[at], 1.0), order + 2.0)


def next_step(pilots, limit, order, start, duration):
    """The Next of a setting with these pilots, on the ladder start·2^k but for one half-way (√2) to a step
    where the motion is lost; `limit` is for estimates."""
    def fits(step):
        return duration / MOST_STEPS <= step <= duration / LEAST_STEPS
    if not pilots:
        return Next(step=start)
    by_step = {pilot.step: pilot for pilot in pilots}

    def find(step):
        return next((by_step[at] for at in by_step if close(at, step)), None)
    good = sorted(step for step, pilot in by_step.items() if pilot.valid and pilot.estimate <= limit
                  and abs(math.remainder(math.log2(step / start), 1)) < 0.01)
    for step in reversed(good):  # the longest first
        if counts(step, pilots, limit):
            longer = find(2 * step)
            if longer is None and fits(2 * step):
                return Next(step=2 * step)
            between = find(math.sqrt(2) * step)
            if longer and not longer.valid and between is None:
                return Next(step=math.sqrt(2) * step)
            if between and between.valid and by_step[step].estimate <= between.estimate <= limit:
                return Next(chosen=between.step)
            return Next(chosen=_between(step, longer, pilots, limit))
        # Two halvings are needed to believe it; the longer step is the cheaper witness.
        for witness in (2 * step, step / 2):
            if fits(witness) and find(witness) is None:
                return Next(step=witness)
    return _shorter(pilots, limit, order, fits)


def next_at(step, pilots, limit, duration):
    """The Next of a setting whose step is given: other steps are run only to believe the estimate at that one."""
    by_step = {pilot.step: pilot for pilot in pilots}
    if step not in by_step:
        return Next(step=step)
    here = by_step[step]
    if not here.valid:
        return Next(reason=f"{here.status} at step {step:g} s: {here.reason}")
    if here.estimate > limit:
        return Next(reason=f"estimate {here.estimate:.2g} m at step {step:g} s")
    if counts(step, pilots, limit):
        return Next(chosen=step)
    for witness in (2 * step, step / 2):
        if witness not in by_step and duration / MOST_STEPS <= witness <= duration / LEAST_STEPS:
            return Next(step=witness)
    return Next(reason=f"the estimate {here.estimate:.2g} m at step {step:g} s is not shown to be right by halving "
                       "the step")


def _between(step, longer, pilots, limit):
    """The step between a good one and twice that, where the estimate is expected to meet the limit."""
    if longer is None or not longer.valid:
        return step
    here = next(pilot for pilot in pilots if pilot.step == step)
    slope = math.log2(longer.estimate / here.estimate) if longer.estimate > here.estimate else 1.0
    slope = max(slope, 1.0)
    return step * min(2.0, max(1.0, (AIM * limit / max(here.estimate, 1e-300)) ** (1 / slope)))


def _shorter(pilots, limit, order, fits):
    """A shorter step than all so far, or why none helps."""
    valid = sorted((pilot for pilot in pilots if pilot.valid), key=lambda pilot: pilot.step)
    least = min(pilot.step for pilot in pilots)
    # Where no estimate counts yet, long steps that agree by chance may look like rounding.
    settled = len(valid) > 5 or any(counts(pilot.step, pilots) for pilot in valid)
    if settled and len(valid) >= 3 and valid[0].estimate >= valid[1].estimate >= valid[2].estimate:
        best = min(valid, key=lambda pilot: pilot.estimate)
        return Next(reason=f"shorter steps do not help: estimate {best.estimate:.2g} m at step "
                           f"{best.step:g} s, {valid[0].estimate:.2g} m at {valid[0].step:g} s")
    factor = 2.0
    if valid and valid[0].step == least and valid[0].estimate > limit and counts(least, pilots):
        # The order shown tells how far; one halving less, as two steps must show it there.
        halvings_left = math.log2(valid[0].estimate / limit) / local_order(least, pilots, order)
        factor = min(JUMP, 2.0 ** max(1, math.floor(halvings_left)))
    if not fits(least / factor):
        lost = max(pilots, key=lambda pilot: -pilot.step)
        return Next(reason=f"no step down to {least:g} s: {lost.reason or lost.status}")
    return Next(step=least / factor)


def tidy(step, duration):
    """The longest step of three digits, at most 5 % shorter than `step`, that fits whole into `duration`;
    or else of two digits; or else of three."""
    unit = 10.0 ** math.floor(math.log10(step) - 2)
    most = math.floor(step / unit * (1 + 1e-9))
    numbers = range(most, math.ceil((1 - TIDY) * most) - 1, -1)
    values = [float(f"{number * unit:.6g}") for number in numbers]
    whole = [value for value in values
             if abs(duration / value - round(duration / value)) < 1e-9 * duration / value]
    short = [value for value, number in zip(values, numbers) if number % 10 == 0]
    return [*whole, *short, *values][0]
