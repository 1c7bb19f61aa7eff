# The growth of roundoff: how far implementations are from the long-double reference of the same settings.
import numpy
import pandas

from study.extremes_study import tools
from study.extremes_study.motions import Chain, singular_times
from study.pipeline import runs
from study.pipeline.layout import read_json

LOOPS, STEP, DURATION, EVERY = (1, 2, 10, 40), 1.25e-3, 20.0, 16
INSTANTS = (1.0, 5.0, 20.0)  # s, of the table


def run(study):
    """{"roundoff": a row a run, "roundoff_growth": its difference over time, "singular": times}"""
    reference = tools.Reference()
    asked = [(loops, form) for loops in LOOPS for form in tools.FORMS]
    jobs = [(*key, one) for key in asked for one in study.contenders if study.serves(one, key[1])]
    references = dict(zip(asked, tools.side_by_side(
        study, lambda key: "roundoff reference", lambda key: _record(study, *key, reference), asked)))
    tools.side_by_side(study, lambda job: f"roundoff N = {job[0]}",
                       lambda job: _record(study, *job) and None, jobs)
    rows, growth = [], []
    for loops, form, one in jobs:
        path = _path(study, loops, form, one)
        record = read_json(path)  # one at a time: they are large
        status, reason = runs.status(record)
        times, found = differences(record, references[loops, form])
        rows.append({"loops": loops, "scheme": form, "implementation": one.variant, "status": status,
                     "reason": reason} | {f"at_{instant:g}_s": _at(times, found, instant)
                                          for instant in INSTANTS}
                    | {"raw_file": study.layout.relative(path), "command": runs.typed(record)})
        growth.append(pandas.DataFrame({"loops": loops, "scheme": form, "implementation": one.variant,
                                        "t": times, "difference": found,
                                        "speed": Chain(loops).speed(numpy.asarray(times, dtype=float))}))
    singular = [{"loops": loops, "t": t} for loops in LOOPS
                for t in singular_times(Chain(loops), DURATION)]
    return {"roundoff": pandas.DataFrame(rows), "singular": pandas.DataFrame(singular),
            "roundoff_growth": _short(pandas.concat(growth, ignore_index=True)) if growth else
            pandas.DataFrame(columns=["loops", "scheme", "implementation", "t", "difference",
                                  "speed"])}


def _short(table):
    """Numbers with four significant digits: a line has a thousand of them."""
    found = table.copy()
    for column in ("t", "difference", "speed"):
        found[column] = [float(f"{value:.4g}") for value in table[column]]
    return found


def differences(record, reference):
    """(times, largest distance of a point from where the reference has it, m), as long as both have steps."""
    count = min(len(one.get("outputs", {}).get("t", [])) for one in (record, reference))
    if count == 0:
        return [], []
    ours, theirs = ({column: values[:count] for column, values in one["outputs"].items()}
                    for one in (record, reference))
    return ours["t"], tools.distances(ours, {c: v for c, v in theirs.items() if c != "t"}, 1.0)


def _at(times, found, instant):
    """The difference at `instant`; none where the run did not get there."""
    return next((float(value) for t, value in zip(times, found) if abs(t - instant) < EVERY * STEP / 2), None)


def _path(study, loops, form, one):
    return study.layout.results / "raw" / "roundoff" / f"{loops}" / f"{one.file_name}-{form}.json"


def _record(study, loops, form, one):
    return runs.simulate(_path(study, loops, form, one), one, f"four-bar:{loops}", step=STEP, duration=DURATION,
                         every=EVERY, context=study.context(one), seconds=5 * study.seconds,
                         more=["--scheme", form], columns=list(Chain(loops).solutions([0.0])[0]))
