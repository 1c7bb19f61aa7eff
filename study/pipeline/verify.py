# Verifies one column: pilots, gate and accuracy runs; writes the plan that says what is timed.
#
# A pilot (the first steps of the motion, the fastest of PILOT_RUNS) predicts each cell's cost.
# Cells more than `exclusion_factor` times slower than the best of their scene are excluded: neither
# checked nor timed. A pilot that runs out of time proves a least cost; that excludes its cell too
# if a single step does end: without that it may hang. "Best" counts only what the gate has not
# rejected, so a wrong but fast implementation excludes nobody: after each verdict the rule is
# applied again, until nobody new has to be checked.
import sys

from study.pipeline import cells
from study.pipeline.errors import StudyError
from study.pipeline.layout import NULL, write_json
from study.pipeline.progress import Progress

PILOT_RUNS = 3


def verify(study, variables):
    progress = Progress(study.layout, "verify", variables)
    scenes, natural_fill = {}, None
    for scene in study.profile.columns[variables]:
        if scene.fill is not None and 100 * scene.fill <= natural_fill:
            scenes[scene.name] = _not_reached(scene, natural_fill)
            progress.done(len(study.variants) + 1)
            continue
        pilots = {name: _pilot(study, name, scene, progress) for name in study.variants}
        if scene.fill is None:
            natural_fill = _natural_fill(study, scene)
        verdicts = _gate(study, scene, pilots)
        progress.done()
        scenes[scene.name] = _scene_plan(study.profile, scene, pilots, verdicts)
    _accuracy(study, variables, scenes, progress)
    write_json(study.layout.plan(variables), {
        "variables": variables, "natural_fill_percent": natural_fill, "seed": study.profile.seed,
        "scenes": scenes})


def _pilot(study, implementation, scene, progress):
    """{"step_us"} predicted, or {"status", "reason"} of the failure, perhaps "step_us_at_least"."""
    raw = _run_pilot(study, implementation, scene)
    progress.done()
    failed = cells.failure(raw)
    if failed and failed[0] == "timeout":
        return _single_step(study, implementation, scene)
    if failed:
        return {"status": failed[0], "reason": f"pilot: {failed[1]}"}
    fastest = min(sample["real_time"] for sample in cells.samples(raw))
    return {"step_us": fastest / study.profile.pilot_steps}


def _single_step(study, implementation, scene):
    """After a pilot's timeout: a bound on the cost if one step ends at all, else the failure."""
    raw = cells.bench(study.layout.cell("single", implementation, scene), implementation, scene,
                      study.profile, study.context, steps=1, more=["--start", "0"])
    limit = study.profile.limits["pilot_seconds"]
    pilot = {"status": "timeout", "reason": f"pilot: did not end within {limit:g} s"}
    failed = cells.failure(raw)
    if failed:
        return {"status": failed[0], "reason": f"{pilot['reason']}; a single step: {failed[1]}"}
    # A warm-up and PILOT_RUNS stretches were not done within the limit.
    bound = 1e6 * limit / (study.profile.pilot_steps * (PILOT_RUNS + 1))
    return pilot | {"step_us_at_least": max(bound, cells.samples(raw)[0]["real_time"])}


def _run_pilot(study, implementation, scene):
    return cells.bench(study.layout.cell("pilot", implementation, scene), implementation, scene,
                       study.profile, study.context, steps=study.profile.pilot_steps,
                       repetitions=PILOT_RUNS, limit="pilot_seconds", more=["--start", "0"])


def _natural_fill(study, scene):
    """Percent, as the harness's null control reports it."""
    raw = _run_pilot(study, NULL, scene)
    failed = cells.failure(raw)
    if failed:
        raise StudyError(f"{scene.name} cannot be set up: {failed[1]}")
    return cells.samples(raw)[0]["fill_percent"]


