# A set: the results of one commit, one build, one machine; its folder, and whether it may be continued.
import contextlib
import datetime
import shutil
import tempfile
from dataclasses import replace
from functools import cached_property

from analysis.core import records
from analysis.core.files import ROOT, StudyError, digest, read_object, write_json, write_text
from analysis.core.registry import Registry
from analysis.core.schema import need_unchanged
from analysis.core.view import Folder, context_in, facts_of, parts
from study.core import executor, locks, profile as profiles
from study.core.cell import CONTROL, Cell, control, on_usual_pairs
from study.core.executor import need_same, program_of

BEGUN = {".lock", "run.log", ".scratch", "registry.json", "profile.yaml", ".cluster", ".snakemake"}  # written before set.json, or on a cluster


class StudySet(Folder):
    profile = cached_property(lambda self: profiles.read(self.folder / "profile.yaml", self.facts["profile"], self.facts["parts"]))
    # Those of the selection on their usual pairs, in the registry's order.
    contenders = cached_property(lambda self: on_usual_pairs(self.registry, self.profile.blas, select(self.registry, self.facts["only"])))

    def context(self, one):
        """What is known of a contender's environment; asked of its program the first time."""
        path = self.folder / "contexts" / f"{one.environment.replace('|', '-')}.json"
        if not path.exists():
            write_json(path, context_of(one))
        return context_in(path)

    def need_programs(self, names):
        """StudyError naming a program (Cell.built) that changed since the set's records were made; notes new ones."""
        known = self.facts["programs"]
        found = {name: digest(path)[:16] for name in names for path in [ROOT / program_of(*name.split("@", 1))] if path.exists()}
        if set(found) - set(known):
            with locks.noting(self.folder):  # other nodes of a cluster note theirs
                known.update(facts_of(self.folder)["programs"])
                write_json(self.folder / "set.json", self.facts | {"programs": found | known})
                known.update(found | known)
        if changed := [name for name in found if known[name] != found[name]]:
            raise _other(self.folder, f"programs: {changed[0]} was built anew")

    def clear(self):
        """Removes what a process that was killed has left, in the set's own folders only."""
        shutil.rmtree(self.scratch, ignore_errors=True)
        self.scratch.mkdir(parents=True)
        own = [self.folder / name for name in ("raw", "contexts", ".done", "added", *parts())]
        for path in [*self.folder.glob(".partial-*"), *(path for base in own for path in base.rglob(".partial-*"))]:
            path.unlink()

    def stamp(self, part, column):
        """Is there when a column is done."""
        return self.folder / ".done" / part / column

    def page(self, part):
        """Is there when all columns of a part are done and drawn."""
        return self.folder / ".done" / f"{part}.page"

    progress = property(lambda self: self.folder / ".progress")
    scratch = property(lambda self: self.folder / ".scratch")
    log = property(lambda self: self.folder / "run.log")


def context_of(one):
    """The context of a contender's build and BLAS pair on this machine."""
    null = replace(one, variant=CONTROL.variant)
    cell = Cell("bench", "four-bar:1", (null,), ("--steps", 1, "--benchmark_repetitions=1", "--benchmark_min_time=0"))
    found = executor.run(cell.settled(), None)
    if not found["context"]:
        raise StudyError(f"{program_of(build=one.build)} bench does not work: {found['reason']}")
    return found["context"]


def listed():
    return Registry(_said(Cell("list")))


def describe(scene):
    """`mbs describe --json`"""
    return _said(Cell("describe", scene))


def _said(cell):
    """What the program says; StudyError with its own words if it refuses."""
    if not (ROOT / program_of()).exists():
        raise StudyError(f"{program_of()} is missing: build it with study/setup")
    found = executor.run(cell.settled(), None)
    if found["status"] != "done":
        raise StudyError(found["reason"].partition("mbs: ")[2] or f"`{' '.join(found['command'])}` does not work: {found['reason']}")
    return found["output"]


