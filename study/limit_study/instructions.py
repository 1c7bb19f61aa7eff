# Instructions of a step, counted by Valgrind: repeatable, whatever else the machine does.
import re
import shutil
from dataclasses import replace

from study.pipeline import child
from study.pipeline.layout import read_json, write_json

BUILD = "gcc-O3-no-avx512"  # of study/pipeline/builds.py
STEPS = (20, 60)            # from the start on: long before the first singular position, two passes each
STRETCHES = 2               # `mbs bench` runs one to warm up and one that it times
MOST_LOOPS = 40             # of larger ones the emulation takes too long
MEMORY_MB = 4096


def why_not():
    """Why nothing can be counted here; empty if it can."""
    return "" if shutil.which("valgrind") else "valgrind is not installed"


def count(layout, one, loops, seconds):
    """Instructions of a step of a contender: what more steps of a run take more; None where they were
    not counted."""
    path = layout.results / "raw" / f"n{2 * loops + 2}" / f"{one.file_name}-instructions.json"
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        write_json(path, {"runs": [_run(one, loops, steps, seconds, path.with_suffix(".log"))
                                   for steps in STEPS]})
    totals = [run.get("instructions") for run in read_json(path)["runs"]]
    if None in totals:
        return None
    return (totals[1] - totals[0]) / (STRETCHES * (STEPS[1] - STEPS[0]))


def _run(one, loops, steps, seconds, log):
    bench = replace(one, build=BUILD).call(
        "bench", f"four-bar:{loops}", "--implementation", one.variant, "--start", "0", "--steps",
        str(steps), "--benchmark_min_time=0", "--benchmark_repetitions=1")
    command = ["valgrind", "--tool=callgrind", "--trace-children=yes",  # it executes itself again
               "--callgrind-out-file=/dev/null",
               f"--log-file={log}", *bench]
    ended = child.run(command, seconds, MEMORY_MB)
    record = {"command": ["--log-file=LOG" if word.startswith("--log-file") else word
                          for word in command]}
    try:
        if ended.status != "exited" or ended.code != 0:
            raise ValueError(ended.reason)
        record["instructions"] = collected(log.read_text())
    except ValueError as error:
        record["failure"] = str(error)
    log.unlink(missing_ok=True)
    return record


def collected(log):
    """The number of instructions that Callgrind says it has collected; ValueError if it has none."""
    found = re.search(r"Collected : (\d+)", log)
    if not found or int(found[1]) == 0:
        raise ValueError("callgrind has not collected anything")
    return int(found[1])
