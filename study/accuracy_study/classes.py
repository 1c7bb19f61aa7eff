# The required errors, and the class of a run's error: the smallest of them that it meets.
from study.accuracy_study import subjects
from study.accuracy_study.bench import row
from study.pipeline import runs

ERRORS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-6)  # m
DURATION = 1.0  # s; a class needs as much: before the first singular position (0.71 s) all are accurate
SECONDS = 10.0  # a run over DURATION that is predicted to take longer is not made


def error_class(error):
    """The smallest of the required errors that `error` meets; None without one."""
    return min((limit for limit in ERRORS if error is not None and error <= limit), default=None)


def judged(bench, contender, setting, loops, step, predicted):
    """(the row of a run over DURATION at the mechanism's own fill, how it was lost or "") or (None, why there is
    none). `predicted`: s of computation for a simulated second."""
    if predicted * DURATION > SECONDS:
        return None, f"{DURATION:g} s would take {predicted * DURATION:.0f} s"
    subject = subjects.chain(loops, DURATION)
    record = bench.run("classes", subject, contender, setting, step, seconds=3 * SECONDS)
    found = row(subject, contender.variant, setting, step, record)
    return found, "" if found["status"] in runs.FINISHED else lost(found)


def lost(row):
    """Why a run has no time that counts: how it ended."""
    return ": ".join(word for word in (row["status"], row["status_reason"]) if word)
