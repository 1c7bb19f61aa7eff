# Distributions, what judging costs, what the search tried and what it came to, and the losses of null processes, from their records.
from collections import namedtuple

import pandas

from analysis.core.controls import CONTROL, repeated
from analysis.core.outcomes import FINISHED, of_run
from analysis.core.text import number

TIMES = ("mean", "median", "p99", "p999", "max")
END = "end of the search"
HOPELESS = 0.01  # share of the steps beyond the null process's losses: no interruption explains as many
LARGE, BOUNDS = 22, {True: 0.02, False: 0.04}  # variables; what judging may cost of a step from there on, and below

# Of a run; why it did not keep its deadline; whether another run of the same would not keep it either.
Verdict = namedtuple("Verdict", ("kept", "reason", "hopeless"))


def build(records, view):
    nulls = {one.options["after"]: one for one in records if one.role == "null"}  # by the run that each came after
    order = {name: place for place, name in enumerate(view.registry.variants)}
    key = lambda row: (row["scheme"], row["step"], order[row["implementation"]], row["loops"], row["run"])
    found = {role: pandas.DataFrame(sorted((_run(one, nulls.get(one.name)) for one in records if one.role == role), key=key))
             for role in ("steps", "search")}
    machine = [{"after": after, "step": float(f"{1e-6 * one.option('deadline-us'):g}"), "seconds": one.option("seconds"),
                "status": one.status, "reason": one.reason, "record": one.name} | {
               key: one.output.get(key) for key in ("readings", "lost", "largest_us")} for after, one in nulls.items()]
    judging, again = (_runs([one for one in records if one.role == role]) for role in ("judging", CONTROL))
    ended = [one[one.status.isin(FINISHED)].assign(status="ok") for one in (judging, again)]
    return {"steps": found["steps"].drop(columns=["null_missed", "kept", "reason_not"], errors="ignore"), "machine": pandas.DataFrame(machine),
            "judging": pandas.DataFrame(_judging(judging)), "controls": repeated(*ended, "mean_us"), "tried": found["search"],
            "largest": pandas.DataFrame(_largest(found["search"]))}


def _run(record, null):
    words, output, (status, reason) = record.options, record.output, of_run(record)
    row = {"implementation": record.cell["contenders"][0], "scheme": words["scheme"], "step": float(words["step"]),
           "loops": int(record.cell["scene"].partition(":")[2]), "run": record.cell["number"], "status": status, "reason": reason,
           "steps": output.get("steps"), "missed": missed(record), "judge_us": output.get("judge_us"), "record": record.name} | {
           f"{key}_us": (output.get("step_us") or {}).get(key) for key in TIMES}
    if status == "dropped":
        return row
    verdict = judge(record, null)
    return row | {"null_missed": None if null is None else lost(null), "kept": verdict.kept, "reason_not": verdict.reason}


def _runs(records):
    known = ("scene", "implementation", "process", "status", "reason", "variables", "mean_us", "judge_us", "record")
    return pandas.DataFrame([dict(zip(known, (
        one.cell["scene"], one.cell["contenders"][0], one.cell["number"], *of_run(one), one.output.get("variables"),
        (one.output.get("step_us") or {}).get("mean"), one.output.get("judge_us"), one.name))) for one in records], columns=known)


def _judging(runs):
    """A row a scene, of the implementation whose steps are fastest there: the middle one of its runs."""
    for scene, tried in runs.drop(columns="process").groupby("scene", sort=False):
        whole = tried[tried.status.isin(FINISHED)]
        if whole.empty:
            yield tried.iloc[0].to_dict() | {"mean_us": None, "judge_us": None}
            continue
        own = whole[whole.implementation == whole.groupby("implementation", sort=False).mean_us.median().idxmin()]
        row = own.loc[(own.judge_us / own.mean_us).sort_values().index[len(own) // 2]].to_dict()
        share, bound = row["judge_us"] / row["mean_us"], BOUNDS[row["variables"] >= LARGE]
        yield row | {"share": share, "bound": bound, "held": share <= bound, "record": " ".join(own.record)}


def _largest(tried):
    """One row a search: the largest size all of whose runs kept the deadline, and the next one tried that did not."""
    for key, runs in tried.groupby(["scheme", "step", "implementation"], sort=False) if len(tried) else ():
        made = runs[runs.status != "dropped"]
        every = made.groupby("loops").kept.all() if len(made) else pandas.Series(dtype=bool)
        good = None if made.empty else int(every.index[every].max()) if every.any() else 0
        above = [int(loops) for loops in every.index[~every] if loops > good]
        row = dict(zip(("scheme", "step", "implementation"), key)) | {
            "largest": good, "complete": len(made) == len(runs), "record": " ".join((made[made.loops == good] if good else made).record),
            "next_reason": runs[runs.status == "dropped"].reason.iloc[0] if len(made) < len(runs) else END}
        if good:
            last = made[made.loops == good].iloc[-1]
            row |= _observed(made[made.loops == good], "") | {"status": last.status, "reason": last.reason}
        if above:
            beyond = made[made.loops == min(above)]
            worst = beyond[~beyond.kept.astype(bool)].iloc[0]
            row |= _observed(beyond, "next_") | {"next": min(above), "next_status": worst.status, "next_reason": worst.reason_not}
        yield row


def _observed(runs, prefix):
    """Counts of each run of a size, "1300 and 1300", and the longest step of all."""
    return {f"{prefix}{name}": " and ".join(number(value, 6) for value in runs[name]) for name in ("steps", "missed", "null_missed")} | {
        f"{prefix}max_us": runs.max_us.max()}


def missed(record):
    """Steps that took longer than the deadline; None if there is no such count."""
    return (record.output.get("step_us") or {}).get("deadline_misses")


def lost(null):
    """Deadlines that a null process lost: 0 if there was none, or if it did not work."""
    return null.output["lost"] if null is not None and null.done else 0


def needs_null(record):
    """Whether a null process can matter: a run that is whole and missed nothing needs no excuse."""
    return of_run(record)[0] in FINISHED and missed(record) > 0


def judge(record, null):
    """The Verdict on a run. `null`: the record of the null process after it, or None."""
    status, reason = of_run(record)
    if status not in FINISHED:
        return Verdict(False, f"{status}: {reason}", True)
    beyond, steps = missed(record) - lost(null), record.output["steps"]
    if beyond <= 0:
        return Verdict(True, "", False)
    return Verdict(False, f"{missed(record)} of {steps} steps missed, {lost(null)} by the null process", beyond > HOPELESS * steps)
