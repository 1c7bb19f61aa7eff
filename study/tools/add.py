# study/add NAME: times a new or changed implementation against those who lead the cells of a set's map.
#
# The newcomer, the leader and the runner-up of the libraries and the leader of all take turns in fresh processes: what
# the set has of the others is never paired with new samples. Records: SET/raw/added/NAME/, the result: SET/added/NAME.csv.
import datetime
import shutil
from collections import Counter
from dataclasses import dataclass, replace

from analysis.core import schema, timing
from analysis.core.errors import StudyError
from analysis.core.files import ROOT, digest, read_json, write, write_json
from analysis.map.timed import differing
from study.core import executor, locks, profile as profiles
from study.core.contender import CONTROL, on_usual_pairs
from study.core.executor import program_of
from study.core.gate import verdicts
from study.core.main import set_up
from study.core.options import Parser, directory
from study.core.front import duration
from study.core.studyset import StudySet, context_of, listed, opened, select, sets_in, writable
from study.core.timing import measure
from study.tools import shelf

SHARE = 0.2     # of the time that all parts of the set's profile have
PASSES = (3, 5)  # processes of all scenes before there are more of any
MOST_SAMPLES, TURN = 40, 0.005  # of a process; s, the least that a turn takes
GATE_S = 20     # s of a check
NOT_TIMED = ("dropped", "slower", "timeout")  # statuses of who might still be the fastest
PATIENT = 8     # times the slowest rival's stretch: whose first takes longer is left out
RESULTS = ROOT / "results"
LOG = RESULTS / "local" / "add.log"  # of setting up
SAME = ("machine", "compiler", "flags", "build_type")  # of two contexts


def add(arguments):
    parser = Parser(prog="study/add", description="Measures a new or changed implementation into a set of the same machine "
                    "and libraries: the newcomer beside the leaders of each cell of its map, in fresh common processes.")
    parser.add_argument("name", metavar="NAME", help="folder or folder/variant")
    parser.add_argument("--to", type=directory, metavar="SET", help="its directory (the newest of this machine and build in results/ and results/local)")
    parser.add_argument("--wait", action="store_true", help="queue behind a study that is running")
    options = parser.parse_args(arguments)
    if options.to:
        opened(options.to)
    with locks.only_one_study(options.wait):
        set_up(LOG)
        known = listed()
        select(known, [options.name], "")
        folder = options.to or newest(known)
        writable(folder)
        with locks.only_one(folder):
            table = measured(folder, options.name, known)
    tell(table, folder, options.name)
    return 0


def newest(known):
    """The newest set with a map of this machine and build, stored or one's own."""
    found = [one for one in sets_in(RESULTS, RESULTS / "local") if "map" in one.facts["parts"]]
    now = context_of(replace(CONTROL, blas=next(name for name, why in known.pairs.items() if not why)))
    for one in found:
        if not executor.differing(one.facts["context"], now, SAME):
            return one.folder
    others = ", ".join(f"{one.folder.relative_to(ROOT)} is of {one.facts['context'].get('cpu_model', 'another')}" for one in found)
    raise StudyError(f"no set with a map is of this machine and build{f' ({others})' * bool(others)}: study/run --part map makes one in "
                     "some minutes, with every implementation in it; for a first look: build/mbs bench four-bar:10 four-bar:40")


@dataclass(frozen=True)
class _Present(StudySet):
    """A set's folder with the present program, whatever the set's is."""
    present: dict  # {environment: context}

    def context(self, one):
        return self.present[one.environment]

    def need_programs(self, names):
        """Nothing: _begin sees to them."""

    @property
    def facts(self):
        return {"context": next(iter(self.present.values()))}


