# One simulation in a child process: its summary and its sampled outputs, kept as one raw file.
import json
import shlex

import pandas

from analysis.accuracy.front import FINISHED, GOOD  # of simulations everywhere in the study
from study.pipeline import child
from study.pipeline.errors import StudyError
from study.pipeline.layout import read_json, write_json

MEMORY_MB = 4096
OUTPUTS = "OUTPUT.csv"  # stands in records for a file that was read and removed
USAGE = 2  # the exit status of `mbs` where it refuses what it is asked for


def simulate(path, contender, scene, *, step, duration, every, context, seconds, more=(),
             stored=False, columns=None):
    """{"context", "command", "seconds", "summary", "outputs": {column: values}} or "failure" in place
    of the last two; an existing file is never run again. `outputs` are those of the scene or, where
    `columns` are given, t and these of the trajectory."""
    if path.exists():
        return _read(path)
    need(stored, path)
    outputs = path.with_name(path.name + ".partial.csv")
    outputs.parent.mkdir(parents=True, exist_ok=True)
    kind = "--trajectory" if columns else "--output"
    command = contender.call("simulate", scene, "--implementation", contender.variant,
                             "--step", f"{step:g}", "--duration", f"{duration:g}", "--json",
                             *([kind, str(outputs), "--every", str(every)] if every else []),
                             *map(str, more))
    ended = child.run(command, seconds, MEMORY_MB, outputs)
    record = {"context": context, "seconds": ended.seconds,
              "command": [OUTPUTS if word == str(outputs) else word for word in command]}
    try:
        if ended.status != "exited" or ended.code not in (0, 1):
            raise ValueError(ended.reason)
        record["summary"] = json.loads(ended.stdout)
        table = (pandas.read_csv(outputs, usecols=["t", *columns] if columns else None)
                 if outputs.exists() else pandas.DataFrame())
        record["outputs"] = {column: table[column].tolist() for column in table}
    except ValueError as error:
        record |= {"failure": _failure(ended, str(error))}
    outputs.unlink(missing_ok=True)
    write_json(path, record)
    return record


def typed(record):
    """What repeats the run of a record, to be typed where the repository is: the outputs are only the study's."""
    words = ["build/mbs", *(word for word in record["command"][1:] if word != "--json")]
    if OUTPUTS in words:
        at = words.index(OUTPUTS) - 1
        del words[at:at + len(("--output", OUTPUTS, "--every", "K"))]
    return shlex.join(words)


def _failure(ended, reason):
    """Status and reason; `refused` where `mbs` said in a line that it would not run it."""
    if ended.status == "exited" and ended.code == USAGE:
        return {"status": "refused", "reason": reason.partition(": ")[2] or reason}
    return {"status": "crashed" if ended.status == "exited" else ended.status, "reason": reason}


def _read(path):
    """A raw file that is there; StudyError if it is none of a run."""
    record = read_json(path)
    told = record.get("failure", record.get("summary")) if isinstance(record, dict) else None
    if not isinstance(told, dict) or not isinstance(told.get("status"), str):
        raise StudyError(f"{path} is damaged (it tells of no run): remove it and resume to measure it again")
    return record


def need(stored, path):
    """With `stored` nothing may be run: StudyError, since `path` is missing."""
    if stored:
        raise StudyError(f"{path} is missing: the results are not complete; run study/scenes again")


def status(record):
    """(status, reason) of a run."""
    if "failure" in record:
        return record["failure"]["status"], record["failure"]["reason"]
    return record["summary"]["status"], record["summary"]["status_reason"]
