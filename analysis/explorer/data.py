# What the explorer knows of a set: the samples of every contest, so that a page can rank anew whoever is left; points of error
# and time; the rule that predicts.
import re
from collections import namedtuple
from collections.abc import Callable
from dataclasses import dataclass

import numpy
import pandas

from analysis.accuracy import points as accuracy
from analysis.accuracy.subjects import columns
from analysis.accuracy.winners import cut, meeting
from analysis.core import records, schema, timing
from analysis.core.contest import by_scene, grouped
from analysis.core.files import read_object
from analysis.core.gather import gather
from analysis.core.view import Folder, View, facts_of
from analysis.families.tables import SCHEMES, family_of
from analysis.map.results import FAILURES, Results
from analysis.map.timed import AFTER

DIGITS = 6  # of samples


@dataclass(frozen=True)
class Contest:
    """A scene and form of the step that contenders were timed on."""
    part: str
    scene: str
    form: str
    n: float
    fill: float              # %
    rows: pandas.DataFrame   # those of timing.processes that count
    able: list               # who may be ranked
    lost: dict               # {name: (status, reason)} of the others
    failed: list             # those of them of whom nothing is known
    look: dict               # {name: µs a step} of a first look
    rank: Callable           # names → timing.Ranking, as the part itself does it
    beyond: tuple = timing.NO_VARIANCE  # of timing.Paired

    family = property(lambda self: family_of(self.scene))


def of_families(folder):
    about, table = (schema.read_table(folder, "families", name) for name in ("mechanisms", "scenes"))
    about = about[about.n.notna() & about.fill.notna()].set_index("scene")
    table = table[table.scene.isin(about.index) & ~table.implementation.isin(Folder(folder).registry.examples)]
    by_role = grouped(records.read_part(folder, "families"))
    for form in SCHEMES:
        timed = dict(by_scene(by_role.get(form, [])))
        for scene, cells in table[(table.scheme == form) & table.scene.isin(timed)].groupby("scene", sort=False):
            rows = timed[scene][timed[scene].status == "ok"]
            good = (cells.status == "ok") & (cells.verdict == "agrees")
            if able := list(cells.implementation[good]):
                yield Contest("families", scene, form, about.n[scene], about.fill[scene], rows, able,
                              {row.implementation: (row.status, row.reason) for row in cells[~good].itertuples()}, [],
                              cells.set_index("implementation").look_us.dropna().to_dict(),
                              lambda names, rows=rows, able=able: timing.rank(rows, [name for name in able if name in names]))


def of_map(folder):
    results = Results({"tidy": schema.read_table(folder, "map", "tidy")}, View(folder, "map"))
    names = results.layer("all")
    for scene in results.samples()[results.samples().fill_percent.notna()].scene.unique():
        rows = results.rows(scene)
        good = rows[rows.status == "ok"]
        lost = rows[~rows.status.isin(["ok", "dropped"])].drop_duplicates("implementation").set_index("implementation")
        if able := [name for name in names if name in set(good.implementation) and name not in lost.index]:
            yield Contest("map", scene, SCHEMES[0], rows.variables.iloc[0], rows.fill_percent.iloc[0], good, able,
                          {name: (row.status, row.reason) for name, row in lost.iterrows() if name in names},
                          [name for name in names if name in lost.index and lost.status[name] in FAILURES],
                          rows.groupby("implementation").pilot_us.first().dropna().to_dict(),
                          lambda names, scene=scene: results.rank(scene, names), results.beyond(scene))


# A scene whose runs were judged: its points with error and time; of which curves the budget left out finer values.
Curve = namedtuple("Curve", "subject scene title unit n fill points rounds cut")


def of_accuracy(folder):
    view = View(folder, "accuracy")
    tables = {name: schema.read_table(folder, "accuracy", name) for name in ("points", "references")}
    about = tables["references"].drop_duplicates("subject").set_index("subject")
    kinds = columns(view.settings)
    timed = accuracy.timed([one for one in records.read_part(folder, "accuracy") if kinds.get(one.column, ("pairs",))[0] != "pairs"])
    for (subject, scene), rows in tables["points"].groupby(["subject", "scene"], sort=False):
        known, mine = about.loc[subject], meeting(rows, numpy.inf)
        if len(mine):
            yield Curve(subject, scene, known.title, known.unit, rows.variables.max(), 100 * rows.fill.dropna().median(), mine,
                        accuracy.rounds(rows, timed), cut(tables["points"][tables["points"].subject == subject], scene))


