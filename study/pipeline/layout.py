# Where everything lies inside one results directory; results/README.md shows the same picture.
import hashlib
import json
import os
from pathlib import Path

from study.pipeline.errors import StudyError

ROOT = Path(__file__).resolve().parent.parent.parent
DIGESTS = "tables.json"  # {name of a table: its SHA-256}
NULL = "null/null"  # the harness's control: a simulation that does nothing


class Layout:
    """Paths of one results directory."""

    def __init__(self, results):
        self.results = Path(results)
        self.run = self.results / "run.json"                  # profile, selection, build, machine
        self.registry = self.results / "implementations.json"  # `mbs list --json`
        self.refined = self.results / "plans" / "refined.json"
        self.refined_stamp = self.results / "plans" / "refined.measured"
        self.progress = self.results / ".progress"
        self.log = self.results / "run.log"

    def column(self, variables):
        return self.results / "raw" / f"n{variables:04d}"

    def plan(self, variables):
        return self.results / "plans" / f"n{variables:04d}.json"

    def measured(self, variables):
        return self.results / "plans" / f"n{variables:04d}.measured"

    def cell(self, kind, contender, scene):
        """`kind` is pilot, round1, round2, ... phases1, ... or operations1, ..."""
        return self.column(scene.variables) / kind / f"{contender.file_name}@{scene.label}.json"

    def gate(self, scene, attempt):
        return self.column(scene.variables) / "gate" / f"{scene.label}-{attempt}.json"

    def accuracy(self, variables, contender, penalty):
        return self.column(variables) / "accuracy" / f"{contender.file_name}@{penalty}.json"

    def relative(self, path):
        return str(Path(path).relative_to(self.results))


def program(build=""):
    """The `mbs` to run, relative to ROOT where it can be; MBS_PROGRAM names another for tests."""
    if "MBS_PROGRAM" in os.environ:
        return os.environ["MBS_PROGRAM"]
    return f"build-{build}/mbs" if build else "build/mbs"


def read_json(path):
    """The JSON in `path`; StudyError naming the file and the position if it is damaged."""
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise StudyError(f"{path} is damaged ({error}): remove it and resume to measure it again"
                         ) from error
    except OSError as error:
        raise StudyError(f"cannot read {path}: {error.strerror}") from error


RUN = frozenset({"profile", "only", "variants", "contenders", "control", "contexts", "programs",
                 "builds"})  # what run.json of study/run must hold


def read_run(layout, needed=RUN):
    """run.json, with everything that it must hold; StudyError if something is missing."""
    record = read_json(layout.run)
    missing = sorted(needed - set(record)) if isinstance(record, dict) else sorted(needed)
    if missing:
        raise StudyError(f"{layout.run} is no record of a run: it lacks {', '.join(missing)}")
    return record


def write_json(path, data):
    """Writes atomically: a reader sees the whole file or none."""
    _write(Path(path), lambda partial: partial.write_text(json.dumps(data, indent=1) + "\n"))


def write_csv(path, table):
    """The same for a pandas table, whose digest is kept beside it: need_unchanged()."""
    _write(path, lambda partial: table.to_csv(partial, index=False))
    kept = path.with_name(DIGESTS)
    write_json(kept, (read_json(kept) if kept.exists() else {}) | {path.name: _digest(path)})


def _write(path, write):
    partial = path.with_name(path.name + ".partial")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write(partial)
        os.replace(partial, path)
    except OSError as error:
        raise StudyError(f"cannot write {path}: {error.strerror}") from error
    finally:
        partial.unlink(missing_ok=True)


def need_unchanged(results):
    """StudyError if a table in the directory `results` is not what a study wrote there."""
    kept = results / DIGESTS
    for name, digest in (read_json(kept) if kept.exists() else {}).items():
        path = results / name
        if not path.exists() or _digest(path) != digest:
            raise StudyError(f"{path} is {'not as it was written' if path.exists() else 'missing'}: restore it, "
                             "or run the study again without --stored, which reads it from raw/ anew")


def _digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def fingerprint(context):
    """What must be equal for two results to be comparable: the machine and the build."""
    keys = ("machine", "commit", "dirty", "compiler", "flags", "build_type", "blas",
            "blas_loaded", "libraries")
    found = {key: str(context.get(key, "missing")) for key in keys}
    return found | {"blas_loaded": ";".join(sorted(found["blas_loaded"].split(";")))}
