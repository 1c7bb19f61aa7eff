# The growth of roundoff: how far implementations are from the long-double reference of the same settings.
import numpy
import pandas

from analysis.core.outcomes import of_run
from analysis.extremes import judge
from analysis.extremes.motions import Chain, singular_times

STEP, DURATION, EVERY = 1.25e-3, 20.0, 40
POINTS = 2
INSTANTS = (1.0, 5.0, 20.0)  # s, of the table
DRAWN = 4                    # one of so many instants is drawn
FORMS = ("penalty", "saddle-point")
NEAR = 0.1                   # s on either side of a singular position
FLOOR = 1e-17                # m; differences below it are none


def build(records, registry):
    """{"roundoff": a row a run, "growth": its difference over time}"""
    references = {_key(record): record for record in records if record.cell["program"] == "mbs_reference"}
    order = list(registry.variants)
    own = [record for record in records if record.cell["program"] == "mbs"]
    own.sort(key=lambda record: (_key(record), order.index(record.cell["contenders"][0])))
    rows, lines = [], []
    for record in own:
        row, line = _run(record, references.get(_key(record)))
        rows.append(row)
        lines.append(line)
    return {"roundoff": pandas.DataFrame(rows), "growth": pandas.concat(lines, ignore_index=True) if lines else pandas.DataFrame()}


def _key(record):
    """(form, loops)"""
    return record.role, int(judge.scene_of(record).partition(":")[2])


def _run(record, reference):
    (form, loops), (status, reason) = _key(record), of_run(record)
    if reference is None or not reference.series:
        reason = f"{reason}; there is no reference".removeprefix("; ")
    times, found = differences(record, reference)
    speed, singular = Chain(loops).speed(times), singular_times(Chain(loops), DURATION)
    near, far, share = growth(times, found, singular)
    own = {"loops": loops, "scheme": form, "implementation": record.cell["contenders"][0]}
    row = own | {"status": status, "reason": reason, "near": near, "far": far, "near_time": share,
                 "with_speed": with_speed(times, found, speed), "record": record.name}
    row |= {f"at_{instant:g}_s": _at(times, found, instant) for instant in INSTANTS}
    drawn = slice(DRAWN, None, DRAWN)
    line = pandas.DataFrame({"t": times[drawn].round(6), "difference": found[drawn]})
    line["difference"] = [float(f"{value:.3g}") for value in line.difference]
    return row, line.assign(**own, record=record.name)


def differences(record, reference):
    """(times, largest distance of a point from where the reference has it, m), as long as both have steps."""
    both = [one.series if one else {} for one in (record, reference)]
    count = min(len(one.get("t", [])) for one in both)
    if count == 0:
        return numpy.array([]), numpy.array([])
    ours, theirs = ({column: values[:count] for column, values in one.items()} for one in both)
    return numpy.array(ours["t"]), judge.distances(ours, {c: numpy.array(v, dtype=float) for c, v in theirs.items()}, 1.0)


def _at(times, found, instant):
    """The difference at `instant`; none where the run did not get there."""
    return next((float(value) for t, value in zip(times, found) if abs(t - instant) < EVERY * STEP / 2), None)


def growth(times, found, singular):
    """Of the growth of log10(difference) after the first turn, the decades that lie within NEAR of a singular
    position, those in between, and the share of time that is near. In the first turn the difference leaves zero,
    by as many decades as FLOOR is low."""
    later = times >= singular[2] - singular[0]  # two of them a turn
    times, found = times[later], found[later]
    if len(times) < 2 or not numpy.isfinite(found).all():
        return (float("nan"),) * 3
    logs = numpy.maximum.accumulate(numpy.log10(numpy.maximum(found, FLOOR)))  # oscillation is no growth
    near = numpy.array([bool((abs(singular - middle) <= NEAR).any()) for middle in (times[1:] + times[:-1]) / 2])
    steps = numpy.diff(logs)
    return float(steps[near].sum()), float(steps[~near].sum()), float(near.mean())


def with_speed(times, found, speed):
    """Correlation of log(difference) with log(speed) over a line's second half, both without their trend over
    log(t). Near 1, one motion is late: it is on the same path, and off by its speed times the lag."""
    late = (found > FLOOR) & (times >= times.max(initial=0.0) / 2)
    if late.sum() < 3:
        return float("nan")
    rests = []
    for values in (found[late], speed[late]):
        logs, at = numpy.log(values), numpy.log(times[late])
        rests.append(logs - numpy.polyval(numpy.polyfit(at, logs, 1), at))
    return float(numpy.corrcoef(*rests)[0, 1]) if min(rest.std() for rest in rests) > 1e-9 else float("nan")
