# study/against REVISION: times this tree and another revision of it in the same rounds.
#
# A results directory belongs to these two programs, this machine and selection. Its run.json says so.
import argparse
import json
import os
import random
import subprocess
import sys
from pathlib import Path

from study.pipeline import cells, child
from study.pipeline.contenders import Contender
from study.pipeline.errors import StudyError
from study.pipeline.layout import NULL, ROOT, Layout, program, read_json, write_csv, write_json
from study.pipeline.prepare import (continues, digest, digest_of_scene, need_modules, only_one,
                                    only_one_measuring, registry, select, set_up, writable)
from study.pipeline.progress import Teller

SEED = 20080101
SECONDS, MEMORY_MB = 60, 4096


def against(arguments):
    parser = argparse.ArgumentParser(prog="study/against", description="Builds another revision "
                                     "beside this tree and times both in the same rounds.")
    parser.add_argument("revision", help="of git, for instance HEAD~1")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME",
                        help="only these implementations (folder or folder/variant)")
    parser.add_argument("--scenes", nargs="+", metavar="SCENE", default=[
        "four-bar:10", "four-bar:40", "four-bar:79", "four-bar:499"], help="four-bar:10 ... 499")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--results", metavar="DIR", help="(results/local/against-REVISION)")
    options = parser.parse_args(arguments)
    if options.rounds < 2:
        raise StudyError(f"--rounds is {options.rounds}: intervals need at least 2")
    revision = _resolve(options.revision)
    layout = Layout(Path(options.results).absolute() if options.results
                    else ROOT / "results" / "local" / f"against-{revision[:10]}")
    writable(layout.results)
    with only_one(layout), only_one_measuring():
        need_modules("pandas", "yaml")
        if "MBS_PROGRAM" not in os.environ:
            set_up(layout)
        programs = {"old": _build(revision), "new": ROOT / program()}
        variants = select(registry(), options.only)
        _start(layout, options, programs, variants)
        samples = _measure(layout, options, programs, variants)
    _tell(layout, samples, revision)
    return 0


def _resolve(name):
    found = subprocess.run(["git", "rev-parse", "--verify", "--quiet", f"{name}^{{commit}}"],
                           cwd=ROOT, capture_output=True, text=True)
    if found.returncode != 0:
        raise StudyError(f"'{name}' is no revision of this repository")
    return found.stdout.strip()


def _build(revision):
    """The program of `revision`, from a work tree of its own below build-against/."""
    tree = ROOT / "build-against" / revision[:10]
    program = tree / "build" / "mbs"
    if program.exists():
        return program
    for command in ([] if tree.exists() else [["git", "worktree", "prune"], [
            "git", "worktree", "add", "--detach", str(tree), revision]]) + [
            ["cmake", "-S", str(tree), "-B", str(tree / "build"), "-G", "Ninja",
             "-DCMAKE_BUILD_TYPE=Release"],
            ["cmake", "--build", str(tree / "build"), "--target", "mbs_program"]]:
        print(f"{revision[:10]}: {' '.join(command[:2])} …", flush=True)
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
        if done.returncode != 0:
            lines = (done.stdout + done.stderr).strip().splitlines()[-15:]
            print("\n".join(lines), file=sys.stderr)
            raise StudyError(f"{revision[:10]} could not be built, see above")
    return program


def _start(layout, options, programs, variants):
    """Records what is measured, or refuses a directory that holds samples of something else."""
    record = {"contexts": {"new": cells.context(Contender(NULL, NULL))}, "variants": variants,
              "scenes": {scene: digest_of_scene(scene) for scene in options.scenes},
              "programs": {tree: digest(path) for tree, path in programs.items()}}
    if not continues(layout, record, ("programs", "variants", "scenes")):
        write_json(layout.run, record)


def _measure(layout, options, programs, variants):
    import pandas
    work = [(tree, path, variant, scene) for tree, path in programs.items()
            for variant in variants for scene in options.scenes]
    rows, skipped, tell = [], set(), Teller()
    for number in range(1, options.rounds + 1):
        order = random.Random(f"{SEED}:{number}").sample(work, len(work))
        for place, (tree, path, variant, scene) in enumerate(order):
            tell(f"round {number} of {options.rounds}: {variant}, {scene}, {tree}",
                 (number - 1 + place / len(work)) / options.rounds)
            if (variant, scene) in skipped:
                continue
            raw = layout.results / "raw" / f"round{number}" / (
                f"{tree}-{variant.replace('/', '.')}@{scene.replace(':', '')}.json")
            record = _sample(raw, path, variant, scene)
            step, reason = _step_us(record, raw)
            rows.append({"tree": tree, "implementation": variant, "scene": scene, "round": number,
                         "step_us": step, "reason": reason,
                         "raw_file": str(raw.relative_to(layout.results))})
            if reason:
                skipped.add((variant, scene))
    tell.end()
    table = pandas.DataFrame(rows)
    write_csv(layout.results / "samples.csv", table)
    return table


def _sample(raw, path, variant, scene):
    if raw.exists():
        return read_json(raw)
    ended = child.run([str(path), "bench", scene, "--implementation", variant,
                       "--benchmark_min_time=0.02", "--benchmark_repetitions=1",
                       "--benchmark_format=json"], SECONDS, MEMORY_MB)
    try:
        record = json.loads(ended.stdout)
    except ValueError:
        record = {"failure": ended.reason}
    write_json(raw, record)
    return record


def _step_us(record, raw):
    """(microseconds a step, "") or (None, why not). StudyError if `raw` is in another format."""
    try:
        if "failure" in record:
            return None, record["failure"]
        row = record["benchmarks"][0]
        if row.get("error_occurred"):
            return None, row.get("error_message", "failed")
        return row["step_us"], ""
    except (KeyError, IndexError, TypeError, AttributeError) as error:
        raise StudyError(f"{raw} has no time of a step (benchmarks[0].step_us): its program is of a "
                         "revision that this tree's study/against cannot read") from error


def _tell(layout, samples, revision):
    import pandas
    from analysis.statistics import median, ratio_interval
    rows = []
    for (variant, scene), group in samples.groupby(["implementation", "scene"], sort=False):
        trees = {tree: {number: one.to_numpy() for number, one in of_tree.groupby("round").step_us}
                 for tree, of_tree in group.dropna(subset="step_us").groupby("tree")}
        if set(trees) != {"old", "new"} or (group.reason != "").any():
            rows.append({"implementation": variant, "scene": scene,
                         "reason": next((text for text in group.reason if text), "no samples")})
            continue
        ratio, low, high = ratio_interval(trees["new"], trees["old"])
        rows.append({"implementation": variant, "scene": scene,
                     "old_us": median(group[group.tree == "old"].step_us),
                     "new_us": median(group[group.tree == "new"].step_us),
                     "ratio": ratio, "low": low, "high": high, "reason": ""})
    table = pandas.DataFrame(rows)
    write_csv(layout.results / "ratios.csv", table)
    print(f"\ntime of a step, this tree / {revision[:10]} (95 % interval; below 1: faster now)")
    for row in rows:
        if row["reason"]:
            print(f"{row['implementation']:28} {row['scene']:14} {row['reason'][:60]}")
        else:
            print(f"{row['implementation']:28} {row['scene']:14} {row['old_us']:10.3g} -> "
                  f"{row['new_us']:10.3g} us  {row['ratio']:.3f} ({row['low']:.3f} to "
                  f"{row['high']:.3f})")
    print(f"table: {layout.results / 'ratios.csv'}")
