# The executor: runs one cell as a child under its limits and says how it ended.
import csv
import json
import math
import os
import re
import tempfile
from pathlib import Path

from analysis.core.files import StudyError
from analysis.core.gather import gather
from study.core import child
from study.core.cell import LAYOUT

USAGE = 2  # the exit status of a program that refuses what it is asked for
BY_FILE = ("check", "bench")  # these write their JSON into a file
CULPRIT = re.compile(r"ended by \S+ in (\S+)")  # what `mbs bench` says where a contender ends it


def program_of(name="mbs", build=""):
    """Path of a program, relative to the repository; MBS_PROGRAM stands in for `mbs` in tests, but for that of
    another revision ("against/REVISION/build")."""
    if (name == "mbs" or name.startswith(LAYOUT)) and "/" not in build and "MBS_PROGRAM" in os.environ:
        return os.environ["MBS_PROGRAM"]
    return f"build-{build}/{name}" if build else f"build/{name}"


def command_of(cell, output="FILE", motion="MOTION"):
    """The words of a cell's command line; files that it writes are `output` and `motion`."""
    first = cell.contenders[0] if cell.contenders else None
    words = [program_of(cell.program, first.build if first else ""), *filter(None, (cell.kind, cell.scene))]
    words += [word for one in cell.contenders for word in ("--implementation", one.variant)]
    words += map(str, cell.settings)
    if cell.kind == "bench":
        words += ["--benchmark_out_format=json", f"--benchmark_out={output}"]
    elif cell.kind == "check":
        words += ["--json", output]
    elif cell.own or cell.program == "mbs_reference":
        words += ["--json"]
    if cell.every:
        words += ["--output" if cell.keep == ("outputs",) else "--trajectory", motion, "--every", str(cell.every)]
    if first and first.blas != "system":
        words += ["--blas", first.blas]
    return words


def run(cell, context, scratch=None):
    """The fields of a Record. `context`: what its environment is known to be, or None (then that of the output);
    `scratch`: the folder for what the program writes."""
    with tempfile.TemporaryDirectory(dir=scratch) as folder:
        output, motion = Path(folder) / "output.json", Path(folder) / "motion.csv"
        before = _ticks()
        ended = child.run(command_of(cell, str(output), str(motion)), cell.seconds, cell.memory_mb, cell.timed)
        record = {"cell": cell.document(), "command": command_of(cell), "seconds": round(ended.seconds, 6),
                  "context": context or {}, "status": "done", "reason": "", "output": {}, "series": {},
                  "machine": _since(before) | {"cpu_s": round(ended.cpu_s, 6)} if cell.timed else {}}
        if ended.status != "exited" or ended.code not in (0, 1):
            return record | _failure(ended)
        try:
            found = json.loads(output.read_text() if cell.kind in BY_FILE else ended.stdout, parse_constant=_no_number)
            record["series"] = _columns(motion, cell.keep) if cell.every and motion.exists() else {}
        except (OSError, ValueError) as error:
            return record | {"status": "crashed", "reason": f"its output is no JSON: {error}"[:300]}
    if not isinstance(found, dict):
        return record | {"status": "crashed", "reason": "its output is no JSON object"}
    own = found.pop("context", None) or {}
    if own and context:
        need_same(context, own, " ".join(record["command"]))
    return record | {"output": compact(found), "context": context or {key: own[key] for key in KEPT if key in own}}


def compact(output):
    """Rows of Google Benchmark by name: what is the same in all samples once, what differs as a list; and, always lists,
    "stretch_us" by the clock and "cpu_us" of the processor, the same where nothing else ran."""
    if "benchmarks" not in output:
        return output
    groups = gather((row["name"], row) for row in output["benchmarks"] if row.get("run_type", "iteration") == "iteration")
    return {"rows": {name: {"stretch_us": [row.get("real_time") for row in rows],
                            "cpu_us": [row.get("cpu_time") for row in rows]} | {
        key: rows[0][key] if all(row.get(key) == rows[0][key] for row in rows) else [row.get(key) for row in rows]
        for key in rows[0] if key not in ("name", "run_name", "run_type", "real_time", "cpu_time", "threads", "repetitions",
                                          "family_index", "per_family_instance_index", "repetition_index")}
        for name, rows in groups.items()}}


FINGERPRINT = ("machine", "commit", "dirty", "compiler", "flags", "build_type", "blas", "blas_loaded", "libraries")
KEPT = (*FINGERPRINT, "cpu_model", "kernel", "num_cpus")  # by a record, of the context that a program prints
OF_ALL = ("machine", "commit", "dirty", "cpu_model", "kernel", "num_cpus")  # true of programs other than `mbs`, too


def fingerprint(context):
    """What must be equal for two records to be comparable: the machine and the build."""
    found = {key: str(context.get(key, "missing")) for key in FINGERPRINT}
    return found | {"blas_loaded": ";".join(sorted(found["blas_loaded"].split(";")))}


def differing(known, found, keys=FINGERPRINT):
    """The first thing in which two contexts differ, as (key, known value, found value); None if there is nothing."""
    known, found = fingerprint(known), fingerprint(found)
    return next(((key, known[key], found[key]) for key in keys if known[key] != found[key]), None)


def need_same(known, found, what):
    if other := differing(known, found):
        key, mine, its = other
        raise StudyError(f"{what}: comes from another machine or build ({key} is '{its}', the set's is '{mine}'): "
                         "results are never merged; name another directory with --results")


def _ticks():
    """(those that the host took, all) of this machine's processors since it was started."""
    found = [int(one) for one in Path("/proc/stat").read_text().split()[1:9]]  # user, …, steal
    return found[-1], sum(found)


def _since(before):
    """{"steal", "mhz"}: the share that the host took since `_ticks` were `before`; the processor's frequency now, None where it cannot be read."""
    taken, total = (now - then for now, then in zip(_ticks(), before))
    found = re.findall(r"^cpu MHz\s*: ([\d.]+)", Path("/proc/cpuinfo").read_text(), re.M)
    return {"steal": taken / total if total else 0.0, "mhz": max(map(float, found), default=None)}


def _failure(ended):
    if ended.status == "exited":
        return {"status": "crashed", "reason": ended.reason} if ended.code != USAGE else {
            "status": "refused", "reason": ended.reason.partition(": ")[2] or ended.reason}
    culprit = CULPRIT.search(f"{ended.reason}\n{ended.stderr}")
    return {"status": ended.status, "reason": ended.reason, "output": {"culprit": culprit[1]} if culprit else {}}


def _no_number(word):
    raise ValueError(f"{word} is no number")


def _columns(path, keep):
    with open(path, newline="", encoding="utf-8") as file:  # JSON has no number that is not finite
        return {name: [value if math.isfinite(value) else None for value in map(float, values)]
                for name, *values in zip(*csv.reader(file), strict=True) if keep in (("outputs",), ("all",)) or name in ("t", *keep)}
