# Runs the battery: every cell by every implementation in each of its settings, each held to what the motion is known to be.
import numpy
import pandas

from study.extremes_study import settings, tools
from study.extremes_study.cells import CLASS, DENSE_LOOPS, battery
from study.pipeline import runs
from study.pipeline.layout import write_json

NOT_RUN = "not run"
FINER = (4, 8)          # the reference runs at a quarter and at an eighth of the step


def run(study):
    """{"battery": table}"""
    cells = battery()
    for cell in cells:
        if cell.document:
            path = study.layout.results / "scenes" / f"{cell.name}.json"
            if not path.exists():
                write_json(path, cell.document)
    jobs = [(cell, setting, one) for cell in cells for setting in settings.of(cell.axis, cell.label)
            for one in study.contenders if study.serves(one, *setting.needs())]
    unknown = [cell for cell in cells if cell.motion is None]
    finer = [(cell, factor) for cell in unknown for factor in FINER]
    references = dict(zip(finer, tools.side_by_side(
        study, lambda job: "battery reference", lambda job: _reference(study, *job), finer)))
    found = tools.side_by_side(study, lambda job: f"battery {job[0].axis}",
                               lambda job: _record(study, *job), jobs)
    return {"battery": pandas.DataFrame(
        [_row(study, *job, record, references) for job, record in zip(jobs, found)])}


def _path(study, cell, setting, contender):
    return (study.layout.results / "raw" / "battery" / cell.name
            / f"{contender.file_name}-{setting}.json")


def _scene(study, cell):
    return cell.scene or tools.path_of_scene(study, cell.name, cell.document)


def _record(study, cell, setting, contender):
    """None of what is not run."""
    if study.settings[contender.variant]["dense"] and cell.loops > DENSE_LOOPS:
        return None
    return runs.simulate(
        _path(study, cell, setting.file_name, contender), contender, _scene(study, cell), step=cell.step,
        duration=cell.duration, every=cell.every, context=study.context(contender),
        seconds=study.seconds, more=[*setting.options(), "--penalty", cell.penalty],
        columns=_columns(cell))


def _columns(cell):
    return list(cell.motion.solutions([0.0])[0]) if cell.motion else ["B.x", "B.y", "C.x", "C.y"]


def _reference(study, cell, factor):
    reference = tools.Reference()
    path = _path(study, cell, f"penalty-step-{factor}", reference)
    return runs.simulate(path, reference, _scene(study, cell), step=cell.step / factor,
                         duration=cell.duration, every=cell.every * factor,
                         context=study.context(reference), seconds=10 * study.seconds,
                         columns=_columns(cell))


def truth(cell, references, times):
    """([solutions], their own error in lengths, what they are), or ([], None, why there is none)."""
    if cell.motion:
        solutions = cell.motion.solutions(times)
        return solutions, _rounding(cell, solutions, times), "exact"
    quarter, eighth = (references[cell, factor] for factor in FINER)
    for record in (quarter, eighth):
        status, reason = runs.status(record)
        if status not in runs.FINISHED:
            return [], None, f"none: the reference ended as {status}: {reason}"
    fine, finest = ({column: values[:len(times)] for column, values in record["outputs"].items()}
                    for record in (quarter, eighth))
    solution = {column: finest[column] for column in _columns(cell)}
    # The error of the finer one of two runs of second order is a third of their difference.
    own = float(tools.distances(fine, solution, cell.length).max()) / 3 if len(times) else 0.0
    if not own <= CLASS / 10:
        return [], own, f"none: the reference's own error is {own:.1e}"
    return [solution], own, "reference at an eighth of the step"


def _rounding(cell, solutions, times):
    """The error of exact motions as they are evaluated in double, in lengths: an ulp of time and one of positions."""
    if not len(times):
        return 0.0
    ulp = numpy.finfo(float).eps
    moved = cell.motion.solutions(numpy.asarray(times) * (1 + ulp))
    return max(float(tools.distances(late, known, cell.length).max()
                     + ulp * max(abs(values).max() for values in known.values()) / cell.length)
               for late, known in zip(moved, solutions))


def _row(study, cell, setting, contender, record, references):
    row = {"axis": cell.axis, "value": cell.label, "implementation": contender.variant,
           "setting": setting.label}
    if record is None:
        return row | {"status": NOT_RUN, "reason": f"dense implementations run up to {DENSE_LOOPS} loops",
                      "silent": False}
    status, reason = runs.status(record)
    solutions, own, kind = truth(cell, references, record.get("outputs", {}).get("t", []))
    summary = record.get("summary", {})
    # Its own word, where it knows the exact motion, covers instants that the samples miss.
    reported = (summary.get("position_error_max") or 0.0) / cell.length
    error = float(numpy.maximum(tools.error_of(record, solutions, cell.length), reported))
    allowed = cell.allowed(solutions)
    return row | {
        "status": status, "reason": reason, "failed_at": summary.get("failed_at"), "true_error": error,
        "truth": kind, "truth_error": own, "class": allowed,
        "silent": bool(solutions) and tools.is_silent(record, error, allowed + own),
        "steps": cell.steps, "step": cell.step, "penalty": summary.get("penalty"),
        "passes_per_step": summary.get("passes_per_step"),
        "raw_file": study.layout.relative(_path(study, cell, setting.file_name, contender)),
        "command": runs.typed(record)}
