# The standard problems: gate, accuracy against what is known, conserved energy, mirror symmetry.
#
# Two implementations run every problem at every step and are judged against what is known: a closed form,
# equations of motion of its own, or else the extrapolation of the *other* one. The last is self-convergence:
# both start from the same lowering of the scene, so that it checks the integration and not the modelling.
# Every implementation goes through the gate.
from dataclasses import dataclass
from pathlib import Path

import numpy
import pandas
import yaml

from study.pipeline import cells, child, runs
from study.pipeline.errors import StudyError
from study.pipeline.layout import read_json
from study.scene_study import metric
from study.scene_study.extrapolate import extrapolate, observed_order
from study.scene_study.references import EXTRAPOLATED, KNOWN, PUBLISHED, kind

LIST = Path(__file__).resolve().parent.parent / "problems.yaml"
SECONDS = 600  # a run at most
CHECK_SECONDS = 120
NOT_JUDGED = "not judged"  # the precision of what has nothing to be compared with
ORDER_NOISE = 1e-9  # differences of successive steps below this share of a component are rounding


@dataclass(frozen=True)
class Problem:
    name: str
    title: str
    scene: str
    duration: float
    steps: tuple
    known: str
    judged: tuple
    penalty: str = "auto"
    tolerance: str = "auto"
    max_passes: int = 20
    check_step: float | None = None
    conserved: bool = False
    mirrored: tuple = ()
    everyone: bool = False
    published: str | None = None

    @property
    def settings(self):
        return ["--penalty", f"{self.penalty}", "--tolerance", f"{self.tolerance}",
                "--max-passes", f"{self.max_passes}"]

    @property
    def names(self):
        """What the user may call it: names, title, scene file."""
        every = (self.name, self.title, Path(self.scene).stem)
        return tuple({name.lower(): name for name in every}.values())

    @property
    def file_name(self):
        return self.name.replace(" ", "-").lower()


def read_list():
    """(names of the two that are compared, [Problem])"""
    data = yaml.safe_load(LIST.read_text())
    listed = [Problem(**entry | {"steps": tuple(entry["steps"]), "judged": tuple(entry["judged"]),
                                 "mirrored": tuple(map(tuple, entry.get("mirrored", ())))})
              for entry in data["problems"]]
    for problem in listed:
        if problem.known not in {EXTRAPOLATED, *KNOWN}:
            raise StudyError(f"{LIST}: {problem.name}: unknown reference '{problem.known}'")
        if problem.published not in {None, *PUBLISHED}:
            raise StudyError(f"{LIST}: {problem.name}: unknown published values "
                             f"'{problem.published}'")
        if problem.known == EXTRAPOLATED and len(problem.steps) != 3:
            raise StudyError(f"{LIST}: {problem.name}: extrapolation needs three steps")
    return data["compared"], listed


def compared_of(preferred, names):
    """The two of `names` that run every problem at every step, of different folders: the preferred
    ones, others where these do not take part; fewer where there are no two."""
    chosen = [name for name in preferred if name in names]
    for name in names:
        if len(chosen) < 2 and name.split("/")[0] not in {one.split("/")[0] for one in chosen}:
            chosen.append(name)
    return chosen


def run_problem(problem, raw, contenders, compared, contexts, tell, stored=False):
    """Raw files of one problem: {"gate": {name: verdict}, "runs": {(name, step): record}}."""
    folder = raw / "problems" / problem.file_name
    found = {"gate": {}, "runs": {}}
    for one in contenders:
        tell(f"{problem.name}: gate, {one.name}")
        found["gate"][one.name] = _check(folder / f"gate-{one.file_name}.json", one, problem,
                                         contexts[one.environment], stored)
    for one in contenders:
        steps = problem.steps if one.name in compared else (
            problem.steps[:1] if problem.everyone else ())
        for step in steps:
            tell(f"{problem.name}: {one.name}, step {step:g} s")
            every = round(problem.duration / step) // metric.SAMPLES
            found["runs"][one.name, step] = runs.simulate(
                folder / f"{one.file_name}-{step:g}.json", one, problem.scene, step=step,
                duration=problem.duration, every=every, context=contexts[one.environment],
                seconds=SECONDS, more=problem.settings, stored=stored)
    return found


def _check(path, contender, problem, context, stored):
    if path.exists():
        return read_json(path)
    runs.need(stored, path)
    partial = path.with_name(path.name + ".partial")
    partial.parent.mkdir(parents=True, exist_ok=True)
    settings = ["--step", f"{problem.check_step:g}"] if problem.check_step else [
        "--step", f"{problem.steps[0]:g}", *problem.settings]
    command = contender.call("check", problem.scene, *settings, "--time-limit", str(CHECK_SECONDS), "--json",
                             str(partial), "--implementation", contender.variant)
    ended = child.run(command, 2 * CHECK_SECONDS, runs.MEMORY_MB, partial)
    if partial.exists() and ended.status == "exited":
        partial.replace(path)
        return read_json(path)
    partial.unlink(missing_ok=True)
    status = "crashed" if ended.status == "exited" else ended.status
    row = {"scene": problem.scene, "implementation": contender.variant, "verdict": status,
           "reason": ended.reason, "checks": []}
    cells.write_json(path, {"context": context, "rows": [row]})
    return read_json(path)


