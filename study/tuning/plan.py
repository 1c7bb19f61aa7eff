# Settings that were tried for a library's variants and not taken, each beside the variant itself.
from dataclasses import replace

from analysis.tuning.tables import FORMS
from study.core.cell import twin_of
from study.core.contest import CHECK_S, Asked, agreeing, controls_of, usual
from study.core.profile import by_share
from study.core.setting import Setting
from study.core.timing import measure

SETTINGS = {"scenes": [str], "saddle_point": [str], "steps": int, "processes": int, "samples": int}


def alternatives(lab):
    """The gate; then, a scene at a time, whoever it agrees with. Forms take turns, as the budget may end before the last scene."""
    here, controls = asked(lab), controls_of(lab.settings["scenes"])
    cases = sorted((place, form, scene) for form in FORMS for place, scene in enumerate(lab.settings[FORMS[form].scenes]))
    gates = [Asked(scene, serving(lab, here, form), f"{FORMS[form].prefix}gate", Setting(form).words()) for _, form, scene in cases]
    for (_, form, scene), good in zip(cases, agreeing(lab, gates, each=CHECK_S, seconds=4 * CHECK_S, drop=True)):
        twins = [twin_of(one) for one in good if one.variant not in lab.registry.tried][:1] if form == "penalty" and scene in controls else []
        measure(lab, scene, [*good, *twins], processes=lab.settings["processes"], repetitions=lab.settings["samples"],
                settings=("--steps", lab.settings["steps"], *Setting(form).words()), role=f"{FORMS[form].prefix}time")


def asked(lab):
    """Each variant that takes part on the pair of most, and what was tried for it; without the latter it does not."""
    found = ()
    for one in usual(lab):
        if tried := [name for name, said in lab.registry.tried.items() if said["tried_for"] == one.variant]:
            found += (one, *(replace(one, name=name, variant=name) for name in tried))
    return found


def serving(lab, contenders, form):
    known = lab.registry.variants | lab.registry.tried
    return [one for one in contenders if Setting(form).needs <= {*known[one.variant].get("settings", [])}]


columns, run = by_share({"alternatives": (1.0, alternatives)})
