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
    found = []
    for step in view.settings["steps"]:
        if said := [_best(name, *searched) for name, *searched in _layers(tables["largest"], step, view)]:
            found.append({"anchor": "largest", "text": f"Steps of {number(1e3 * step)} ms: {'. '.join(said)}."})
    return [*found, *_clean(tables["steps"], tables["machine"], view), *_judging(tables["judging"])] or [
        {"text": "Not measured: no implementation of this part took part.", "anchor": ""}]


def cases(tables, view):
    """Row of the front page's table: how large a four-bar may be at the longest step that was searched."""
    step = max(view.settings["steps"])
    known = [(layer, _first(rows)) for layer, rows, _ in _layers(tables["largest"], step, view) if rows.largest.max() > 0]
    said = "; ".join(f"of {layer} up to {_variables(first.largest.iloc[0])} variables ({', '.join(first.implementation)})" for layer, first in known)
    return [{"case": "You have a deadline", "link": "realtime.html#largest",
             "take": f"what `study/advise` names for your scene, with `--deadline-us`; the four-bar in steps of {number(1e3 * step)} ms, without more "
                     f"deadlines missed than the machine itself loses: {said}"}] if said else []


def _layers(largest, step, view):
    """(layer, its rows that were searched, how many were not) of a step in the penalty form, where there are any that were."""
    rows = largest[(largest.scheme == "penalty") & (largest.step == step)]
    own, known = rows.implementation.isin(view.registry.own), rows.largest.notna()
    for layer, mine in (("the libraries", ~own), ("our own code", own)):
        if (mine & known).any():
            yield layer, rows[mine & known], (mine & ~known).sum()


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
    held = f"not held on {', '.join(f'{row.scene} ({number(100 * row.share, 2)} %)' for row in beyond.itertuples())}" if len(beyond) else "held"
    return [{"anchor": "judging", "text": f"Judging the motion costs at most {number(100 * known.share.max(), 2)} % of a step on {len(known)} scenes, beside "
             f"the implementation with the fastest steps. Bound “{number(100 * BOUNDS[True])} % from {LARGE} variables on, {number(100 * BOUNDS[False])} % below”: {held}"
             f"{'' if len(beyond) else f'; nearest to it: {most.scene}, {number(100 * most.share, 2)} %'}."}]


def _best(layer, rows, others):
    first = _first(rows)
    row, *equal = first.itertuples()
    lacking = f"; {others} not searched, as the budget was spent" if others else ""
    if not row.largest:
        return f"Of {layer} none keeps up with any size{lacking}"
    text = (f"Of {layer} {row.implementation} keeps up with N = {number(row.largest, 5)}, n = {_variables(row.largest)} ({row.missed} of {row.steps} "
            f"steps missed, {row.null_missed} lost by the null process)")
    if row.next == row.next:
        text += f", and not with N = {number(row.next, 5)} ({row.next_reason})"
    return text + "".join(f"; so does {one.implementation}" for one in equal) + lacking


def _first(rows):
    return rows[rows.largest == rows.largest.max()]


def _variables(loops):
    return number(2 * loops + 2, 6)