def measured(folder, name, known):
    """The table of one newcomer, or several variants of one, which is written."""
    newcomers = select(known, [name], "")
    cells = schema.read_table(folder, "map", "cells")
    cells = cells[cells.winner != ""]
    steps = schema.read_table(folder, "map", "scenes").set_index("scene")
    times = _times(schema.read_table(folder, "map", "tidy"))
    profile = profiles.read(folder / "profile.yaml", StudySet(folder).facts["profile"], [])
    rivals = {*cells.winner, *cells[cells.layer == "libraries"].second} & set(known.variants)
    contenders = {one.name: one for one in on_usual_pairs(known, profile.blas, [*newcomers, *sorted(rivals - set(newcomers))])}
    present = contexts(folder, contenders.values())
    column = name.replace("/", ".")
    lab = shelf.ToolLab(_Present(folder, present), "added", column, SHARE * sum(part["seconds"] for part in profile.parts.values()))
    _begin(folder, column, lab)
    scenes = list(dict.fromkeys(cells.scene))
    chosen = {scene: _rivals(cells[cells.scene == scene], newcomers, contenders) for scene in scenes}
    verdicts, records = {}, {}
    for count in PASSES:
        for scene in scenes:
            verdicts[scene] = verdicts.get(scene) or _gate(lab, scene, newcomers, contenders)
            fit = [contenders[one] for one in newcomers if verdicts[scene][one][0] == "ok"]
            if fit and chosen[scene]:
                records[scene] = measure(lab, scene, [*fit, *(contenders[one] for one in chosen[scene])], processes=count,
                                         **_size(lab, times.get(scene, {}), chosen[scene], steps.steps[scene], len(scenes)))
    lab.display.end()
    context = present[contenders[newcomers[0]].environment]
    rows = [row | {"commit": context["commit"], "dirty": context["dirty"]} for scene in scenes
            for row in _rows(cells[cells.scene == scene], known, verdicts[scene], records.get(scene, []), steps.loc[scene])]
    return _finish(folder, column, lab, rows)


def contexts(folder, contenders):
    """{environment: what its program says now}; StudyError naming what differs from the set."""
    known, found = StudySet(folder), {}
    for one in contenders:
        if one.environment in found:
            continue
        now = found[one.environment] = context_of(one)
        kept = folder / "contexts" / f"{one.environment.replace('|', '-')}.json"
        then = read_json(kept) if kept.exists() else known.facts["context"]
        if other := executor.differing(then, now, (*SAME, "blas_loaded") if kept.exists() else SAME):
            key, its, here = other
            raise StudyError(f"{folder} is of another machine or build ({then.get('cpu_model', '')}; here: {now.get('cpu_model', '')}): "
                             f"its {key} is '{its}', here it is '{here}'; times of both cannot stand side by side")
        lost = versions(then) - versions(now)
        if lost:
            raise StudyError(f"{folder} is of other libraries: it has {', '.join(sorted(lost))}, here there is "
                             f"{', '.join(sorted(versions(now) - versions(then))) or 'none of it'}")
    return found


def versions(context):
    """The libraries with their versions, as a set of texts."""
    return {one.strip() for one in context.get("libraries", "").split(";")} - {""}


def _begin(folder, column, lab):
    """Goes on with the records of this very program, or removes those of an earlier one."""
    path, program = folder / "added" / f"{column}.json", digest(ROOT / program_of())
    if not path.exists() or read_json(path).get("program") != program:
        shutil.rmtree(lab.base / column, ignore_errors=True)
        (folder / "added" / f"{column}.csv").unlink(missing_ok=True)
    write_json(path, {"program": program})
    lab.set.clear()


def _rivals(cells, newcomers, contenders):
    """Names: the leader and the runner-up of the libraries, and the leader of all; those that are still there."""
    libraries = cells[cells.layer == "libraries"]
    names = dict.fromkeys([*libraries.winner, *libraries.second, *cells[cells.layer == "all"].winner])
    return [name for name in names if name in contenders and name not in newcomers]


def _gate(lab, scene, newcomers, contenders):
    """{newcomer: (status, reason)}. Being right takes nothing of the budget of times."""
    spent = lab.spent
    said = verdicts(lab, scene, [contenders[name] for name in newcomers], each=GATE_S, seconds=2 * GATE_S)
    lab.budget += lab.spent - spent
    return {one.name: ("ok", "") if found[0] == "agrees" else found for one, found in said.items()}


def _times(tidy):
    """{scene: {implementation: µs a step}} that the set has; for the number of samples only."""
    return {scene: rows.groupby("implementation").step_us.median().dropna().to_dict()
            for scene, rows in tidy[tidy.kind == "timing"].groupby("scene")}


