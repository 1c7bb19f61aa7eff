# The battery's table: every run beside the truth, and what its outcome is worth; runs of a verdict by kind, those that are equal as one.
import shlex

from analysis.core.files import StudyError
from analysis.core.outcomes import FINISHED, GOOD, WHOLE, of_run
from analysis.extremes import cells, judge, trials

NOT_RUN = ("unsupported", "refused", "excluded", "dropped", "unavailable")
KINDS = ("silent", "other", "crashed", "out-of-memory", "timeout", "diverged", "wrong-branch", "not-converged", "degraded", "unjudged", "ok",
         "refused")  # what a row is shown as, the worst first
REFERENCE = "reference"  # the role of its runs
RIGHT, SILENT, FALSE, TOLD, STOPPED = ALL = "right", "silently wrong", "false alarm", "told", "stopped"  # verdicts
FAR = 0.3  # clearance from a change point, beyond which nothing jumps


def table(records, registry):
    """A row a run, in the order of cells, settings and implementations."""
    every = [*trials.all_trials(), *cells.extremes()]
    known = {(cell.name, f"{cell.step:g}"): place for place, cell in enumerate(every)}
    alone = {cell.name: cell for cell in every}  # a cell with a reference is the only one of its scene
    settings = {setting.file_name: setting.name for some in (*(cell.settings for cell in every), cells.OTHERS) for setting in some}
    roles, names = list(settings), list(registry.variants)
    references, truths, runs, rows = {}, {}, [], []
    for record in records:
        scene, step = record.cell["scene"], f"{record.option('--step'):g}"
        scene = scene if scene.startswith("harness/") else scene.rpartition("/")[2].removesuffix(".json")  # that, or a file of the set's own
        if record.role == REFERENCE and scene in alone:
            references.setdefault(scene, {})[round(alone[scene].step / float(step))] = record
        elif record.role not in settings or (scene, step) not in known:
            raise StudyError(f"{record.name}: its cell is none of the battery: the set is of another state of it")
        else:
            runs.append((known[scene, step], roles.index(record.role), names.index(record.cell["contenders"][0]), record))
    for place, _, _, record in sorted(runs, key=lambda one: one[:3]):
        cell, times = every[place], record.series.get("t", [])
        same = place, len(times)  # all runs of a cell are judged at the same times
        if same not in truths:
            motion = judge.true_motion(cell, references.get(cell.name, {}), times)
            truths[same] = judge.allowed(cell, motion[0]), *motion
        rows.append(_row(record, cell, settings[record.role], *truths[same]))
    return rows


def _row(record, cell, setting, limit, solutions, own, truth):
    (status, reason), failed_at = of_run(record), record.output.get("failed_at")
    beyond = limit + (own or 0.0)
    error, since = judge.off(record, solutions, cell.length, beyond)
    # Its own word, where it knows the exact motion, covers instants and points that are not kept.
    reported = (record.output.get("position_error_max") or 0.0) / cell.length
    error = reported if reported > error else error
    jumps_nowhere = cell.motion and failed_at and status not in FINISHED and cell.motion.clearance(failed_at) > FAR
    worth = verdict(status, error, beyond, since, ("wrong-branch",) if jumps_nowhere else cell.harmless) if (
        solutions and record.done and status not in NOT_RUN) else ""
    command = iter(record.command)  # what repeats the run, without the files that the study reads
    words = (word for word in command if not (word == "--json" or word in ("--trajectory", "--output", "--every") and next(command)))
    return {"axis": cell.axis, "value": cell.label, "implementation": record.cell["contenders"][0], "setting": setting, "status": status,
            "reason": reason, "failed_at": failed_at, "true_error": error, "truth": truth, "truth_error": own, "allowed": limit,
            "verdict": worth, "near": cell.near, "wrong_from": since, "steps": cell.steps, "step": cell.step,
            "penalty": record.output.get("penalty"), "passes_per_step": record.output.get("passes_per_step"),
            "command": shlex.join(words) if worth in (SILENT, FALSE) else "", "record": record.name}


def extreme(table):
    """The rows of cells that are extreme in one respect: those that are no trials."""
    return table[table.axis.isin(cells.TELLING)]


def kind(row):
    """What a row is shown as, one of KINDS."""
    if row.verdict == SILENT:
        return "silent"
    if row.status in GOOD:
        return "ok" if row.true_error == row.true_error else "unjudged"
    return row.status if row.status in KINDS else "other"


def verdict(status, error, limit, wrong_from, harmless):
    """Of a run whose error is allowed to be `limit`. One that stopped (wrong-branch, diverged) before any instant kept at which it
    was wrong did so in time, unless its cell's motion deserves no such outcome (`harmless`)."""
    if status in GOOD:
        return RIGHT if error <= limit else SILENT
    if status in WHOLE:
        small = wrong_from is None and error <= limit / 10
        return FALSE if small and (status in FINISHED or status in harmless) else TOLD
    return TOLD if wrong_from is not None else FALSE if status in harmless else STOPPED


def judged(table):
    return table[table.verdict.isin(ALL)]


def counts(table):
    return {verdict: int((table.verdict == verdict).sum()) for verdict in ALL}


def kinds(table):
    """A row a kind: mechanisms, runs and their verdicts."""
    return [{"kind": kind, "mechanisms": rows.value.nunique(), "runs": len(rows)} | counts(rows) for kind, rows in judged(table).groupby("axis", sort=False)]


def by_setting(table):
    """{setting: (right runs, runs)} where more than the two forms was tried, of those who tried more; the best first."""
    runs = judged(table)
    more = runs[~runs.setting.isin([form.name for form in cells.FORMS])][["axis", "value", "implementation"]].drop_duplicates()
    found = {name: (int((rows.verdict == RIGHT).sum()), len(rows)) for name, rows in runs.merge(more).groupby("setting", sort=False)}
    return dict(sorted(found.items(), key=lambda one: -one[1][0] / one[1][1]))


def listed(table, verdict):
    """Runs of a verdict, those that are equal but for setting and implementation in one entry, with the worst of them."""
    return [{"kind": kind, "mechanism": mechanism, "step": step, "runs": len(rows), "settings": list(rows.setting.unique()),
             "commands": list(rows.command.unique())} | rows.loc[
                 rows.true_error.fillna(-1).idxmax(), ["true_error", "wrong_from", "status", "reason"]].to_dict()
            for (kind, mechanism, step), rows in table[table.verdict == verdict].groupby(["axis", "value", "step"], sort=False)]
