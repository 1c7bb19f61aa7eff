# From error estimates at some steps: which of them count, which step comes next, which step is chosen.
import math
from collections import namedtuple

from analysis.core.outcomes import FINISHED

LEAST_STEPS = 10   # of a whole run
MOST_STEPS = 10**7
NEGLIGIBLE = 0.01  # of the error that is asked for
SLACK = 0.3        # by which an order may fall below the one that was shown
AIM = 0.95         # of the error: what the step between two pilots is chosen for
TIDY = 0.05        # share that a step may become shorter to be a tidy number
JUMP = 8           # a pilot's step is at least this part of the one before it


class Pilot(namedtuple("Pilot", "step status estimate step_us reason", defaults=(math.nan, ""))):
    """A run at a step, with half the step beside it. `estimate`: of the position error, m; `step_us`: median time of a step, as one run must do,
    even on a busy machine."""
    valid = property(lambda self: self.status in FINISHED and self.estimate is not None)


# What a setting's pilots ask for: another one at `step`; or nothing, if they have chosen a step or given up for a reason.
Next = namedtuple("Next", "step chosen reason", defaults=(None, None, ""))


def halvings(pilots):
    """{step: log2(estimate there / estimate at half of it)}, where both runs are valid."""
    valid = {pilot.step: max(pilot.estimate, 1e-300) for pilot in pilots if pilot.valid}
    return {step: math.log2(valid[step] / valid[half]) for step in valid for half in valid if close(half, step / 2)}


def close(one, other):
    return abs(one - other) < 1e-3 * other


def counts(step, pilots, error=0.0):
    """Whether the estimate at a step counts: the halving that begins there, or if that is not known the one that ends there, shows an order
    of at least 1, or leaves both estimates below a hundredth of `error` (a motion that steps hardly change shows no order)."""
    orders = halvings(pilots)
    if (at := next((at for start in (step, 2 * step) for at in orders if close(at, start)), None)) is None:
        return False
    small = [pilot.step for pilot in pilots if pilot.valid and pilot.estimate <= NEGLIGIBLE * error]
    return orders[at] >= 1 or all(any(close(one, other) for other in small) for one in (at, at / 2))


def local_order(step, pilots, order):
    """The order observed at a step or nearest above it, or below it; the scheme's own where none is."""
    found = halvings(pilots)
    at = min(found, key=lambda at: (at <= step * 0.999, abs(at - step)), default=None)
    return order if at is None else min(max(found[at], 1.0), order + 2.0)


def trusted(step, pilots, order):
    """The order that is reckoned with at a step: SLACK below the observed one, but at least 1 and at most the scheme's."""
    return min(max(local_order(step, pilots, order) - SLACK, 1.0), order)


def apart(estimate, order):
    """How far a run is from the one with half the step, m: of that its estimate is made, by the scheme's order."""
    return estimate * (1 - 2.0**-order)


def by_order(step, estimate, pilots, order):
    """The largest error of a run with this estimate, m, if only the order that its setting shows is known."""
    return apart(estimate, order) / (1 - 2.0 ** -trusted(step, pilots, order))


def most(step, estimate, pilots, order, error):
    """The largest error, m, of a run with this estimate: its distance to the run with half the step, and what that one's may be, of which
    pilots tell, of the order that they show where theirs is longer; where there are none, by that order alone. Infinite where they show none."""
    if halves := [pilot for pilot in pilots if pilot.valid and 0.499 * step < pilot.step < 0.9 * step]:
        half = min(halves, key=lambda pilot: pilot.step)
        rest = most(half.step, half.estimate, pilots, order, error)
        if math.isfinite(rest):
            return apart(estimate, order) + rest * min(1.0, step / 2 / half.step) ** trusted(half.step, pilots, order)
    return by_order(step, estimate, pilots, order) if counts(step, pilots, error) else math.inf


def known(pilot, pilots, error, order):
    """`most` of a pilot; infinite for one that is lost."""
    return most(pilot.step, pilot.estimate, pilots, order, error) if pilot.valid else math.inf


def enough(pilots, error, order):
    """Pilots whose errors are known to be small enough, the longest step first."""
    return [pilot for pilot in sorted(pilots, key=lambda pilot: -pilot.step) if known(pilot, pilots, error, order) <= error]


def possible(step, duration):
    return duration / MOST_STEPS <= step <= duration / LEAST_STEPS


