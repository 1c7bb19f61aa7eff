# What must be in place before the workflow starts: build, modules, a results directory that fits.
import fcntl
import hashlib
import importlib.util
import json
import os
import shutil
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

from study.pipeline import cells, profile as profiles
from study.pipeline.builds import build
from study.pipeline.contenders import contenders, control, to_json, wanted_builds
from study.pipeline.errors import StudyError
from study.pipeline.front import Display
from study.pipeline.layout import ROOT, fingerprint, program, read_json, read_run, write_json

MODULES = {"yaml": "python3-yaml", "pandas": "python3-pandas", "matplotlib": "python3-matplotlib",
           "jinja2": "python3-jinja2", "snakemake": "snakemake", "scipy": "python3-scipy"}


def set_up(layout):
    """Runs study/setup; shows its last line while it works and all of its end if it fails."""
    display = Display()
    display.show("set-up")
    with open(layout.log, "a", encoding="utf-8") as log:
        process = subprocess.Popen([str(ROOT / "study" / "setup")], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True, errors="replace")
        lines = []
        for line in process.stdout:
            lines = lines[-20:] + [line.rstrip()]
            log.write(line)
            display.show("set-up", line.strip())
    display.end()
    if process.wait() != 0:
        print("\n".join(lines), file=sys.stderr)
        raise StudyError(f"set-up failed, see above (log: {layout.log})")


def start(layout, profile, only):
    """Records what this results directory is for, or refuses one that is for something else."""
    known = registry()
    record = run_record(layout, profile, only, known)
    text = (profiles.FOLDER / f"{profile.name}.yaml").read_text()
    stored_text = layout.results / "profile.yaml"
    if continues(layout, record, ("profile", "variants", "contenders", "programs")):
        if stored_text.read_text() != text:
            raise _other(layout, "the profile's settings")
        return
    write_json(layout.registry, known)
    stored_text.write_text(text)
    write_json(layout.run, record)


def continues(layout, record, keys):
    """Whether this results directory holds a run with `record`; False if it holds none. StudyError if
    it is one of something else: another machine, build or BLAS in "contexts", or one of `keys`."""
    if not layout.run.exists():
        return False
    stored = read_run(layout, {"contexts", *keys})
    differing = [text for environment, context in stored["contexts"].items()
                 for text in _differing(context, record["contexts"].get(environment, {}))]
    differing += [_changed(key, stored[key], record[key]) for key in keys if stored[key] != record[key]]
    if differing:
        raise _other(layout, differing[0])
    return True


def _changed(key, old, new):
    """What differs between two values of run.json."""
    if key != "inputs":
        return key
    names = [name for name in {**old, **new} if old.get(name) != new.get(name)]
    return "inputs: " + ", ".join(f"{name} {old.get(name, 'none')}, now {new.get(name, 'none')}" for name in names)


def _other(layout, what):
    return StudyError(f"{layout.results} holds results of something else ({what}); results are never "
                      "merged: name another directory with --results, or move this one away")


def run_record(layout, profile, only, known):
    variants = select(known, only)
    broken = _build_others(layout, wanted_builds(profile, variants))
    own, found, contexts = control(profile, known), [], {}
    contexts[own.environment] = cells.context(own)
    for one in contenders(profile, known, variants, broken):
        if not one.missing and one.environment not in contexts:
            try:
                contexts[one.environment] = cells.context(one)
            except StudyError as error:
                if one.ranked:
                    raise
                one = replace(one, missing=str(error))
        found.append(one)
    builds = {"": ROOT / program()} | {
        one.build: ROOT / program(one.build) for one in found if not one.missing}
    return {"profile": profile.name, "only": only, "variants": variants,
            "contenders": to_json(found), "control": to_json([own])[0], "contexts": contexts,
            "blas": {one.name: one.blas for one in found if one.ranked},
            "builds": {one.build: {key: contexts[one.environment][key]
                                   for key in ("compiler", "flags")}
                       for one in [own, *found] if not one.missing},
            "programs": {name: digest(path) for name, path in builds.items()}}


def _build_others(layout, builds):
    """{build: why it failed} of the builds that are not the study's own."""
    if "MBS_PROGRAM" in os.environ:
        return {}
    display = Display()
    with open(layout.log, "a", encoding="utf-8") as log:
        broken = {name: build(name, log, lambda line: display.show("set-up", line))
                  for name in builds}
    display.end()
    return {name: reason for name, reason in broken.items() if reason}


