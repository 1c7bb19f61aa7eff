# Curves of error against time, from coarse to fine: which runs are worth making.
from dataclasses import dataclass, field

from analysis.engines.runs import row
from study.core.curves import of_no_use, too_long


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
            status, reason = "not-reached", too_long(curve.rows, limit, curve.finer) or of_no_use(curve.rows, known[curve.family], least)
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
    cell = curve.cells[place][1]
    curve.rows.append(row(record) | {"cell": cell, "duration": float(cell.settings[cell.settings.index("--duration") + 1])})
