# What setting a simulation up costs: one timed scene a size.
from study.core.timing import measure

SETTINGS = {"loops": list}  # sizes


def columns(settings, studyset):
    return {"sizes": settings["seconds"]}


def run(lab, column):
    for loops in lab.settings["loops"]:
        measure(lab, f"four-bar:{loops}", lab.contenders, processes=1, repetitions=1, drop=True)
