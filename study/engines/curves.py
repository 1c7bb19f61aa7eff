# Curves of error against time, from coarse to fine: which runs are worth making.
import math
from dataclasses import dataclass, field

from analysis.core.outcomes import FINISHED
from analysis.engines.runs import row

FAR = 2.0    # a curve that is this far from its family's front, and comes no nearer, is not followed further


@dataclass
class Curve:
    family: str    # whose front it is measured by: all curves of an engine, or of an implementation of ours
    cells: list    # (value, Cell), the coarsest first
    finer: float   # predicted: how much longer the next value takes
    rows: list = field(default_factory=list)
    ended: bool = False


def follow(lab, curves, limit, least, share):
    """The rows of all curves, followed at once a value at a time. A curve ends with a row that says why: a run would
    take longer than `limit` s, `least` is reached, finer values are of no use, or the `share` of the budget is spent."""
    for place in range(max((len(curve.cells) for curve in curves), default=0)):
        going = [curve for curve in curves if not curve.ended and place < len(curve.cells)]
        known = {curve.family: [] for curve in curves}
        for curve in curves:
            known[curve.family] += curve.rows
        chosen = []
        for curve in going:
            status, reason = _end(curve, known[curve.family], limit, least)
            if not reason and lab.left <= (1 - share) * lab.budget:
                status, reason = "dropped", f"the curves' share of the budget, {share * lab.budget:.0f} s, was spent"
            if reason:
                curve.ended = True
                _note(curve, place, lab.skip(curve.cells[place][1], status, reason))
            else:
                chosen.append(curve)
        lab.tell(f"{len(chosen)} curves at value {place + 1}")
        for curve, record in zip(chosen, lab.run([curve.cells[place][1] for curve in chosen])):
            _note(curve, place, record)
    return [one for curve in curves for one in curve.rows]


def _note(curve, place, record):
    curve.rows.append(row(record) | {"cell": curve.cells[place][1]})


def _end(curve, known, limit, least):
    """(status, reason) of what ends a curve, or two times ""."""
    ahead = _ahead(curve)
    if ahead > limit:
        return "not-reached", (f"predicted to take {ahead:.1f} s, the limit is {limit:g} s" if math.isfinite(ahead) else
                               "the run before it did not end")
    reason = of_no_use(curve.rows, known, least)
    return ("not-reached", reason) if reason else ("", "")


def _ahead(curve):
    """Predicted seconds of the next run; a run that was lost early counts as if it had ended."""
    if not curve.rows:
        return 0.0
    last, cell = curve.rows[-1], curve.cells[0][1]
    if last["status"] == "timeout":
        return math.inf
    duration = float(cell.settings[cell.settings.index("--duration") + 1])
    return curve.finer * (last["time"] or 0.0) * duration


def of_no_use(rows, known, least):
    """Why a curve is not followed further, or "". `known`: the rows of its family."""
    made = rows[-3:]
    if made and made[-1]["error"] <= least:
        return f"the error is at most {least:.2g} m, the least that is asked for"
    if len(made) < 3 or any(one["status"] not in FINISHED for one in made):
        return ""
    if made[0]["error"] <= made[1]["error"] <= made[2]["error"]:
        return "finer values do not make the error smaller"
    before, now = (one["time"] / min(other["time"] for other in known
                                     if other["status"] in FINISHED and other["error"] <= one["error"])
                   for one in made[1:])
    if now > FAR and now > 0.8 * before:
        return f"takes {now:.1f} times the front's time at its error, and comes no nearer"
    return ""
