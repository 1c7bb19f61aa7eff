# Families of real mechanisms at their own fill: who is fastest on each, by size.
from analysis.core.timing import LEFT_OUT, processes as rows_of
from study.core.cell import Cell
from study.core.timing import measure
from study.limit.plan import LOOK, ask_gate, elsewhere, environment, timed

SETTINGS = {"scenes": list,     # families with their sizes, as the program takes them, the most telling first
            "processes": int,   # of a scene
            "samples": int}     # of a process and contender


def columns(settings, studyset):
    return {"mechanisms": settings["seconds"]}


def run(lab, column):
    """First a look at everyone; then those on whom an answer may stand, as far as the gate agrees with them."""
    here = [one for one in lab.contenders if one.environment == environment(lab)]
    for scene in lab.settings["scenes"] if here else []:
        lab.one(Cell("describe", scene, role="about"))
        elsewhere(lab, Cell("bench", scene, role=f"look{LEFT_OUT}"))
        look = rows_of(measure(lab, scene, here, processes=1, repetitions=1, settings=LOOK, role="look", drop=True))
        timed(lab, scene, ask_gate(lab, scene, look, here, "gate"), "time")
