# Times at equal error: each engine's fastest run that meets an error, and ours at that run's error or a smaller one.
#
# Runs that were not timed alone choose the candidates; the common rounds have the times that are compared.
from analysis.core import timing
from analysis.core.outcomes import finished
from analysis.engines.runs import NATIVE

LIMITS = tuple(10.0**-power for power in range(1, 13))  # well above FLOOR, where noise would decide who meets one
PAPER = ("penalty", "penalty, penalty 1e8")  # settings that are the paper's scheme
CHAINS, FRONTS = "compiled_chains/sweeps", "compiled_ldl/fronts"
SIDES = {"chains": "our code for chains", "fronts": "our general code", "library": "the fastest library", "paper": "the scheme of 2008"}
ABOUT = {"chains": CHAINS, "fronts": FRONTS, "library": "any variant on a library",
         "paper": "any variant, in the penalty form with the automatic penalty factor or the paper's, all else as in the paper's step"}
NOT_MEASURED, UNSERVED, UNREACHED = "not measured", "not served", "not reached"  # what reasons begin with
NEAR = 1.3   # untimed times are this uncertain
MOST = 2     # candidates of a side for one run of an engine


def of_side(ours, side, own):
    """Rows of ours that belong to a side. `own`: names of the variants that stand on no library."""
    if side == "paper":
        return ours[ours.setting.isin(PAPER)]
    if side == "library":
        return ours[~ours.name.isin(own)]
    return ours[ours.name == {"chains": CHAINS, "fronts": FRONTS}[side]]


def compared(table, side):
    """Comparisons of engines as they are packaged with a side of ours."""
    return table[(table.side == side) & table.ratio.notna() & ~table.engine.str.endswith(NATIVE)]


def lacking(rows):
    """["1 of 5 errors not reached"]: why comparisons have no ratio, and how many."""
    reasons = rows.reason[rows.ratio.isna()].str.replace(":.*", "", regex=True)
    return [f"{count} of {len(rows)} errors {why}" for why, count in reasons.value_counts().items()]


def candidates(engines, ours, own):
    """Rows, of one subject, that may be the fastest of theirs at some error, and those of ours that may be at these."""
    theirs, sides = _candidates(engines), [finished(of_side(ours, side, own)) for side in SIDES]
    mine = {place for error in engines.error[theirs] for done in sides for place in _near(done[done.error <= error])}
    return engines.loc[theirs], ours.loc[sorted(mine)]


def least_error(engines):
    """The smallest error of a candidate of theirs: ours needs no smaller one. 0 without any."""
    return min(engines.error[_candidates(engines)], default=0.0)


def _candidates(engines):
    done = finished(engines)
    native = done.name.str.endswith(NATIVE)  # runs of those that were chosen already
    near = [_near(rows[rows.error <= limit]) for _, rows in done[~native].groupby("name") for limit in LIMITS]
    return sorted(set(done.index[native]).union(*near))


def _near(rows):
    """Index of the fastest rows, at most MOST."""
    return rows[rows.time <= NEAR * rows.time.min()].nsmallest(MOST, "time").index


def table(engines, ours, rounds, own):
    """A row for each subject, engine, error that it reaches, and side of ours. `ratio`: the engine's time over ours;
    empty, with the reason, where ours does not reach the error."""
    for subject, theirs in engines.groupby("subject", sort=False):
        timed = samples(rounds[rounds.subject == subject])
        mine, paired = ours[ours.subject == subject], timing.Paired(timed)
        sides = {side: (every, _timed(every, timed)) for side in SIDES for every in [of_side(mine, side, own)]}
        for name, of_engine in _timed(theirs, timed).groupby("name", sort=False):
            reached = {one.key: one for one in (_fastest(of_engine, limit) for limit in LIMITS) if one is not None}
            for best in reached.values():  # who is the fastest for several limits is there once, with the smallest that it meets
                limit = min(limit for limit in LIMITS if best.error <= limit)
                for side, (every, compared) in sides.items():
                    yield _row(subject, name, limit, best, side, _fastest(compared, best.error), every, paired)


def native(engines, rounds):
    """A row for each run of an engine that was timed both ways: Debian's build over that with our flags."""
    for subject, theirs in engines.groupby("subject", sort=False):
        timed = samples(rounds[rounds.subject == subject])
        done, paired = _timed(theirs, timed), timing.Paired(timed)
        for row in done[done.name.str.endswith(NATIVE)].to_dict("records"):
            ratio = timing.ratio(paired, row["key"].replace(NATIVE, ""), row["key"])
            if ratio.value == ratio.value:
                yield {name: row[name] for name in ("subject", "setting", "over", "value", "record")} | {
                    "engine": row["name"].removesuffix(NATIVE), "native_time": row["time"]} | ratio.columns()


def samples(rounds):
    """Rows as analysis/core/timing.py has them, a process a round. Who failed in one round has failed."""
    rows = rounds.assign(scene=rounds.subject, implementation=rounds.key, process=rounds["round"], error=0.0)
    done = finished(rows)
    failed = rows.implementation[~rows.index.isin(done.index) & (rows.status != "dropped")]
    return timing.apart(done[~done.implementation.isin(failed)].assign(status="ok"), "time")


def _timed(rows, timed):
    """Finished rows that were timed in the rounds, with the median of these times."""
    times = rows.key.map(timed.groupby("implementation").time.median()).astype(float)
    return finished(rows.assign(time=times.where(rows.time.notna())))


def _fastest(rows, error):
    meeting = rows[rows.error <= error]
    return None if meeting.empty else meeting.loc[meeting.time.idxmin()]


def _row(subject, engine, limit, best, side, mine, every, paired):
    found = {"subject": subject, "engine": engine, "limit": limit, "side": side, "engine_setting": best.setting,
             "over": best.over, "engine_value": best.value, "engine_status": best.status, "engine_error": best.error,
             "engine_time": best.time, "record": best.record, "reason": ""}
    if mine is None:
        return found | {"reason": unreached(every, best.error)}
    return found | timing.ratio(paired, best.key, mine.key).columns() | {
        "implementation": mine["name"], "setting": mine.setting, "step": mine.value, "error": mine.error, "time": mine.time,
        "record": f"{best.record} {mine.record}"}


def unreached(rows, error):
    """Why no run of a side meets `error`: a word of those above and, after a colon, more. A curve that the budget cut might have met it."""
    if rows.empty:
        return "none of it takes part"
    curves = rows.name + rows.setting
    rows = rows[~curves.isin(curves[rows.status == "unsupported"])]
    done, cut = finished(rows), (rows.status == "dropped").sum()
    least = f"its smallest error is {done.error.min():.2g} m" if len(done) else "it lost the motion" if cut < len(rows) else "no run was made"
    if rows.empty:
        return f"{UNSERVED}: no setting of it can simulate this"
    if (done.error <= error).any():
        return f"{NOT_MEASURED}: not timed in the rounds"
    return f"{NOT_MEASURED}: the budget cut {cut} of its curves, {least}" if cut else f"{UNREACHED}: {least}"
