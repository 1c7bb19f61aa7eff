# Profiles (study/profiles/NAME.yaml): how much of each part is run.
import importlib
from collections import namedtuple

from analysis.core.files import MEND, ROOT, StudyError, misfit, need_kind, read_yaml
from analysis.core.parts import parts

FOLDER = ROOT / "study" / "profiles"
MENDED = f"{FOLDER.relative_to(ROOT) / 'quick.yaml'} explains every setting"
STARTED, DRAWN = 4.5, 0.015  # s around the columns of a part, about: its process and pages; for each second of theirs, the last cells


# blas: {folder or "all": BLAS and LAPACK pair}; dropped: what a smaller budget leaves out, and why; parts: {part: its settings}
Profile = namedtuple("Profile", "name title blas dropped parts")


def names():
    return sorted(path.stem for path in FOLDER.glob("*.yaml"))


def load(name, chosen=None):
    """The profile called `name`; the settings of the `chosen` parts are checked, None: of all."""
    if name not in names():
        raise StudyError(f"unknown profile '{name}'; known: {', '.join(names())}")
    return read(FOLDER / f"{name}.yaml", name, chosen)


def read(path, name, chosen=None):
    """The profile in a file; StudyError if a setting is missing, unknown or of another kind. A set may be older than a part:
    its profile needs the `chosen` ones."""
    mend = MENDED if path.parent == FOLDER else MEND
    data = read_yaml(path, mend)
    need_keys(path, "the profile", data, {"title", "blas", "dropped", "parts"})
    if not isinstance(data["blas"], dict) or "all" not in data["blas"]:
        raise StudyError(f"{path}: blas must name a pair for all")
    need_kind(path, data, {"title": str, "blas": {...: str}, "dropped": str}, mend)
    more = data["parts"].keys() if chosen is not None and isinstance(data["parts"], dict) else ()
    need_keys(path, "parts", data["parts"], {*(parts() if chosen is None else chosen), *more})
    for part in parts() if chosen is None else chosen:
        settings, wanted = data["parts"][part], {"seconds": float, **plan_of(part).SETTINGS}
        need_keys(path, part, settings, set(wanted))
        for key, kind in wanted.items():
            where, value = f"{path}: {part}: {key}", settings[key]
            outer = kind if isinstance(kind, type) else type(kind)
            if misfit(value, outer):
                raise StudyError(f"{where} must be of type {outer.__name__}, is {value!r}")
            need_kind(path, settings, {key: kind}, mend)
            if kind in (int, float) and not 0 <= value < float("inf"):
                raise StudyError(f"{where} must be a number of at least 0, is {value!r}")
    return Profile(name, data["title"], data["blas"], data["dropped"], data["parts"])


def plan_of(part):
    return importlib.import_module(f"study.{part}.plan")


def columns_of(profile, chosen):
    """{part: {column: seconds at most}}, in the order of the list."""
    return {part: plan_of(part).columns(profile.parts[part]) for part in parts() if part in chosen}


def planned(columns):
    """s at most of {part: {column: seconds}}, with what is around the columns of each part."""
    return sum(STARTED + (1 + DRAWN) * sum(names.values()) for names in columns.values() if names)


def by_share(columns):
    """`columns` and `run` of a plan whose columns share out the part's seconds: {column: (its share, what runs it, of a lab)}."""
    def seconds(settings):
        return {name: share * settings["seconds"] for name, (share, _) in columns.items()}

    def run(lab, column):
        columns[column][1](lab)
    return seconds, run


def need_keys(path, what, data, keys):
    if not isinstance(data, dict):
        raise StudyError(f"{path}: {what} needs settings, found {type(data).__name__}")
    if wrong := sorted(map(str, set(data) ^ keys)):
        raise StudyError(f"{path}: {what}: missing or unknown: {', '.join(wrong)}")
