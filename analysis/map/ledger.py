# A row of the claims ledger: the paper's figure, ours with its interval, and the verdict by a rule.
import math

from analysis.core.text import bounded, number, rough

CONFIRMED, REFUTED, UNDECIDED, UNMEASURED = "confirmed", "refuted", "undecided", "not measured"


def at_least(bound):
    return bound, math.inf


def more_than(bound):
    """As at_least, but the bound itself decides nothing."""
    return bound, math.inf, bound


def at_most(bound):
    return -math.inf, bound


def verdict(low, high, rule):
    """Confirmed if the whole interval obeys the rule, refuted if none of it does; an interval that includes a bound of
    the rule decides nothing, nor does the open bound of `more_than`."""
    lowest, highest, *undecided = rule
    if lowest <= low and high <= highest and low not in undecided:
        return CONFIRMED
    return REFUTED if high < lowest or low > highest else UNDECIDED


def tested(head, measured, rule, where, why, unit="×", record=""):
    """A row from what was measured. `head`: (id, claim, the paper's number); `measured`: (value, low, high) in `unit`;
    `rule`: of at_least, more_than or at_most, or (lowest, highest), in the same unit; `why`: a sentence from this set's
    numbers."""
    value, low, high = measured
    found, known = verdict(low, high, rule), bounded(low, high)
    crossed = [number(bound) + unit for bound in rule[:2] if low <= bound <= high and math.isfinite(bound)]
    reason = "" if found != UNDECIDED else "A single process has no interval." if not known else (
        f"The interval includes {' and '.join(crossed)}.")
    return _row(head) | {"ours": (number if known else rough)(value) + unit, "low": number(low) if known else "",
                         "high": number(high) if known else "", "where": where, "verdict": found, "reason": reason,
                         "rule": rule_text(rule, unit), "why": why, "record": record}


def compared(head, found, rule, why, where=None):
    """A row of a compare.Versus."""
    return tested(head, of(found), rule, where or found.where, why, record=found.record)


def unmeasured(head, reason, rule, unit="×"):
    """A row for what this set has no times of, with the reason."""
    return _row(head) | {"ours": "", "low": "", "high": "", "where": "", "verdict": UNMEASURED, "reason": reason,
                         "rule": rule_text(rule, unit), "why": "", "record": ""}


def undecided(head, reason, rule, why):
    """A row for what was measured but says nothing of the claim."""
    return unmeasured(head, reason, rule) | {"verdict": UNDECIDED, "why": why}


def _row(head):
    return dict(zip(("id", "claim", "paper"), head))


def counted(table):
    """"12 confirmed, 6 refuted, 14 undecided, 13 not measured"."""
    return ", ".join(f"{(table.verdict == one).sum()} {one}" for one in (CONFIRMED, REFUTED, UNDECIDED, UNMEASURED))


def rule_text(rule, unit):
    lowest, highest, *undecided = rule
    if math.isinf(highest):
        return f"{'more than' if undecided else 'at least'} {number(lowest)}{unit}"
    if math.isinf(lowest):
        return f"at most {number(highest)}{unit}"
    return f"{number(lowest)} to {number(highest)}{unit}"


def of(ratio):
    """(value, low, high)"""
    return ratio.value, ratio.low, ratio.high
