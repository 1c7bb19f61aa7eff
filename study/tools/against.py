# study/against REVISION: times this tree and another revision of it, whose program is built beside. Two programs cannot share a process: fresh
# ones alternate, old new new old, so that what drifts falls on both alike. A ratio is that of two neighbours, its interval one over pairs.
import json
import subprocess
from dataclasses import replace
from pathlib import Path

import pandas

from analysis.core import timing
from analysis.core.files import ROOT, StudyError, digest, write
from analysis.core.text import layout
from study.core import child, locks
from study.core.cell import Cell, by_environment
from study.core.executor import program_of
from study.core.front import build as built, set_up
from study.core.options import Parser, directory, rounds
from study.core.studyset import beginning, describe, listed, need_own, select, writable
from study.tools import shelf

SECONDS = 120.0  # of a process
# Google's option makes the programs of older revisions take turns too; later ones do so anyway.
WORDS = ("--benchmark_repetitions=20", "--benchmark_min_time=0.005", "--benchmark_enable_random_interleaving=true")
ORDER = (("old", 1), ("new", 1), ("new", 2), ("old", 2))  # of a round


def against(arguments):
    parser = Parser(prog="study/against", description="Builds another revision beside this tree and times both in alternating processes.")
    parser.add_argument("revision", help="of git, for instance HEAD~1")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME", help="only these implementations (folder or folder/variant)")
    parser.add_argument("--scenes", nargs="+", metavar="SCENE", default=[
        "four-bar:10", "four-bar:40", "four-bar:79", "four-bar:499"], help="(four-bar:10 four-bar:40 four-bar:79 four-bar:499)")
    parser.add_argument("--rounds", type=rounds, default=4, help="each has two processes of each program (4)")
    parser.add_argument("--results", type=directory, metavar="DIR", help="(results/local/against-REVISION)")
    parser.add_argument("--wait", action="store_true", help="queue behind a study that is running")
    options = parser.parse_args(arguments)
    revision = _resolve(options.revision)[:10]
    folder = options.results or ROOT / "results" / "local" / f"against-{revision}"
    need_own(folder)
    writable(folder)
    with locks.only_one(folder), locks.only_one_study(options.wait):
        set_up(folder / "run.log")
        known = listed()
        with beginning(folder):  # before the other revision is built for nothing
            names = select(known, options.only)
            for scene in options.scenes:
                describe(scene)
        build = _build(revision, folder / "run.log")
        old = digest(ROOT / program_of(build=build))[:16]
        lab, contenders = shelf.open_shelf(folder, "against", known, options.only, names, scenes=options.scenes, old=old)
        there = _variants_of(build)
        rows = [{"implementation": one.name, "scene": scene, "reason": f"is not in {revision}"}
                for one in contenders if one.variant not in there for scene in options.scenes]
        for scene in options.scenes:
            for group in by_environment(one for one in contenders if one.variant in there).values():
                rows += _ratios(lab, scene, group, options.rounds, build, revision)
        lab.display.end()
    table = shelf.table(rows, "ratios")
    write(folder / "ratios.csv", lambda partial: table.to_csv(partial, index=False))
    print(layout(Path(__file__).with_name("against.txt.j2")).render(revision=revision, rows=table.itertuples(), table=folder / "ratios.csv"))


def _resolve(name):
    found = subprocess.run(["git", "rev-parse", "--verify", "--quiet", f"{name}^{{commit}}"], cwd=ROOT, capture_output=True, text=True)
    if found.returncode != 0:
        raise StudyError(f"'{name}' is no revision of this repository")
    return found.stdout.strip()


def _build(revision, log):
    """Builds `mbs` of `revision` in a work tree of its own; the name of that build (executor.program_of)."""
    build = f"against/{revision}/build"
    tree = (ROOT / program_of(build=build)).parent.parent
    checkout = [] if tree.exists() else [["git", "worktree", "prune"], ["git", "worktree", "add", "--detach", str(tree), revision]]
    for command in [] if (tree / "build" / "mbs").exists() else [
            *checkout, ["cmake", "-S", str(tree), "-B", str(tree / "build"), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"],
            ["cmake", "--build", str(tree / "build"), "--target", "mbs_program"]]:
        built(command, f"{revision}: {' '.join(command[:2])}", log)
    return build


def _variants_of(build):
    """Names of the variants that the program of the other revision has."""
    ended = child.run([program_of(build=build), "list", "--json"], 60, 4096)
    try:
        return {variant["name"] for entry in json.loads(ended.stdout)["implementations"] for variant in entry["variants"]}
    except (ValueError, KeyError, TypeError) as error:
        raise StudyError(f"{program_of(build=build)} list --json says nothing that this tree can read") from error


def _ratios(lab, scene, group, count, build, revision):
    """Rows of a scene's contenders of one environment. Where a process of all of them ends badly, each alone."""
    found = {"old": [], "new": []}
    for number in range(1, count + 1):
        for tree, place in ORDER:
            who = group if tree == "new" else [replace(one, name=f"{one.variant}+{revision}", build=build) for one in group]
            record = lab.one(Cell("bench", scene, tuple(who), WORDS, tree, 2 * (number - 1) + place, timed=True, seconds=SECONDS))
            found[tree].append(record)
            if not record.done:
                if len(group) > 1:
                    return [row for one in group for row in _ratios(lab, scene, [one], count, build, revision)]
                return [{"implementation": group[0].name, "scene": scene, "record": record.name,
                         "reason": f"{tree}: {record.status}: {record.reason}"}]
    return [_row(one.name, scene, found) for one in group]


def _row(name, scene, found):
    trees = []
    for tree, records in found.items():
        try:
            rows = timing.processes(records)
        except (KeyError, TypeError) as error:
            raise StudyError(f"raw/against/{records[0].name}: lacks {error}: its program is of a revision that this "
                             "tree's study/against cannot read") from error
        trees.append(rows[rows.implementation.str.partition("+")[0] == name].assign(implementation=tree))
    row = {"implementation": name, "scene": scene, "record": " ".join(one[0].name for one in found.values())}
    both = pandas.concat(trees)
    if len(wrong := both[both.status != "ok"]):
        return row | {"reason": f"{wrong.implementation.iloc[0]}: {wrong.status.iloc[0]}: {wrong.reason.iloc[0]}"}
    if both.steps.nunique() > 1 or both.start.nunique() > 1:
        return row | {"reason": "the two programs time different stretches"}
    # By the clock, since what the processor's time covers is not alike in all revisions.
    ratio = timing.ratio(timing.apart(both, "clock_us"), "new", "old")
    middle = both.groupby("implementation").clock_us.median()
    return row | {"old_us": middle["old"], "new_us": middle["new"], "ratio": ratio.value, "low": ratio.low, "high": ratio.high,
                  "pairs": len(found["old"])}
