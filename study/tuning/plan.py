# Settings that were tried for a library's variants and not taken, each beside the variant itself.
from dataclasses import replace

from study.core.cell import twin_of
from study.core.contest import CHECK_S, Asked, agreeing, controls_of, usual
from study.core.profile import by_share
from study.core.timing import measure

SETTINGS = {"scenes": [str], "steps": int, "processes": int, "samples": int}


def alternatives(lab):
    """The gate; then, a scene at a time, whoever it agrees with."""
    here, scenes = asked(lab), lab.settings["scenes"]
    controls = controls_of(scenes)
    for scene, good in zip(scenes, agreeing(lab, [Asked(one, here) for one in scenes if here], each=CHECK_S, seconds=4 * CHECK_S, drop=True)):
        twins = [twin_of(one) for one in good if one.variant not in lab.registry.tried][:1] if scene in controls else []
        measure(lab, scene, [*good, *twins], processes=lab.settings["processes"], repetitions=lab.settings["samples"],
                settings=("--steps", lab.settings["steps"]))


def asked(lab):
    """Each variant that takes part on the pair of most, and what was tried for it; without the latter it does not."""
    found = ()
    for one in usual(lab):
        if tried := [name for name, said in lab.registry.tried.items() if said["tried_for"] == one.variant]:
            found += (one, *(replace(one, name=name, variant=name) for name in tried))
    return found


columns, run = by_share({"alternatives": (1.0, alternatives)})
