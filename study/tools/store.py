# study/store [DIR] [NAME]: a finished set as results/NAME: an archive of records a part, its tables and answers. Pages and figures are left out,
# since study/figures draws them from these; pictures that a text shows are kept.
import contextlib
import os
import re
import shutil
import subprocess
from pathlib import Path

from analysis.core import records, schema
from analysis.core.files import ROOT, StudyError, read_object
from analysis.core.text import layout
from analysis.core.view import parts
from study.core import locks
from study.core.options import Parser, directory
from study.core.profile import columns_of
from study.core.studyset import need_records, newest, opened
from study.tools import fragments
from study.tools.merge import agreement, machine

RESULTS = ROOT / "results"
MOST = 3  # sets
OF_ALL = ("set.json", "registry.json", "profile.yaml", "contexts")
SHOWN = re.compile(r"results/[\w.+-]+/(\w+/figures/[\w.+-]+\.svg)")
COMMON = {"r", "tm", "cpu", "processor", "family", "model", "stepping", "core", "intel", "amd"}  # words of processors


def store(arguments):
    parser = Parser(prog="study/store", description="Stores a finished set of a clean tree in results/NAME, to be committed.")
    parser.add_argument("set", nargs="?", type=directory, metavar="DIR", help="its directory (the newest in results/local)")
    parser.add_argument("name", nargs="?", metavar="NAME", help="(PROFILE-PROCESSOR)")
    options = parser.parse_args(arguments)
    folder = options.set or newest(RESULTS / "local")
    studyset = opened(folder)
    with locks.only_one(RESULTS), locks.only_one(folder):
        studyset.clear()  # what was killed may have left a half-written table
        need_whole(studyset)
        name = options.name if options.name is not None else f"{studyset.facts['profile']}-{short(studyset.facts['context']['cpu_model'])}"
        if not re.fullmatch(r"[A-Za-z0-9][\w.+-]*", name) or name == "local":
            raise StudyError(f"'{name}' is no name of a set: letters, digits, dots and dashes")
        if (RESULTS / name).exists():
            raise StudyError(f"results/{name} is there already: remove it, or choose another NAME")
        if len(stored := sorted(path.parent.name for path in RESULTS.glob("*/set.json"))) >= MOST:
            raise StudyError(f"results/ holds {MOST} sets already, which is the most: remove one of {', '.join(stored)}")
        pictures = _build(studyset, name)
    known = {"name": name, "sizes": [path.stat().st_size for path in (RESULTS / name).rglob("*") if path.is_file()], "pictures": pictures,
             "added": (folder / "added").exists()}
    try:
        known["texts"] = [path.relative_to(ROOT) for path in fragments.refresh()]
    except StudyError as error:
        known |= {"texts": [], "why": error}
    print(layout(Path(__file__).with_name("store.txt.j2")).render(known))


def short(processor):
    """"epyc-25-17" of "AMD EPYC (family 25, model 17, stepping 1)"."""
    words = [word for word in re.findall(r"[a-z0-9]+", processor.lower().partition("@")[0]) if word not in COMMON]
    return "-".join(words[:3]) or "machine"


def faults(kept):
    """What is wrong with a set, a line each: a changed tree, several commits or machines, a missing part, tables that its records do not make."""
    usual = kept.facts["context"]
    with contextlib.suppress(StudyError):  # of a changed table, which is said below
        if why := machine.no_evidence(kept):
            yield f"{kept.folder} is no evidence: {why}"
    for path, context in agreement.contexts(kept).items():
        if str(context.get("dirty")).lower() != "false":
            yield f"{path}: it was measured from a dirty tree (dirty is {context.get('dirty')}): commit, build and measure again"
        yield from (f"{path}: is of another {key} than its set" for key in ("commit", "machine") if context.get(key) != usual.get(key))
    yield from _lacking(kept)
    yield from of_records(kept)


def of_records(kept):
    """What is wrong with its records and the tables that were made of them."""
    for part in kept.facts["parts"]:
        try:
            schema.records_of(kept.folder, part, kept.facts["context"], drawn=True)
        except StudyError as error:
            yield str(error)


def _lacking(kept):
    return [f"{kept.folder} lacks {part}: a stored set has all parts" for part in parts() if part not in kept.facts["parts"]]


def need_commit(where, commit):
    """StudyError naming `where` if what is there is of a commit that this repository does not have."""
    if subprocess.run(["git", "cat-file", "-e", f"{commit}^{{commit}}"], cwd=ROOT, capture_output=True).returncode != 0:
        raise StudyError(f"{where}: it is of {commit}, which is no commit of this repository")


def need_whole(studyset):
    """StudyError naming what is not finished, or not as it was measured."""
    for fault in _lacking(studyset):
        raise StudyError(fault)
    need_commit(studyset.folder / "set.json", studyset.facts["context"].get("commit"))
    need_records(studyset)
    for part, columns in columns_of(studyset.profile, studyset.facts["parts"]).items():
        for column in columns:
            if not studyset.stamp(part, column).exists():
                raise StudyError(f"{studyset.folder} is not finished: {part}/{column} has not ended; run study/run again")
        for name, path in records.files_of(studyset.folder, part).items():
            if name.partition("/")[0] not in columns:
                raise StudyError(f"{path} belongs to no column that has ended: remove it, and run study/run again")
    for fault in faults(studyset):
        raise StudyError(fault)


def _build(studyset, name):
    """Writes all beside its place, then moves it there; the pictures that were kept."""
    for path in RESULTS.glob(".storing-*"):  # of a process that was killed
        shutil.rmtree(path)
    building = RESULTS / f".storing-{name}"
    try:
        building.mkdir(parents=True)
        for shared in OF_ALL:
            source = studyset.folder / shared
            (shutil.copytree if source.is_dir() else shutil.copyfile)(source, building / shared)
        for part in studyset.facts["parts"]:
            (building / part).mkdir()
            for path in sorted(path for path in (studyset.folder / part).iterdir() if path.suffix in (".csv", ".json")):
                shutil.copyfile(path, building / part / path.name)
            records.pack(studyset.folder, part, records.archive_of(building, part))
            if schema.digest_of(records.read_part(building, part)) != read_object(building / part / schema.DIGESTS, records=str)["records"]:
                raise StudyError(f"{studyset.folder / 'raw' / part} changed while it was stored")
        pictures = sorted({tail for text in fragments.texts() for tail in SHOWN.findall(text.read_text(encoding="utf-8"))
                           if (studyset.folder / tail).exists()})
        for tail in pictures:
            (building / tail).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(studyset.folder / tail, building / tail)
        os.rename(building, RESULTS / name)
    except OSError as error:
        raise StudyError(f"cannot store results/{name}: {error.strerror}") from error
    finally:
        shutil.rmtree(building, ignore_errors=True)
    return pictures
