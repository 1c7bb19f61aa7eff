# Curves of error against time, followed from coarse values to fine ones: which runs are worth making.
from dataclasses import dataclass, field

from analysis.core.gather import gather
from analysis.core.outcomes import FINISHED

FAR = 2.0  # a curve that is this far from its family's front, and comes no nearer, is not followed further


@dataclass
class Curve:
    family: str    # whose front it is measured by
    cells: list    # (value, Cell), the coarsest first
    finer: float   # predicted: how much longer the next value takes
    rows: list = field(default_factory=list)  # of its runs: status, error, time (s for a simulated second), duration
    ended: bool = False


def follow(lab, curves, row, limit, least, share=None, status="not-reached"):
    """Follows all curves at once, a value at a time. A curve ends with a row of this `status` that says why: a run would take longer
    than `limit` s, `least` is reached, or finer values are of no use; or with one that is dropped, where the budget, or a `share` of
    it, is spent. `row`: of a cell's record."""
    for place in range(max((len(curve.cells) for curve in curves), default=0)):
        known, chosen = gather((curve.family, row) for curve in curves for row in curve.rows), []
        for curve in (one for one in curves if not one.ended and place < len(one.cells)):
            how, reason = status, too_long(curve.rows, limit, curve.finer) or of_no_use(curve.rows, known.get(curve.family), least)
            if not reason and share and lab.left <= (1 - share) * lab.budget:
                how, reason = "dropped", f"the curves' share of the budget, {share * lab.budget:.0f} s, was spent"
            if reason:
                curve.ended = True
                _note(curve, row, place, lab.skip(curve.cells[place][1], how, reason))
            else:
                chosen.append(curve)
        lab.tell(f"{len(chosen)} curves at value {place + 1}")
        for curve, record in zip(chosen, lab.run([curve.cells[place][1] for curve in chosen], drop=not share)):
            _note(curve, row, place, record)
            curve.ended = record.status == "dropped"


def _note(curve, row, place, record):
    cell = curve.cells[place][1]
    curve.rows.append(row(record) | {"cell": cell, "duration": float(cell.settings[cell.settings.index("--duration") + 1])})


def too_long(rows, limit, finer):
    """Why the next run is not made, or "". `finer`: how much longer it will take than the last."""
    if not rows:
        return ""
    last = rows[-1]
    if last["status"] == "timeout":
        return "the run before it did not end"
    ahead = finer * (last["time"] or 0.0) * last["duration"]  # a run that was lost early counts as if it had ended
    return f"predicted to take {ahead:.1f} s, the limit is {limit:g} s" if ahead > limit else ""


def of_no_use(rows, known, least):
    """Why a curve is not followed further, or "". `known`: the rows of its family."""
    made = rows[-3:]
    if made and made[-1]["error"] <= least:
        return f"the error is at most {least:.2g}, the least that is asked for"
    if len(made) < 3 or any(one["status"] not in FINISHED for one in made):
        return ""
    if made[0]["error"] <= made[1]["error"] <= made[2]["error"]:
        return "finer values do not make the error smaller"
    before, now = (one["time"] / min(other["time"] for other in known if other["status"] in FINISHED and other["error"] <= one["error"])
                   for one in made[1:])
    return f"takes {now:.1f} times the front's time at its error, and comes no nearer" if now > FAR and now > 0.8 * before else ""
