# Profiles (study/profiles/NAME.yaml): how much of each part is run.
import importlib
from collections import namedtuple

from analysis.core.files import ANY, MEND, ROOT, StudyError, need_kind, read_yaml
from analysis.core.view import parts

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
    wanted = {part: {"seconds": float, **plan_of(part).SETTINGS} for part in (parts() if chosen is None else chosen)}
    data = need_kind(path, read_yaml(path, mend), {"title": str, "blas": {"all": str, ...: str}, "dropped": str,
                                                   "parts": wanted if chosen is None else ANY | wanted}, mend)
    for part, kinds in wanted.items():
        for key, value in data["parts"][part].items():
            if kinds[key] in (int, float) and not 0 <= value < float("inf"):
                raise StudyError(f"{path}: {part}: {key} must be a number of at least 0, is {value!r}")
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
