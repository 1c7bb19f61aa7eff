# Two settings of one implementation side by side, in the same rounds at the same step: the form of the step
# (forms.csv) and the precision of its numbers (precision.csv). Times may be those of a short stretch, error classes
# are those of a second.
import random

import numpy

from analysis.statistics import ratio_interval
from study.accuracy_study import classes, subjects
from study.accuracy_study.bench import REPEATS, SHORT, row
from study.pipeline import runs

STEP = 1.25e-3
ROUNDS, SEED = 7, 20080101
DURATIONS = (1.0, 0.2, 0.05, 0.0125)  # s, of the timing; 1 s crosses the first singular position
RUN_SECONDS, PILOT_STEPS, PILOT_SECONDS = 0.5, 8, 10.0
FORMS = (("default", "saddle"),)
PRECISIONS = (("default", "mixed"), ("default", "single"), ("saddle", "saddle mixed"))
FORM_LOOPS, PRECISION_LOOPS = (10, 40, 200, 1000), (10, 40, 200, 500)


def measure(bench, entries, kind, pairs, loops, tell):
    """DataFrame with a row for each pair, implementation and size: columns first_… and second_…"""
    import pandas
    table = []
    for count in loops:
        subject = subjects.chain(count, max(DURATIONS))
        for first, second in pairs:
            for variant, settings in entries.settings.items():
                both = [one for name in (first, second) for one in settings if one.name == name]
                if len(both) == 2:
                    tell(f"{kind}: {subject.name}, {variant}, {second}")
                    table.append(_pair(bench, subject, entries, kind, variant, both))
    return pandas.DataFrame(table)


def _pair(bench, subject, entries, kind, variant, both):
    found = {"loops": subject.loops, "variables": 2 * subject.loops + 2, "implementation": variant,
             "dense": entries.dense[variant], "first": both[0].name, "second": both[1].name,
             "step": STEP, "ratio": numpy.nan}
    refused = [entries.refused[variant, one.name] for one in both
               if (variant, one.name) in entries.refused]
    if refused:
        return found | {"reason": refused[0]}
    duration, slowest, reason = _duration(bench, subject, entries.contenders[variant], kind, both)
    if reason:
        return found | {"reason": reason}
    judged = [classes.judged(bench, entries.contenders[variant], one, subject.loops, STEP, slowest)
              for one in both]
    reason = next((f"{one.name}: {why}" for one, (whole, why) in zip(both, judged) if whole and why), "")
    if reason:
        return found | {"reason": reason}
    rows = _rounds(bench, subject, entries, kind, variant, both, duration,
                   REPEATS if slowest * duration < SHORT else 1)
    reason = next((f"{setting.name}: {classes.lost(one)}" for setting in both for one in rows[setting.name]
                   if one["status"] not in runs.FINISHED), "")
    found |= {"duration": duration, "rounds": ROUNDS, "reason": reason}
    if not reason:
        samples = [{number: numpy.array([one["step_us"]]) for number, one in enumerate(rows[setting.name])}
                   for setting in both]
        found |= dict(zip(("ratio", "low", "high"), ratio_interval(*samples)))
    for place, setting, (whole, why) in zip(("first", "second"), both, judged):
        found |= {f"{place}_{name}": value for name, value in _half(rows[setting.name], whole, why).items()}
    return found


def _rounds(bench, subject, entries, kind, variant, both, duration, repeats):
    """{name of the setting: rows}, a row a round."""
    rows = {one.name: [] for one in both}
    for number in range(1, ROUNDS + 1):
        for one in random.Random(f"{SEED}:{number}").sample(both, 2):
            record = bench.run(f"{kind}/{duration:g}s", subject, entries.contenders[variant], one,
                               STEP, duration=duration, repeat=number, repeats=repeats)
            rows[one.name].append(row(subject, variant, one, STEP, record))
    return rows


def _half(rows, whole, why):
    """Columns of one setting of a pair; `whole`: its row over a second, or None and `why`."""
    found = {column: rows[0].get(column) for column in ("status", "passes_per_step", "raw_file", "command")}
    found |= {"step_us": float(numpy.median([one.get("step_us", numpy.nan) for one in rows])),
              "class_reason": why}
    error = whole["error"] if whole else None
    return found | {"error": error, "class": classes.error_class(error),
                    "error_raw_file": whole["raw_file"] if whole else None}


def _duration(bench, subject, contender, kind, both):
    """(the longest of DURATIONS that both finish soon enough, s of computation for a simulated second, "") by a
    few steps, or (None, None, why not)."""
    slowest = 0.0
    for one in both:
        record = bench.run(f"{kind}/pilots", subject, contender, one, STEP,
                           duration=PILOT_STEPS * STEP, seconds=PILOT_SECONDS)
        if "summary" not in record:
            return None, None, f"{one.name}: {record['failure']['reason']} for {PILOT_STEPS} steps"
        slowest = max(slowest, 1e-6 * record["summary"]["step_us"]["median"] / STEP)
    least = DURATIONS[-1] * slowest
    if least > bench.time_limit / 2:
        return None, None, f"{DURATIONS[-1]:g} s would take {least:.1f} s, {2 * ROUNDS} times"
    duration = next((one for one in DURATIONS if one * slowest <= RUN_SECONDS), DURATIONS[-1])
    return duration, slowest, ""

