# study/add NAME: times a new or changed implementation beside those who lead a set's mechanisms, in both forms of the step, and its map, in
# fresh processes: what the set has of the others is never paired with new samples. README.md has what it leaves.
import datetime
import shutil
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from analysis.core import schema, timing
from analysis.core.files import ROOT, StudyError, digest, read_object, write, write_json
from analysis.core.text import layout
from analysis.core.view import context_in
from study.core import executor, locks, profile as profiles
from study.core.cell import control, on_usual_pairs
from study.core.contest import Asked, verdicts
from study.core.front import duration, set_up
from study.core.options import Parser, directory
from study.core.setting import Setting
from study.core.studyset import StudySet, context_of, listed, need_records, opened, select, sets_in, writable
from study.core.timing import measure
from study.tools import shelf
from study.tools.merge import machine

TABLES = {"families": "winners", "map": "cells"}  # of the parts that say who leads
SHARE = 0.2     # of the time that all parts of the set's profile have
GATES = 0.5     # of this, at most, for checks
PASSES = (3, 5)  # processes of all contests before there are more of any
MOST_SAMPLES, TURN = 40, 0.005  # of a process; s, the least that a turn takes
GATE_S = 20     # s of a check
NOT_TIMED = ("dropped", "slower", "timeout")  # statuses of who might still be the fastest
PATIENT = 8     # times the slowest rival's stretch: whose first takes longer is left out
RESULTS = ROOT / "results"
LOG = RESULTS / "local" / "add.log"  # of setting up
NUMBER = r"\d[\d.]*(e[-+]?\d+)?"  # of a reason
SAME = ("machine", "compiler", "flags", "build_type")  # of two contexts


def add(arguments):
    parser = Parser(prog="study/add", description="Times a new or changed implementation beside the leaders of a set, in each cell of the set's "
                    "mechanisms and map, in fresh common processes. The set must be of the same machine and libraries.",
                    epilog="Exit status: 0, or 1 if it could be timed nowhere.")
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
            need_records(opened(folder))
            table = measured(folder, options.name, known)
    tell(table, folder, options.name)
    return 0 if (table.status == "ok").any() else 1


def newest(known):
    """The newest set with leaders of this machine and build, stored or one's own."""
    found = [one for one in sets_in(RESULTS, RESULTS / "local") if TABLES.keys() & set(one.facts["parts"])]
    now = context_of(control(known, profiles.load("quick", []).blas))
    for one in found:
        if not executor.differing(one.facts["context"], now, SAME):
            return one.folder
    others = ", ".join(f"{one.folder.relative_to(ROOT)} is of {one.facts['context'].get('cpu_model', 'another')}" for one in found)
    raise StudyError(f"no set with mechanisms or a map is of this machine and build{f' ({others})' * bool(others)}: study/run --part map makes one in "
                     "some minutes, with every implementation in it; for a first look: build/mbs bench four-bar:10 four-bar:40")


@dataclass(frozen=True)
class _Present(StudySet):
    """A set's folder with the present program, whatever the set's is."""
    present: dict  # {environment: context}

    facts = property(lambda self: {"context": next(iter(self.present.values()))})

    def context(self, one):
        return self.present[one.environment]

    def need_programs(self, names):
        """Nothing: _begin sees to them."""


@dataclass(frozen=True)
class Contest:
    """A scene and form of the step that somebody leads in the set."""
    part: str
    scene: str
    scheme: str
    variables: float
    led: list        # rows with layer, winner and second
    form: tuple      # words of the command line, as the set's records have them
    stretch: tuple   # the same, of what is timed ...
    steps: float     # ... and how long that is
    start: float     # s
    times: dict      # {name: µs a step}, for the number of samples only
    newcomers: list  # names
    beyond: tuple = timing.NO_VARIANCE  # of timing.Paired

    def rivals(self, there):
        """The leader and the runner-up of the libraries, and the leader of all; those that are still there."""
        names = dict.fromkeys(name for row in self.led for name in ((row.winner, row.second) if row.layer == "libraries" else (row.winner,)))
        return [name for name in names if name in there and name not in self.newcomers]


