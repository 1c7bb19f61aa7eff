# Files that a reader sees whole or not at all, digests that tell whether they are as they were written, and the one kind of error that a user
# can mend: a single clear line, exit status 2.
import contextlib
import hashlib
import json
import os
import threading
from pathlib import Path

import yaml

MEND = "restore it from a copy or from git, or begin anew in another directory"
ROOT = Path(__file__).resolve().parent.parent.parent
ANY = {...: None}  # of `misfit`: other keys of an object
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
        raise damaged(path, error) from error


def read_object(path, **kinds):
    """The JSON object in `path`; StudyError naming the file unless it has these keys, perhaps more, with values of these kinds (of `misfit`)."""
    return need_kind(path, read_json(path), kinds | ANY)


def read_yaml(path, mend=MEND, **kinds):
    """The same of YAML; by Python's own loader, since libyaml's dies of a deep one."""
    try:
        found = yaml.safe_load(read_bytes(path).decode())
    # Those of YAML, of UTF-8, and whatever a wrong number, date or flag ends in.
    except (yaml.YAMLError, ValueError, LookupError, AttributeError, TypeError, ArithmeticError, RecursionError) as error:
        raise damaged(path, error, mend) from error
    return need_kind(path, found, kinds | ANY, mend)


def need_kind(path, found, kind, mend=MEND):
    """What was found in a file; StudyError naming the file unless it is of this kind."""
    if wrong := misfit(found, kind):
        raise damaged(path, wrong, mend)
    return found


def damaged(path, what, mend=MEND):
    return StudyError(f"{path} is damaged ({' '.join(str(what).split())[:300]}): {mend}")


def misfit(found, kind, name=""):
    """What keeps a value from being of a kind, in words; "" if nothing does. A kind is a type, several, [kind of all entries] or {key: kind}: an
    object that has these keys and no more, but "key?" may be missing, and `...` stands for all others. None is any. A flag is no number, a whole
    number is one."""
    kinds = kind if isinstance(kind, tuple) else (kind if isinstance(kind, type) else type(kind),)
    if kind is not None and type(found) not in kinds and not (float in kinds and type(found) is int):
        return f"{name or 'it'} must be of type {' or '.join(one.__name__ for one in kinds)}, is {found!r}"
    inner, within = [], name and f"{name}: "
    if isinstance(kind, list):
        inner = [(one, kind[0], f"entry {place}") for place, one in enumerate(found, 1)]
    elif isinstance(kind, dict):
        known = {str(key).removesuffix("?"): one for key, one in kind.items()}
        wrong = [f"{key} is missing" for key in kind if key is not ... and key not in found and not key.endswith("?")]
        if wrong := wrong + [f"{key} is unknown" for key in found if key not in known and ... not in kind]:
            return within + ", ".join(wrong)
        inner = [(one, known.get(key, kind.get(...)), key) for key, one in found.items()]
    return next(filter(None, (misfit(one, its, f"{within}{key}") for one, its, key in inner)), "")


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
