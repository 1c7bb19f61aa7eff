# How far ahead of the library-backed implementations those with code of their own are, scene by scene.
import itertools
import json
import statistics

from study.limit_study import measure
from study.pipeline import child
from study.pipeline.errors import StudyError
from study.pipeline.layout import ROOT, program

FOLDERS = ("problems", "examples")
FILLS = tuple(f"four-bar:49,fill={fill}" for fill in (0.12, 0.2, 0.3, 0.5, 0.75, 1))
BATCHES = ("four-bar:10", "four-bar:40")
TIMES_ROUNDS = 3  # for batches: they fill a core, and suffer most from whatever else the machine does with it
SETS = (64, 8)  # of parameters over the same range: neighbours alike as in a what-if study, and a single wide batch
LARGE = (49, 160, 499, 1999, 4999, 9999)  # sizes at which time, memory and set-up have to grow linearly
NEAR = 1.5  # of the fastest with a library, in a first short run; who is slower is not timed further


def scenes():
    """Every scene file that users are given, then the four-bar of 100 variables with artificial fill."""
    files = [path for folder in FOLDERS for path in sorted((ROOT / "harness/scenes" / folder).glob("*.json"))]
    return [*(str(path.relative_to(ROOT)) for path in files), *FILLS]


def rows(layout, contenders, mine, scene, rounds, seconds, tell):
    """Rows of scenes.csv: those of `mine` and what comes near the fastest of the others."""
    folder = "scenes/" + scene.removeprefix("harness/scenes/").removesuffix(".json").replace("/", "-")
    pilots, lost = {}, []
    for one in contenders:
        tell(f"first look at {one.name}")
        found, reason = measure.bench(layout, one, scene, f"{folder}/{one.file_name}-0", seconds)
        if reason.startswith("unsupported"):
            continue
        if reason:
            lost.append({"implementation": one.name, "status": "failed", "reason": reason})
        else:
            pilots[one.name] = found
    best = min((row["step_us"] for name, row in pilots.items() if name not in mine), default=0.0)
    near = [one for one in contenders if one.name in pilots
            and (one.name in mine or pilots[one.name]["step_us"] <= NEAR * best)]
    slow = [{"implementation": name, "status": "slower", "step_us": row["step_us"],
             "reason": f"more than {NEAR} times the fastest with a library in a first run"}
            for name, row in pilots.items() if name not in {one.name for one in near}]
    about = _about(scene)
    return [row | about for row in (*measure.cell(layout, near, scene, folder, rounds, seconds, tell),
                                    *slow, *lost)]


def batches(layout, contenders, rounds, seconds, tell):
    """Rows of batches.csv: many lanes side by side against each alone, medians of TIMES_ROUNDS times `rounds`
    processes, in turn over all cells: what disturbs the machine for some seconds is not all rounds of a cell."""
    rounds *= TIMES_ROUNDS
    cells = list(itertools.product(BATCHES, SETS, contenders))
    samples, reasons = [[] for _ in cells], ["" for _ in cells]
    for turn in range(1, rounds + 1):
        for place, (scene, sets, one) in enumerate(cells):
            if reasons[place]:
                continue
            tell(f"{scene}, {sets} sets, {one.name}: round {turn} of {rounds}",
                 (turn - 1 + place / len(cells)) / rounds)
            row, reasons[place] = measure.bench(
                layout, one, scene, f"batches/{one.file_name}-{scene[9:]}-{sets}-{turn}", seconds,
                "--batch", "--sets", str(sets))
            samples[place].append(row)
    return [{"scene": scene, "sets": sets, "implementation": one.name} | _batch(rows, reason, rounds)
            for (scene, sets, one), rows, reason in zip(cells, samples, reasons)
            if not reason.startswith("unsupported")]


def _batch(rows, reason, rounds):
    if reason:
        return {"status": "failed", "reason": reason}
    return {"status": "ok", "reason": "", "rounds": rounds} | {key: rows[0][key] for key in ("variables", "lanes")} | {
        key: statistics.median(row[key] for row in rows) for key in ("step_us", "alone_us", "gain")}


def _about(scene):
    ended = child.run([program(), "describe", scene, "--json"], 60, measure.MEMORY_MB)
    if ended.code != 0:
        raise StudyError(f"mbs describe {scene}: {ended.reason}")
    found = json.loads(ended.stdout)
    return {"scene": scene, "variables": found["variables"], "dimension": found["dimension"],
            "filled": scene in FILLS}
