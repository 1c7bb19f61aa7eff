# The largest step of every implementation and setting that meets each required error, from the curves.
import numpy

from analysis.accuracy.front import FINISHED
from study.accuracy_study.classes import ERRORS


def largest_steps(rows, entries):
    """{(variant, setting): {required error: the row of the largest step that meets it}}. Where a curve of a
    slow implementation was not followed so far, or has no run between two steps, it has the row of the variant
    that needs the smallest step in the same setting: they have agreed, and differ in rounding only. What that
    does to the error is then judged (rounds.py)."""
    curves = dict(list(rows.groupby(["implementation", "setting"])))
    found = {}
    for variant, setting in entries.admitted():
        own = curves.get((variant, setting.name))
        others = [curve for key, curve in curves.items() if key[1] == setting.name and curve is not own]
        for error in ERRORS:
            chosen = _largest(own, error) if own is not None else None
            shortest, longest = _open(own, chosen)
            borrowed = (_largest(curve[(curve.step > shortest) & (curve.step < longest)], error)
                        for curve in others)
            chosen = min((one for one in borrowed if one is not None), key=lambda one: one.step,
                         default=chosen)
            if chosen is not None:
                found.setdefault((variant, setting.name), {})[error] = chosen
    return found


def _largest(curve, error):
    """The row of the largest step of a curve that meets `error`, or None."""
    meeting = curve[curve.status.isin(FINISHED) & (curve.error <= error)]
    return None if meeting.empty else meeting.loc[meeting.step.idxmax()]


def _open(own, chosen):
    """The steps between which a curve leaves open whether they meet an error, without its ends."""
    if own is None:
        return 0.0, numpy.inf
    if chosen is None:
        return 0.0, 0.999 * own.step.min()
    longer = own.step[own.step > 1.001 * chosen.step]
    return 1.001 * chosen.step, 0.999 * longer.min() if len(longer) else chosen.step
