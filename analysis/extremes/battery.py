# The battery's table: every run beside the truth; who ends alike.
import shlex

import pandas

from analysis.core.errors import StudyError
from analysis.core.outcomes import GOOD, of_run
from analysis.extremes import cells, judge

NOT_RUN = ("unsupported", "refused", "excluded", "dropped", "unavailable")
REFERENCE = "reference"  # the role of its runs
ALIKE = 10.0             # errors within this factor are alike


def rows(records, registry, every):
    """A row a run of the cells `every`, in the order of cells, settings and implementations."""
    known = {(cell.name, f"{cell.step:g}"): place for place, cell in enumerate(every)}
    alone = {cell.name: cell for cell in every}  # a cell with a reference is the only one of its scene
    settings = {setting.file_name: setting.name for some in (*(cell.settings for cell in every), cells.OTHERS) for setting in some}
    implementations = list(registry.variants)
    references, truths, found = {}, {}, []
    for record in records:
        scene = judge.scene_of(record)
        if record.role == REFERENCE and scene in alone:
            references.setdefault(scene, {})[round(alone[scene].step / record.option("--step"))] = record
        elif record.role not in settings or (scene, f"{record.option('--step'):g}") not in known:
            raise StudyError(f"{record.name}: its cell is none of the battery: the set is of another state of it")
    for record in records:
        if record.role != REFERENCE:
            place = known[judge.scene_of(record), f"{record.option('--step'):g}"]
            cell = every[place]
            name = record.cell["contenders"][0]
            order = place, list(settings).index(record.role), implementations.index(name)
            times = record.series.get("t", [])
            same = place, len(times)  # all runs of a cell are judged at the same times
            if same not in truths:
                truths[same] = judge.true_motion(cell, references.get(cell.name, {}), times)
            found.append((order, _row(record, cell, name, settings[record.role], *truths[same])))
    return [row for _, row in sorted(found, key=lambda one: one[0])]


def _row(record, cell, name, setting, solutions, own, truth):
    status, reason = of_run(record)
    # Its own word, where it knows the exact motion, covers instants and points that are not kept.
    reported = (record.output.get("position_error_max") or 0.0) / cell.length
    error = judge.error_of(record, solutions, cell.length)
    error = error if not reported > error else reported
    limit = judge.allowed(cell, solutions)
    beyond = limit + (own or 0.0)
    since = judge.wrong_from(record, solutions, cell.length, beyond)
    verdict = judge.verdict(status, error, beyond, since, cell.harmless) if solutions and record.done and status not in NOT_RUN else ""
    silent = verdict == judge.SILENT
    return {"axis": cell.axis, "value": cell.label, "implementation": name, "setting": setting, "status": status,
            "reason": reason, "failed_at": record.output.get("failed_at"), "true_error": error, "truth": truth,
            "truth_error": own, "allowed": limit, "verdict": verdict, "silent": silent, "near": cell.near,
            "wrong_from": since, "steps": cell.steps, "step": cell.step,
            "penalty": record.output.get("penalty"), "passes_per_step": record.output.get("passes_per_step"),
            "command": shlex.join(record.command) if verdict in (judge.SILENT, judge.FALSE) else "", "record": record.name}


def ran(table):
    """The rows that are runs: neither refused nor left out."""
    return table[~table.status.isin(NOT_RUN)]


def kind(row):
    """What a row is shown as."""
    if row.silent:
        return "silent"
    if row.status in GOOD:
        return "ok" if row.true_error == row.true_error else "unjudged"
    return row.status


def groups(table):
    """{setting: [(names, rows of them)]}: implementations of one setting of which each two are alike in every cell."""
    found = {}
    for setting, rows in table.groupby("setting", sort=False):
        members = []
        for name, own in rows.groupby("implementation", sort=False):
            mine = {(row.axis, row.value): row for row in own.itertuples()}
            home = next((group for group in members if all(_alike(mine, other) for _, other in group)), None)
            members.append([(name, mine)]) if home is None else home.append((name, mine))
        found[setting] = [(tuple(name for name, _ in group), [rows for _, rows in group]) for group in members]
    return found


def _alike(first, second):
    """Whether two implementations end alike: the same outcome in each cell, errors within ALIKE."""
    return set(first) == set(second) and all(_same(first[key], second[key]) for key in first)


def _same(first, second):
    errors = [max(row.true_error, row.truth_error) for row in (first, second)]
    return kind(first) == kind(second) and (any(error != error for error in errors)
                                            or max(errors) <= ALIKE * min(errors))


def table(records, registry, every):
    return pandas.DataFrame(rows(records, registry, every))
