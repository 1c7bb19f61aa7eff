# Makes one raw file each, by running `mbs` as a child. An existing file is never measured again.
import json
import os

from study.pipeline import child
from study.pipeline.errors import StudyError
from study.pipeline.layout import ROOT, read_json, write_json


def bench(path, contender, scene, study, *, more=(), repetitions=1, min_time=1e-6,
          limit="cell_seconds"):
    """Google Benchmark's JSON of one cell; a dead child leaves the same shape with "failure"."""
    if path.exists():
        return read_json(path)
    partial, profile = _partial(path), study.profile
    command = contender.call("bench", scene.name, "--implementation", contender.variant, *more,
                             "--step", f"{profile.step:g}", "--penalty", profile.penalty,
                             f"--benchmark_repetitions={repetitions}",
                             f"--benchmark_min_time={min_time:g}",
                             f"--benchmark_out={_short(partial)}", "--benchmark_out_format=json")
    ended = child.run(command, profile.limits[limit], profile.limits["memory_mb"])
    # Status 1 says that a row failed: it is in the JSON with its message.
    if ended.status == "exited" and ended.code in (0, 1) and _complete(partial):
        os.replace(partial, path)
    else:
        partial.unlink(missing_ok=True)
        write_json(path, {"context": study.context(contender), "benchmarks": [],
                          "failure": _failure(ended, command)})
    return read_json(path)


def check(path, contenders, scene, study):
    """The gate's verdicts on one scene, of contenders in one build on one pair; None if it died
    with several of them at once."""
    if path.exists():
        return read_json(path)
    partial, limits = _partial(path), study.profile.limits
    # A limit of its own for each implementation, with room left for the reference: the program can
    # then blame the slow one, before the limit on the whole child takes all verdicts with it.
    each = limits["check_seconds"] / (len(contenders) + 1)
    names = [word for one in contenders for word in ("--implementation", one.variant)]
    command = contenders[0].call("check", scene.name, "--step", f"{study.profile.step:g}",
                                 "--penalty", study.profile.penalty, "--time-limit", f"{each:g}",
                                 "--json", _short(partial), *names)
    ended = child.run(command, limits["check_seconds"], limits["memory_mb"])
    if ended.status == "exited" and ended.code in (0, 1) and _complete(partial):
        os.replace(partial, path)
        return read_json(path)
    partial.unlink(missing_ok=True)
    if len(contenders) > 1:
        return None
    status = "crashed" if ended.status == "exited" else ended.status
    row = {"scene": scene.name, "implementation": contenders[0].variant, "verdict": status,
           "reason": f"the check {ended.reason}", "checks": []}
    write_json(path, {"context": study.context(contenders[0]), "rows": [row],
                      "failure": _failure(ended, command)})
    return read_json(path)


def simulate(path, contender, scene, penalty, study):
    """Summary of a whole simulation; {"context", "summary" or "failure"}."""
    if path.exists():
        return read_json(path)
    profile = study.profile
    command = contender.call("simulate", scene.name, "--implementation", contender.variant,
                             "--step", f"{profile.step:g}", "--penalty", penalty,
                             "--duration", f"{profile.accuracy['duration']:g}", "--json")
    ended = child.run(command, profile.limits["simulate_seconds"], profile.limits["memory_mb"])
    record = {"context": study.context(contender), "penalty_asked": penalty, "command": command}
    try:
        if ended.status != "exited":
            raise ValueError(ended.reason)
        record["summary"] = json.loads(ended.stdout)
    except ValueError:
        record["failure"] = _failure(ended, command)
    write_json(path, record)
    return record


def context(contender, memory_mb=4096):
    """The context of a contender's build and BLAS pair on this machine, as its raw files have it."""
    command = contender.call("bench", "four-bar:1", "--implementation", "null/null", "--steps", "1",
                             "--benchmark_min_time=1e-6", "--benchmark_format=json")
    ended = child.run(command, 60, memory_mb)
    try:
        return json.loads(ended.stdout)["context"]
    except (ValueError, KeyError) as error:
        raise StudyError(f"{command[0]} bench does not work: {ended.reason}") from error


def samples(raw):
    """The single runs in a raw file, without Google Benchmark's own aggregates."""
    return [row for row in raw["benchmarks"] if row.get("run_type", "iteration") == "iteration"]


def failure(raw):
    """(status, reason) if this raw file holds no usable sample, else None."""
    if "failure" in raw:
        return raw["failure"]["status"], raw["failure"]["reason"]
    rows = samples(raw)
    if not rows:
        return "crashed", "no benchmark was run"
    for row in rows:
        if row.get("error_occurred"):
            message = row.get("error_message", "")
            kind = message.split(":")[0].strip()
            return kind if kind in ("unsupported", "out-of-memory") else "disagrees", message
    return None


def _partial(path):
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(path.name + ".partial")
    partial.unlink(missing_ok=True)
    return partial


def _short(path):
    """Relative to the repository where possible: raw files quote their command."""
    path = path.resolve()
    return str(path.relative_to(ROOT) if path.is_relative_to(ROOT) else path)


def _complete(path):
    try:
        json.loads(path.read_text())
        return True
    except (OSError, ValueError):
        return False


def _failure(ended, command):
    status = "crashed" if ended.status == "exited" else ended.status
    return {"status": status, "reason": ended.reason, "command": command}
