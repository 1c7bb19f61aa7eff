# What the page says besides its figures: who is late, what the machine loses; the answer to "Which mechanism keeps its deadlines?".
from analysis.core.outcomes import FINISHED
from analysis.core.text import number
from analysis.realtime.tables import BOUNDS, HOPELESS, LARGE


def context(tables, view):
    steps, largest, machine = tables["steps"], tables["largest"], tables["machine"]
    searched, nulls = largest[largest.largest.notna()], machine[machine.status == "done"].groupby("step")
    return {"settings": view.settings, "steps": steps.to_dict("records"), "finished": FINISHED, "hopeless": HOPELESS,
            "largest": searched.to_dict("records"), "not_searched": len(largest) - len(searched),
            "dropped": int((steps.status == "dropped").sum()), "incomplete": int((~searched.complete.astype(bool)).sum()),
            "judging": tables["judging"].to_dict("records"),
            "machine": [(step, len(rows), rows.seconds.sum(), rows.lost.sum(), rows.largest_us.max()) for step, rows in nulls]}


def answers(tables, view):
    largest, own, found = tables["largest"], view.registry.own, []
    searched = largest[(largest.scheme == "penalty") & largest.largest.notna()]
    for step in view.settings["steps"]:
        rows = searched[searched.step == step]
        layers = {"the libraries": rows[~rows.implementation.isin(own)], "our own code": rows[rows.implementation.isin(own)]}
        if said := [_best(name, one) for name, one in layers.items() if len(one)]:
            found.append({"anchor": "largest", "text": f"Steps of {number(1e3 * step)} ms: {'. '.join(said)}."})
    return [*found, *_clean(tables["steps"], tables["machine"], view), *_judging(tables["judging"])] or [
        {"text": "Not measured: no implementation of this part took part.", "anchor": ""}]


def _clean(steps, machine, view):
    """How many runs missed nothing, and what the null processes lost: how far this machine allows real time."""
    observed = steps[steps.missed.notna()]
    missed = (f"{(observed.missed == 0).sum()} of {len(observed)} runs of {number(view.settings['duration'])} s missed no "
              "deadline at all.") if len(observed) else ""
    said = [f"{number(rows.lost.sum(), 5)} of the deadlines of {number(1e3 * step)} ms in {number(rows.seconds.sum())} s"
            for step, rows in machine[machine.status == "done"].groupby("step")]
    text = " ".join(filter(None, (missed, said and f"The machine itself lost {' and '.join(said)}.")))
    return [{"anchor": "steps" if missed else "machine", "text": text}] if text else []


def _judging(judging):
    """Whether judging costs no more of a step than it may."""
    known = judging[judging.share.notna()]
    if known.empty:
        return []
    beyond, most = known[~known.held.astype(bool)], known.loc[(known.share / known.bound).idxmax()]
    held = f"not held on {', '.join(beyond.scene)}" if len(beyond) else "held"
    return [{"anchor": "judging", "text": f"Judging the motion costs at most {number(100 * known.share.max(), 2)} % of a step on {len(known)} scenes, beside "
             f"the implementation with the fastest steps. Bound “{number(100 * BOUNDS[True])} % from {LARGE} variables on, {number(100 * BOUNDS[False])} % below”: {held}. "
             f"Nearest to it: {most.scene}, {number(100 * most.share, 2)} %."}]


def _best(layer, rows):
    row = rows.loc[rows.largest.idxmax()]
    if not row.largest:
        return f"Of {layer} none keeps up with any size"
    text = (f"Of {layer} {row.implementation} keeps up with N = {number(row.largest, 4)} ({row.missed} of {row.steps} steps missed, "
            f"{row.null_missed} lost by the null process)")
    if row.next == row.next:
        text += f", and not with N = {number(row.next, 4)} ({row.next_reason})"
    return text
