# Records: one for every cell, what was run and what came of it. Loose files while a study runs, an archive a part in a stored set.
#
# A record's file is {"sha256": D, "record": {…}} in two lines; D is the digest of the second one's value as it
# stands there, so that a changed or truncated file is named and never believed.
import gc
import io
import json
import lzma
import math
import re
import tarfile
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from analysis.core.files import StudyError, digest, read_bytes, write_text

gc.set_threshold(10**6)  # else garbage is looked for in all records again and again, a quarter of the time that they are made and used
RUN_ENDED = "done"  # status of a cell whose program ended as it should
KINDS = {"cell": dict, "status": str, "reason": str, "seconds": (int, float), "command": list, "context": dict}
MORE = {"output": dict, "series": dict, "machine": dict}  # which a record may have
FORM = re.compile(r'\{"sha256": "([0-9a-f]{64})",\n"record": (\{.*\})\}\n', re.S)


@dataclass(frozen=True)
class Record:
    """What a cell was and how it ended. `status`: "done", or why there is no output: "crashed", "timeout", "out-of-memory", "refused" (by the
    program, in a line), or of a cell that was not run "excluded", "unavailable", "not-reached", "dropped" (the budget), always with a `reason`."""
    name: str        # its file in raw/PART: "COLUMN/ROLE/WHO@WHAT-ID.json"
    cell: dict       # study/core/cell.py
    status: str
    reason: str
    seconds: float   # of the process
    command: list
    context: dict    # machine, build and BLAS of the run
    output: dict = field(default_factory=dict)  # what the program printed
    series: dict = field(default_factory=dict)  # {column: values} of the motion, where the cell keeps some
    machine: dict = field(default_factory=dict)  # of a timed cell: "steal", "mhz" (study/core/executor.py), "cpu_s", processor time of its process
    digest: str = ""  # of the file's text

    column = property(lambda self: self.name.partition("/")[0])
    role = property(lambda self: self.cell["role"])
    done = property(lambda self: self.status == RUN_ENDED)

    @cached_property
    def options(self):
        """{option: its value as text, "" without one} of its cell."""
        words = [str(word) for word in self.cell["settings"]]
        return {word.removeprefix("--"): "" if after.startswith("--") else after
                for word, after in zip(words, [*words[1:], "--"]) if word.startswith("--")}

    def option(self, name):
        """The number behind an option of its cell; NaN without one."""
        return float(self.options.get(name.removeprefix("--"), math.nan))

    @property
    def verdicts(self):
        """{contender: (verdict, reason)} of a check: the gate's, or how the process ended without one."""
        rows = {row["implementation"]: row for row in self.output.get("rows", []) if row["scene"] == self.cell["scene"]}
        none = {"verdict": "disagrees", "reason": "the check gave no verdict"} if self.done else {
            "verdict": self.status, "reason": f"the check: {self.reason}"}
        found = {name: rows.get(name.partition("+")[0], none) for name in self.cell["contenders"]}
        return {name: (row["verdict"], row["reason"]) for name, row in found.items()}


def to_text(data):
    line = json.dumps(data, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    return f'{{"sha256": "{digest(line)}",\n"record": {line}}}\n'


def from_text(text, name, where):
    """The Record in `text`; StudyError naming `where` if it is not what was written."""
    found = FORM.fullmatch(text)
    if not found or digest(found[2]) != found[1]:
        raise StudyError(f"{where} is {'changed' if found else 'truncated or no record'}: remove it to have it measured again, or restore it")
    data = json.loads(found[2])
    wrong = {*set(KINDS) - set(data), *set(data) - set(KINDS) - set(MORE),
             *(key for key, kind in (KINDS | MORE).items() if key in data and not isinstance(data[key], kind))}
    if wrong:
        raise StudyError(f"{where} is no record ({', '.join(sorted(wrong))}): remove it to have it measured again")
    return Record(name, **data, digest=found[1])


def write(path, data):
    write_text(path, to_text(data))


def read(path, name):
    return from_text(read_bytes(path).decode("utf-8", "replace"), name, path)


def need_same_origin(record, context, where):
    """StudyError if a record is of another machine or commit than the set's `context`."""
    for key in ("machine", "commit"):
        if record.context.get(key, context.get(key)) != context.get(key):
            raise StudyError(f"{where}: {record.name} is of another {key} than its set ({record.context[key]} instead of "
                             f"{context.get(key)}): remove it")


def files_of(folder, part, column="."):
    """{name: path} of the records of a part, or of one of its columns, that lie loose in a set's folder."""
    base = Path(folder) / "raw" / part
    found = {path.relative_to(base).as_posix(): path for path in (base / column).rglob("*.json")
             if path.parent != base / "scenes" and not path.name.startswith(".")}
    return dict(sorted(found.items()))  # as an archive has them


def archive_of(folder, part):
    return Path(folder) / "raw" / f"{part}.tar.xz"


def read_part(folder, part):
    """All records of a part, by name; of a stored set from its archive."""
    archive = archive_of(folder, part)
    if not archive.exists():
        return [read(path, name) for name, path in files_of(folder, part).items()]
    try:
        with lzma.open(archive) as file:  # all of it, as tarfile would not miss the end of a file that was cut
            whole = io.BytesIO(file.read())
        with tarfile.open(fileobj=whole) as tar:
            return [from_text(tar.extractfile(one).read().decode(), one.name, f"{archive}: {one.name}")
                    for one in sorted(tar, key=lambda one: one.name)
                    if one.name.endswith(".json") and one.name.rpartition("/")[0] != "scenes"]  # which a column may be called, too
    except (OSError, EOFError, lzma.LZMAError, tarfile.TarError, UnicodeDecodeError) as error:
        raise StudyError(f"{archive} is damaged ({error}): restore it") from error


def pack(folder, part, target):
    """Writes the archive of a part's records and scenes; equal records give equal archives."""
    base = Path(folder) / "raw" / part
    target.parent.mkdir(parents=True, exist_ok=True)
    with tarfile.open(target, "w:xz", preset=9) as tar:
        for path in sorted(path for path in base.rglob("*.json") if not path.name.startswith(".")):
            data = path.read_bytes()
            entry = tarfile.TarInfo(path.relative_to(base).as_posix())
            entry.size = len(data)
            tar.addfile(entry, io.BytesIO(data))
