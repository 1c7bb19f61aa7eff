# Times at equal error: each engine's fastest run that meets an error, and ours at that run's error or a smaller one.
#
# engines.csv and work.csv hold single runs, which choose the candidates; rounds.csv holds the times that are compared.
import numpy
import pandas

from analysis.accuracy.front import finished
from analysis.statistics import median, ratio_interval

LIMITS = tuple(10.0**-power for power in range(1, 13))
PAPER = ("default", "paper")  # settings of study/settings.yaml that are the paper's scheme
SCOPES = {"all": None, "paper": PAPER}
NEAR = 1.3   # single times are this uncertain
MOST = 3     # candidates of ours for one run of an engine
ENGINE, OURS = "engine", "ours"


def of_scope(ours, scope):
    return ours if SCOPES[scope] is None else ours[ours.setting.isin(SCOPES[scope])]


def candidates(engines, ours):
    """(index of engines' rows, index of ours) of one subject that may be the fastest at some error."""
    theirs, mine = _candidates(engines), set()
    for error in engines.loc[theirs].error:
        for scope in SCOPES:
            done = finished(of_scope(ours, scope))
            mine |= set(_near(done[done.error <= error]))
    return theirs, sorted(mine)


def errors_of(engines):
    """Of the runs of one subject that may be an engine's fastest at some error, the largest first."""
    return sorted(set(engines.loc[_candidates(engines)].error), reverse=True)


def _candidates(engines):
    found = set()
    for _, rows in finished(engines).groupby("engine"):
        for limit in LIMITS:
            found |= set(_near(rows[rows.error <= limit]))
    return sorted(found)


def _near(rows):
    """Index of the fastest rows, at most MOST."""
    if rows.empty:
        return []
    rows = rows[rows.time <= NEAR * rows.time.min()].sort_values("time", kind="stable")
    return list(rows.index[:MOST])


def table(engines, ours, rounds):
    """DataFrame, a row for each subject, engine, error that it reaches, and scope of ours. `ratio`: the engine's time
    over ours; empty where ours does not reach the error."""
    samples = _samples(rounds)
    rows = []
    for subject, theirs in engines.groupby("subject", sort=False):
        mine = _timed(ours[ours.subject == subject], OURS, samples)
        for engine, of_engine in _timed(theirs, ENGINE, samples).groupby("engine", sort=False):
            for limit, best in _reached(of_engine):
                for scope in SCOPES:
                    rows.append(_row(subject, engine, limit, best, scope,
                                     _fastest(of_scope(mine, scope), best.error), samples))
    return pandas.DataFrame(rows, columns=COLUMNS)


def _samples(rounds):
    """{key of a run: {round: array of its time}}"""
    found = {}
    for row in rounds.itertuples():
        if numpy.isfinite(row.time):
            found.setdefault((row.subject, row.side, row.name, row.setting, f"{row.value:g}"), {})[
                row.round] = numpy.array([row.time])
    return found


def key(side, row):
    """Of a row of engines.csv or work.csv, what identifies its run in rounds.csv."""
    name, value = (row.engine, row.value) if side == ENGINE else (row.implementation, row.step)
    return row.subject, side, name, row.setting, f"{value:g}"


def _timed(rows, side, samples):
    """Finished rows that were timed in the rounds, with the median of these times."""
    done = finished(rows)
    keys = [key(side, row) for row in done.itertuples()]
    done = done.assign(key=pandas.Series(keys, index=done.index, dtype=object))
    done = done[[one in samples for one in keys]]
    return done.assign(time=[median(numpy.concatenate(list(samples[one].values()))) for one in done.key])


def _reached(rows):
    """(limit, the fastest row that meets it); a row that is the fastest for several is given once, with the smallest
    limit that it meets."""
    last = None
    for limit in LIMITS:
        best = _fastest(rows, limit)
        if best is None:
            return
        if last is None or best.key != last:
            yield min(one for one in LIMITS if best.error <= one), best
        last = best.key


def _fastest(rows, error):
    meeting = rows[rows.error <= error]
    return None if meeting.empty else meeting.loc[meeting.time.idxmin()]


COLUMNS = ("subject", "engine", "limit", "scope", "engine_setting", "over", "engine_value", "engine_status",
           "engine_error", "engine_time", "implementation", "setting", "step", "error", "time", "ratio", "low",
           "high", "engine_raw_file", "engine_command", "raw_file", "command")


def _row(subject, engine, limit, best, scope, mine, samples):
    found = {"subject": subject, "engine": engine, "limit": limit, "scope": scope,
             "engine_setting": best.setting, "over": best.over, "engine_value": best.value,
             "engine_status": best.status, "engine_error": best.error, "engine_time": best.time,
             "engine_raw_file": best.raw_file, "engine_command": best.command}
    if mine is None:
        return found
    ratio, low, high = ratio_interval(samples[best.key], samples[mine.key])
    return found | {"ratio": ratio, "low": low, "high": high} | {
        column: mine[column] for column in ("implementation", "setting", "step", "error", "time", "raw_file",
                                            "command")}
