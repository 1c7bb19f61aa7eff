# The settings that advice considers, as options of `mbs simulate`, who serves them, and who is tried: implementations near the fastest by the rule
# of `mbs describe`; how long a step of each takes.
import math
from itertools import product

from analysis.core.outcomes import FINISHED
from study.core.setting import LOOSENED, Setting
from study.tools.advise.choice import LEAST_STEPS
from study.tools.advise.runner import QUICK, REPEATS
from study.tools.advise.search import LOST

PROJECTIONS = dict.fromkeys(("penalty", "saddle-point"), ("both", "velocity", "none"))
SCHEMES = ("penalty", "saddle-point", "rattle", "rattle4", "rattle6", "multistep6")
CHEAP = (("projections", "velocity"), ("tolerance", "one-pass"))
OTHERS = [Setting("saddle-point", (("tangent", "every-step"),)), *(Setting(scheme, (change, *CHEAP)) for scheme, change in (
    ("saddle-point", ("tangent", "kept")), ("penalty", ("precision", "single")), ("penalty", ("geometric-stiffness", ""))))]
BEHIND = 3.0  # times the least time that the rule foresees: who is slower is not tried; its times are right to a factor of
              # 1.5, mostly
DEAR = 100.0  # us a step from which probes are as short as they can be
LONGEST = 20.0  # s, of a probe
HALVINGS = 7    # of a probe's step, for a run that comes to its end
SHARE = 0.3     # of the budget: when probes must be done; twice that while there is no time of any


def catalogue():
    """Scheme × projections × tolerance, a scheme's own first; of what else changes a step, what was the fastest somewhere (README.md)."""
    return [*(Setting(scheme, tuple(one for one in zip(("projections", "tolerance"), values) if one[1] not in ("both", "auto")))
              for scheme in SCHEMES for values in product(PROJECTIONS.get(scheme, ("both",)), ("auto", *LOOSENED))), *OTHERS]


def fits(setting, scene):
    """Why a scheme cannot be used for a scene (`mbs describe --json`), or ""."""
    terms = scene["terms"]
    if not setting.scheme.startswith(("rattle", "multistep")):
        return ""
    if terms["driven_constraints"] or terms["factors"] or scene["driven_points"] or scene["driven_vectors"]:
        return "not for scenes with drivers"
    return "not for scenes with dampers" if terms["damping"] else ""


def serving(setting, variants):
    """Names of the `variants` ({name: what `mbs list --json` says}) that serve a setting."""
    return [name for name, said in variants.items() if setting.needs <= set(said["settings"])]


def find_speeds(advice, settings, run):
    """Fills `advice.speeds`. The rule does not know who simulates the scene: whoever does not is no measure of who is near."""
    able, seen = dict(advice.variants), set()
    while True:
        tried, advice.left_out = named(advice.described, able, [one for one in settings if serving(one, able)], advice.everyone)
        rows, found = probe({name: able[name] for name in tried if name not in seen}, advice.described, run,
                            advice.question.first_step, advice.question.duration)
        advice.probe += rows
        advice.speeds, seen = _sorted(advice.speeds | found), seen | set(tried)
        if missed := seen - {row["implementation"] for row in advice.probe}:
            advice.hurry(f"no time was left to try {', '.join(sorted(missed))}")
            return
        if not (unable := [row["implementation"] for row in rows if row["status"] == "unsupported"]):
            return
        able = {name: said for name, said in able.items() if name not in unable}


def named(described, variants, settings, everyone=False):
    """({implementation: foreseen us a step or nan} to try, fastest first; {implementation: why it is left out}): those near the fastest by the
    rule of `mbs describe`, who is sparse and unknown to it, and who else is needed for a setting; all without a rule, or if `everyone` is."""
    foreseen = _foreseen(described, variants)
    order = sorted(foreseen, key=foreseen.get)
    if everyone or not foreseen:
        return {name: foreseen.get(name, math.nan) for name in dict.fromkeys((*order, *variants))}, {}
    tried = [name for name in order if foreseen[name] <= BEHIND * foreseen[order[0]]]
    form = Setting(described["scheme"]["take"])
    tried += [name for name in serving(form, variants) if name not in foreseen and not variants[name]["dense"]]
    for setting in settings:
        serves = serving(setting, variants)
        if not set(serves) & set(tried):
            tried.append(min(serves, key=lambda name: foreseen.get(name, math.inf)))
    return {name: foreseen.get(name, math.nan) for name in tried}, {
        name: f"{foreseen[name] / foreseen[order[0]]:.1f} times the time of {order[0]} by the rule of mbs describe"
        if name in foreseen else "the rule of mbs describe does not name it" for name in variants if name not in tried}


def probe(variants, described, run, step, duration):
    """(rows, {implementation: us a step} of those that simulate the scene, fastest first), in the rule's form and in steps so short that a run
    comes to its end; foreseen or nan if none does. Those for which no time is left have no row."""
    rows, speeds, foreseen = [], {}, _foreseen(described, variants)
    form = Setting(described["scheme"]["take"])
    shortest = step / 2**HALVINGS
    for name in variants:
        run.tell(f"probe: {name}")
        usual = min([foreseen.get(name, math.inf), *(us for us in speeds.values() if us > 0)])
        steps, at = QUICK if usual < DEAR else LEAST_STEPS, step
        setting = form if name in serving(form, variants) else Setting()
        while (left := run.left(SHARE if (known := any(row["status"] in FINISHED for row in rows)) else 2 * SHARE)) > 0 or not rows:
            limit = min(LONGEST, max(2.0, left), 1.0 + 7e-6 * run.slowdown * REPEATS * steps * usual if known else math.inf)
            rows.append(run("probe", setting, name, at, min(duration, steps * at), limit))
            if rows[-1]["status"] in FINISHED:
                speeds[name], step = rows[-1]["step_us"], at
                break
            if rows[-1]["status"] in LOST or at < step:  # passes of steps that are too long say little
                speeds[name] = foreseen.get(name, math.nan)
            if rows[-1]["status"] not in LOST or at <= shortest:
                break
            at /= 2
    return rows, _sorted(speeds)


def _foreseen(described, variants):
    return {one["implementation"]: one["step_us"] for one in described["recommendation"] if one["implementation"] in variants}


def _sorted(speeds):
    return dict(sorted(speeds.items(), key=lambda item: (math.isnan(item[1]), item[1])))
