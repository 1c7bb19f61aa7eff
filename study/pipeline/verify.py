# Verifies one column: pilots, gate and accuracy runs; writes the plan that says what is timed.
#
# A pilot (the first steps of the motion, the fastest of PILOT_RUNS) predicts each cell's cost.
# Cells slower than the best of their scene by more than the profile's factor are excluded: neither
# checked nor timed; code of the study's own, without a library, excludes nobody. Where a pilot runs out of time, a single step and the least cost that the timeout
# proves predict; if not even that step ends, it may hang. "Best" counts only what the gate has not
# rejected, so a wrong but fast implementation excludes nobody: after each verdict the rule is
# applied again, until nobody new has to be checked. In filled scenes the two fastest of each family
# (dense, sparse, symmetric, unsymmetric) stay within FAMILY times that factor: maps are drawn for
# families too. Stretches are as long as if they were excluded.
import math
import sys
from itertools import groupby

from study.pipeline import cells
from study.pipeline.errors import StudyError
from study.pipeline.layout import read_json, write_json
from study.pipeline.progress import Progress

PILOT_RUNS = 3
FAMILY = 5


def verify(study, variables):
    progress = Progress(study.layout, "verify", variables)
    natural, *filled = study.profile.columns[variables]
    natural_fill = _natural_fill(study, natural)
    progress.done()
    hopeless = _hopeless(study, variables)
    scenes = {natural.name: verify_scene(study, natural, progress, hopeless)}
    for scene in filled:
        if 100 * scene.fill <= natural_fill:
            scenes[scene.name] = _not_reached(scene, natural_fill)
            progress.done(len(study.at(scene)) + 1)
        else:
            scenes[scene.name] = verify_scene(study, scene, progress)
    _accuracy(study, natural, scenes[natural.name], progress)
    write_json(study.layout.plan(variables), {
        "variables": variables, "natural_fill_percent": natural_fill, "seed": study.profile.seed,
        "scenes": scenes})


def verify_scene(study, scene, progress, hopeless=None):
    """Plan of one scene: status and reason of each cell, and the stretch that is timed.
    `hopeless`: {contender: reason} of those that are excluded without a pilot."""
    hopeless = hopeless or {}
    pilots = {one.name: _pilot(study, one, scene, progress) for one in study.at(scene)
              if one.name not in hopeless}
    progress.done(len(hopeless))
    verdicts = _gate(study, scene, pilots)
    progress.done()
    plan = _scene_plan(study, scene, pilots, verdicts)
    plan["cells"] |= {name: {"status": "excluded", "reason": reason, "pilot_step_us": None,
                             "pilot_ratio": None, "checks": []}
                      for name, reason in hopeless.items()}
    return plan


def _hopeless(study, variables):
    """{contender: reason} of those that the next smaller column excluded already at natural fill:
    there all of them fall behind further as the size grows."""
    smaller = max((size for size in study.profile.columns if size < variables), default=None)
    if smaller is None:
        return {}
    plan = read_json(study.layout.plan(smaller))
    cells_there = plan["scenes"][study.profile.columns[smaller][0].name]["cells"]
    natural, reasons = study.profile.columns[variables][0], {}
    for one in study.at(natural):
        cell = cells_there.get(one.name, {"status": ""})
        if cell["status"] == "excluded":
            text = cell["reason"].removeprefix("not tried: ")
            where = "" if "at n = " in text else f"at n = {smaller} "
            ratio = f"{cell['pilot_ratio']:.0f} times slower than the best of its scene" if (
                cell["pilot_ratio"]) else text
            reasons[one.name] = f"not tried: {where}{ratio}"
    return reasons


def _pilot(study, contender, scene, progress):
    """{"step_us"} predicted, perhaps with a "note", or {"status", "reason"} of the failure."""
    raw = _run_pilot(study, contender, scene)
    progress.done()
    failed = cells.failure(raw)
    if failed and failed[0] == "timeout":
        return _single_step(study, contender, scene)
    if failed:
        return {"status": failed[0], "reason": f"pilot: {failed[1]}"}
    fastest = min(sample["real_time"] for sample in cells.samples(raw))
    return {"step_us": fastest / study.profile.pilot_steps}


def _single_step(study, contender, scene):
    """A pilot after a timeout."""
    raw = cells.bench(study.layout.cell("single", contender, scene), contender, scene, study,
                      more=["--steps", "1", "--start", "0"])
    limit = study.profile.limits["pilot_seconds"]
    note = f"its pilot did not end within {limit:g} s"
    failed = cells.failure(raw)
    if failed:
        return {"status": failed[0], "reason": f"{note}; a single step: {failed[1]}"}
    # A warm-up and PILOT_RUNS stretches were not done within the limit.
    bound = 1e6 * limit / (study.profile.pilot_steps * (PILOT_RUNS + 1))
    return {"step_us": max(bound, cells.samples(raw)[0]["real_time"]), "note": note}


def _run_pilot(study, contender, scene):
    return cells.bench(study.layout.cell("pilot", contender, scene), contender, scene, study,
                       more=["--steps", str(study.profile.pilot_steps), "--start", "0"],
                       repetitions=PILOT_RUNS, limit="pilot_seconds")


def _natural_fill(study, scene):
    """Percent, as the harness's null control reports it."""
    raw = _run_pilot(study, study.control, scene)
    failed = cells.failure(raw)
    if failed:
        raise StudyError(f"{scene.name} cannot be set up: {failed[1]}")
    return cells.samples(raw)[0]["fill_percent"]


