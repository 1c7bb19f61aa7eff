# A row of the claims ledger: the paper's figure, ours with its interval, and the verdict by a rule.
import math

from analysis.core.text import number

CONFIRMED, REFUTED, UNTESTED = "confirmed", "refuted", "cannot be tested here"


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
    return REFUTED if high < lowest or low > highest else UNTESTED


def tested(head, measured, rule, where, why, unit="×", record=""):
    """A row from what was measured. `head`: (id, claim, the paper's number); `measured`: (value, low, high) in `unit`;
    `rule`: of at_least, more_than or at_most, or (lowest, highest), in the same unit; `why`: a sentence from this set's
    numbers."""
    value, low, high = measured
    found = verdict(low, high, rule)
    if found == UNTESTED:
        why = f"Undecided: the interval includes a bound of the rule. {why}"
    return _row(head) | {"ours": number(value) + unit, "low": number(low), "high": number(high), "where": where,
                         "verdict": found, "rule": rule_text(rule, unit), "why": why, "record": record}


def compared(head, found, rule, why, where=None):
    """A row of a compare.Versus."""
    return tested(head, of(found), rule, where or found.where, why, record=found.record)


def untested(head, why, rule=None, unit="×"):
    """A row for what this set cannot tell, with the reason."""
    return _row(head) | {"ours": "", "low": "", "high": "", "where": "", "verdict": UNTESTED,
                         "rule": rule_text(rule, unit) if rule else "", "why": why, "record": ""}


def _row(head):
    return dict(zip(("id", "claim", "paper"), head))


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