def contests(studyset, newcomers, known):
    """Those that one of the newcomers serves; StudyError naming a record or table of the set that was changed."""
    found, seeds = [], machine.of_seeds(studyset)
    for part in studyset.facts["parts"]:
        there = {one.name: one for one in schema.records_of(studyset.folder, part, studyset.facts["context"])}
        if part not in TABLES:
            continue
        rows = schema.read_table(studyset.folder, part, TABLES[part])
        rows = (rows if "scheme" in rows else rows.assign(scheme=Setting().scheme))[rows.winner != ""]
        for (scene, scheme), led in rows.groupby(["scene", "scheme"], sort=False):
            records = [there[name] for name in dict.fromkeys(" ".join(led.record).split())]
            asked = records[0].options
            form, stretch = ((f"--{name}", asked[name]) if name in asked else () for name in ("scheme", "steps"))
            timed = timing.processes(records).loc[lambda rows: rows.status == "ok"]
            times = timed.groupby("implementation").step_us.median().to_dict()
            found.append(Contest(part, scene, scheme, led.variables.iloc[0], list(led.itertuples()), form, stretch, timed.steps.iloc[0],
                                 timed.start.iloc[0], times, [name for name in newcomers if known.serves(name, *Setting(scheme).needs)],
                                 seeds if "fill=" in scene else timing.NO_VARIANCE))
    return [one for one in found if one.newcomers]


def measured(folder, name, known):
    """The table of one newcomer, or several variants of one, which is written."""
    newcomers = select(known, [name], "")
    profile = profiles.read(folder / "profile.yaml", StudySet(folder).facts["profile"], [])
    if not (asked := contests(StudySet(folder), newcomers, known)):
        raise StudyError(f"{folder} has neither mechanisms nor a map that {name} could be timed on: study/run --part map families measures them")
    rivals = {rival for one in asked for rival in one.rivals(known.variants)}
    contenders = {one.name: one for one in on_usual_pairs(known, profile.blas, [*newcomers, *sorted(rivals - set(newcomers))])}
    present = contexts(folder, contenders.values())
    column = name.replace("/", ".")
    lab = shelf.ToolLab(_Present(folder, present), "added", column, SHARE * sum(part["seconds"] for part in profile.parts.values()))
    _begin(folder, column, lab)
    print(f"{len(asked)} contests of {folder}, at most {duration(lab.budget)}", flush=True)
    verdicts = _gates(lab, asked, contenders)
    records, share = [[] for _ in asked], 0.6 * lab.left / max(1, len(asked) * PASSES[-1])
    for count in PASSES:
        for place, one in enumerate(asked):
            fit = [contenders[name] for name in one.newcomers if verdicts[place][name][0] == "ok"]
            chosen = one.rivals(contenders)
            if fit and chosen:
                fit += [contenders[name] for name in chosen]
                records[place] = measure(lab, one.scene, fit, processes=count, **_size(share, one, chosen))
    lab.display.end()
    context = present[contenders[newcomers[0]].environment]
    rows = [row | {"commit": context["commit"], "dirty": context["dirty"]} for one, said, found in zip(asked, verdicts, records)
            for row in _rows(one, known, said, found)]
    return _finish(folder, column, lab, timing.holm(rows, "part", "scheme", "layer"))


def contexts(folder, contenders):
    """{environment: what its program says now}; StudyError naming what differs from the set."""
    known, found = StudySet(folder), {}
    for environment, one in {one.environment: one for one in contenders}.items():
        now = found[environment] = context_of(one)
        kept = folder / "contexts" / f"{environment.replace('|', '-')}.json"
        then = context_in(kept) if kept.exists() else known.facts["context"]
        if other := executor.differing(then, now, (*SAME, "blas_loaded") if kept.exists() else SAME):
            key, its, here = other
            raise StudyError(f"{folder} is of another machine or build ({then.get('cpu_model', '')}; here: {now.get('cpu_model', '')}): "
                             f"its {key} is '{its}', here it is '{here}'; times of both cannot stand side by side")
        if lost := versions(then) - versions(now):
            raise StudyError(f"{folder} is of other libraries: it has {', '.join(sorted(lost))}, here there is "
                             f"{', '.join(sorted(versions(now) - versions(then))) or 'none of it'}")
    return found


def versions(context):
    """The libraries with their versions, as a set of texts."""
    return {one.strip() for one in context.get("libraries", "").split(";")} - {""}


def _begin(folder, column, lab):
    """Goes on with the records of this very program, or removes those of an earlier one."""
    path, program = folder / "added" / f"{column}.json", digest(ROOT / executor.program_of())
    if not path.exists() or read_object(path).get("program") != program:
        shutil.rmtree(lab.base / column, ignore_errors=True)
        (folder / "added" / f"{column}.csv").unlink(missing_ok=True)
    write_json(path, {"program": program})
    lab.set.clear()


def _gates(lab, asked, contenders):
    """[{newcomer: (status, reason)}] of each contest"""
    whole, lab.budget = lab.budget, GATES * lab.budget
    found = verdicts(lab, [Asked(one.scene, [contenders[name] for name in one.newcomers], settings=one.form) for one in asked],
                     each=GATE_S, seconds=2 * GATE_S, drop=True)
    lab.budget = whole
    return [{who.name: ("ok", "") if verdict[0] == "agrees" else verdict for who, verdict in said.items()} for said in found]


