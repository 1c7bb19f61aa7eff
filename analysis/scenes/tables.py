# Rows of the gate, of the standard problems and their convergence, and of what modelling costs.
import numpy
import pandas

from analysis.core import timing
from analysis.core.contest import grouped
from analysis.core.controls import repeated
from analysis.core.files import StudyError
from analysis.core.outcomes import FINISHED, GOOD, of_run
from study.scenes import metric
from study.scenes.modelling import AGAIN, CASES, PLAIN
from study.scenes.problems import read_list
from study.scenes.references import EXTRAPOLATED, PUBLISHED, four_bar, kind, solution

NOT_JUDGED = "not judged"  # the precision of what has nothing to be compared with
ORDER_NOISE = 1e-9  # differences of successive steps below this share of a component are rounding
FIGURES = ("variables", "constraints", "penalty", "tolerance", "passes_per_step", "steps_at_limit", "energy_drift_max", "constraint_violation_max")


def build(records, view):
    listed = {problem.scene: problem for problem in read_list()[1]}
    found, runs = {"gate": [], "problems": [], "convergence": []}, {}
    for record in (one for one in records if one.role in ("gate", "compared", "everyone")):
        if (problem := listed.get(record.cell["scene"])) is None:
            raise StudyError(f"{record.name}: {record.cell['scene']} is no standard problem of study/scenes/problems.yaml")
        if record.role == "gate":
            found["gate"] += [{"problem": problem.name, "implementation": name, "verdict": verdict, "reason": reason, "record": record.name}
                              for name, (verdict, reason) in record.verdicts.items()]
        else:
            runs.setdefault(problem.name, {})[record.cell["contenders"][0], record.option("--step")] = record
    for problem in listed.values():
        found["problems"] += problem_rows(problem, runs.get(problem.name, {}))
        found["convergence"] += convergence_rows(problem, runs.get(problem.name, {}))
    by_role = grouped(records)
    found["modelling"] = list(modelling_rows(by_role))
    found["controls"] = repeated(*(timing.processes(by_role.get(f"time.{case}", [])) for case in (PLAIN, AGAIN.file_name)))
    order = {name: place for place, name in enumerate([*(problem.name for problem in listed.values()), *view.registry.variants])}
    for rows in found.values():  # as the lists have problems and implementations; steps and cases stay as they are
        rows.sort(key=lambda row: [order.get(row.get(key), 0) for key in ("problem", "implementation")])
    return found


def problem_rows(problem, runs):
    """One row a run. `runs`: {(implementation, step): record}."""
    for (name, step), record in runs.items():
        status, reason = of_run(record)
        row = {"problem": problem.name, "title": problem.title, "implementation": name,
               "compared": record.role == "compared", "step": step, "duration": problem.duration,
               "reference": kind(problem.known), "status": status, "reason": reason, "precision": NOT_JUDGED,
               "conserved": problem.conserved, "record": record.name} | {key: record.output.get(key) for key in FIGURES}
        known = _known(problem, runs, name, step) if status in FINISHED else None
        if known:
            row["error_rms"], row["error_max"] = metric.errors({column: _values(record, column) for column in known}, known)
            row["precision"] = metric.precision(row["error_rms"])
        if status in FINISHED and problem.mirrored:
            row["asymmetry"] = max(sum(abs(_values(record, f"{left}.{axis}") + sign * _values(record, f"{right}.{axis}")).max()
                                       for axis, sign in (("x", 1), ("y", -1))) for left, right in problem.mirrored)
        yield row


def _known(problem, runs, name, step):
    """{column: values} that a run is judged by, or None if what it needs is missing: self-convergence needs the
    finest two steps of the other one that is compared."""
    if problem.known != EXTRAPOLATED:
        known = solution(problem.known, tuple(numpy.round(_values(runs[name, step], "t"), 12)))
        return {column: known[column] for column in problem.columns(known)}
    other = next((one for one, _ in runs if one != name and runs[one, problem.steps[0]].role == "compared"), None)
    finer, finest = (runs.get((other, one)) for one in problem.steps[1:])
    if not _whole(finer, finest):
        return None
    return {column: metric.extrapolate(_values(finer, column), _values(finest, column)) for column in problem.columns(finest.series)}


def _whole(*records):
    return all(record and of_run(record)[0] in FINISHED for record in records)


def _values(record, column):
    return numpy.array(record.series[column], dtype=float)


def convergence_rows(problem, runs):
    """The final value of every judged component over three steps: order and extrapolated value; where it is
    published, that and by how much the extrapolated value differs."""
    published = PUBLISHED[problem.published]() if problem.published else {}
    for name in dict.fromkeys(name for (name, _), record in runs.items() if record.role == "compared"):
        three = [runs.get((name, step)) for step in problem.steps]
        if len(three) != 3 or not _whole(*three):
            continue
        for column in problem.columns(three[0].series):
            values = [_values(record, column)[-1] for record in three]
            limit, known = metric.extrapolate(*values[1:]), published.get(column, numpy.nan)
            yield {
                "problem": problem.name, "implementation": name, "component": column, "time": three[0].series["t"][-1],
                "coarse": values[0], "finer": values[1], "finest": values[2], "order": float(metric.observed_order(*values)),
                "order_meaningful": bool(abs(values[1] - values[2]) > ORDER_NOISE * max(abs(values[2]), 1e-3)),
                "extrapolated": limit, "published": known, "difference": limit - known, "record": three[2].name}


def modelling_rows(by_role):
    """One row for each implementation, size and case: error of the whole run, time of a step, and its ratio to the
    case that it is compared with, round by round."""
    loops_of = lambda scene: int(scene.rpartition("/")[2].partition("-")[0])  # which study/scenes/modelling.py wrote
    motions = {(record.cell["contenders"][0], loops_of(record.cell["scene"]), case): record
               for case in CASES for record in by_role.get(f"motion.{case.file_name}", [])}
    timed = pandas.concat([timing.processes(by_role.get(f"time.{case.file_name}", [])).assign(case=case.name) for case in CASES])
    timed["loops"] = [loops_of(scene) for scene in timed.scene]
    for (name, loops, case), record in sorted(motions.items(), key=lambda one: one[0][1]):
        status, reason = of_run(record)
        rows = timed[(timed.implementation == name) & (timed.loops == loops)]
        mine = rows[rows.case == case.name]
        good, wrong = mine[mine.status == "ok"], mine[mine.status != "ok"]
        by_case = timing.apart(rows.assign(implementation=rows.case))  # cases are compared as contenders are elsewhere
        cost = timing.ratio(by_case, case.name, case.base) if case.name != case.base else timing.Ratio(1.0, 1.0, 1.0)
        row = {"implementation": name, "loops": loops, "case": case.name, "piece": case.piece, "base": case.base,
               "status": status, "reason": reason, "rounds": len(good), "step_us": timing.median(good.step_us),
               "not_timed": "; ".join(f"{one.status}: {one.reason}" for one in wrong[:1].itertuples()),
               "record": " ".join([record.name, *good.record[:1]])} | {
            key: record.output.get(key) for key in (*FIGURES, "tangent_nonzeros")}
        if len(good):
            row |= cost.columns("ratio", "ratio_")
        if status in GOOD:
            exact = four_bar(_values(record, "t"), loops)
            row["position_error"] = max(abs(_values(record, column) - exact[column]).max() for column in ("B0.x", "B0.y"))
        yield row
