# The gate, then rounds of timed processes over all contenders of a size; one raw file each.
import json
import statistics

from study.pipeline import child
from study.pipeline.contenders import Contender
from study.pipeline.errors import StudyError
from study.pipeline.layout import read_json, write_json

LIMIT = Contender("limit/limit", "limit/limit")
MEMORY_MB = 4096
GATE_S = 60
TRIES, CALM = 3, 1.1  # of a process whose wall time is above its processor time by more: it was interrupted
PHASES = ("evaluation", "assembly", "factorization", "solve", "projection", "other")


def bounds(layout, loops):
    """The rows of bounds.csv, in the order of `loops`."""
    key = "-".join(map(str, loops))
    raw = _kept(layout, f"bounds-{key}.json", LIMIT.call("limit", *map(str, loops), "--json"), 600)
    if "failure" in raw:
        raise StudyError(f"mbs limit: {raw['failure']}")
    return raw["found"]["rows"]


def size(layout, contenders, loops, rounds, seconds, tell):
    """The rows of steps.csv of one size."""
    rows = cell(layout, contenders, f"four-bar:{loops}", f"n{2 * loops + 2}", rounds, seconds, tell)
    return [{"loops": loops, "variables": 2 * loops + 2} | row for row in rows]


def growth(layout, contenders, loops, rounds, seconds, tell):
    """The rows of growth.csv of one size: the saddle-point form."""
    rows = cell(layout, contenders, f"four-bar:{loops}", f"growth/n{2 * loops + 2}", rounds, seconds, tell,
                ("--scheme", "saddle-point"))
    return [{"loops": loops, "variables": 2 * loops + 2} | row for row in rows]


def cell(layout, contenders, scene, folder, rounds, seconds, tell, setting=()):
    """A row a contender: the gate, then `rounds` in turn. Raw files go to raw/`folder`. `setting`: options of
    `mbs check` and `mbs bench`."""
    rows, timed = [], []
    for one in contenders:
        tell(f"gate of {one.name}")
        reason = _objection(layout, one, scene, folder, setting)
        rows.append({"scene": scene, "implementation": one.name,
                     "status": "disagrees" if reason else "ok", "reason": reason})
        timed.append(not reason)
    samples = [[] for _ in contenders]
    for turn in range(1, rounds + 1):
        for place, one in enumerate(contenders):
            if not timed[place]:
                continue
            tell(f"round {turn} of {rounds}, {one.name}")
            found, reason = bench(layout, one, scene, f"{folder}/{one.file_name}-{turn}", seconds,
                                  "--phases", *setting)
            samples[place].append(found)
            if reason:
                rows[place] |= {"status": "failed", "reason": reason}
                timed[place] = False
    return [row | (_figures(found) if good else {})
            for row, found, good in zip(rows, samples, timed)]


def bench(layout, one, scene, name, seconds, *options):
    """(the row of Google Benchmark, "") or ({}, why there is none); raw/`name`.json. A process that the machine
    interrupted is run again; the calmest of its TRIES counts."""
    raw = _kept(layout, f"{name}.json",
                one.call("bench", scene, "--implementation", one.variant, *options,
                         "--benchmark_min_time=0.02", "--benchmark_repetitions=1",
                         "--benchmark_format=json"), seconds, _unrest)
    if "failure" in raw:
        return {}, raw["failure"]
    row = raw["found"]["benchmarks"][0]
    return (row, "") if not row.get("error_occurred") else ({}, row["error_message"])


def _unrest(record):
    """Wall time over processor time of a benchmark; 1 of one that failed, which is not tried again."""
    row = record.get("found", {}).get("benchmarks", [{}])[0]
    if not row.get("cpu_time"):
        return 1.0
    # The real time of batches is without that of their lanes alone.
    real = (row["step_us"] + row["alone_us"]) * row["sets"] * row["steps"] if "alone_us" in row else row["real_time"]
    return real / row["cpu_time"]


def _kept(layout, name, command, seconds, unrest=lambda record: 1.0):
    """{"command", "found": what it printed} or {"command", "failure"}; a stored one is not run again."""
    path = layout.results / "raw" / name
    if path.exists():
        return read_json(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    records = []
    while not records or (len(records) < TRIES and unrest(records[-1]) > CALM):
        records.append(_record(command, seconds))
    record = min(records, key=unrest)
    write_json(path, record)
    return record


def _record(command, seconds):
    ended = child.run(command, seconds, MEMORY_MB)
    record = {"command": command}
    try:
        if ended.status != "exited" or ended.code not in (0, 1):
            raise ValueError(ended.reason)
        record["found"] = json.loads(ended.stdout)
    except ValueError as error:
        record["failure"] = str(error)
    return record


def _objection(layout, one, scene, folder, setting):
    """Why the gate rejects it; empty if it does not."""
    path = layout.results / "raw" / folder / f"{one.file_name}-gate.json"
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        ended = child.run(one.call("check", scene, "--implementation", one.variant, *setting,
                                   "--time-limit", str(GATE_S), "--json", str(path)),
                          3 * GATE_S, MEMORY_MB)
        if not path.exists():
            write_json(path, {"rows": [{"verdict": ended.status, "reason": ended.reason}]})
    row = read_json(path)["rows"][0]
    return "" if row["verdict"] == "agrees" else f"{row['verdict']}: {row['reason']}"


def _figures(found):
    times = [row["step_us"] for row in found]
    shares = {phase: statistics.median(row[f"phase_{phase}"] for row in found) for phase in PHASES}
    total = sum(shares.values())
    return {"step_us": statistics.median(times), "low_us": min(times), "high_us": max(times),
            "rounds": len(times), "passes": found[0]["passes"] / found[0]["steps"],
            "setup_us": statistics.median(row["setup_us"] for row in found),
            "memory_bytes": found[0].get("memory_bytes")} | {
        f"{phase}_us": statistics.median(times) * share / total for phase, share in shares.items()}
