# The standard problems of problems.yaml: what is run, and what it is judged by.
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from analysis.core.files import StudyError, from_yaml
from study.scenes.references import EXTRAPOLATED, KNOWN, PUBLISHED

LIST = Path(__file__).resolve().parent / "problems.yaml"


@dataclass(frozen=True)
class Problem:
    name: str
    title: str
    scene: str
    duration: float
    steps: tuple
    known: str
    judged: tuple
    link: float = 1.0
    penalty: str = "auto"
    tolerance: str = "auto"
    max_passes: int = 20
    check_step: float | None = None
    conserved: bool = False
    mirrored: tuple = ()
    everyone: bool = False
    published: str | None = None

    options = property(lambda self: (("penalty", f"{self.penalty}"), ("tolerance", f"{self.tolerance}"), ("max-passes", f"{self.max_passes}")))
    settings = property(lambda self: tuple(word for option, value in self.options for word in (f"--{option}", value)))

    def columns(self, outputs):
        """The columns of the judged outputs, in the order of the file."""
        return [column for column in outputs if column.split(".")[0] in self.judged]


@cache
def read_list(path=LIST):
    """(names of the two that are compared, [Problem])"""
    data = from_yaml(path.read_text(encoding="utf-8"))
    listed = [Problem(**entry | {key: tuple(map(tuple, entry[key])) if key == "mirrored" else tuple(entry[key])
                                 for key in ("steps", "judged", "mirrored") if key in entry}) for entry in data["problems"]]
    for problem in listed:
        if problem.known not in {EXTRAPOLATED, *KNOWN}:
            raise StudyError(f"{path}: {problem.name}: unknown reference '{problem.known}'")
        if problem.published not in {None, *PUBLISHED}:
            raise StudyError(f"{path}: {problem.name}: unknown published values '{problem.published}'")
        if problem.known == EXTRAPOLATED and len(problem.steps) != 3:
            raise StudyError(f"{path}: {problem.name}: extrapolation needs three steps")
    return data["compared"], listed


def compared_of(preferred, names):
    """The two of `names` that run every problem at every step, of different folders: the preferred
    ones, others where these do not take part; fewer where there are no two."""
    chosen = [name for name in preferred if name in names]
    for name in names:
        if len(chosen) < 2 and name.split("/")[0] not in {one.split("/")[0] for one in chosen}:
            chosen.append(name)
    return chosen
