# Derives the tidy tables of one results directory from its raw files and plans.
import math
import sys
from collections import Counter
from itertools import product

import pandas

from study.pipeline import cells
from study.pipeline.errors import StudyError
from study.pipeline.job import job, open_study
from study.pipeline.layout import NULL, fingerprint, read_json, read_run, write_json

PHASES = ("evaluation", "assembly", "factorization", "solve", "projection", "other")
COUNTERS = ("passes", "steps_at_limit", "setup_us", "constraints", "penalty", "step", "tolerance",
            "max_passes", "start", "fill_seed", "position_error", "constraint_violation",
            "energy_drift")
PER_SAMPLE = ("stretch_steps", "iterations", "stretch_us", "step_us") + COUNTERS
# results/README.md says what each column means.
TIDY = ("kind", "scene", "implementation", "folder", "variant", "variables", "fill_asked",
        "fill_percent", "status", "reason", "round", "repetition") + PER_SAMPLE + (
        tuple(f"phase_{phase}" for phase in PHASES) + (
            "pilot_step_us", "pilot_ratio", "machine", "commit", "dirty", "raw_file"))
VERIFICATION = ("scene", "implementation", "variables", "fill_asked", "verdict", "reason", "check",
                "value", "tolerance", "passed", "detail")
ACCURACY = ("scene", "implementation", "variables", "penalty_asked", "penalty", "step", "tolerance",
            "duration", "status", "status_reason", "failed_at", "steps", "passes_per_step",
            "position_error_max", "energy_drift_max", "constraint_violation_max", "setup_us",
            "step_us_median", "step_us_p99", "step_us_max", "raw_file")


def collect(study):
    """Writes tidy.csv, verification.csv, accuracy.csv and context.json."""
    plans = [read_json(study.layout.plan(variables)) for variables in study.profile.columns]
    machine = _one_fingerprint(study)
    tidy = [row for plan in plans for row in _column_rows(study, plan)]
    mark_lost_cells(tidy)
    mark_differing_passes(tidy)
    tables = {"tidy": (TIDY, tidy + list(_unavailable(study))),
              "verification": (VERIFICATION, [row for plan in plans for row in _checks(plan)]),
              "accuracy": (ACCURACY, [row for plan in plans for row in _accuracy(study, plan)])}
    for row in tables["tidy"][1]:
        row |= {key: machine[key] for key in ("machine", "commit", "dirty")}
    for name, (columns, rows) in tables.items():
        path = study.layout.results / f"{name}.csv"
        partial = path.with_suffix(".csv.partial")
        pandas.DataFrame(rows, columns=columns).to_csv(partial, index=False)
        partial.replace(path)
    write_json(study.layout.results / "context.json", study.context)


def _one_fingerprint(study):
    """The machine and build of every raw file; StudyError if there is more than one."""
    expected = fingerprint(study.context)
    for path in sorted((study.layout.results / "raw").rglob("*.json")):
        found = fingerprint(read_json(path).get("context", {}))
        differing = [key for key in expected if found[key] != expected[key]]
        if differing:
            key = differing[0]
            raise StudyError(f"{path} comes from another machine or build ({key} is '{found[key]}',"
                             f" the study's is '{expected[key]}'): results are never merged; "
                             "remove the file or keep it in a results directory of its own")
    return expected


def _column_rows(study, plan):
    for scene in study.profile.columns[plan["variables"]]:
        scene_plan = plan["scenes"][scene.name]
        base = {"scene": scene.name, "variables": scene.variables, "fill_asked": scene.fill,
                "kind": "timing"}
        if not scene_plan["reached"]:
            yield base | {"status": "not-reached", "reason": scene_plan["reason"]}
            continue
        planned = dict(scene_plan["cells"])
        if scene.fill is None:
            planned[NULL] = {"status": "measure", "reason": ""}
        for name, cell in planned.items():
            folder, variant = name.split("/")
            named = base | {"implementation": name, "folder": folder, "variant": variant,
                            "pilot_step_us": cell.get("pilot_step_us"),
                            "pilot_ratio": cell.get("pilot_ratio")}
            if cell["status"] == "measure":
                yield from _measured(study, scene, name, named)
            else:
                pilot = study.layout.cell("pilot", name, scene)
                yield named | {"status": cell["status"], "reason": cell["reason"],
                               "fill_percent": _fill(read_json(pilot)),
                               "raw_file": study.layout.relative(pilot)}