def _gate(study, scene, pilots):
    """Verdict rows of all that are neither excluded nor dead, by implementation."""
    verdicts, attempt = {}, 0
    while True:
        best = best_cost(pilots, verdicts)
        todo = [name for name, pilot in pilots.items() if name not in verdicts
                and "step_us" in pilot
                and pilot["step_us"] <= study.profile.exclusion_factor * best]
        if not todo:
            return verdicts
        attempt += 1
        report = _check(study, scene, todo, attempt)
        # Several at once saves time; if the check itself died, one by one loses only the culprit.
        reports = [report] if report else [
            _check(study, scene, [name], f"{attempt}-{name.replace('/', '.')}") for name in todo]
        found = {row["implementation"]: row for report in reports for row in report["rows"]
                 if row["scene"] == scene.name}
        absent = {"verdict": "disagrees", "reason": "the check gave no verdict", "checks": []}
        verdicts |= {name: found.get(name, absent) for name in todo}


def _check(study, scene, names, attempt):
    path = study.layout.gate(scene, attempt)
    return cells.check(path, names, scene, study.profile, study.context)


def best_cost(pilots, verdicts):
    """Least predicted time per step among those not rejected; infinite if nobody is left."""
    return min((pilot["step_us"] for name, pilot in pilots.items() if "step_us" in pilot
                and verdicts.get(name, {"verdict": "agrees"})["verdict"] == "agrees"),
               default=float("inf"))


def _scene_plan(profile, scene, pilots, verdicts):
    best, plan, factor = best_cost(pilots, verdicts), {}, profile.exclusion_factor
    for name, pilot in pilots.items():
        verdict = verdicts.get(name)
        cell = {"pilot_step_us": pilot.get("step_us"), "pilot_ratio": None, "checks": []}
        if "step_us" not in pilot:
            cell |= without_pilot(profile, pilot, best)
        elif verdict is None:
            cell |= {"status": "excluded", "pilot_ratio": pilot["step_us"] / best,
                     "reason": f"at least {factor:g} times slower than the best of its scene"}
        elif verdict["verdict"] == "agrees":
            cell |= {"status": "measure", "reason": "", "pilot_ratio": pilot["step_us"] / best}
        else:
            cell |= {"status": verdict["verdict"], "reason": verdict["reason"]}
        cell["checks"] = verdict["checks"] if verdict else []
        plan[name] = cell
    slowest = max((cell["pilot_step_us"] for cell in plan.values() if cell["status"] == "measure"),
                  default=0.0)
    return {"fill_asked": scene.fill, "reached": True, "cells": plan,
            "stretch_steps": stretch_steps(profile, scene, slowest)}


def without_pilot(profile, pilot, best):
    """A cell whose pilot gave no cost: excluded if its least cost is beyond the factor."""
    if "step_us_at_least" not in pilot or best == float("inf"):
        return {"status": pilot["status"], "reason": pilot["reason"]}
    ratio = pilot["step_us_at_least"] / best
    if ratio <= profile.exclusion_factor:
        text = f"{pilot['reason']}; at least {ratio:.1f} times slower than the best of its scene"
        return {"status": pilot["status"], "reason": text, "pilot_ratio": ratio}
    limit = profile.limits["pilot_seconds"]
    return {"status": "excluded", "pilot_ratio": ratio,
            "reason": f"at least {ratio:.0f} times slower than the best of its scene "
                      f"(its pilot did not end within {limit:g} s)"}


def stretch_steps(profile, scene, slowest_us):
    """The longest stretch that the slowest implementation of a scene runs within the budget."""
    budget = profile.stretch_budget["natural" if scene.fill is None else "filled"]
    lengths = sorted(profile.stretch_lengths, reverse=True)
    fitting = (steps for steps in lengths if steps * slowest_us * 1e-6 <= budget)
    return next(fitting, lengths[-1])


def _not_reached(scene, natural_fill):
    reason = f"the mechanism's own fill is {natural_fill:.3g} %"
    return {"fill_asked": scene.fill, "reached": False, "reason": reason, "cells": {},
            "stretch_steps": None}


def _accuracy(study, variables, scenes, progress):
    """Whole simulations of the natural scene by everything that the pilots did not exclude."""
    scene = study.profile.columns[variables][0]
    for name, cell in scenes[scene.name]["cells"].items():
        for penalty in study.profile.accuracy["penalties"]:
            if cell["status"] in ("measure", "disagrees"):
                path = study.layout.accuracy(variables, name, penalty)
                cells.simulate(path, name, scene, str(penalty), study.profile, study.context)
            progress.done()


if __name__ == "__main__":
    from study.pipeline.job import column_job
    sys.exit(column_job(verify))
