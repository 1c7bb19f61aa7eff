# The answer as JSON (its keys: README.md) and as text.
from dataclasses import asdict

from analysis.core.text import number
from study.tools.advise.choice import allowed, counts, halvings
from study.tools.advise.runner import advised
from study.tools.advise.settings import catalogue, fits, serving
from study.tools.advise.verify import expected_error
from analysis.core.outcomes import FINISHED

MOST_REASONS = 3  # of pilots that were lost


def as_json(advice, run, described, variants, folder):
    question = advice.question
    answer = {"question": {"scene": question.scene, "error": question.error,
                           "duration": question.duration, "deadline_us": question.deadline_us,
                           "step": question.step},
              "met": advice.verified is not None,
              "advice": _advised(advice, variants[advice.chosen.implementation]["library"]) if advice.verified
              else None,
              "runner_up": None, "best_reached": None,
              "why_not": None if advice.verified else _why_not(advice),
              "pilot_duration": advice.pilot_duration, "cut_short": advice.cut_short,
              "seconds": round(advice.seconds, 2),
              "settings": [_setting(setting, advice, described, variants) for setting in catalogue()],
              "candidates": [_candidate(one, advice) for one in advice.candidates],
              "runs": run.rows, "results": str(folder)}
    return answer | {"runner_up": _runner_up(answer), "best_reached": _best_reached(answer)}


def _times(one):
    """Time of a step and of a simulated second, with the least and the most of the rounds, us."""
    middle, low, high = one.us_per_second()
    return {"step_us": {"median": middle * one.step, "low": low * one.step, "high": high * one.step,
                        "p99": one.p99_us()},
            "us_per_second": {"median": middle, "low": low, "high": high}, "rounds": len(one.rows)}


def _advised(advice, library):
    one, row = advice.chosen, advice.verified
    estimate, low, high = expected_error(advice)
    return {"implementation": one.implementation, "setting": one.setting.name,
            "scheme": one.setting.scheme, "changes": dict(one.setting.changes),
            "precision": dict(one.setting.changes).get("precision", "double"), "step": one.step,
            "penalty": row["penalty"], "tolerance": row["tolerance"], "status": row["status"],
            "error": {"estimate": estimate, "low": low, "high": high, "exact": row["exact"],
                      "allowed_estimate": allowed(advice.question.error, one.setting.order)},
            **_times(one), "verified_step_us": {"median": row["step_us_median"], "p99": row["step_us_p99"],
                                                "max": row["step_us_max"]},
            "deadline_misses": row["deadline_misses"], "steps": row["steps"],
            "command": advised(row["command"], library), "raw_file": row["raw_file"]}


def _setting(setting, advice, described, variants):
    found = advice.found.get(setting)
    reason = fits(setting, described) or (
        "" if serving(setting, variants) else "no implementation serves it")
    orders = halvings(found.pilots) if found else {}
    limit = allowed(advice.question.error, setting.order)
    return {"setting": setting.name, "step": found.chosen if found else None,
            "reason": found.reason if found else reason or "no implementation simulates the scene",
            "pilots": [asdict(pilot) | {"order": orders.get(pilot.step),
                                        "counts": counts(pilot.step, found.pilots, limit)}
                       for pilot in (found.pilots if found else [])]}


def _candidate(one, advice):
    told = {"implementation": one.implementation, "setting": one.setting.name, "step": one.step,
            "advised": advice.verified is not None and one is advice.chosen, "reason": one.reason}
    return told | (_times(one) if one.rows else {"step_us": None, "us_per_second": None, "rounds": 0})


def _runner_up(answer):
    """The second fastest candidate and why it lost."""
    timed = sorted((one for one in answer["candidates"] if one["rounds"] and not one["advised"]),
                   key=lambda one: (-one["rounds"], one["us_per_second"]["median"]))
    if not answer["met"] or not timed:
        return None
    second = timed[0]
    ratio = second["us_per_second"]["median"] / answer["advice"]["us_per_second"]["median"]
    tie = second["us_per_second"]["low"] <= answer["advice"]["us_per_second"]["high"]
    why = second["reason"] or (f"{ratio:.2f} times the time of a simulated second"
                               + (", which the rounds do not tell apart" if tie else ""))
    return {key: second[key] for key in ("implementation", "setting", "step", "us_per_second")} | {
        "ratio": ratio, "why": why}


def _best_reached(answer):
    """The pilot of the least estimate, one that counts if there is any."""
    found = [{"setting": entry["setting"]} | {key: pilot[key] for key in ("step", "estimate", "counts")}
             for entry in answer["settings"] for pilot in entry["pilots"]
             if pilot["status"] in FINISHED and pilot["estimate"] is not None]
    return None if answer["met"] else min(
        found, key=lambda one: (not one["counts"], one["estimate"]), default=None)


