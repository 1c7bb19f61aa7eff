# How far a curve of error against time is followed, from coarse values to fine ones. Rows of runs: status, error, time (s for a
# simulated second), duration.
from analysis.core.outcomes import FINISHED

FAR = 2.0  # a curve that is this far from its family's front, and comes no nearer, is not followed further


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
    if now > FAR and now > 0.8 * before:
        return f"takes {now:.1f} times the front's time at its error, and comes no nearer"
    return ""
