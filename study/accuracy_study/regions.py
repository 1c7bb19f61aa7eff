# The third axis: who meets a required accuracy in the least time, over size and fill of the tangent matrix.
#
# Artificial fill is stored zeros: motion and error are those of the natural fill (fills.py checks it). So the
# curves at natural fill tell the largest step that meets each accuracy (largest.py), and only its time is measured
# at each fill: first a few steps of everyone (the pilot), then rounds of those near the fastest (rounds.py).
import numpy

from analysis.accuracy.front import FINISHED
from study.accuracy_study import rounds, subjects
from study.accuracy_study.classes import ERRORS
from study.accuracy_study.largest import largest_steps
from study.pipeline import runs

LOOPS = (2, 10, 24, 40, 79, 200)
FILLS = (0.3, 0.6, 1.0)      # beside the mechanism's own
PILOT_STEPS, PILOT_SECONDS = 12, 3.0
SLOW, CLOSE = 4.0, 2.0       # pruned by the default setting's pilot; by the candidate's own


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
            rounds.measure(bench, subject, entries, cells, tell)
            table += cells
    return pandas.DataFrame(table)


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
        status, reason = runs.status(record)
        speeds[variant, name] = (
            (1e-6 * record["summary"]["step_us"]["median"], "") if status in FINISHED else
            (numpy.inf, f"pruned: its pilot is {status}: {reason}"))
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
