# Stale pivots: the program of implementations/csc_klu that measures them, kept as one raw file.
import json

import pandas

from study.extremes_study import tools
from study.pipeline import child, runs
from study.pipeline.errors import StudyError
from study.pipeline.layout import read_json, write_json

COLUMNS = ("sequence", "form", "strategy", "matrices", "pivoting", "error_median", "error_worst",
           "repivotings", "time_us_median")
SECONDS = 600


def run(study):
    """{"pivots": its rows, "pivots_claims": what it says of its own claims}"""
    path = study.layout.results / "raw" / "stale_pivots.json"
    record = read_json(path) if path.exists() else _measure(study, path)
    command = f"build/{tools.STALE_PIVOTS} --json"
    rows = pandas.DataFrame(record["document"]["rows"], columns=COLUMNS)
    return {"pivots": rows.assign(raw_file=study.layout.relative(path), command=command),
            "pivots_claims": pandas.DataFrame(record["document"].get("claims", []),
                                              columns=["claim", "holds"])}


def _measure(study, path):
    study.tell("stale pivots")
    command = [tools.built(tools.STALE_PIVOTS), "--json"]
    ended = child.run(command, SECONDS, runs.MEMORY_MB)
    try:
        document = json.loads(ended.stdout)  # exit status 1: a claim does not hold, which is a finding
        missing = [name for row in document["rows"] for name in COLUMNS if name not in row]
    except (ValueError, KeyError) as error:
        raise StudyError(f"`{' '.join(command)}` does not work: {ended.reason}") from error
    if missing:
        raise StudyError(f"`{' '.join(command)}`: its rows lack {missing[0]}")
    record = {"context": next(iter(study.contexts.values())), "command": command, "document": document}
    write_json(path, record)
    return record
