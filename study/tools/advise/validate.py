# study/advise --validate: the advice against an exhaustive search, on families of mechanisms and standard problems: every setting at every
# step, until it meets the smallest error or costs too much.
import math
from argparse import Namespace
from pathlib import Path

from analysis.core.files import StudyError, from_yaml
from analysis.core.outcomes import FINISHED
from study.core import locks
from study.core.cell import scene_name
from study.core.setting import Setting, read_settings
from study.core.studyset import describe, listed, select
from study.tools.advise import evidence, timing
from study.tools.advise.advice import SLOWER
from study.tools.advise.probe import catalogue, fits, probe, serving
from study.tools.advise.runner import EXACT, folder_of
from study.tools.advise.truth import FIRST_STEP, Truth

SCENES = from_yaml(Path(__file__).with_name("questions.yaml").read_text())
OTHERS, OTHERS_DURATION = "other scenes", 4.0  # kind; s
SHARES = (1e-2, 1e-3, 1e-4)  # of the scene's length (describe: judged_length): the errors that are asked for
CERTAIN = 0.1             # of an error: how well the motion must be known
ROUNDS_AT_MOST = 600.0    # s of timing a question
LEAST_STEPS, MOST_STEPS, RATIO = 20, 2e5, 2**-0.5  # of a run; of a step to the next longer one
BETWEEN = (0.96, 0.92, 0.85, 0.78, 0.6)  # of a step: what is run besides, to tell luck
UNKNOWN = ("unsupported", "timeout", "crashed", "out-of-memory")  # nothing of the motion
NEAR = 1.5        # times the fastest setting's time: others may be the fastest with another implementation
TOO_LONG = 20.0   # s, of a run


def validate(options, ask, runner_of, results):
    """`ask` and `runner_of` are those of main.py, which calls this. `options.scene`: only these; empty: all."""
    known = listed()
    names = select(known, options.only)
    variants = {name: known.variants[name] for name in names}
    with locks.only_one(results):
        for kind, scene, duration in questions(options.scene):
            folder = results / "scenes" / folder_of(scene)
            described = describe(scene)
            errors = [float(f"{share * described['judged_length']:.2g}") for share in SHARES]
            with locks.only_one_study(options.wait):
                run = runner_of(folder, {"scene": scene, "duration": duration}, described, names, known)
                if not scene.startswith("four-bar:"):  # of which the exact motion is known
                    run.tell(f"{scene}: reference")
                    run.truth = Truth(run.lab, scene, described, run.contenders[_reference(described, variants, run)],
                                      duration, CERTAIN * min(errors))
                asked = [error for error in errors if not run.truth or run.truth.uncertainty <= CERTAIN * error]
                found, speeds = search(run, variants, described, duration, asked) if asked else ([], {})
            rows = [{"kind": kind, "n": described["variables"], "error": error, "asked": error in asked}
                    | evidence.origin(run.lab.set.facts["context"]) for error in errors]
            for row in (row for row in rows if row["asked"]):
                question = Namespace(**vars(options) | {"scene": [scene], "error": row["error"], "duration": duration})
                answer = ask(question, folder=folder / f"error-{row['error']:g}")
                with locks.only_one_study(options.wait):
                    row |= _compare(row["error"], duration, answer, run, variants, found, speeds)
            evidence.keep(results, scene, rows, found)
            run.lab.display.end()
    table = evidence.read(results)
    print(f"{evidence.sentence(table)}\npage: {results / evidence.PAGE}")
    return 0 if evidence.held(table[table.asked]).all(axis=None) and table.asked.any() else 1


def questions(asked):
    """[(kind, scene, s)]: all of SCENES, or the kinds and scenes of it that are asked for, and any other scene."""
    known = [(one["kind"], scene, one["duration"]) for one in SCENES for scene in one["scenes"]]
    others = [scene_name(text) for text in asked if not any(text in one for one in known)]
    return [one for one in known if not asked or one[0] in asked or one[1] in asked] + [
        (OTHERS, scene, min(OTHERS_DURATION, describe(scene)["drivers_end"] or OTHERS_DURATION)) for scene in others]


def _reference(described, variants, run):
    """Who simulates the reference: the fastest by the rule that serves both schemes, and the scene, of which the rule knows nothing."""
    form = Setting("saddle-point")
    foreseen = {one["implementation"]: one["step_us"] for one in described["recommendation"]}
    for name in sorted(serving(form, variants), key=lambda name: foreseen.get(name, math.inf)):
        if run("serves", form, name, FIRST_STEP, FIRST_STEP, 60)["status"] != "unsupported":
            return name
    raise StudyError(f"{run.scene}: no implementation that takes part simulates it in both forms, to know its motion by")


