# A row of the claims ledger: the paper's figure, ours with its interval, and the verdict by a rule.
import math
from collections import namedtuple

from analysis.core.gather import gather
from analysis.core.text import bounded, number, rough

CONFIRMED, EXCEEDED, REFUTED, UNDECIDED = "confirmed", "exceeded", "refuted", "undecided"
MIXED, INCOMPARABLE, UNMEASURED = "mixed", "not comparable", "not measured"
VERDICTS = (CONFIRMED, EXCEEDED, REFUTED, MIXED, UNDECIDED, INCOMPARABLE, UNMEASURED)  # in the order of texts
FACTOR_BAND = 1.25  # around a factor of the paper: from it divided by this to it times this confirms


class Rule(namedtuple("Rule", "low high beyond", defaults=(-math.inf, math.inf, REFUTED))):
    """What confirms lies between `low` and `high`; `beyond`: the verdict on what lies above."""

    def text(self, unit):
        if math.isinf(self.high):
            return f"at least {number(self.low)}{unit}"
        if math.isinf(self.low):
            return f"at most {number(self.high)}{unit}"
        return f"{number(self.low)} to {number(self.high)}{unit}" + (", above it exceeded" if self.beyond == EXCEEDED else "")


def factor(low, high=None):
    """The paper says that something is so many times faster or slower, or from `low` to `high` times."""
    return Rule(low / FACTOR_BAND, (high or low) * FACTOR_BAND, EXCEEDED)


def verdict(low, high, rule):
    """Confirmed if the whole interval obeys the rule, refuted or exceeded if none of it does; an interval that includes a
    bound of the rule decides nothing."""
    if rule.low <= low and high <= rule.high:
        return CONFIRMED
    return REFUTED if high < rule.low else rule.beyond if low > rule.high else UNDECIDED


def summed(verdicts):
    """One verdict of several sizes or fills: theirs if it is one; mixed if they were decided differently; else open."""
    decided = set(verdicts) & {CONFIRMED, EXCEEDED, REFUTED}
    return next(iter(set(verdicts))) if len(set(verdicts)) == 1 else MIXED if len(decided) > 1 else UNDECIDED


def judged(head, cases, rule, where, unit="×"):
    """A row from what was measured at one or several sizes or fills, each judged alone. `head`: (id, claim, the paper's
    number); `cases`: [(place, (value, low, high) in `unit`, record)]; `where`: who was compared."""
    told = gather((verdict(low, high, rule), place) for place, (_, low, high), _ in cases)
    known = [bounded(low, high) for _, (_, low, high), _ in cases]
    values = sorted((value, (number if one else rough)(value)) for (_, (value, _, _), _), one in zip(cases, known))
    ends = ["", ""] if not all(known) else [number(min(low for _, (_, low, _), _ in cases)), number(max(high for _, (_, _, high), _ in cases))]
    seen = ", ".join(f"{(number if one else rough)(value)}{unit} at {place}" for (place, (value, _, _), _), one in zip(cases, known))
    return row(head, summed(told), _reason(cases, told, rule, unit), rule.text(unit), seen) | {
        "ours": " to ".join(dict.fromkeys([values[0][1], values[-1][1]])) + unit, "low": ends[0], "high": ends[1],
        "where": f"{places([place for place, _, _ in cases])}, {where}", "record": " ".join(dict.fromkeys(one for _, _, one in cases))}


def _reason(cases, told, rule, unit):
    if len(cases) > 1 or UNDECIDED not in told:
        return by_place(told) if len(told) > 1 or UNDECIDED in told else ""
    _, (_, low, high), _ = cases[0]
    crossed = [number(bound) + unit for bound in (rule.low, rule.high) if low <= bound <= high and math.isfinite(bound)]
    return f"The interval includes {' and '.join(crossed)}." if bounded(low, high) else "A single process has no interval."


def by_place(told):
    """"confirmed at n = 22; undecided at n = 50, 82", of {verdict: places}."""
    return "; ".join(f"{one} at {places(told[one])}" for one in VERDICTS if one in told)


def places(names):
    """"n = 22, 50" of "n = 22" and "n = 50"."""
    heads = {name.partition("= ")[0] for name in names}
    short = [name.partition("= ")[2] for name in names]
    return f"{heads.pop()}= {', '.join(short)}" if len(heads) == 1 and all(short) else ", ".join(names)


def compared(head, found, rule, lacking=""):
    """A row of results.Versus of several sizes; without any it says what is `lacking`."""
    if not found:
        return unmeasured(head, lacking, rule)
    return judged(head, [(f"n = {one.size:g}", one[:3], one.record) for one in found], rule,
                  ", ".join(dict.fromkeys(f"{one.slow} ÷ {one.fast}" for one in found)))


def row(head, found, reason, rule="", seen=""):
    """A row without numbers: for what has no times, or says nothing of the claim."""
    return dict(zip(("id", "claim", "paper"), head)) | {"ours": "", "low": "", "high": "", "where": "", "verdict": found,
                                                        "reason": reason, "rule": rule, "seen": seen, "record": ""}


def unmeasured(head, reason, rule, unit="×"):
    return row(head, UNMEASURED, reason, rule.text(unit))


def beside(tables):
    """[(id, claim, the paper's number, [its row in each set's ledger, or None])]"""
    ledgers = [{(row["id"], row["claim"], row["paper"]): row for row in one.to_dict("records")} for one in tables]
    return [(*name, [one.get(name) for one in ledgers]) for name in dict.fromkeys(name for one in ledgers for name in one)]


def by_id(table):
    """{id: (verdict, its rows' verdicts in words)}: that of all its measured rows, mixed where they differ."""
    return {name: ((MIXED if len({*kinds} - {UNMEASURED}) > 1 else kinds[0]), ", ".join(kinds) if len(kinds) > 1 else "")
            for name, rows in table.groupby("id", sort=False) for kinds in [[one for one in VERDICTS if one in set(rows.verdict)]]}


def told(table):
    """"confirmed: F4, C4; mixed: T2": one verdict a claim."""
    found = gather((one, name) for name, (one, _) in by_id(table).items())
    return "; ".join(f"{one}: {', '.join(found[one])}" for one in VERDICTS if one in found)