def next_step(pilots, error, order, start, duration):
    """The Next of a setting with these pilots, on the ladder start·2^k but for one half-way (√2) to a step where the motion is lost."""
    if not pilots:
        return Next(step=start)
    find = lambda step: next((pilot for pilot in pilots if close(pilot.step, step)), None)
    good = (pilot for pilot in pilots if pilot.valid and pilot.estimate <= error and abs(math.remainder(math.log2(pilot.step / start), 1)) < 0.01)
    for pilot in sorted(good, key=lambda pilot: -pilot.step):
        step, reached = pilot.step, known(pilot, pilots, error, order)
        if reached <= error:
            longer, between = find(2 * step), find(math.sqrt(2) * step)
            if longer is None and possible(2 * step, duration):
                return Next(step=2 * step)
            if longer and not longer.valid and between is None:
                return Next(step=math.sqrt(2) * step)
            if between and pilot.estimate <= (between.estimate or 0.0) and known(between, pilots, error, order) <= error:
                return Next(chosen=between.step)
            return Next(chosen=_between(pilot, longer, reached, error))
        if math.isfinite(reached):
            continue
        # Two halvings are needed to believe it; the longer step is the cheaper witness.
        for witness in (2 * step, step / 2):
            if possible(witness, duration) and find(witness) is None:
                return Next(step=witness)
    return _shorter(pilots, error, order, duration)


def next_at(step, pilots, error, order, duration):
    """The Next of a setting whose step is given: half of it is run, too, to show that the estimate there counts."""
    by_step = {pilot.step: pilot for pilot in pilots}
    if step not in by_step:
        return Next(step=step)
    here = by_step[step]
    if not here.valid:
        return Next(reason=f"{here.status} at step {step:g} s: {here.reason}")
    if here.estimate > error:
        return Next(reason=f"estimate {here.estimate:.2g} m at step {step:g} s")
    if step / 2 not in by_step and possible(step / 2, duration):
        return Next(step=step / 2)
    if here in enough(pilots, error, order):
        return Next(chosen=step)
    return Next(reason=f"estimate {here.estimate:.2g} m at step {step:g} s, and half the step does not show it to be right")


def _between(pilot, longer, reached, error):
    """The step between a good one and twice that, where the error is expected to be met."""
    if longer is None or not longer.valid:
        return pilot.step
    slope = math.log2(longer.estimate / pilot.estimate) if longer.estimate > pilot.estimate > 0 else 1.0
    return pilot.step * min(2.0, max(1.0, (AIM * error / max(reached, 1e-300)) ** (1 / max(slope, 1.0))))


def _shorter(pilots, error, order, duration):
    """A shorter step than all so far, or why none helps."""
    valid = sorted((pilot for pilot in pilots if pilot.valid), key=lambda pilot: pilot.step)
    least = min(pilot.step for pilot in pilots)
    # Where no estimate counts yet, long steps that agree by chance may look like rounding.
    settled = len(valid) > 5 or any(counts(pilot.step, pilots) for pilot in valid)
    if settled and len(valid) >= 3 and valid[0].estimate >= valid[1].estimate >= valid[2].estimate:
        best = min(valid, key=lambda pilot: pilot.estimate)
        return Next(reason=f"shorter steps do not help: estimate {best.estimate:.2g} m at step {best.step:g} s, {valid[0].estimate:.2g} m at "
                           f"{valid[0].step:g} s")
    factor = 2.0
    if valid and valid[0].step == least and valid[0].estimate > error and counts(least, pilots):
        # The order shown tells how far; one halving less, as two steps must show it there.
        halvings_left = math.log2(valid[0].estimate / error) / local_order(least, pilots, order)
        factor = min(JUMP, 2.0 ** max(1, math.floor(halvings_left)))
    if possible(least / factor, duration):
        return Next(step=least / factor)
    lost = min(pilots, key=lambda pilot: pilot.step)
    return Next(reason=f"no step down to {least:g} s: {lost.reason or lost.status}")


def tidy(step, duration):
    """The longest step of three digits, at most 5 % shorter than `step`, that fits whole into `duration`; or else of three digits."""
    unit = 10.0 ** math.floor(math.log10(step) - 2)
    most_units = math.floor(step / unit * (1 + 1e-9))
    values = [float(f"{number * unit:.6g}") for number in range(most_units, math.ceil((1 - TIDY) * most_units) - 1, -1)]
    whole = [value for value in values if abs(duration / value - round(duration / value)) < 1e-9 * duration / value]
    return [*whole, *values][0]
