# Reads and validates a profile (study/profiles/*.yaml): sizes, fills and every setting of a run.
from dataclasses import dataclass, field
from pathlib import Path

from study.pipeline.errors import StudyError

FOLDER = Path(__file__).resolve().parent.parent / "profiles"
NATURAL = "natural"
SETTINGS = {  # key: type; ../README.md and the profiles themselves say what each means
    "title": str, "seed": int, "step": float, "penalty": str, "rounds": int, "repetitions": int,
    "min_time": float, "stretch_lengths": list, "stretch_budget": dict, "pilot_steps": int,
    "exclusion_factor": float, "limits": dict, "accuracy": dict, "columns": list,
}
LIMITS = {"pilot_seconds", "cell_seconds", "check_seconds", "simulate_seconds", "memory_mb"}


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
    columns: dict = field(default_factory=dict)  # variables -> [Scene], natural first

    def __getattr__(self, key):
        try:
            return self.__dict__["settings"][key]
        except KeyError:
            raise AttributeError(key) from None


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
    if set(data["limits"]) != LIMITS:
        raise StudyError(f"{path}: limits must be exactly {', '.join(sorted(LIMITS))}")
    if set(data["stretch_budget"]) != {"natural", "filled"}:
        raise StudyError(f"{path}: stretch_budget must be exactly natural, filled")
    if set(data["accuracy"]) != {"duration", "penalties"}:
        raise StudyError(f"{path}: accuracy must be exactly duration, penalties")
    return Profile(name, data, dict(_column(path, entry) for entry in data["columns"]))


def _column(path, entry):
    if not isinstance(entry, dict) or set(entry) != {"variables", "fills"}:
        raise StudyError(f"{path}: a column has exactly variables and fills, found {entry!r}")
    variables, fills = entry["variables"], entry["fills"]
    if not isinstance(variables, int) or variables < 4 or variables % 2:
        raise StudyError(f"{path}: variables must be an even number >= 4, is {variables!r}")
    if not fills or fills[0] != NATURAL:
        raise StudyError(f"{path}: fills of {variables} variables must start with {NATURAL}")
    for fill in fills[1:]:
        if not isinstance(fill, (int, float)) or not 0 < fill <= 1:
            raise StudyError(f"{path}: a fill is a share above 0 and up to 1, is {fill!r}")
    return variables, [Scene(variables, None)] + [Scene(variables, fill) for fill in fills[1:]]
