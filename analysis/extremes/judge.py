# What a run is held to: the true motion, how far the run is from it, and how far it may be.
import numpy

from analysis.core.outcomes import FINISHED, WHOLE, of_run

CLASS = 1e-2         # of a link's length, what "ok" allows: AccurateBounds of harness/src/run/judge.hpp
PLACES = (".x", ".y", ".z")  # what columns of places end in
STILL = 1e-9         # lengths; what moves less rests
FINER = (4, 8)       # the reference runs at a quarter and at an eighth of the step


def true_motion(cell, references, times):
    """([solutions], their own error in lengths, what they are), or ([], None, why there is none). `references`:
    {finer: Record} where nothing else knows the motion."""
    times = numpy.array(times, dtype=float)
    if cell.motion:
        solutions = cell.motion.solutions(times) if len(times) else [{}]  # motions are asked for at some times
        return solutions, rounding(cell, solutions, times), cell.motion.truth
    for factor in FINER:
        status, reason = of_run(references[factor]) if factor in references else ("missing", "it was not run")
        if status not in FINISHED:
            return [], None, f"none: the reference is {status}: {reason}"
    fine, finest = ({column: values[:len(times)] for column, values in references[factor].series.items()} for factor in FINER)
    solution = {column: values for column, values in finest.items() if column != "t"}
    # The error of the finer one of two runs of second order is a third of their difference.
    own = float(distances(fine, solution, cell.length).max()) / 3 if len(times) else 0.0
    if not own <= CLASS / 10:
        return [], own, f"none: the reference's own error is {own:.1e}"
    return [solution], own, f"reference at 1/{FINER[-1]} of the step"


def rounding(cell, solutions, times):
    """The error of known motions as they are evaluated in double, in lengths: what their integration leaves, or an ulp of
    time and one of positions."""
    if not len(times) or cell.motion.accuracy:
        return cell.motion.accuracy / cell.length
    ulp = numpy.finfo(float).eps
    return max(
        float(distances(late, known, cell.length).max() + ulp * max(abs(values).max() for values in known.values()) / cell.length)
        for late, known in zip(cell.motion.solutions(times * (1 + ulp)), solutions))


def allowed(cell, solutions):
    """The largest true error, in lengths, of a run that may be ok. Of a short way it is the same share, as else a run
    that stood still would be right; what is at rest must stay within a hundredth."""
    way = max((float(numpy.ptp(values)) for solution in solutions for column, values in solution.items()
               if column.endswith(PLACES) and len(values)), default=0.0) / cell.length
    return CLASS * min(1.0, way) if way > STILL else CLASS


def off(record, solutions, length, limit):
    """(true error, lengths; the first instant kept at which a run is off by more than `limit` lengths, s, None if it is at none): by the
    largest distance of a point, from the nearest where several motions are possible. The error is NaN where the run has not all of its
    motion, or nothing is known."""
    far = [distances(record.series, solution, length) for solution in solutions] if record.series.get("t") else []
    late = ~(numpy.min(far, axis=0) <= limit) if far else numpy.zeros(0, bool)
    return (min(one.max() for one in far) if far and of_run(record)[0] in WHOLE else numpy.nan,
            float(record.series["t"][late.argmax()]) if late.any() else None)


def distances(series, solution, length):
    """At each time of `series`, the largest distance of one of its points from `solution`, in lengths."""
    found = {}
    for column in series:
        if column.endswith(PLACES) and column in solution:
            point = column.rpartition(".")[0]
            found[point] = found.get(point, 0) + ((numpy.array(series[column], dtype=float) - solution[column]) / length)**2
    return numpy.sqrt(numpy.max(list(found.values()), axis=0))
