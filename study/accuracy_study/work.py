# Work and precision: error against time over the step, a curve for each implementation and setting.
import numpy

from analysis.accuracy.front import finished, near, pareto
from study.accuracy_study import brackets
from study.accuracy_study.bench import left_out, row, time_of
from study.accuracy_study.classes import ERRORS
from study.pipeline import runs

SLOW = 2.0   # whose default setting is this much slower than the fastest is not tried in others
FAR = 2.0    # a curve that is this far from the front, and comes no nearer, is not followed further
NEAR = 1.5   # runs up to this factor from the front are repeated, if they are
LONG = 1.0   # s: longer ones are averages themselves
PASSES = 3.0  # a step at most, where the next run is predicted
ROUNDS = 3


def measure(bench, subject, entries, tell, errors=None):
    """DataFrame of one subject's runs: work.csv. `errors`, m: those that are asked for, around which curves have closer
    steps, and below which they end; None: ERRORS of the N-four-bar, and curves do not end for that."""
    import pandas
    least = min(errors, default=0.0) if errors is not None else 0.0
    if errors is None:
        errors = ERRORS if subject.loops else ()
    table = pandas.concat([_family(bench, subject, family, errors, least, tell) for family in entries.families()],
                          ignore_index=True)
    table["front"] = table.index.isin(pareto(table))
    return table


def _family(bench, subject, entries, errors, least, tell):
    import pandas
    table = []
    for variant, settings in entries.settings.items():
        tell(f"{subject.name}: {variant}, {settings[0].name}")
        table += _curve(bench, subject, variant, settings[0], entries, table, least)
    slow = _slow(pandas.DataFrame(table), entries)
    for variant, settings in entries.settings.items():
        for setting in settings[1:]:
            tell(f"{subject.name}: {variant}, {setting.name}")
            if variant in slow:
                table.append(left_out(subject, variant, setting, numpy.nan, slow[variant]))
            else:
                table += _curve(bench, subject, variant, setting, entries, table, least)
    if errors:
        table += brackets.refine(bench, subject, entries, pandas.DataFrame(table), errors, tell)
    table = pandas.DataFrame(table)
    _repeat(bench, subject, entries, table, tell)
    return table


def _curve(bench, subject, variant, setting, entries, known, least):
    """The rows of a curve from the largest step on, until a run would take too long or smaller steps are of no
    use. `known`: rows of other curves; `least`: the least error that is asked for."""
    reason = entries.refused.get((variant, setting.name))
    if reason:
        return [left_out(subject, variant, setting, numpy.nan, reason)]
    rows, ahead = [], 0.0
    for step in subject.steps:
        reason = too_long(ahead, bench.time_limit) or of_no_use(rows, known, least)
        if reason:
            rows.append(left_out(subject, variant, setting, step, reason))
            continue
        contender = entries.contenders[variant]
        ahead = _half_step(subject, step, bench.run("work", subject, contender, setting, step))
        record = bench.steady("work", subject, contender, setting, step)
        rows.append(row(subject, variant, setting, step, record))
    return rows


def too_long(ahead, limit):
    """Why a run that is predicted to take `ahead` s is not made, or ""."""
    if ahead <= limit:
        return ""
    return (f"predicted to take {ahead:.1f} s, the limit is {limit:g} s" if numpy.isfinite(ahead) else
            "the run at twice the step did not end")


def of_no_use(rows, known, least=0.0):
    """Why a curve is not followed further: the last error is the `least` that is asked for or smaller, two halvings
    of the step in turn have not made the error smaller, or it is far from the front and no nearer than before."""
    made = [one for one in rows if one["rounds"]][-3:]
    if made and made[-1].get("error", numpy.inf) <= least:
        return f"the error is below {least:.2g} m, the least that is asked for"
    if len(made) < 3 or any("error" not in one for one in made):
        return ""
    errors = [one["error"] for one in made]
    if errors[0] <= errors[1] <= errors[2]:
        return "smaller steps do not make the error smaller"
    before, now = (one["time"] / min([other["time"] for other in [*known, *rows]
                                      if other.get("error", numpy.inf) <= one["error"]])
                   for one in made[1:])
    if now > FAR and now > 0.8 * before:
        return f"takes {now:.1f} times the front's time at its error, and comes no nearer"
    return ""


def _half_step(subject, step, record):
    """Predicted seconds of the run with half the step."""
    if runs.status(record)[0] == "timeout":
        return numpy.inf
    summary = record.get("summary", {})
    done = summary.get("steps", 0)  # fewer than all of a run that diverged
    if not done:
        return 0.0
    fewer = min(1.0, PASSES / summary["passes_per_step"])  # a step that is too long needs many passes
    return fewer * record["seconds"] / done * 2 * subject.duration / step


def _slow(table, entries):
    """{implementation: why its other settings are not tried}. Of dense and of sparse ones the fastest is
    spared, and the fastest of those that serve the most settings."""
    done = finished(table) if "time" in table else table[:0]
    found = {name: "its default setting finished no run" for name in table.implementation.unique()
             if name not in set(done.implementation)}
    if done.empty:
        return found
    times = done.pivot_table(index="step", columns="implementation", values="time")
    ratios = times.div(times.min(axis=1), axis=0).min().sort_values(kind="stable")
    spared = set()
    for dense in (True, False):
        kind = [name for name in ratios.index if entries.dense[name] == dense]
        most = max((len(entries.settings[name]) for name in kind), default=0)
        spared |= {*kind[:1], *[name for name in kind if len(entries.settings[name]) == most][:1]}
    return found | {name: f"its default setting takes at least {ratio:.1f} times the fastest's time"
                    for name, ratio in ratios.items() if ratio > SLOW and name not in spared}


def _repeat(bench, subject, entries, table, tell):
    """Medians of ROUNDS runs in place of the single times near the front."""
    if "time" not in table:
        table[["time", "error"]] = numpy.nan
    chosen = [index for index in near(table, NEAR)
              if table.time[index] * subject.duration <= LONG]
    times = {index: [table.time[index]] for index in chosen}
    for repeat in range(2, ROUNDS + 1):
        for place, index in enumerate(chosen, start=1):
            one = table.loc[index]
            tell(f"{subject.name}: round {repeat} near the front, {place} of {len(chosen)}")
            record = bench.run("work", subject, entries.contenders[one.implementation],
                               entries.setting(one.implementation, one.setting), one.step,
                               repeat=repeat, repeats=int(one["repeats"]))
            if runs.status(record)[0] in runs.FINISHED:
                times[index].append(time_of(record))
    for index, found in times.items():
        table.loc[index, ["time", "time_low", "time_high", "rounds"]] = [
            numpy.median(found), min(found), max(found), len(found)]
