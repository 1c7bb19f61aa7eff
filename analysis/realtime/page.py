# What the page says besides its figures: who is late, what the machine loses.
from analysis.core.outcomes import FINISHED
from analysis.realtime.tables import HOPELESS


def context(tables, view):
    steps, largest, machine = tables["steps"], tables["largest"], tables["machine"]
    searched = largest[largest.largest.notna()]
    return {"settings": view.settings, "steps": steps.to_dict("records"), "finished": FINISHED, "hopeless": HOPELESS,
            "largest": searched.to_dict("records"), "not_searched": len(largest) - len(searched),
            "dropped": int((steps.status == "dropped").sum()), "incomplete": int((~searched.complete.astype(bool)).sum()),
            "tried": len(tables["tried"]), "machine": losses(machine), "judging": tables["judging"].to_dict("records")}


def losses(machine):
    """[(deadline, processes, seconds, lost, largest gap)] of the null processes."""
    done = machine[machine.status == "done"]
    return [(step, len(rows), rows.seconds.sum(), rows.lost.sum(), rows.largest_us.max())
            for step, rows in done.groupby("step")]