def _compare(error, duration, answer, run, variants, found, speeds):
    """The row of validation.csv of one question."""
    settings, told, candidates = {setting.name: setting for setting in everything()}, answer["advice"], []
    for row in fastest(found, error):
        served = {name: us for name, us in speeds.items() if name in serving(settings[row["setting"]], variants)}
        candidates += [timing.Candidate(settings[row["setting"]], name, row["step"])
                       for name, us in served.items() if us <= SLOWER * min(served.values())]
    if advised := told and timing.Candidate(settings[told["setting"]], told["implementation"], told["step"], kept=True):
        candidates = [one for one in candidates if one != advised] + [advised]

    def timed(one, number):
        run.tell(f"timing: error {error:g} m, round {number}, {one.implementation}, {one.setting.name}")
        return run(f"timing-{error:g}/round{number}", one.setting, one.implementation, one.step, duration, 60)
    timing.race(candidates, timed, lambda: ROUNDS_AT_MOST)
    held = advised and run("advised", advised.setting, advised.implementation, advised.step, duration, 300, EXACT, 1)
    best = min((one for one in candidates if one.rows and (one is advised or not one.out)), default=None, key=lambda one: one.us_per_second()[0])
    return {"met": answer["met"], "estimate": told and told["error"]["estimate"], "exact": held and held["exact"],
            "meets": bool(held and meets(held, error)), "seconds": answer["seconds"], "others": answer["waited"],
            "why_not": answer["why_not"] or "", **_columns("advised", advised), **_columns("best", best),
            "ratio": advised.us_per_second()[0] / best.us_per_second()[0] if advised and best else None}


def _columns(prefix, one):
    values = (one.implementation, one.setting.name, one.step, one.us_per_second()[0]) if one else (None,) * 4
    return {f"{prefix}_{key}": value for key, value in zip(("implementation", "setting", "step", "us_per_second"), values)}


def everything():
    """All settings that advice considers, and all of study/settings.yaml whose tolerances suit any scene."""
    found = catalogue()
    stored = [Setting(one.scheme, one.changes) for one in read_settings() if not {"penalty", "tolerance"} & set(dict(one.changes))]
    return found + [one for one in stored if one not in found]


def search(run, variants, described, duration, errors):
    """Rows of every setting at every step by its fastest implementation, and {implementation: us a step}. A setting's steps end where two
    in succession meet the smallest error or where they cost too much; beside the fastest there are more (`_between`)."""
    longest = duration / LEAST_STEPS
    _, speeds = probe(variants, described, run, longest / 8, duration)
    rows, least = [], {}  # least time of a simulated second that meets the smallest error
    for setting in (one for one in everything() if not fits(one, described)):
        served = [name for name in speeds if name in serving(setting, variants)]
        step, ended = longest, 0
        while served and ended < 2 and step >= duration / MOST_STEPS:
            at = float(f"{step:.3g}")
            run.tell(f"search: {run.scene}, {setting.name}, step {at:g} s")
            row = run("search", setting, served[0], at, duration, 4 * TOO_LONG, checks=EXACT, repeats=1)
            if row["status"] in UNKNOWN:
                break
            timed = meets(row, max(errors)) and run("speed", setting, served[0], at, duration, 8 * TOO_LONG)
            row |= {"us_per_second": timed["step_us"] / at if timed and timed["step_us"] else None, "pruned": ""}
            rows.append(row)
            ended = ended + 1 if meets(row, min(errors)) else 0
            if ended and row["us_per_second"]:
                least[setting] = min(least.get(setting, row["us_per_second"]), row["us_per_second"])
            usual = row["us_per_second"] or (row["step_us_median"] or 0.0) / at
            if usual > (2 * NEAR * min(least.values()) if least else 1e6 * TOO_LONG / duration):
                row["pruned"] = "shorter steps are left out: " + (
                    "far slower than a setting that meets all errors" if least else f"they take more than {TOO_LONG:g} s")
                break
            step *= RATIO
    _between(run, rows, variants, speeds, duration, errors)
    return rows, speeds


def _between(run, rows, variants, speeds, duration, errors):
    """Runs each of the fastest rows at steps between its own and half of it, and so those that are the fastest then."""
    settings = {setting.name: setting for setting in everything()}
    tried = set()
    while chosen := {at: row for error in errors for row in fastest(rows, error) if (at := (row["setting"], row["step"])) not in tried}:
        tried |= chosen.keys()
        for row in chosen.values():
            setting = settings[row["setting"]]
            name = next(name for name in speeds if name in serving(setting, variants))
            for at in (float(f"{part * row['step']:.3g}") for part in BETWEEN):
                run.tell(f"search: {run.scene}, {setting.name}, step {at:g} s, between")
                found = run("between", setting, name, at, duration, 4 * TOO_LONG, checks=EXACT, repeats=1)
                if found["status"] not in UNKNOWN:
                    rows.append(found | {"us_per_second": None, "pruned": ""})


def fastest(found, error):
    """The fastest row of each setting that meets an error, fastest first, as far as they are near the best. All shorter steps of its setting
    that were run, down to half of its own, must meet it too: else it is luck, which half the step cannot show."""
    best = {}
    rows = [row for row in found if row["us_per_second"] and all(
        meets(other, error) for other in found if other["setting"] == row["setting"] and 0.49 * row["step"] < other["step"] <= row["step"])]
    for row in sorted(rows, key=lambda row: row["us_per_second"]):
        best.setdefault(row["setting"], row)
    return [row for row in best.values() if row["us_per_second"] <= NEAR * min(one["us_per_second"] for one in rows)]


def meets(row, error):
    return row["status"] in FINISHED and row["exact"] is not None and row["exact"] <= error
