# Work and precision: error against time over the step, a curve for each implementation and setting.
import numpy

from analysis.accuracy.front import finished, near, pareto
from study.accuracy_study.bench import left_out, row, time_of
from study.pipeline import runs

SLOW = 2.0   # whose default setting is this much slower than the fastest is not tried in others
NEAR = 1.5   # runs up to this factor from the front are repeated
ROUNDS = 3


def measure(bench, subject, entries, tell):
    """DataFrame of one subject's runs: work.csv."""
    import pandas
    table = []
    for variant, settings in entries.settings.items():
        tell(f"{subject.name}: {variant}, {settings[0].name}")
        table += _curve(bench, subject, variant, settings[0], entries)
    slow = _slow(pandas.DataFrame(table), entries)
    for variant, settings in entries.settings.items():
        for setting in settings[1:]:
            tell(f"{subject.name}: {variant}, {setting.name}")
            if variant in slow:
                table.append(left_out(subject, variant, setting, numpy.nan, slow[variant]))
            else:
                table += _curve(bench, subject, variant, setting, entries)
    table = pandas.DataFrame(table)
    _repeat(bench, subject, entries, table, tell)
    table["front"] = table.index.isin(pareto(table))
    return table


def _curve(bench, subject, variant, setting, entries):
    """The rows of a curve, from the largest step until a run would take too long, or rounding has won:
    two halvings of the step in turn have not made the error smaller."""
    reason = entries.refused.get((variant, setting.name))
    if reason:
        return [left_out(subject, variant, setting, numpy.nan, reason)]
    rows, ahead = [], 0.0
    for step in subject.steps:
        if _rounding(rows):
            rows.append(left_out(subject, variant, setting, step, "smaller steps do not make the error smaller"))
            continue
        if ahead > bench.time_limit:
            said = (f"predicted to take {ahead:.1f} s, the limit is {bench.time_limit:g} s"
                    if numpy.isfinite(ahead) else "the run at twice the step did not end")
            rows.append(left_out(subject, variant, setting, step, said))
            continue
        record = bench.run("work", subject, entries.contenders[variant], setting, step)
        rows.append(row(subject, variant, setting, step, record))
        ahead = _half_step(subject, step, record)
    return rows


def _rounding(rows):
    """Whether the last three runs that were made have finished with errors that do not fall."""
    errors = [row.get("error", numpy.nan) for row in rows if row["rounds"]][-3:]
    return len(errors) == 3 and errors[0] <= errors[1] <= errors[2]


def _half_step(subject, step, record):
    """Predicted seconds of the run with half the step."""
    if runs.status(record)[0] == "timeout":
        return numpy.inf
    done = record.get("summary", {}).get("steps", 0)  # fewer than all of a run that diverged
    return record["seconds"] / done * 2 * subject.duration / step if done else 0.0


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
    chosen = near(table, NEAR)
    times = {index: [table.time[index]] for index in chosen}
    for repeat in range(2, ROUNDS + 1):
        for place, index in enumerate(chosen, start=1):
            one = table.loc[index]
            tell(f"{subject.name}: round {repeat} near the front, {place} of {len(chosen)}")
            record = bench.run("work", subject, entries.contenders[one.implementation],
                               entries.setting(one.implementation, one.setting), one.step,
                               repeat=repeat)
            if runs.status(record)[0] in runs.FINISHED:
                times[index].append(time_of(record))
    for index, found in times.items():
        table.loc[index, ["time", "time_low", "time_high", "rounds"]] = [
            numpy.median(found), min(found), max(found), len(found)]