def columns_of(problem, outputs):
    """The columns of the judged outputs, in the order of the file."""
    return [column for column in outputs if column.split(".")[0] in problem.judged]


def known_solution(problem, found, judged_one, compared):
    """{column: values} that `judged_one` is judged by, or None if what it needs failed."""
    times = _times(found["runs"][judged_one, problem.steps[0]])
    if problem.known != EXTRAPOLATED:
        solution = KNOWN[problem.known](times)
        return {name: values for name, values in solution.items()
                if name.split(".")[0] in problem.judged}
    other = next((name for name in compared if name != judged_one), None)
    finer, finest = (found["runs"].get((other, step)) for step in problem.steps[1:])
    if any(record is None or runs.status(record)[0] not in runs.FINISHED for record in (finer, finest)):
        return None
    return {column: extrapolate(_values(finer, column), _values(finest, column))
            for column in columns_of(problem, finest["outputs"])}


def _values(record, column):
    return numpy.array(record["outputs"][column])


def _times(record):
    return numpy.array(record["outputs"]["t"])


def rows(problem, found, compared, layout_relative):
    """The rows of problems.csv."""
    result = []
    for (name, step), record in found["runs"].items():
        status, reason = runs.status(record)
        row = {"problem": problem.name, "title": problem.title, "scene": problem.scene,
               "implementation": name, "step": step, "duration": problem.duration,
               "known": problem.known, "reference": kind(problem.known), "status": status, "reason": reason,
               "error_rms": numpy.nan, "error_max": numpy.nan, "precision": NOT_JUDGED}
        if "summary" in record:
            summary = record["summary"]
            row |= {key: summary[key] for key in (
                "variables", "constraints", "penalty", "tolerance", "passes_per_step",
                "steps_at_limit", "energy_drift_max", "constraint_violation_max", "setup_us")}
            row["step_us"] = summary["step_us"]["median"]
        known = known_solution(problem, found, name, compared) if status in runs.FINISHED else None
        if known:
            square, largest = metric.errors(
                {column: _values(record, column) for column in known}, known)
            row |= {"error_rms": square, "error_max": largest,
                    "precision": metric.precision(square)}
        if status in runs.FINISHED and problem.mirrored:
            row["asymmetry"] = max(
                max(abs(_values(record, f"{left}.x") + _values(record, f"{right}.x"))) +
                max(abs(_values(record, f"{left}.y") - _values(record, f"{right}.y")))
                for left, right in problem.mirrored)
        row["conserved"] = problem.conserved
        row["raw_file"] = layout_relative(f"problems/{problem.file_name}", name, step)
        result.append(row)
    return result


def gate_rows(problem, found):
    """The rows of gate.csv: one for each implementation."""
    return [{"problem": problem.name, "implementation": name,
             "verdict": record["rows"][0]["verdict"], "reason": record["rows"][0]["reason"]}
            for name, record in found["gate"].items()]


def convergence_rows(problem, found, compared):
    """The final value of every judged component over three steps: order and extrapolated value; where it
    is published, that and by how much the extrapolated value differs."""
    result = []
    published = PUBLISHED[problem.published]() if problem.published else {}
    for name in compared:
        records = [found["runs"].get((name, step)) for step in problem.steps]
        if len(records) != 3 or any(record is None or runs.status(record)[0] not in runs.FINISHED
                                    for record in records):
            continue
        for column in columns_of(problem, records[0]["outputs"]):
            values = [_values(record, column)[-1] for record in records]
            limit, known = extrapolate(*values[1:]), published.get(column, numpy.nan)
            result.append({
                "problem": problem.name, "implementation": name, "component": column,
                "time": _times(records[0])[-1], "coarse": values[0], "finer": values[1],
                "finest": values[2], "order": float(observed_order(*values)),
                "order_meaningful": abs(values[1] - values[2]) > ORDER_NOISE * max(
                    abs(values[2]), 1e-3),
                "extrapolated": limit, "published": known, "difference": limit - known})
    return result


def tables(found_all, compared, layout_relative):
    """{file name: DataFrame}"""
    pairs = list(found_all.items())
    return {
        "problems": pandas.DataFrame([row for problem, found in pairs for row in rows(
            problem, found, compared, layout_relative)]),
        "gate": pandas.DataFrame([row for problem, found in pairs
                                  for row in gate_rows(problem, found)]),
        "convergence": pandas.DataFrame([row for problem, found in pairs for row in
                                         convergence_rows(problem, found, compared)])}