def _size(lab, times, rivals, steps, scenes):
    """How many samples fill a process's share of the budget, and when one has waited too long for a stretch."""
    stretches = [1e-6 * steps * times[name] for name in rivals if name in times] or [1.0]
    turns = sum(max(one, TURN) for one in (*stretches, max(stretches)))  # the newcomer taken for as slow as the slowest
    samples = min(max(round(0.6 * lab.budget / (scenes * PASSES[-1]) / turns), 1), MOST_SAMPLES)
    patience = max(PATIENT * max(stretches), 0.5)
    return {"repetitions": samples, "settings": ("--patience", f"{patience:.3g}"),
            "seconds": 30 + 3 * samples * turns + 5 * patience}


def _rows(cells, known, verdicts, records, asked):
    """A row for each layer of a scene and newcomer that has a place in it. `verdicts`: of the newcomers."""
    rows = timing.processes(records)
    good = rows[rows.status == "ok"]
    wrong = differing(rows) if len(rows) else {}
    if len(good) and set(zip(good.steps, good.start)) != {(asked.steps, asked.start)}:
        wrong = dict.fromkeys(verdicts, "the program times another stretch than the set's") | wrong
    for cell in cells.itertuples():
        others = [name for name in good.implementation.unique() if name not in verdicts and "+" not in name and name not in wrong
                  and (cell.layer == "all" or name not in known.own)]
        for name in verdicts:
            if cell.layer == "libraries" and name in known.own:
                continue
            status, reason = _standing(rows[rows.implementation == name], verdicts[name], wrong.get(name))
            row = {"scene": cell.scene, "variables": cell.variables, "layer": cell.layer, "implementation": name, "before": cell.winner,
                   "hands": "not timed" if status in NOT_TIMED else "stays", "record": records[0].name if records else "",
                   "status": status, "reason": reason}
            yield row | (_compared(rows, name, timing.rank(rows, others), cell.winner) if status == "ok" else {})


def _standing(rows, verdict, wrong):
    """(status, reason) of a newcomer: what the gate says, then what its processes say; what was dropped counts where no other was
    timed. `wrong`: what makes its times none."""
    if verdict[0] != "ok" or wrong:
        return verdict if verdict[0] != "ok" else ("disagrees", wrong)
    lost = rows[(rows.status != "ok") & ((rows.status != "dropped") | ~(rows.status == "ok").any())]
    return (lost.status.iloc[0], lost.reason.iloc[0]) if len(lost) else verdict


def _compared(rows, name, ranking, before):
    """What a newcomer's row says of it beside the fastest of the others."""
    if ranking is None:
        return {"hands": "open", "reason": "none of those who led the cell could be timed"}
    ratio = timing.ratio(rows, name, ranking.winner)
    times = rows[rows.status == "ok"].groupby("implementation").step_us.median()
    hands = "open" if ratio.low <= 1 <= ratio.high else "changes" if (ratio.high < 1) != (before == name) else "stays"
    return {"rival": ranking.winner, "ratio": ratio.value, "low": ratio.low, "high": ratio.high, "hands": hands,
            "step_us": times[name], "rival_us": times[ranking.winner],
            "processes": len(timing.log_ratios(rows, name, ranking.winner))}


def _finish(folder, column, lab, rows):
    table = shelf.table(rows, "added")
    path = folder / "added" / f"{column}.csv"
    write(path, lambda partial: table.to_csv(partial, index=False))
    write_json(path.with_suffix(".json"), read_json(path.with_suffix(".json")) | {
        "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M"), "context": lab.set.facts["context"],
        "table": digest(path), "records": {name: digest(lab.base / name) for name in sorted(lab.names)}})
    shutil.rmtree(lab.set.scratch, ignore_errors=True)
    lab.tell(duration(lab.spent))
    return table


def tell(table, folder, name):
    print(f"\ntime of {name} over that of the fastest other one, timed anew (95 % interval)")
    for row in table.itertuples():
        print(f"{row.scene:24} {row.layer:10} " + (f"{row.status}: {row.reason}" if row.status != "ok" or not row.rival else (
            f"{row.implementation} ÷ {row.rival}: {row.ratio:.3f} ({row.low:.3f} to {row.high:.3f})"
            + ("" if row.hands == "stays" else f": {row.hands}{' hands' if row.hands == 'changes' else ''}"))))
    counts = Counter(table.hands)
    print(f"{counts['changes']} cells change hands, {counts['open']} are open, {counts['stays']} stay, "
          f"{counts['not timed']} were not timed")
    print(f"table: {folder / 'added' / name.replace('/', '.')}.csv")
