# Refines the maps within a time budget: adds fills where the winner changes between two of them, and
# rounds where a winner is not decided.
#
# plans/refined.json holds what was added, what is being added and the seconds spent, written before
# and after each addition: a resumed run first finishes what was interrupted, and repeats nothing. An
# addition that has begun is finished.
import sys
import tempfile
import time
from pathlib import Path

from analysis.loader import load
from analysis.maps import refinement_candidates
from study.pipeline.collect import collect, scene_of
from study.pipeline.layout import read_json, write_json
from study.pipeline.measure import shuffled, time_cell
from study.pipeline.progress import Progress, Quiet
from study.pipeline.verify import verify_scene

LOOKS = 6  # times at which candidates are chosen anew: each look costs a second or two


def refine(study):
    budget, layout = study.profile.refine["seconds"], study.layout
    record = read_json(layout.refined) if layout.refined.exists() else {"seconds": 0.0, "added": []}
    progress = Progress(layout, "refine", 0)
    for entry in record["added"]:
        _measure(study, entry)  # nothing to do, unless a file was removed
    before, begin = record["seconds"], time.monotonic()

    def add(candidate):
        write_json(layout.refined, record | {"next": candidate})
        _add(study, record["added"], candidate)
        spent = before + time.monotonic() - begin
        progress.done(spent - record["seconds"], _text(record["added"]))
        record["seconds"] = spent
        write_json(layout.refined, record)

    if "next" in record:
        add(record.pop("next"))
    while record["seconds"] < budget:
        candidates = refinement_candidates(_results(study), study.profile.refine["rounds"])
        if not candidates:
            break
        pause = record["seconds"] + budget / LOOKS
        for candidate in candidates:
            add(candidate)
            if record["seconds"] >= min(budget, pause):
                break
    files = [layout.relative(layout.cell(f"round{number}", study.contender(name), scene_of(entry)))
             for entry in record["added"] for number in entry["rounds"] for name in _names(entry)]
    write_json(layout.refined, record)
    write_json(layout.refined_stamp, {"files": files})


def _results(study):
    """What has been measured so far, as figures see it."""
    with tempfile.TemporaryDirectory() as folder:
        collect(study, Path(folder))
        for path in (study.layout.run, study.layout.registry):
            (Path(folder) / path.name).write_text(path.read_text())
        return load(folder)


def _add(study, added, candidate):
    entry = dict(candidate)
    scene, rounds = scene_of(entry), study.profile.refine["rounds"]
    if entry["kind"] == "cell":
        entry["plan"] = verify_scene(study, scene, Quiet())
        entry["rounds"] = list(range(1, study.profile.rounds + 1))
    else:
        done = study.profile.rounds + rounds * sum(
            other["kind"] == "samples" and scene_of(other) == scene for other in added)
        entry["rounds"] = list(range(done + 1, done + 1 + rounds))
        entry["plan"] = {"stretch_steps": _stretch(study, added, scene)}
    _measure(study, entry)
    added.append(entry)


def _measure(study, entry):
    scene = scene_of(entry)
    for number in entry["rounds"]:
        seed = f"{study.profile.seed}:refined:{scene.name}:{number}"
        for name in shuffled(_names(entry), seed):
            time_cell(study, study.contenders[name], scene, entry["plan"], number)


def _names(entry):
    if entry["kind"] == "samples":
        return entry["implementations"]
    return [name for name, cell in entry["plan"]["cells"].items() if cell["status"] == "measure"]


def _stretch(study, added, scene):
    """Steps that the scene's samples have so far."""
    for entry in added:
        if entry["kind"] == "cell" and scene_of(entry) == scene:
            return entry["plan"]["stretch_steps"]
    plan = read_json(study.layout.plan(scene.variables))
    return plan["scenes"][scene.name]["stretch_steps"]


def _text(added):
    cells = sum(entry["kind"] == "cell" for entry in added)
    return f"{cells} cells added, {len(added) - cells} sampled again"


if __name__ == "__main__":
    from study.pipeline.job import study_job
    sys.exit(study_job(refine))
