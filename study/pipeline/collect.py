# Derives the tidy tables of one results directory from its raw files and plans.
import sys

import pandas

from study.pipeline import cells
from study.pipeline.errors import StudyError
from study.pipeline.layout import fingerprint, read_json, read_run, write_csv, write_json
from study.pipeline.marks import mark_differing_passes, mark_lost_cells
from study.pipeline.measure import operating, planned, processes
from study.pipeline.profile import Scene
from study.pipeline.verify import accuracy_runs

PHASES = ("evaluation", "assembly", "factorization", "solve", "projection", "other")
COUNTERS = ("passes", "steps_at_limit", "setup_us", "constraints", "penalty", "step", "tolerance",
            "max_passes", "start", "fill_seed", "position_error", "constraint_violation",
            "energy_drift")
PER_SAMPLE = ("stretch_steps", "iterations", "stretch_us", "step_us") + COUNTERS
# results/README.md says what each column means.
TIDY = ("kind", "stage", "scene", "implementation", "folder", "variant", "blas", "build",
        "operation", "variables", "fill_asked", "fill_percent", "status", "reason", "round",
        "repetition") + PER_SAMPLE + (
        tuple(f"phase_{phase}" for phase in PHASES) + (
            "operation_us", "pilot_step_us", "pilot_ratio", "machine", "commit", "dirty",
            "raw_file"))
VERIFICATION = ("scene", "implementation", "variables", "fill_asked", "verdict", "reason", "check",
                "value", "tolerance", "passed", "detail")
ACCURACY = ("scene", "implementation", "variables", "penalty_asked", "penalty", "step", "tolerance",
            "duration", "status", "status_reason", "failed_at", "steps", "passes_per_step",
            "position_error_max", "energy_drift_max", "constraint_violation_max", "setup_us",
            "step_us_median", "step_us_p99", "step_us_max", "raw_file")


def collect(study, folder=None):
    """Writes tidy.csv, verification.csv, accuracy.csv and context.json into `folder`, by default
    that of the results."""
    folder = folder or study.layout.results
    plans, added = _plans(study), _added(study)
    machine = _machine(study)
    tidy = [row for plan in plans for row in _column_rows(study, plan)]
    tidy += [row for entry in added for row in _added_rows(study, entry)]
    mark_lost_cells(tidy)
    mark_differing_passes(tidy)
    checked = [(plan["variables"], name, scene) for plan in plans
               for name, scene in plan["scenes"].items()]
    checked += [(entry["variables"], scene_of(entry).name, entry["plan"]) for entry in added
                if entry["kind"] == "cell"]
    tables = {"tidy": (TIDY, tidy + list(_unavailable(study))),
              "verification": (VERIFICATION, [row for case in checked for row in _checks(*case)]),
              "accuracy": (ACCURACY, [row for plan in plans for row in _accuracy(study, plan)])}
    for row in tables["tidy"][1]:
        row |= {key: machine[key] for key in ("machine", "commit", "dirty")}
    for name, (columns, rows) in tables.items():
        write_csv(folder / f"{name}.csv", pandas.DataFrame(rows, columns=columns))
    write_json(folder / "context.json", study.context(study.control))


def _plans(study):
    return [read_json(study.layout.plan(variables)) for variables in study.profile.columns]


def _added(study):
    """What the refinement added to the profile's grid."""
    path = study.layout.refined
    return read_json(path)["added"] if path.exists() else []


def scene_of(entry):
    """The scene of something that the refinement added."""
    return Scene(entry["variables"], entry["fill"])


