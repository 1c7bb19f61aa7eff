# What the page says besides its figures: who is late, what judging costs.
from analysis.core.outcomes import FINISHED
from analysis.realtime.verdict import HOPELESS


def context(tables, view):
    steps, largest, machine = tables["steps"], tables["largest"], tables["machine"]
    searched = largest[largest.largest.notna()]
    return {"settings": view.settings, "steps": steps.to_dict("records"), "finished": FINISHED, "hopeless": HOPELESS,
            "largest": searched.to_dict("records"), "not_searched": len(largest) - len(searched),
            "dropped": int((steps.status == "dropped").sum()), "incomplete": int((~searched.complete.astype(bool)).sum()),
            "tried": len(tables["tried"]), "machine": losses(machine), "judging": judging(steps)}


def losses(machine):
    """[(deadline, processes, seconds, lost, largest gap)] of the null processes."""
    done = machine[machine.status == "done"]
    return [(step, len(rows), rows.seconds.sum(), rows.lost.sum(), rows.largest_us.max())
            for step, rows in done.groupby("step")]


def judging(steps):
    """The row of the largest share of a step that judging takes; None without times."""
    rows = steps[steps.judge_us.notna() & steps.mean_us.notna()]
    if rows.empty:
        return None
    share = rows.judge_us / rows.mean_us
    return rows.loc[share.idxmax()].to_dict() | {"share": share.max()}
