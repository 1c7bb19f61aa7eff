# Whole runs of 20 s at the paper's step, everything automatic: what each form must hold.
from study.advise_study.settings import Setting
from study.stability_study.grid import AUTOMATIC, Cell, row, run

STEP, DURATION = 1.25e-3, 20.0
LOOPS = {"penalty": (*range(1, 41), 80, 100, 150, 200, 300, 500),
         "saddle-point": (*range(1, 41), 80, 100, 150, 200, 300, 500, 1000, 2000),
         "rattle": (1, 2, 5, 10, 40), "rattle4": (1, 2, 10), "rattle6": (1, 2, 10)}
MUST_HOLD = {  # scheme: up to which N, position error (m), passes a step, steps at the pass limit
    "penalty": (200, 5e-3, 3.0, None), "saddle-point": (2000, 2e-3, 2.2, 0)}


def cells(contender, served):
    """The runs that `contender` serves; `served`: its settings in `mbs list --json`."""
    return [Cell(loops, scheme, "double", contender, STEP, AUTOMATIC)
            for scheme, sizes in LOOPS.items() if Setting(scheme).needs() <= set(served) for loops in sizes]


def record(cell, layout, contexts, seconds):
    return run(cell, layout, contexts, DURATION, seconds)


def judged(cell, found, layout):
    """The row of long.csv: that of stability.csv, and whether it holds what it must."""
    result = row(cell, found, layout, DURATION)
    return result | {"must_hold": holds(result)}


def holds(result):
    """"yes", "no", or "" where nothing is promised."""
    promised = MUST_HOLD.get(result["scheme"])
    if promised is None or result["loops"] > promised[0]:
        return ""
    _, error, passes, at_limit = promised
    kept = (result["status"] == "ok" and result["position_error_max"] < error
            and result["passes_per_step"] <= passes
            and (at_limit is None or result["steps_at_limit"] <= at_limit))
    return "yes" if kept else "no"