def _machine(study):
    """Checks that every raw file comes from one of the study's builds on this machine; StudyError
    naming the first that does not."""
    expected = [fingerprint(context) for context in study.contexts.values()]
    for path in sorted((study.layout.results / "raw").rglob("*.json")):
        found = fingerprint(read_json(path).get("context", {}))
        if found in expected:
            continue
        differing = min(([key for key in known if found[key] != known[key]] for known in expected),
                        key=len)
        near = next(known for known in expected
                    if [key for key in known if found[key] != known[key]] == differing)
        key = differing[0]
        raise StudyError(f"{path} comes from another machine or build ({key} is '{found[key]}',"
                         f" the study's is '{near[key]}'): results are never merged; "
                         "remove the file or keep it in a results directory of its own")
    return fingerprint(study.context(study.control))


def _column_rows(study, plan):
    rounds = range(1, study.profile.rounds + 1)
    for scene in study.profile.columns[plan["variables"]]:
        scene_plan = plan["scenes"][scene.name]
        if not scene_plan["reached"]:
            yield _scene_row(scene) | {"status": "not-reached", "reason": scene_plan["reason"]}
            continue
        yield from _planned_rows(study, scene, scene_plan, "grid", rounds)
        if scene.fill is not None:
            continue
        for row, path in _sampled(study, scene, study.control, rounds):
            yield from _timing_rows(row, path)
        numbers = processes(study.profile.phases, scene.variables)
        for one in (one for one in planned(study, scene_plan) if one.ranked):
            for row, path in _sampled(study, scene, one, numbers, "phases"):
                yield from _timing_rows(row | {"kind": "phases"}, path)
        numbers = processes(study.profile.operations, scene.variables)
        for one in operating(study, scene_plan):
            for row, path in _sampled(study, scene, one, numbers, "operations"):
                yield from _operation_rows(row, path)


def _added_rows(study, entry):
    scene = scene_of(entry)
    if entry["kind"] == "cell":
        yield from _planned_rows(study, scene, entry["plan"], "refined", entry["rounds"])
        return
    for name in entry["implementations"]:
        for row, path in _sampled(study, scene, study.contenders[name], entry["rounds"]):
            yield from _timing_rows(row | {"stage": "refined"}, path)


def _scene_row(scene):
    return {"scene": scene.name, "variables": scene.variables, "fill_asked": scene.fill,
            "kind": "timing", "stage": "grid"}


def _contender_row(scene, contender):
    folder, variant = contender.variant.split("/")
    return _scene_row(scene) | {
        "implementation": contender.name, "folder": folder, "variant": variant,
        "blas": contender.blas, "build": contender.build}


def _planned_rows(study, scene, scene_plan, stage, rounds):
    """Samples of the cells that were timed; a row with the reason for each other one."""
    for name, cell in scene_plan["cells"].items():
        contender = study.contenders[name]
        pilot = {"pilot_step_us": cell["pilot_step_us"], "pilot_ratio": cell["pilot_ratio"],
                 "stage": stage}
        if cell["status"] == "measure":
            for row, path in _sampled(study, scene, contender, rounds):
                yield from _timing_rows(row | pilot, path)
        else:
            row = _contender_row(scene, contender) | pilot | {
                "status": cell["status"], "reason": cell["reason"]}
            path = study.layout.cell("pilot", contender, scene)
            if path.exists():  # else a smaller column excluded it
                row |= {"fill_percent": _fill(read_json(path)),
                        "raw_file": study.layout.relative(path)}
            yield row


def _sampled(study, scene, contender, rounds, prefix="round"):
    """(row, raw file) of each of a cell's processes."""
    for number in rounds:
        path = study.layout.cell(f"{prefix}{number}", contender, scene)
        yield _contender_row(scene, contender) | {
            "round": number, "raw_file": study.layout.relative(path)}, path


def _timing_rows(row, path):
    raw = read_json(path)
    failed = cells.failure(raw)
    if failed:
        yield row | {"status": failed[0], "reason": failed[1]}
        return
    for repetition, sample in enumerate(cells.samples(raw), start=1):
        yield row | {"status": "ok", "reason": "", "repetition": repetition} | _values(sample)