def opened(folder):
    """The StudySet in a folder; StudyError if it holds none, or one that is damaged or without parts."""
    if not (folder / "set.json").exists():
        raise StudyError(f"{folder} holds no set (no set.json)")
    found = StudySet(folder)
    if not found.facts["parts"]:
        raise StudyError(f"{folder / 'set.json'} has no parts: it is damaged, or of a tool's records")
    return found.need_whole()


def sets_in(*bases):
    """The sets in these folders, the newest first; what tools keep there has no parts, and is none."""
    found = [StudySet(path.parent) for base in bases for path in base.glob("*/set.json")]
    return sorted((one for one in found if one.facts["parts"]), key=lambda one: one.facts["date"], reverse=True)


def newest(base):
    """Folder of the newest set in `base`; StudyError if there is none."""
    if not (found := sets_in(base)):
        raise StudyError(f"{base.relative_to(ROOT)}/ holds no set: name one, or make one with study/run")
    return found[0].folder


def need_own(folder, begun=BEGUN, marks=frozenset({".lock"})):
    """StudyError if a folder holds anything but a set, or one that was just begun, which has one of `marks`: nothing of a user's is overwritten."""
    if not folder.is_dir() or (folder / "set.json").exists():
        return
    names = {path.name for path in folder.iterdir() if not path.name.startswith(".partial-")}
    if names and not (marks & names and names <= begun):
        raise StudyError(f"{folder} is not empty and holds no set (no set.json): name another directory with --results, or an empty one")


def writable(folder):
    """Makes a folder; StudyError unless it can be written to and has room."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise StudyError(f"cannot write to {folder}: {error.strerror}") from error
    if shutil.disk_usage(folder).free < 100 * 2**20:
        raise StudyError(f"less than 100 MB free for {folder}")


@contextlib.contextmanager
def beginning(folder):
    """Leaves nothing of a set that a StudyError keeps from being one: there is only what it began (need_own)."""
    try:
        yield
    except StudyError:
        if not (folder / "set.json").exists():
            shutil.rmtree(folder, ignore_errors=True)
        raise


def start(folder, profile, only, chosen, **more):
    """Records what a folder is for, with `more` facts, or continues it; StudyError if it holds results of something else."""
    registry = listed()
    select(registry, only)
    context = context_of(control(registry, profile.blas))
    record = begun(profile.name, only, chosen, context, **more)
    if (folder / "set.json").exists():
        known = opened(folder)
        need_same(known.facts["context"], context, str(folder))
        known.need_programs([*known.facts["programs"]])
        record |= kept_facts(known, profile, only, chosen)
    found = StudySet(folder)
    found.clear()
    write_json(folder / "registry.json", registry.listed)
    write_text(folder / "profile.yaml", _settings(profile))
    write_json(folder / "set.json", record)
    found.need_programs(["mbs"])  # a lab notes the others when it runs them
    return found


def begun(profile, only, chosen, context, **question):
    now = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M")
    return {"profile": profile, "only": only, "parts": chosen, "context": context, "programs": {}, "date": now, **question}


def need_question(known, **asked):
    """StudyError if a set holds results of something else."""
    for key, value in asked.items():
        if known.facts.get(key) != value:
            raise _other(known.folder, key)


def kept_facts(known, profile, only, chosen):
    """What stays of a set's facts when it is continued, with its parts then; StudyError if it holds results of something else."""
    old = known.facts
    need_question(known, profile=profile.name, only=only)
    if (known.folder / "profile.yaml").read_bytes() != _settings(profile).encode():
        raise _other(known.folder, "the profile's settings")
    return {"date": old["date"], "programs": old["programs"],
            "parts": [*old["parts"], *(part for part in chosen if part not in old["parts"])],
            **{key: old[key] for key in ("no_evidence",) if key in old}}


def _settings(profile):
    return (profiles.FOLDER / f"{profile.name}.yaml").read_text()


