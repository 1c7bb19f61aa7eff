# Files that a reader sees whole or not at all, digests that tell whether they are as they were written, and the one kind of error that a user
# can mend: a single clear line, exit status 2.
import contextlib
import hashlib
import json
import os
import threading
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parent.parent.parent
RULE = ROOT / "harness" / "src" / "describe" / "rule.json"  # what `mbs describe` applies: that of the set it names


class StudyError(Exception):
    """What is wrong, where, and what to do about it, in one line."""


def read_bytes(path):
    """What is in a file; StudyError if it cannot be read."""
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise StudyError(f"cannot read {path}: {error.strerror}") from error


def read_json(path):
    """The JSON in `path`; StudyError naming the file and the position if it is damaged."""
    try:
        return json.loads(read_bytes(path))
    except (ValueError, RecursionError) as error:  # of JSON and of UTF-8
        raise StudyError(f"{path} is damaged ({error})") from error


def read_object(path, **kinds):
    """The JSON object in `path`; StudyError naming the file unless it has these keys with values of these types."""
    found = read_json(path)
    if not isinstance(found, dict):
        raise StudyError(f"{path} is damaged (it is no object)")
    for name, kind in kinds.items():
        if not isinstance(found.get(name), kind):
            raise StudyError(f"{path} is damaged ({name} is {'of another type' if name in found else 'missing'})")
    return found


def from_yaml(text):
    """By libyaml where there is one: a tenth of the time."""
    return yaml.load(text, getattr(yaml, "CSafeLoader", yaml.SafeLoader))


def write_json(path, data):
    write_text(path, as_json(data))


def as_json(data):
    return json.dumps(data, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def write_text(path, text):
    write(path, lambda partial: partial.write_text(text, encoding="utf-8"))


def write(path, fill):
    """Calls `fill` with the path of a partial file, which then becomes `path`; StudyError if that fails."""
    path = Path(path)
    partial = path.with_name(f".partial-{os.uname().nodename}-{os.getpid()}-{threading.get_ident()}-{path.name}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        fill(partial)
        os.replace(partial, path)
    except OSError as error:
        raise StudyError(f"cannot write {path}: {error.strerror}") from error
    finally:
        with contextlib.suppress(OSError):  # of a folder that may not be written to
            partial.unlink(missing_ok=True)


def digest(data):
    """SHA-256 of bytes, of a text or of the file at a path."""
    data = read_bytes(data) if isinstance(data, Path) else data
    return hashlib.sha256(data.encode() if isinstance(data, str) else data).hexdigest()
