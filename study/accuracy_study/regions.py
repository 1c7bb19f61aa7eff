# The third axis: who meets a required accuracy in the least time, over size and fill of the tangent matrix.
#
# Artificial fill is stored zeros: motion and error are those of the natural fill (fills.py checks it). So the
# curves at natural fill tell the largest step that meets each accuracy, and only its time is measured at each
# fill: first a few steps of everyone (the pilot), then rounds of those that the pilot finds near the fastest.
import random

import numpy

from analysis.accuracy.front import FINISHED
from study.accuracy_study import subjects
from study.accuracy_study.bench import row
from study.pipeline import runs

LOOPS = (2, 10, 24, 40, 79, 200)
FILLS = (0.3, 0.6, 1.0)      # beside the mechanism's own
ERRORS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-6)  # m
ROUNDS, SEED = 3, 20080101
PILOT_STEPS, PILOT_SECONDS = 12, 3.0
SLOW, CLOSE = 4.0, 2.0       # pruned by the default setting's pilot; by the candidate's own
DURATIONS = (1.0, 0.2, 0.05)  # s, or that of the curves; the first singular position is at 0.7 s
RUN_SECONDS = 0.25           # the longest duration that is predicted to take less is taken


def measure(bench, curves, entries, loops, tell):
    """DataFrame: regions.csv. `curves`: work.csv of these sizes."""
    import pandas
    table = []
    for count in loops:
        rows = curves[(curves.loops == count) & (curves["rounds"] > 0)]
        if not rows.status.isin(FINISHED).any():
            continue
        steps, natural = largest_steps(rows, entries), rows.fill.dropna().iloc[0]
        for fill in (None, *(fill for fill in FILLS if fill > natural + 0.02)):
            subject = subjects.chain(count, rows.duration.max(), fill)
            tell(f"{subject.name}: pilots")
            cells = _candidates(steps, _pilots(bench, subject, entries, steps))
            for cell in cells:
                cell |= {"loops": count, "fill_asked": fill, "natural_fill": natural}
            _rounds(bench, subject, entries, cells, tell)
            table += cells
    return pandas.DataFrame(table)


def largest_steps(rows, entries):
    """{(variant, setting): {required error: the row of the largest step that meets it}}. Where a curve of a
    slow implementation was not followed so far, it has the row of the variant that needs the smallest step
    in the same setting: they have agreed, and differ in rounding only."""
    curves = dict(list(rows.groupby(["implementation", "setting"])))
    found = {}
    for variant, setting in entries.admitted():
        own = curves.get((variant, setting.name))
        others = [curve for key, curve in curves.items() if key[1] == setting.name and curve is not own]
        for error in ERRORS:
            chosen = _largest(own, error) if own is not None else None
            if chosen is None:
                smallest = numpy.inf if own is None else own.step.min()
                borrowed = (_largest(curve[curve.step < smallest], error) for curve in others)
                chosen = min((one for one in borrowed if one is not None), key=lambda one: one.step,
                             default=None)
            if chosen is not None:
                found.setdefault((variant, setting.name), {})[error] = chosen
    return found


def _largest(curve, error):
    """The row of the largest step of a curve that meets `error`, or None."""
    meeting = curve[curve.status.isin(FINISHED) & (curve.error <= error)]
    return None if meeting.empty else meeting.loc[meeting.step.idxmax()]


def _pilots(bench, subject, entries, steps):
    """{(variant, setting): (s a step, why it is pruned)}: default settings first."""
    first = {variant: settings[0].name for variant, settings in entries.settings.items()}
    speeds = {}
    for variant, name in sorted(steps, key=lambda key: key[1] != first[key[0]]):
        fastest = min((speeds[key][0] for key in first.items() if key in speeds), default=numpy.inf)
        usual = speeds.get((variant, first[variant]), (0.0, ""))[0]
        if name != first[variant] and usual > SLOW * fastest:
            speeds[variant, name] = numpy.inf, (
                f"pruned: a step of its default setting takes {usual / fastest:.1f} times the fastest's"
                if numpy.isfinite(usual) else "pruned: the pilot of its default setting did not end")
            continue
        step = next(iter(steps[variant, name].values())).step
        record = bench.run("pilots", subject, entries.contenders[variant],
                           entries.setting(variant, name), step, duration=PILOT_STEPS * step,
                           seconds=PILOT_SECONDS)
        speeds[variant, name] = (
            (1e-6 * record["summary"]["step_us"]["median"], "") if "summary" in record else
            (numpy.inf, f"pruned: its pilot {runs.status(record)[1]}"))
    return speeds


def _candidates(steps, speeds):
    """A dictionary, to become a row, for each candidate and required error; "reason": why it is pruned."""
    cells = []
    for key, by_error in steps.items():
        speed, reason = speeds[key]
        for error, source in by_error.items():
            # The same motion needs the same passes: its mean step is dearer than the median by as much.
            mean = speed * source.step_us / source.step_us_median
            cells.append({"required": error, "implementation": key[0], "setting": key[1],
                          "step": source.step, "error": source.error,
                          "error_of": source.implementation, "error_raw_file": source.raw_file,
                          "predicted": mean / source.step, "reason": reason})
    for error in ERRORS:
        mine = [cell for cell in cells if cell["required"] == error]
        best = min((cell["predicted"] for cell in mine), default=numpy.inf)
        for cell in mine:
            if not cell["reason"] and cell["predicted"] > CLOSE * best:
                cell["reason"] = (f"pruned: predicted {cell['predicted'] / best:.1f} times slower than "
                                  "the fastest")
    return cells


def _rounds(bench, subject, entries, cells, tell):
    """Measures who is left in interleaved rounds: adds times, status and raw files to `cells`."""
    left = [cell for cell in cells if not cell["reason"]]
    for cell in left:
        cell["duration"] = _duration(subject.duration, [
            c["predicted"] for c in left if c["required"] == cell["required"]])
    shared = {}  # one measurement serves all required errors that the same step meets
    for cell in left:
        key = cell["implementation"], cell["setting"], cell["step"], cell["duration"]
        shared.setdefault(key, []).append(cell)
    times = {key: [] for key in shared}
    for number in range(1, ROUNDS + 1):
        order = random.Random(f"{SEED}:{subject.name}:{number}").sample(list(shared), len(shared))
        for place, (variant, name, step, duration) in enumerate(order, start=1):
            tell(f"{subject.name}: round {number}, {place} of {len(order)}")
            setting = entries.setting(variant, name)
            record = bench.run(f"regions/{duration:g}s", subject, entries.contenders[variant],
                               setting, step, duration=duration, repeat=number)
            found = row(subject, variant, setting, step, record)
            times[variant, name, step, duration].append(found.get("time", numpy.nan))
            for cell in shared[variant, name, step, duration]:
                cell |= {column: found.get(column) for column in (
                    "status", "status_reason", "fill", "raw_file", "command")}
                cell["measured_error"] = found.get("error")
    for key, found in times.items():
        for cell in shared[key]:
            cell |= {"time": numpy.median(found), "time_low": min(found), "time_high": max(found),
                     "rounds": len(found)}


def _duration(known, predicted):
    """The longest duration that the slowest of a cell is predicted to finish soon enough; errors are known up
    to `known`."""
    allowed = [known, *(one for one in DURATIONS if one < known)]
    return next((one for one in allowed if one * max(predicted) <= RUN_SECONDS), allowed[-1])
