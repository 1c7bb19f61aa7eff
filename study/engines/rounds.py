# The times that are compared: what may be the fastest at some error, engines' and ours, in the same rounds.
import random

import numpy

from analysis.engines.equal_error import ENGINE, OURS, candidates
from study.accuracy_study.bench import time_of
from study.pipeline import runs

ROUNDS, SEED = 5, 20080101


def measure(subject, theirs, ours, place, tell):
    """The rows of rounds.csv of one subject. `theirs`, `ours`: its rows of engines.csv and work.csv; `place`: Place."""
    engines_index, ours_index = candidates(theirs, ours)
    jobs = [(ENGINE, theirs.loc[index]) for index in engines_index]
    jobs += [(OURS, ours.loc[index]) for index in ours_index]
    rows = []
    for number in range(1, ROUNDS + 1):
        # The first run of a program after another one is not special: the order is new in every round.
        order = random.Random(f"{SEED}:{subject.name}:{number}").sample(jobs, len(jobs))
        for done, (side, row) in enumerate(order, start=1):
            tell(f"{subject.name}: round {number} of {ROUNDS}, {done} of {len(jobs)}")
            rows.append(_timed(subject, place, number, side, row) | {"order": done})
    return rows


def _timed(subject, place, number, side, row):
    found = {"subject": subject.name, "round": number, "side": side, "setting": row.setting}
    if side == ENGINE:
        found |= {"name": row.engine, "value": row.value}
        setting = place.setting_of(row.engine, row.setting)
        record = place.engines.run(subject, setting, row.value, kind="rounds", repeat=number,
                                   repeats=int(row.repeats))
        time = record.get("summary", {}).get("time")
    else:
        found |= {"name": row.implementation, "value": row.step}
        entries = place.entries
        record = place.ours.run("rounds", subject, entries.contenders[row.implementation],
                                entries.setting(row.implementation, row.setting), row.step, repeat=number,
                                repeats=int(row.repeats))
        time = time_of(record) if "summary" in record else None
    status, _ = runs.status(record)
    return found | {"status": status, "time": time if status in runs.FINISHED else numpy.nan,
                    "raw_file": record["raw_file"]}