def _why_not(advice):
    if not any(row["step_us"] for row in advice.probe):
        return "no implementation simulates this scene: " + "; ".join(
            dict.fromkeys(f"{row['status']}, {row['reason']}" for row in advice.probe))
    if advice.verifications:
        return "no candidate kept it over the whole time"
    if any(found.chosen for found in advice.found.values()):
        late = [one for one in advice.candidates if "99th percentile" in one.reason]
        return ("no step is done within the deadline" if late else "no candidate could be timed")
    if any("a step takes" in found.reason for found in advice.found.values()):
        return "no step is done within the deadline"
    pilots = [pilot for found in advice.found.values() for pilot in found.pilots]
    if pilots and not any(pilot.status in FINISHED for pilot in pilots):
        return "no pilot came to its end: " + "; ".join(
            dict.fromkeys(f"{pilot.status}, {pilot.reason}" for pilot in pilots[:MOST_REASONS]))
    return "no setting reaches the error" + (
        f" in steps of {advice.question.step:g} s" if advice.question.step else "") + (
        f" within the budget of {advice.question.budget:g} s (--budget)"
        if any("left" in cut for cut in advice.cut_short) else "")


def text(answer):
    asked = answer["question"]
    lines = [f"{asked['scene']} over {asked['duration']:g} s, error at most {number(asked['error'])} m"
             + (f", 99 % of the steps within {asked['deadline_us']:g} us" if asked["deadline_us"] else "")
             + (f", in steps of {asked['step']:g} s" if asked["step"] else "")]
    lines += _advice_lines(answer) if answer["met"] else _refusal_lines(answer)
    lines += [""] + [_row("note", sentence) for sentence in answer["cut_short"]]
    lines += [_row("tried", _tried(answer)), _row("raw files", answer["results"])]
    return "\n".join(lines)


def _row(name, value):
    return f"  {name:22}{value}"


def _spread(value, interval, unit):
    return f"{number(value)} {unit} ({number(interval['low'])} to {number(interval['high'])})"


def _who(one):
    return f"{one['implementation']}, {one['setting']}, step {one['step']:g} s"


def _advice_lines(answer):
    told, times = answer["advice"], answer["advice"]["us_per_second"]
    error, step = told["error"], told["step_us"]
    lines = ["", "Run this (add --half-step to check):", "", f"  {told['command']}", "",
             _row("implementation", told["implementation"]), _row("settings", told["setting"]),
             _row("step", f"{told['step']:g} s"),
             _row("penalty factor", f"{number(told['penalty'], 4)}, automatic"),
             _row("tolerance", f"{number(told['tolerance'])} m"), _row("precision", told["precision"]),
             _row("expected error", f"{_spread(error['estimate'], error, 'm')}, verified over "
                  f"{answer['question']['duration']:g} s: {told['status']}"),
             _row("time per step", f"{_spread(step['median'], step, 'us')} without interruptions, {told['rounds']} "
                  f"round{'s' * (told['rounds'] > 1)}; with them 99th percentile {number(step['p99'])} us"),
             _row("per simulated second", _spread(times["median"] / 1e3, {
                 key: times[key] / 1e3 for key in ("low", "high")}, "ms"))]
    if told["deadline_misses"] is not None:
        lines.append(_row("deadline", f"{told['deadline_misses']} of {told['steps']} steps took longer"))
    second = answer["runner_up"]
    if second:
        lines += [_row("runner-up", _who(second)), _row("", second["why"])]
    return lines


def _refusal_lines(answer):
    best = answer["best_reached"]
    lines = ["", f"No setting meets this: {answer['why_not']}."]
    if best:
        lines.append(_row("best estimate", f"{number(best['estimate'])} m: {best['setting']}, "
                          f"step {best['step']:g} s"
                          + ("" if best["counts"] else ", not shown to be right by halving the step")))
    timed = [one for one in answer["candidates"] if one["rounds"]]
    if timed and answer["question"]["deadline_us"]:
        one = min(timed, key=lambda one: one["step_us"]["p99"])
        lines.append(_row("fastest steps", f"99th percentile {number(one['step_us']['p99'])} us: {_who(one)}"))
    return lines


def _tried(answer):
    runs = answer["runs"]
    settings = [entry for entry in answer["settings"] if entry["pilots"]]
    return (f"{len(settings)} settings in {sum(run['kind'] == 'pilots' for run in runs)} error pilots, "
            f"{sum(bool(one['rounds']) for one in answer['candidates'])} candidates timed; "
            f"{answer['seconds']:.0f} s")