def _other(folder, what):
    return StudyError(f"{folder} holds results of something else ({what}); results are never merged: "
                      "name another directory with --results, or move this one away")


def select(registry, only, option="--only: "):
    """Names "folder/variant" that `only` selects, in the registry's order; empty selects all but examples. `option`: how they were asked for."""
    folders = {entry["folder"]: entry for entry in registry.entries}
    for name in only:
        entry = folders.get(name.split("/")[0])
        if entry and not entry["available"]:
            raise StudyError(f"{option}{name} is unavailable: {entry['reason']}")
        if entry and name in entry.get("lacking", {}):
            raise StudyError(f"{option}{name} is unavailable: {entry['lacking'][name]}")
        if name not in folders and name not in registry.variants:
            raise StudyError(f"{option}unknown implementation '{name}'; known: {', '.join([*folders, *registry.variants])}")
    return [name for name in registry.variants if name in only or name.split("/")[0] in only or not only and name not in registry.examples]


def finish(studyset, part, column, names):
    """Marks a column as done: its stamp lists its records with their digests."""
    write_json(studyset.stamp(part, column), {name: digest(studyset.folder / "raw" / part / name) for name in sorted(set(names))})


def unfinished(studyset, columns):
    """Those of `columns`, {part: {column: seconds}}, that are still to be run: also where a record is missing, or says that a program is
    which is there now. StudyError naming a record that was changed."""
    return {part: {name: seconds for name, seconds in names.items() for stamp in [studyset.stamp(part, name)]
                   if not stamp.exists() or _missing(studyset, stamp) or _there_now(studyset, stamp)} for part, names in columns.items()}


def reopen(studyset, columns):
    """Makes the workflow run what is unfinished, and draw pages that are missing or empty; StudyError naming a table that was changed."""
    if _empty(studyset.folder / "index.html"):
        studyset.page([*columns][-1]).unlink(missing_ok=True)  # it is drawn with each part
    for part, names in unfinished(studyset, columns).items():
        page, stamps = studyset.folder / f"{part}.html", [studyset.stamp(part, name) for name in names]
        if names or _empty(page):
            for path in (*(one for stamp in stamps for one in _there_now(studyset, stamp)), *stamps, studyset.page(part), page):
                path.unlink(missing_ok=True)  # the workflow runs nothing whose results are all there
    for part in parts():
        need_unchanged(studyset.folder, part)


def _there_now(studyset, stamp):
    """Paths of a column's records of programs that were not there, and are now."""
    known = read_object(stamp) if stamp.exists() else ()
    there = {name: path for name, path in records.files_of(studyset.folder, stamp.parent.name, stamp.name).items() if name in known}
    lacking = {path: one.cell["program"] for name, path in there.items() for one in [records.read(path, name)] if one.status == "unavailable"}
    return [path for path, program in lacking.items() if program != "mbs" and (ROOT / program_of(program)).exists()]


def _empty(page):
    return not page.exists() or page.stat().st_size == 0


def need_records(studyset):
    """StudyError naming a record of a finished column that is missing or was changed."""
    for stamp in sorted((studyset.folder / ".done").glob("*/[!.]*")):
        if missing := _missing(studyset, stamp):
            raise StudyError(f"{missing[0]} is missing: study/run measures it again")


def _missing(studyset, stamp):
    """Paths of a column's records that are not there; StudyError naming one that was changed or added."""
    known, there = read_object(stamp), records.files_of(studyset.folder, stamp.parent.name, stamp.name)
    for name, path in there.items():
        if name not in known:
            raise StudyError(f"{path} is no record of this study: remove it")
        if digest(path) != known[name]:
            records.read(path, name)  # says what is wrong with it
            raise StudyError(f"{path} is not the one that was measured: restore it, or remove it to have it measured again")
    return [studyset.folder / "raw" / stamp.parent.name / name for name in known if name not in there]