def _measured(study, scene, name, named):
    kinds = {"round": "timing"}
    if scene.fill is None and name != NULL:
        kinds["phases"] = "phases"
    for (prefix, kind), number in product(kinds.items(), range(1, study.profile.rounds + 1)):
        path = study.layout.cell(f"{prefix}{number}", name, scene)
        raw = read_json(path)
        row = named | {"kind": kind, "round": number, "raw_file": study.layout.relative(path)}
        failed = cells.failure(raw)
        if failed:
            yield row | {"status": failed[0], "reason": failed[1]}
            continue
        for repetition, sample in enumerate(cells.samples(raw), start=1):
            yield row | {"status": "ok", "reason": "", "repetition": repetition} | _values(sample)


def _values(sample):
    """One sample's numbers; the clock's reading is in microseconds a stretch."""
    if sample.get("time_unit", "us") != "us":
        raise StudyError(f"{sample['name']}: times must be in us, are in {sample['time_unit']}")
    steps = sample["steps"]
    values = {"stretch_steps": steps, "iterations": sample["iterations"],
              "stretch_us": sample["real_time"], "step_us": sample["real_time"] / steps,
              "fill_percent": sample.get("fill_percent")}
    values |= {key: sample.get(key) for key in COUNTERS}
    return values | {f"phase_{phase}": sample.get(f"phase_{phase}") for phase in PHASES}


def _fill(raw):
    rows = cells.samples(raw)
    return rows[0].get("fill_percent") if rows else None


def mark_lost_cells(rows):
    """A cell of which one process died may not be ranked by its other processes' samples."""
    dead = {}
    for row in rows:
        if row["kind"] == "timing" and row["status"] not in ("ok", "not-reached"):
            dead.setdefault((row["scene"], row["implementation"]), row)
    for row in rows:
        cause = dead.get((row["scene"], row.get("implementation")))
        if cause and row["status"] == "ok":
            row |= {"status": cause["status"], "reason": cause["reason"]}


def mark_differing_passes(rows):
    """Pass totals of a scene's stretch must be equal: the most common one stands, every other cell
    is marked. Without a most common one (a tie) the whole scene is: nobody can be trusted."""
    timed = [row for row in rows if row["status"] == "ok" and row["implementation"] != NULL]
    for scene in {row["scene"] for row in timed}:
        mine = [row for row in timed if row["scene"] == scene]
        passes = {}  # implementation -> set of totals over its samples
        for row in mine:
            passes.setdefault(row["implementation"], set()).add(row["passes"])
        votes = Counter(min(values) for values in passes.values() if len(values) == 1)
        ranked = votes.most_common(2)
        tie = not ranked or (len(ranked) > 1 and ranked[0][1] == ranked[1][1])
        accepted = math.nan if tie else ranked[0][0]
        for row in mine:
            if passes[row["implementation"]] != {accepted}:
                row["status"] = "passes-differ"
                row["reason"] = _passes_text(passes, row["implementation"], tie)


def _passes_text(passes, name, tie):
    def text(key):
        return "/".join(f"{value:.0f}" for value in sorted(passes[key]))
    others = ", ".join(f"{key} {text(key)}" for key in passes if key != name)
    return f"{text(name)} passes over the stretch; {others}" + (" (no majority)" if tie else "")


def _unavailable(study):
    registry = read_json(study.layout.registry)
    selection = read_run(study.layout)["only"]
    for entry in registry["implementations"]:
        folder = entry["folder"]
        if not entry["available"] and (not selection or folder in selection):
            yield {"kind": "timing", "implementation": folder, "folder": folder,
                   "status": "unavailable", "reason": entry["reason"]}


def _checks(plan):
    for scene, scene_plan in plan["scenes"].items():
        for name, cell in scene_plan["cells"].items():
            verdict = "agrees" if cell["status"] == "measure" else cell["status"]
            row = {"scene": scene, "implementation": name, "variables": plan["variables"],
                   "fill_asked": scene_plan["fill_asked"], "verdict": verdict,
                   "reason": cell["reason"]}
            for check in cell["checks"] or [{}]:
                yield row | {"check": check.get("name"), "value": check.get("value"),
                             "tolerance": check.get("tolerance"), "passed": check.get("passed"),
                             "detail": check.get("detail")}


def _accuracy(study, plan):
    scene = study.profile.columns[plan["variables"]][0]
    for name, cell in plan["scenes"][scene.name]["cells"].items():
        for penalty in study.profile.accuracy["penalties"]:
            row = {"scene": scene.name, "implementation": name, "variables": plan["variables"],
                   "penalty_asked": penalty, "duration": study.profile.accuracy["duration"]}
            path = study.layout.accuracy(plan["variables"], name, penalty)
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
    sys.exit(job(lambda: collect(open_study(sys.argv[1]))))