def _operation_rows(row, path):
    raw, row = read_json(path), row | {"kind": "operations"}
    failed = cells.failure(raw)
    if failed:
        yield row | {"status": failed[0], "reason": failed[1]}
        return
    for sample in cells.samples(raw):
        _need_microseconds(sample)
        yield row | {"status": "ok", "reason": "", "operation": sample["run_name"].split("/")[-1],
                     "repetition": sample["repetition_index"] + 1,
                     "iterations": sample["iterations"], "operation_us": sample["real_time"],
                     "fill_percent": sample["fill_percent"],
                     "constraints": sample["constraints"]}


def _need_microseconds(sample):
    if sample.get("time_unit", "us") != "us":
        raise StudyError(f"{sample['name']}: times must be in us, are in {sample['time_unit']}")


def _values(sample):
    """One sample's numbers; the clock's reading is in microseconds a stretch."""
    _need_microseconds(sample)
    steps = sample["steps"]
    values = {"stretch_steps": steps, "iterations": sample["iterations"],
              "stretch_us": sample["real_time"], "step_us": sample["real_time"] / steps,
              "fill_percent": sample.get("fill_percent")}
    values |= {key: sample.get(key) for key in COUNTERS}
    return values | {f"phase_{phase}": sample.get(f"phase_{phase}") for phase in PHASES}


def _fill(raw):
    rows = cells.samples(raw)
    return rows[0].get("fill_percent") if rows else None


def _unavailable(study):
    """A row for each implementation, BLAS pair and build that could not take part at all."""
    registry = read_json(study.layout.registry)
    selection = read_run(study.layout)["only"]
    lost = {"kind": "timing", "stage": "grid", "status": "unavailable"}
    for entry in registry["implementations"]:
        folder = entry["folder"]
        if not entry["available"] and (not selection or folder in selection):
            yield lost | {"implementation": folder, "folder": folder, "reason": entry["reason"]}
    for contender in study.contenders.values():
        if contender.missing:
            folder, variant = contender.variant.split("/")
            yield lost | {"implementation": contender.name, "folder": folder, "variant": variant,
                          "blas": contender.blas, "build": contender.build,
                          "reason": contender.missing}


def _checks(variables, scene, scene_plan):
    for name, cell in scene_plan["cells"].items():
        verdict = "agrees" if cell["status"] == "measure" else cell["status"]
        row = {"scene": scene, "implementation": name, "variables": variables,
               "fill_asked": scene_plan["fill_asked"], "verdict": verdict,
               "reason": cell["reason"]}
        for check in cell["checks"] or [{}]:
            yield row | {"check": check.get("name"), "value": check.get("value"),
                         "tolerance": check.get("tolerance"), "passed": check.get("passed"),
                         "detail": check.get("detail")}


def _accuracy(study, plan):
    scene = study.profile.columns[plan["variables"]][0]
    for name, penalty in accuracy_runs(study, scene):
        cell = plan["scenes"][scene.name]["cells"][name]
        row = {"scene": scene.name, "implementation": name, "variables": plan["variables"],
               "penalty_asked": penalty, "duration": study.profile.accuracy["duration"]}
        path = study.layout.accuracy(plan["variables"], study.contenders[name], penalty)
        if not path.exists():
            yield row | {"status": cell["status"], "status_reason": cell["reason"]}
            continue
        record = read_json(path)
        row["raw_file"] = study.layout.relative(path)
        if "failure" in record:
            yield row | {"status": record["failure"]["status"],
                         "status_reason": record["failure"]["reason"]}
            continue
        summary = record["summary"]
        times = summary.get("step_us") or {}
        times = {f"step_us_{key}": times.get(key) for key in ("median", "p99", "max")}
        known = {key: summary[key] for key in ACCURACY if key in summary}
        yield row | known | times | {"scene": scene.name, "implementation": name}


if __name__ == "__main__":
    from study.pipeline.job import study_job
    sys.exit(study_job(collect))
