# What the page says besides its figures: who is late, what the machine loses.
from analysis.core.outcomes import FINISHED
from analysis.realtime.tables import HOPELESS


def context(tables, view):
    steps, largest, machine = tables["steps"], tables["largest"], tables["machine"]
    searched, nulls = largest[largest.largest.notna()], machine[machine.status == "done"].groupby("step")
    return {"settings": view.settings, "steps": steps.to_dict("records"), "finished": FINISHED, "hopeless": HOPELESS,
            "largest": searched.to_dict("records"), "not_searched": len(largest) - len(searched),
            "dropped": int((steps.status == "dropped").sum()), "incomplete": int((~searched.complete.astype(bool)).sum()),
            "judging": tables["judging"].to_dict("records"),
            "machine": [(step, len(rows), rows.seconds.sum(), rows.lost.sum(), rows.largest_us.max()) for step, rows in nulls]}
