# Two settings of one implementation side by side, in the same rounds at the same step: the form of the step
# (forms.csv) and the precision of its numbers (precision.csv).
import random

import numpy

from analysis.statistics import ratio_interval
from study.accuracy_study import subjects
from study.accuracy_study.bench import row
from study.accuracy_study.regions import ERRORS

STEP = 1.25e-3
ROUNDS, SEED = 7, 20080101
DURATIONS = (1.0, 0.2, 0.05, 0.0125)  # s; 1 s crosses the first singular position
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
             "step": STEP}
    refused = [entries.refused[variant, one.name] for one in both
               if (variant, one.name) in entries.refused]
    if refused:
        return found | {"reason": refused[0]}
    duration, reason = _duration(bench, subject, entries.contenders[variant], kind, both)
    if reason:
        return found | {"reason": reason}
    rows = {one.name: [] for one in both}
    for number in range(1, ROUNDS + 1):
        for one in random.Random(f"{SEED}:{number}").sample(both, 2):
            record = bench.run(f"{kind}/{duration:g}s", subject, entries.contenders[variant], one,
                               STEP, duration=duration, repeat=number)
            rows[one.name].append(row(subject, variant, one, STEP, record))
    samples = [{number: numpy.array([one.get("step_us", numpy.nan)]) for number, one in
                enumerate(rows[setting.name])} for setting in both]
    ratio, low, high = ratio_interval(*samples)
    found |= {"duration": duration, "rounds": ROUNDS, "ratio": ratio, "low": low, "high": high,
              "reason": ""}
    for place, setting in zip(("first", "second"), both):
        mine = rows[setting.name]
        found |= {f"{place}_{column}": mine[0].get(column) for column in (
            "status", "passes_per_step", "error", "raw_file", "command")}
        found |= {f"{place}_step_us": float(numpy.median([
            one.get("step_us", numpy.nan) for one in mine])),
            f"{place}_class": error_class(mine[0].get("error"))}
    return found


def _duration(bench, subject, contender, kind, both):
    """(the longest of DURATIONS that both finish soon enough, "") by a few steps, or (None, why not)."""
    slowest = 0.0
    for one in both:
        record = bench.run(f"{kind}/pilots", subject, contender, one, STEP,
                           duration=PILOT_STEPS * STEP, seconds=PILOT_SECONDS)
        if "summary" not in record:
            return None, f"{one.name}: {record['failure']['reason']} for {PILOT_STEPS} steps"
        slowest = max(slowest, 1e-6 * record["summary"]["step_us"]["median"] / STEP)
    least = DURATIONS[-1] * slowest
    if least > bench.time_limit / 2:
        return None, f"{DURATIONS[-1]:g} s would take {least:.1f} s, {2 * ROUNDS} times"
    return next((one for one in DURATIONS if one * slowest <= RUN_SECONDS), DURATIONS[-1]), ""


def error_class(error):
    """The smallest of the required errors that `error` meets; None without one."""
    return min((limit for limit in ERRORS if error is not None and error <= limit), default=None)
