# What the page says besides its figures: who is late, what the machine loses; the answer to "Which mechanism keeps its deadlines?".
from pathlib import Path

from analysis.core.outcomes import FINISHED
from analysis.core.text import answers as said, number
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
    steps, machine, judging = (tables[name] for name in ("steps", "machine", "judging"))
    searched = {step: [(layer, [*_first(rows).itertuples()], others) for layer, rows, others in _layers(tables["largest"], step, view)]
                for step in view.settings["steps"]}
    return said(Path(__file__).with_name("answers.j2"), "Not measured: no implementation of this part took part.", searched=searched,
                settings=view.settings, bounds=BOUNDS, large=LARGE, variables=_variables, observed=steps[steps.missed.notna()],
                nulls=machine[machine.status == "done"], judging=judging[judging.share.notna()])


def cases(tables, view):
    """Row of the front page's table: how large a four-bar may be at the longest step that was searched."""
    step = max(view.settings["steps"])
    known = [(layer, _first(rows)) for layer, rows, _ in _layers(tables["largest"], step, view) if rows.largest.max() > 0]
    told = "; ".join(f"of {layer} up to {_variables(first.largest.iloc[0])} variables ({', '.join(first.implementation)})" for layer, first in known)
    return [{"case": "You have a deadline", "link": "realtime.html#largest",
             "take": f"what `study/advise` names for your scene, with `--deadline-us`; the four-bar in steps of {number(1e3 * step)} ms, without more "
                     f"deadlines missed than the machine itself loses: {told}"}] if told else []


def _layers(largest, step, view):
    """(layer, its rows that were searched, how many were not) of a step in the penalty form, where there are any that were."""
    rows = largest[(largest.scheme == "penalty") & (largest.step == step)]
    own, known = rows.implementation.isin(view.registry.own), rows.largest.notna()
    for layer, mine in (("the libraries", ~own), ("our own code", own)):
        if (mine & known).any():
            yield layer, rows[mine & known], (mine & ~known).sum()


def _first(rows):
    return rows[rows.largest == rows.largest.max()]


def _variables(loops):
    return number(2 * loops + 2, 6)
