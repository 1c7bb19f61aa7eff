# The answer to "Which mechanism keeps its deadlines?", from the tables.
from analysis.core.text import number


def answers(tables, view):
    largest, own = tables["largest"], view.registry.own
    searched = largest[(largest.scheme == "penalty") & largest.largest.notna()]
    found = []
    for step in view.settings["steps"]:
        rows = searched[searched.step == step]
        layers = {"libraries": rows[~rows.implementation.isin(own)], "own code": rows[rows.implementation.isin(own)]}
        said = [_best(name, one) for name, one in layers.items() if len(one)]
        if said:
            found.append({"anchor": "largest", "text": f"Steps of {number(1e3 * step)} ms: {'. '.join(said)}."})
    return [*found, *_clean(tables["steps"], view), *_machine(tables["machine"])] or [
        {"text": "Not measured: no implementation of this part took part.", "anchor": ""}]


def _clean(steps, view):
    """How many runs missed nothing."""
    observed = steps[steps.missed.notna()]
    text = (f"{(observed.missed == 0).sum()} of {len(observed)} runs of {number(view.settings['duration'])} s missed no "
            "deadline at all.")
    return [{"anchor": "steps", "text": text}] if len(observed) else []


def _machine(machine):
    """What the null processes lost: how far this machine allows real time."""
    said = [f"{number(rows.lost.sum(), 5)} deadlines of {number(1e3 * step)} ms in {number(rows.seconds.sum())} s"
            for step, rows in machine[machine.status == "done"].groupby("step")]
    return [{"anchor": "machine", "text": f"The machine itself lost {' and '.join(said)}."}] if said else []


def _best(layer, rows):
    row = rows.loc[rows.largest.idxmax()]
    if not row.largest:
        return f"None of the {layer} keeps up with any size"
    text = (f"Of {layer} {row.implementation} keeps up with N = {number(row.largest, 4)} ({row.missed} of {row.steps} steps missed, "
            f"{row.null_missed} lost by the null process)")
    if row.next == row.next:
        text += f", and not with N = {number(row.next, 4)} ({row.next_reason})"
    return text
