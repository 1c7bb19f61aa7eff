# How runs end, and which of that counts as what (harness/src/run/README.md says what each means); the front of error and time.
import numpy

GOOD = ("ok", "plausible")       # nothing is known to be wrong
FINISHED = (*GOOD, "degraded")   # has all of its motion
WHOLE = (*FINISHED, "not-converged")  # got to the end
SAME = 0.02  # errors that differ by so little are those of one motion


def of_run(record):
    """(status, reason) of a record of `mbs simulate`: the outcome, or why there is none."""
    return (record.output["status"], record.output["status_reason"]) if record.done else (record.status, record.reason)


def finished(rows):
    """Rows (`status`, `error`, `time`) of runs that have all of their motion, an error and a time."""
    return rows[rows.status.isin(FINISHED) & rows.error.notna() & rows.time.notna()]


def pareto(rows):
    """Index of the rows that nobody beats, the fastest first: every faster run has an error larger by more than SAME."""
    found, smallest = [], numpy.inf
    ordered = finished(rows).sort_values(["time", "error"], kind="stable")
    for index, error in zip(ordered.index, ordered.error):
        if error < (1 - SAME) * smallest:
            found.append(index)
            smallest = error
    return found


def near(rows, factor):
    """Index of the rows that take at most `factor` times as long as the front at their error."""
    done = finished(rows)
    front = done.loc[pareto(rows)]
    times, errors = front.time.to_numpy(), (1 - SAME) * front.error.to_numpy()
    return done.index[[time <= factor * times[errors <= error].min() for time, error in zip(done.time, done.error)]]
