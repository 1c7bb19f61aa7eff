# Settings that were tried for a library's variants and not taken, each beside the variant itself.
from dataclasses import replace

from study.core.cell import Cell
from study.core.timing import measure
from study.limit.plan import CHECK_S, environment

SETTINGS = {"scenes": list,     # the most telling first
            "steps": int,       # of a scene's stretch
            "processes": int,   # of a scene
            "samples": int}     # of a process and contender


def columns(settings, studyset):
    return {"alternatives": settings["seconds"]}


def run(lab, column):
    """A scene at a time: the gate, then whoever it agrees with."""
    here = asked(lab)
    for scene in lab.settings["scenes"] if here else []:
        said = lab.run([Cell("check", scene, here, ("--time-limit", CHECK_S), "gate", seconds=4 * CHECK_S)], drop=True)[0].verdicts
        good = [one for one in here if said.get(one.variant, ("",))[0] == "agrees"]
        measure(lab, scene, good, processes=lab.settings["processes"], repetitions=lab.settings["samples"],
                settings=("--steps", lab.settings["steps"]), drop=True)


def asked(lab):
    """Each variant that takes part on the pair of most, and what was tried for it; without the latter it does not."""
    found = ()
    for one in lab.contenders:
        tried = [name for name, said in lab.registry.tried.items() if said["tried_for"] == one.variant]
        if tried and one.environment == environment(lab):
            found += (one, *(replace(one, name=name, variant=name) for name in tried))
    return found
