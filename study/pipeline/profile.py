# Reads and validates a profile (study/profiles/*.yaml): sizes, fills and every setting of a run.
from dataclasses import dataclass, field
from pathlib import Path

from study.pipeline.errors import StudyError

FOLDER = Path(__file__).resolve().parent.parent / "profiles"
NATURAL = "natural"
SETTINGS = {  # key: type; ../README.md and the profiles themselves say what each means
    "title": str, "seed": int, "step": float, "penalty": str, "rounds": int, "repetitions": int,
    "min_time": float, "stretch_lengths": list, "stretch_budget": dict,
    "pilot_steps": int, "exclusion_factor": dict, "limits": dict, "accuracy": dict, "blas": dict,
    "alternatives": list, "phases": dict, "operations": dict, "refine": dict, "columns": list,
}
PARTS = {  # key: exactly these keys below it
    "limits": {"pilot_seconds", "cell_seconds", "check_seconds", "simulate_seconds", "memory_mb"},
    "stretch_budget": {"natural", "filled"}, "exclusion_factor": {"natural", "filled"},
    "accuracy": {"duration", "penalties", "columns"}, "refine": {"seconds", "rounds"},
    "phases": {"columns", "rounds"}, "operations": {"columns", "rounds"},
}


@dataclass(frozen=True)
class Scene:
    """One cell column of the region map: a size and a fill; `fill` is None for the natural one."""
    variables: int
    fill: float | None

    @property
    def name(self):
        loops = self.variables // 2 - 1
        return f"four-bar:{loops}" + ("" if self.fill is None else f",fill={self.fill:.2f}")

    @property
    def label(self):
        return NATURAL if self.fill is None else f"fill{round(100 * self.fill):03d}"


@dataclass(frozen=True)
class Profile:
    name: str
    settings: dict
    columns: dict = field(default_factory=dict)     # variables -> [Scene], natural first
    exclusions: dict = field(default_factory=dict)  # variables -> its own factor at natural fill

    def __getattr__(self, key):
        try:
            return self.__dict__["settings"][key]
        except KeyError:
            raise AttributeError(key) from None

    def exclusion(self, scene):
        """A cell predicted slower than this times the best of its scene is not timed."""
        if scene.fill is not None:
            return self.exclusion_factor["filled"]
        return self.exclusions.get(scene.variables, self.exclusion_factor["natural"])


def names():
    return sorted(path.stem for path in FOLDER.glob("*.yaml"))


def load(name):
    """The profile called `name`; StudyError if there is none or a setting is wrong."""
    if name not in names():
        raise StudyError(f"unknown profile '{name}'; known: {', '.join(names())}")
    return read(FOLDER / f"{name}.yaml", name)


def read(path, name):
    import yaml  # here, so that a bad command line is refused before anything is installed
    try:
        data = yaml.safe_load(Path(path).read_text())
    except yaml.YAMLError as error:
        raise StudyError(f"{path}: not valid YAML: {' '.join(str(error).split())}") from error
    if not isinstance(data, dict):
        raise StudyError(f"{path}: needs settings, found {type(data).__name__}")
    wrong = sorted(set(data) ^ set(SETTINGS))
    if wrong:
        raise StudyError(f"{path}: missing or unknown settings: {', '.join(wrong)}")
    for key, kind in SETTINGS.items():
        accepted = (int, float) if kind is float else kind
        if not isinstance(data[key], accepted) or isinstance(data[key], bool):
            raise StudyError(f"{path}: {key} must be of type {kind.__name__}, is {data[key]!r}")
        if kind in (int, float) and not 0 < data[key] < float("inf"):
            raise StudyError(f"{path}: {key} must be positive, is {data[key]!r}")
    for key, parts in PARTS.items():
        if set(data[key]) != parts:
            raise StudyError(f"{path}: {key} must be exactly {', '.join(sorted(parts))}")
    for key, number in [(key, number) for key in ("refine", "exclusion_factor", "stretch_budget",
                                                  "phases", "operations", "limits")
                        for part, number in data[key].items() if part != "columns"]:
        if not isinstance(number, (int, float)) or isinstance(number, bool) or number < 0:
            raise StudyError(f"{path}: {key} needs numbers, found {number!r}")
    if "all" not in data["blas"]:
        raise StudyError(f"{path}: blas must name a pair for all")
    columns = dict(_column(path, entry) for entry in data["columns"])
    exclusions = {entry["variables"]: entry["exclusion"] for entry in data["columns"]
                  if "exclusion" in entry}
    for alternative in data["alternatives"]:
        _check_alternative(path, alternative, columns)
    for key in ("phases", "operations", "accuracy"):
        _need_columns(path, key, data[key]["columns"], columns)
    return Profile(name, data, columns, exclusions)


def _column(path, entry):
    if not isinstance(entry, dict) or set(entry) - {"exclusion"} != {"variables", "fills"}:
        raise StudyError(f"{path}: a column has exactly variables and fills, perhaps exclusion, "
                         f"found {entry!r}")
    variables, fills, exclusion = entry["variables"], entry["fills"], entry.get("exclusion", 2)
    if not isinstance(variables, int) or variables < 4 or variables % 2:
        raise StudyError(f"{path}: variables must be an even number >= 4, is {variables!r}")
    if not isinstance(exclusion, (int, float)) or exclusion <= 1:
        raise StudyError(f"{path}: exclusion must be a number above 1, is {exclusion!r}")
    if not fills or fills[0] != NATURAL:
        raise StudyError(f"{path}: fills of {variables} variables must start with {NATURAL}")
    for fill in fills[1:]:
        if not isinstance(fill, (int, float)) or not 0 < fill <= 1:
            raise StudyError(f"{path}: a fill is a share above 0 and up to 1, is {fill!r}")
    return variables, [Scene(variables, None)] + [Scene(variables, fill) for fill in fills[1:]]


def _check_alternative(path, entry, columns):
    kinds = {"blas", "builds"}
    keys = set(entry) if isinstance(entry, dict) else set()
    if keys - kinds != {"implementations", "columns"} or len(keys & kinds) != 1:
        raise StudyError(f"{path}: an alternative has exactly implementations, columns and one of "
                         f"blas and builds, found {entry!r}")
    for key in keys:
        if not isinstance(entry[key], list) or not entry[key]:
            raise StudyError(f"{path}: {key} of an alternative must be a list, is {entry[key]!r}")
    _need_columns(path, "alternatives", entry["columns"], columns)


def _need_columns(path, key, sizes, columns):
    unknown = [size for size in sizes if size not in columns]
    if unknown:
        raise StudyError(f"{path}: {key} name {unknown[0]!r}, which is no column; columns: "
                         f"{', '.join(map(str, columns))}")
