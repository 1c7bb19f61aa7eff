# Rounds of the candidates of a region in an order shuffled anew each time: one of all, two more of those near the
# fastest, four more of the two best of each required error, which then have intervals.
#
# Times may be those of a short stretch, error classes not: without a curve of its own over seconds, a candidate's
# run of a second at natural fill must meet the error.
import random

import numpy
import pandas

from analysis.accuracy.winners import leaders
from study.accuracy_study import classes
from study.accuracy_study.bench import REPEATS, SHORT, row

FEW, BEST, SEED = 3, 7, 20080101
NEAR = 1.3                    # times the fastest of the first round: who is slower has no second
DURATIONS = (1.0, 0.2, 0.05)  # s, or that of the curves
RUN_SECONDS = 0.25            # the longest duration that is predicted to take less is taken


def measure(bench, subject, entries, cells, tell):
    """Adds times, status and raw files to those of `cells` (of one size and fill) that are not pruned."""
    left = [cell for cell in cells if not cell["reason"]]
    for cell in left:
        predicted = [c["predicted"] for c in left if c["required"] == cell["required"]]
        cell["duration"] = _duration(subject.duration, predicted)
        cell["repeats"] = REPEATS if min(predicted) * cell["duration"] < SHORT else 1
    for cell in left:
        _judge(bench, subject, entries, cell)
    left = [cell for cell in left if not cell["reason"]]
    errors = sorted({cell["required"] for cell in left})
    _round(bench, subject, entries, left, 1, tell)
    near = [cell for error in errors for cell in _near([one for one in left if one["required"] == error])]
    for number in range(2, FEW + 1):
        _round(bench, subject, entries, near, number, tell)
    errors = sorted({cell["required"] for cell in near})
    best = [near[place] for error in errors for place in leaders(_table(near, error))]
    for number in range(FEW + 1, BEST + 1):
        _round(bench, subject, entries, best, number, tell)
    for cell in left:
        found = cell["times"]
        cell |= {"time": numpy.median(found), "time_low": min(found), "time_high": max(found),
                 "rounds": len(found), "times": " ".join(f"{time:.6g}" for time in found)}


def _duration(known, predicted):
    """The longest duration that the slowest of a cell is predicted to finish soon enough; errors are known up
    to `known`."""
    allowed = [known, *(one for one in DURATIONS if one < known)]
    return next((one for one in allowed if one * max(predicted) <= RUN_SECONDS), allowed[-1])


def _judge(bench, subject, entries, cell):
    """Where the error is another variant's and the timed run is too short to judge its own: "reason" if a run
    that is long enough does not meet it."""
    cell["class_from"] = f"{subject.duration:g} s"
    if cell["error_of"] == cell["implementation"]:
        return
    cell["class_from"] = "the timed run"
    if cell["duration"] >= classes.DURATION:
        return
    variant = cell["implementation"]
    found, why = classes.judged(bench, entries.contenders[variant], entries.setting(variant, cell["setting"]),
                                subject.loops, cell["step"], cell["predicted"])
    cell["class_from"] = f"{classes.DURATION:g} s"
    if why:
        cell["reason"] = f"over {classes.DURATION:g} s: {why}" if found else f"error class not known: {why}"
        return
    cell |= {"error": found["error"], "error_of": variant, "error_raw_file": found["raw_file"]}
    if found["error"] > cell["required"]:
        cell["reason"] = f"its own error over {classes.DURATION:g} s is {found['error']:.2g} m"


def _near(cells):
    """Of one required error: those near the fastest, and the fastest of another implementation."""
    meeting = [cell for cell in cells if cell["measured_error"] <= cell["required"]]
    order = sorted(meeting, key=lambda cell: cell["times"][0])
    others = [cell for cell in order if _folder(cell) != _folder(order[0])]
    return [cell for cell in order if cell is next(iter(others), None) or cell["times"][0] <= NEAR * order[0]["times"][0]]


def _folder(cell):
    return cell["implementation"].partition("/")[0]


def _round(bench, subject, entries, cells, number, tell):
    shared = {}  # one measurement serves all required errors that the same step meets
    for cell in cells:
        key = cell["implementation"], cell["setting"], cell["step"], cell["duration"], cell["repeats"]
        shared.setdefault(key, []).append(cell)
    order = random.Random(f"{SEED}:{subject.name}:{number}").sample(list(shared), len(shared))
    for place, key in enumerate(order, start=1):
        variant, name, step, duration, repeats = key
        tell(f"{subject.name}: round {number}, {place} of {len(order)}")
        setting = entries.setting(variant, name)
        record = bench.run(f"regions/{duration:g}s", subject, entries.contenders[variant], setting, step,
                           duration=duration, repeat=number, repeats=repeats)
        found = row(subject, variant, setting, step, record)
        for cell in shared[key]:
            cell |= {column: found.get(column) for column in (
                "status", "status_reason", "fill", "raw_file", "command")}
            cell |= {"measured_error": found.get("error", numpy.nan),
                     "times": [*cell.get("times", ()), found.get("time", numpy.nan)]}


def _table(cells, error):
    """The cells of a required error as rows with the medians so far; their places in `cells` are the index."""
    return pandas.DataFrame([cell | {"time": numpy.median(cell["times"])} if cell["required"] == error else {
        "required": numpy.nan, "time": numpy.nan, "status": "", "measured_error": numpy.nan,
        "implementation": ""} for cell in cells])