def _differing(old, new):
    old, new = fingerprint(old), fingerprint(new)
    return [f"{key} '{old[key]}', now '{new[key]}'" for key in old if old[key] != new[key]]


def reopen_incomplete(layout, profile):
    """Makes the workflow redo a column of which a raw file was removed; what exists is kept."""
    stamps = {layout.measured(variables): [layout.plan(variables)]
              for variables in profile.columns} | {layout.refined_stamp: []}
    for stamp, plans in stamps.items():
        if stamp.exists() and not all((layout.results / name).exists()
                                      for name in read_json(stamp)["files"]):
            derived = (layout.results / name for name in ("tidy.csv", "report.html"))
            for path in (stamp, *plans, layout.refined_stamp, *derived):
                path.unlink(missing_ok=True)


def digest(path):
    """Tells two builds of one commit, or two states of a file, apart."""
    return hashlib.sha256(path.read_bytes()).hexdigest()[:12]


def digest_of_scene(scene):
    """Of a scene's file, relative to ROOT as programs are run there; "" for a name of `mbs`."""
    path = ROOT / scene
    return digest(path) if path.is_file() else ""


def registry():
    """`mbs list --json`."""
    if not (ROOT / program()).exists():
        raise StudyError(f"{program()} is missing: build it with study/setup")
    result = subprocess.run([program(), "list", "--json"], cwd=ROOT, capture_output=True, text=True)
    try:
        return json.loads(result.stdout)
    except ValueError as error:
        raise StudyError(f"`{program()} list --json` does not work: {result.stderr.strip()}"
                         ) from error


def start_named(layout, name, only, inputs):
    """Records for the study `name` build, machine, selection and what identifies the `inputs`, or
    refuses a directory that holds results of others."""
    usual = profiles.load("quick")
    profile = replace(usual, name=name, settings=usual.settings | {"alternatives": []})
    known = registry()
    # As it is read back: a tuple would differ from its list.
    record = run_record(layout, profile, only, known) | {"inputs": json.loads(json.dumps(inputs))}
    if not continues(layout, record, ("variants", "contenders", "programs", "inputs")):
        write_json(layout.registry, known)
        write_json(layout.run, record)


def select(known, only):
    """Names "folder/variant" that `only` selects, in the registry's order; empty selects all."""
    entries = {entry["folder"]: entry for entry in known["implementations"]}
    names = [variant["name"] for entry in entries.values() if entry["available"]
             for variant in entry["variants"]]
    for name in only:
        entry = entries.get(name.split("/")[0])
        if entry and not entry["available"]:
            raise StudyError(f"--only {name}: unavailable: {entry['reason']}")
        if name not in entries and name not in names:
            raise StudyError(f"--only: unknown implementation '{name}'; known: "
                             f"{', '.join([*entries, *names])}")
    return [name for name in names if not only or name in only or name.split("/")[0] in only]


def need_modules(*modules):
    for module in modules or MODULES:
        if importlib.util.find_spec(module) is None:
            raise StudyError(f"Python module {module} is missing for /usr/bin/python3: run "
                             f"study/setup, or apt-get install {MODULES[module]}")


def writable(results):
    try:
        results.mkdir(parents=True, exist_ok=True)
        probe = results / ".writable"
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise StudyError(f"cannot write to {results}: {error.strerror}") from error
    if shutil.disk_usage(results).free < 100 * 2**20:
        raise StudyError(f"less than 100 MB free for {results}")


def only_one(layout):
    """Holds the results directory; the lock vanishes with its process."""
    return _lock(layout.results / ".lock", f"another study is running in {layout.results}")


def only_one_measuring():
    """Holds the machine: two studies that measure at once would time each other."""
    path = Path(tempfile.gettempdir()) / "mbs-study.lock"
    return _lock(path, "another study is measuring on this machine, in other results "
                       f"({path} is held): wait until it is done")


def _lock(path, held):
    try:
        # Another user's file in /tmp can be opened for reading only, and not with O_CREAT.
        file = os.open(path, os.O_RDONLY | (0 if path.exists() else os.O_CREAT), 0o644)
    except OSError as error:
        raise StudyError(f"cannot open the lock {path}: {error.strerror}") from error
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        os.close(file)
        raise StudyError(held) from error
    return os.fdopen(file)
