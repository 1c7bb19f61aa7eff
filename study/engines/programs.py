# The engines' programs: which are built, and one run of one, kept as one raw file.
import json
import os
import shlex
import subprocess
from dataclasses import dataclass

from study.accuracy_study.bench import REPEATS, SHORT
from study.engines.subjects import error
from study.pipeline import child, runs
from study.pipeline.errors import StudyError
from study.pipeline.layout import Layout, ROOT, read_json, write_json

FOLDER = ROOT / "build" / "engines"


def built():
    """{engine: why it is left out, or ""}"""
    path = FOLDER / "engines.json"
    if not path.exists():
        raise StudyError(f"{path} is missing: build the engines' programs with study/setup --engines")
    found = read_json(path)
    return {engine: reason or ("" if program(engine).exists() else f"{program(engine)} is not built")
            for engine, reason in found.items()}


def program(engine):
    return FOLDER / f"engine_{engine}"


def set_up():
    """Installs the engines' packages where they are missing and builds all programs."""
    if subprocess.run([str(ROOT / "study" / "setup"), "--engines"]).returncode != 0:
        raise StudyError("set-up failed, see above")


@dataclass(frozen=True)
class Bench:
    """Runs of engines in one results directory."""
    layout: Layout
    time_limit: float  # s, a run that is predicted to take longer is not run

    def run(self, subject, setting, value, *, kind="engines", repeat=1, repeats=1):
        """The record of one run, with its "raw_file"; an existing file is never run again. `repeat`: the round;
        `repeats`: of the simulation in its process."""
        name = (f"{setting.engine}-{value:g}{'-least' if repeats > 1 else ''}"
                f"{f'-{repeat}' if repeat > 1 else ''}.json")
        path = self.layout.results / "raw" / kind / subject.file_name / setting.file_name / name
        if not path.exists():
            write_json(path, _simulate(subject, setting, value, repeats, 1.5 * self.time_limit))
        return read_json(path) | {"raw_file": self.layout.relative(path)}

    def steady(self, subject, setting, value):
        """The record of `run`, of a finished run that is SHORT that of REPEATS at once, as ours are."""
        record = self.run(subject, setting, value)
        if (runs.status(record)[0] not in runs.FINISHED
                or record["summary"]["time"] * subject.duration > SHORT):
            return record
        return self.run(subject, setting, value, repeats=REPEATS)


def _simulate(subject, setting, value, repeats, seconds):
    model = ["--loops", str(subject.loops)] if subject.loops else ["--pendulum"]
    path = program(setting.engine)
    command = [os.path.relpath(path, ROOT) if path.is_relative_to(ROOT) else str(path), *model, "--duration",
               f"{subject.duration:g}", *(["--repeats", str(repeats)] if repeats > 1 else []),
               *setting.words(value), "--json"]
    ended = child.run(command, seconds, runs.MEMORY_MB)
    record = {"command": command, "seconds": ended.seconds}
    try:
        if ended.status != "exited" or ended.code not in (0, 1):
            raise ValueError(ended.reason)
        return record | {"summary": json.loads(ended.stdout)}
    except ValueError as problem:
        status = "crashed" if ended.status == "exited" else ended.status
        return record | {"failure": {"status": status, "reason": str(problem)}}


def row(subject, setting, value, record):
    """What engines.csv says of a run. `time`: s of computation for a simulated second."""
    status, reason = runs.status(record)
    found = named(subject, setting, value) | {"status": status, "status_reason": reason, "rounds": 1}
    if "summary" in record:
        summary = record["summary"]
        found |= {"time": summary["time"], "repeats": summary["repeats"], "failed_at": summary["failed_at"],
                  "energy_drift": summary["energy_drift_max"], "joint_gap": summary["joint_gap_max"],
                  "version": summary["version"], "complaints": summary["complaints"],
                  "first_complaint": summary["first_complaint"]}
    if status in runs.FINISHED:
        off = error(subject, record)
        found |= {"error": max(off, subject.own_error), "at_most": off <= subject.own_error}
    return found | {"raw_file": record["raw_file"], "command": shlex.join(record["command"])}


def named(subject, setting, value):
    return {"subject": subject.name, "loops": subject.loops, "engine": setting.engine,
            "setting": setting.name, "over": setting.over, "value": value}