def _size(share, contest, rivals):
    """How many samples fill a process's share of the budget, s, and when one has waited too long for a stretch."""
    stretches = [1e-6 * contest.steps * contest.times[name] for name in rivals if name in contest.times] or [1.0]
    turns = sum(max(one, TURN) for one in (*stretches, max(stretches)))  # the newcomer taken for as slow as the slowest
    samples, patience = min(max(round(share / turns), 1), MOST_SAMPLES), max(PATIENT * max(stretches), 0.5)
    return {"repetitions": samples, "settings": (*contest.form, *contest.stretch, "--patience", f"{patience:.3g}"),
            "seconds": 30 + 3 * samples * turns + 5 * patience}


def _rows(contest, known, verdicts, records):
    """A row for each layer and newcomer that has a place in it. `verdicts`: of the newcomers."""
    rows = timing.processes(timing.counted(records))
    paired = timing.Paired(rows, contest.beyond)
    good = rows[rows.status == "ok"]
    wrong = timing.differing(rows) if len(rows) else {}
    if len(good) and set(zip(good.steps, good.start)) != {(contest.steps, contest.start)}:
        wrong = dict.fromkeys(verdicts, "the program times another stretch than the set's") | wrong
    for cell in contest.led:
        others = [name for name in good.implementation.unique() if name not in verdicts and "+" not in name and name not in wrong
                  and (cell.layer == "all" or name not in known.own)]
        for name in (one for one in verdicts if cell.layer == "all" or one not in known.own):
            status, reason = _standing(rows[rows.implementation == name], verdicts[name], wrong.get(name))
            row = {"part": contest.part, "scene": contest.scene, "scheme": contest.scheme, "variables": contest.variables, "layer": cell.layer,
                   "implementation": name, "before": cell.winner, "hands": "not timed" if status in NOT_TIMED else "stays",
                   "record": records[0].name if records else "", "status": status, "reason": reason}
            yield row | (_compared(rows, paired, name, timing.rank(paired, others), cell.winner) if status == "ok" else {})


def _standing(rows, verdict, wrong):
    """(status, reason) of a newcomer: the gate's, then its processes'; what was dropped counts where no other was timed. `wrong`: with its times."""
    if verdict[0] != "ok" or wrong:
        return verdict if verdict[0] != "ok" else ("disagrees", wrong)
    lost = rows[(rows.status != "ok") & ((rows.status != "dropped") | ~(rows.status == "ok").any())]
    return (lost.status.iloc[0], lost.reason.iloc[0]) if len(lost) else verdict


def _compared(rows, paired, name, ranking, before):
    """What a newcomer's row says of it beside the fastest of the others."""
    if ranking is None:
        return {"hands": "open", "reason": "none of those who led the cell could be timed"}
    ratio = timing.ratio(paired, name, ranking.winner)
    times = rows[rows.status == "ok"].groupby("implementation").step_us.median()
    hands = "open" if ratio.low <= 1 <= ratio.high else "changes" if (ratio.high < 1) != (before == name) else "stays"
    return {"rival": ranking.winner, **ratio.columns(), "chance": ratio.chance, "decided": hands != "open", "holm": False, "hands": hands,
            "step_us": times[name], "rival_us": times[ranking.winner], "processes": len(timing.log_ratios(paired, name, ranking.winner))}


def _finish(folder, column, lab, rows):
    table = shelf.table(rows, "added")
    path = folder / "added" / f"{column}.csv"
    write(path, lambda partial: table.to_csv(partial, index=False))
    write_json(path.with_suffix(".json"), read_object(path.with_suffix(".json")) | {
        "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M"), "context": lab.set.facts["context"],
        "table": digest(path), "records": {name: digest(lab.base / name) for name in sorted(lab.names)}})
    shutil.rmtree(lab.set.scratch, ignore_errors=True)
    lab.tell(duration(lab.spent))
    return table


def tell(table, folder, name):
    parts = []
    for part, rows in table.groupby("part", sort=False):
        ranked = rows[(rows.status == "ok") & (rows.rival != "")]
        others = rows.drop(ranked.index)
        others["reason"] = others.reason.str.replace(": the scene has .*", "", regex=True)  # of a term: where, in each of them
        alike = others.reason.str.replace(NUMBER, "", regex=True)
        left = [(status, some.reason.iloc[0] + " (or alike)" * (some.reason.nunique() > 1), some.scene.unique())
                for (status, _), some in others.groupby(["status", alike], sort=False)]
        parts.append((part, ranked, left, Counter(rows.hands), (rows.holm.fillna(False) & (rows.hands == "changes")).sum()))
    path = folder / "added" / f"{name.replace('/', '.')}.csv"
    print(layout(Path(__file__).with_name("add.txt.j2")).render(name=name, parts=parts, table=path))