def _gate(study, scene, pilots):
    """Verdict rows of all that are neither excluded nor dead, by contender."""
    verdicts, attempt = {}, 0
    while True:
        limit = study.profile.exclusion(scene) * best_cost(study, pilots, verdicts)
        todo = [name for name, pilot in pilots.items() if pilot.get("step_us", math.inf) <= limit]
        if scene.fill is not None:
            todo += fastest_of_families(families(study), pilots, verdicts, FAMILY * limit)
        todo = [study.contenders[name] for name in pilots if name in todo and name not in verdicts]
        if not todo:
            return verdicts
        attempt += 1
        todo.sort(key=lambda one: one.environment)  # stable: a process is one build on one pair
        for environment, group in groupby(todo, lambda one: one.environment):
            verdicts |= _check(study, scene, list(group), f"{attempt}-{_file_name(environment)}")


def _check(study, scene, group, attempt):
    """Verdict rows by contender. Several at once saves time; if the check itself died, one by one
    loses only the culprit."""
    report = cells.check(study.layout.gate(scene, attempt), group, scene, study)
    if report is None:
        return {name: row for one in group
                for name, row in _check(study, scene, [one], f"{attempt}-{one.file_name}").items()}
    found = {row["implementation"]: row for row in report["rows"] if row["scene"] == scene.name}
    lacking = [one for one in group if one.variant not in found]
    if lacking and len(lacking) < len(group):  # a stored report of fewer
        return {one.name: found[one.variant] for one in group if one not in lacking} | _check(
            study, scene, lacking, f"{attempt}+")
    absent = {"verdict": "disagrees", "reason": "the check gave no verdict", "checks": []}
    return {one.name: found.get(one.variant, absent) for one in group}


def _file_name(environment):
    return environment.replace("|", "-")


def families(study):
    """{family: names} as `mbs list` says."""
    found = {"dense": [], "sparse": [], "symmetric": [], "unsymmetric": []}
    for entry in read_json(study.layout.registry)["implementations"]:
        for variant in entry["variants"]:
            found["dense" if variant["dense"] else "sparse"].append(variant["name"])
            found["unsymmetric" if variant["unsymmetric"] else "symmetric"].append(variant["name"])
    return found


def fastest_of_families(members, pilots, verdicts, limit):
    """Names of the two fastest of each family that are not rejected, as far as within `limit`."""
    alive = {name: pilot["step_us"] for name, pilot in pilots.items()
             if pilot.get("step_us", math.inf) <= limit and not rejected(name, verdicts)}
    return [name for names in members.values()
            for name in sorted(set(names) & set(alive), key=alive.get)[:2]]


def rejected(name, verdicts):
    return verdicts.get(name, {"verdict": "agrees"})["verdict"] != "agrees"


def best_cost(study, pilots, verdicts):
    """Least predicted time per step of the ranked ones not rejected; infinite if nobody is left. Those
    without a library count only if there is nobody else: they are not what libraries are chosen by."""
    alive = {name: pilot["step_us"] for name, pilot in pilots.items() if "step_us" in pilot
             and study.contenders[name].ranked and not rejected(name, verdicts)}
    backed = [cost for name, cost in alive.items() if name not in study.own]
    return min(backed or alive.values(), default=math.inf)


def _scene_plan(study, scene, pilots, verdicts):
    best, plan, factor = best_cost(study, pilots, verdicts), {}, study.profile.exclusion(scene)
    for name, pilot in pilots.items():
        verdict = verdicts.get(name)
        cell = {"pilot_step_us": pilot.get("step_us"), "pilot_ratio": None, "checks": []}
        if "step_us" not in pilot:
            cell |= pilot
        elif verdict is None:
            note = f" ({pilot['note']})" if "note" in pilot else ""
            cell |= {"status": "excluded", "pilot_ratio": pilot["step_us"] / best,
                     "reason": f"at least {factor:g} times slower than the best of its scene{note}"}
        elif verdict["verdict"] == "agrees":
            cell |= {"status": "measure", "reason": "", "pilot_ratio": pilot["step_us"] / best}
        else:
            cell |= {"status": verdict["verdict"], "reason": verdict["reason"]}
        cell["checks"] = verdict["checks"] if verdict else []
        plan[name] = cell
    slowest = max((cell["pilot_step_us"] for name, cell in plan.items()
                   if cell["status"] == "measure" and study.contenders[name].ranked
                   and cell["pilot_ratio"] <= factor), default=0.0)
    return {"fill_asked": scene.fill, "reached": True, "cells": plan,
            "stretch_steps": stretch_steps(study.profile, scene, slowest)}


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


def _accuracy(study, scene, plan, progress):
    """Whole simulations of the natural scene by the ranked ones that the pilots did not exclude."""
    for name, penalty in accuracy_runs(study, scene):
        if plan["cells"][name]["status"] in ("measure", "disagrees"):
            contender = study.contenders[name]
            path = study.layout.accuracy(scene.variables, contender, penalty)
            cells.simulate(path, contender, scene, str(penalty), study)
        progress.done()


def accuracy_runs(study, scene):
    """[(name, penalty)] of the whole simulations that the profile asks for at this size."""
    return accuracy_runs_of(study.profile, scene, study.contenders.values())


def accuracy_runs_of(profile, scene, contenders):
    if scene.variables not in profile.accuracy["columns"]:
        return []
    return [(one.name, penalty) for one in contenders if one.at(scene) and one.ranked
            for penalty in profile.accuracy["penalties"]]


if __name__ == "__main__":
    from study.pipeline.job import column_job
    sys.exit(column_job(verify))
