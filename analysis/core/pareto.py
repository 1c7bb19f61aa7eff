# The Pareto front of error and time, and what lies close to it. Rows have `status`, `error` and `time`.
import numpy

from analysis.core.outcomes import FINISHED

SAME = 0.02


def finished(rows):
    """Rows of runs that have all of their motion, an error and a time."""
    return rows[rows.status.isin(FINISHED) & rows.error.notna() & rows.time.notna()]


def pareto(rows):
    """Index of the rows that nobody beats, the fastest first: every faster run has an error larger by more than
    SAME. Errors that differ by less are those of one motion, of which the fastest run counts."""
    found, smallest = [], numpy.inf
    for row in finished(rows).sort_values(["time", "error"], kind="stable").itertuples():
        if row.error < (1 - SAME) * smallest:
            found.append(row.Index)
            smallest = row.error
    return found


def near(rows, factor):
    """Index of the rows that take at most `factor` times as long as the front at their error."""
    done = finished(rows)
    front = done.loc[pareto(rows)]
    return done.index[[row.time <= factor * front.time[(1 - SAME) * front.error <= row.error].min()
                       for row in done.itertuples()]]