def read(folder):
    """{part: its contests or curves}; [] of a part without tables."""
    return {part: [*find(folder)] if (folder / part / schema.DIGESTS).exists() else []
            for part, find in (("families", of_families), ("map", of_map), ("accuracy", of_accuracy))}


def as_json(folder, found, number):
    """A set as the page has it. `number`: {name: its place in the page's list of names}."""
    facts, rule = facts_of(folder), folder / "families" / "rule.json"
    return {"name": folder.name, "machine": facts["context"].get("cpu_model", ""), "date": facts["date"], "commit": facts["context"]["commit"],
            "times": read_object(rule, times=dict)["times"] if rule.exists() else {}, "mechanisms": _mechanisms(folder) if found["families"] else {},
            "contests": [_contest(one, number) for part in ("families", "map") for one in found[part]],
            "curves": [_curve(one, number) for one in found["accuracy"]]}


def _mechanisms(folder):
    numbers = [name for name, (kind, _, _) in schema.of_part("families")["mechanisms"].items() if kind == "number"]
    rows = schema.read_table(folder, "families", "mechanisms").to_dict("records")
    return {row["scene"]: {"family": row["family"]} | {name: row[name] for name in numbers if pandas.notna(row[name])} for row in rows}


def names_of(found):
    """Every name that takes part in something, anchors of other environments included."""
    return [name for part in ("families", "map") for one in found[part] for name in (*one.rows.implementation, *one.lost, *one.look)] + [
        name for one in found["accuracy"] for name in (*one.points.implementation, *(ended[0] for ended in one.cut))]


def _contest(one, number):
    keys, rows = {}, []  # {a process: its place}
    for row in one.rows[["implementation", "environment", "process", "record", "samples"]].itertuples(index=False):
        place = keys.setdefault(row[1:4], len(keys))
        rows.append([number[row.implementation], place, [_short(value) for value in row.samples]])
    layouts = timing.layouts_of(one.rows)
    return {"part": one.part, "scene": one.scene, "form": one.form, "family": one.family, "n": one.n, "fill": _short(one.fill),
            "beyond": one.beyond, "able": [number[name] for name in one.able], "failed": [number[name] for name in one.failed],
            "lost": [[*why, places] for why, places in gather((why, number[name]) for name, why in one.lost.items()).items()],
            "look": [[number[name], _short(us)] for name, us in one.look.items()],
            "processes": [[environment, int(process), bool(one.part == "map" and process > AFTER), record, layouts.get(process, "")]
                          for environment, process, record in keys],
            "rows": rows}


def _curve(one, number):
    points = one.points[["implementation", "setting", "step", "error", "time", "time_low", "time_high", "time_from", "record"]]
    labels = {accuracy.label(point): place for place, point in enumerate(points.to_dict("records"))}
    rows = [[labels[row.implementation], int(row.process), row.status, _known(row.seconds)]
            for row in one.rounds.itertuples() if row.implementation in labels]
    return one._asdict() | {
        "family": family_of(one.scene), "rounds": rows,
        "cut": [[number[name], setting, _known(error), _known(time)] for name, setting, error, time in one.cut],
        "points": [[number[row.implementation], row.setting, row.step, *map(_known, (row.error, row.time, row.time_low, row.time_high)),
                    row.time_from if isinstance(row.time_from, str) else None, row.record] for row in points.itertuples(index=False)]}


def _known(value):
    return None if numpy.isnan(value) else _short(value)


def _short(value):
    return float(f"{value:.{DIGITS}g}")


def size_of(contests):
    """{kind of a scene: (a, b)}: n = a N + b for scenes KIND:N, where all that were timed agree on it."""
    sizes = {}
    for one in contests:
        if known := re.fullmatch(r"([\w-]+):(\d+)((?:,dimension=\d)?)", one.scene):
            sizes.setdefault((known[1], known[3]), {})[int(known[2])] = one.n
    lines = {kind: numpy.polyfit(list(found), list(found.values()), 1) for kind, found in sizes.items() if len(found) > 1}
    return [[*kind, round(a, 6), round(b, 6) + 0.0] for kind, (a, b) in lines.items()
            if all(abs(a * size + b - n) < 1e-6 for size, n in sizes[kind].items())]
