# The answer as JSON (its keys: README.md) and as text.
from pathlib import Path

from analysis.core.outcomes import FINISHED, GOOD
from analysis.core.text import layout, number
from study.tools.advise.choice import counts, halvings
from study.tools.advise.probe import catalogue, fits, serving
from study.tools.advise.runner import advised, within
from study.tools.advise.search import Found
from study.tools.advise.timing import in_time
from study.tools.advise.verify import expected_error

MOST_REASONS = 3  # of pilots that were lost
BUSY = 0.05       # share of the time of runs in which other programs had the processor, from which it is said
SHOWN = {"number": number, "in_time": in_time, "good": GOOD, "most_refused": 5}  # lines of settings that would be faster


def as_json(advice, run, folder):
    met = advice.verified is not None
    candidates = [{"implementation": one.implementation, "setting": one.setting.name, "step": one.step, "advised": met and one is advice.chosen,
                   "reason": one.reason} | _times(one) for one in advice.candidates]
    told = _advised(advice) if met else None
    return {"question": {name: value for name, value in advice.question._asdict().items() if name != "budget"}, "met": met, "advice": told,
            "runner_up": _runner_up(candidates, told) if met else None, "refused": _refused(advice) if met else [],
            "why_not": None if met else _why_not(advice), "helps": advice.helps, "pilot_duration": advice.pilot_duration,
            "cut_short": advice.cut_short + _busy(run.waited), "seconds": round(run.seconds, 2), "waited": round(run.waited, 3),
            "settings": [_setting(setting, advice) for setting in catalogue()], "left_out": advice.left_out, "candidates": candidates,
            "runs": run.rows, "results": str(folder)}


def _busy(waited):
    return [f"the machine is busy: other programs had the processor for {100 * waited:.0f} % of the time of these runs, so that "
            "times, and above all a 99th percentile, may be too long; ask again when it is quiet"] if waited > BUSY else []


def _times(one):
    """Time of a step and of a simulated second, with the least and the most of the rounds, us; None without any."""
    if not one.rows:
        return {"step_us": None, "us_per_second": None, "rounds": 0, "timed_step": None, "timed_over": None}
    middle, low, high = one.us_per_second()
    return {"step_us": {"median": middle * one.step, "low": low * one.step, "high": high * one.step, "p99": one.p99_us()},
            "us_per_second": {"median": middle, "low": low, "high": high}, "rounds": len(one.rows), "timed_step": one.rows[-1]["step"],
            "timed_over": min(row["duration"] for row in one.rows)}


def _advised(advice):
    one, row, line, changes = advice.chosen, advice.verified, advice.outcome, dict(advice.chosen.setting.changes)
    (low, high), times, end = expected_error(advice, one, row), _times(one), advice.described["drivers_end"]
    return {"implementation": one.implementation, "setting": one.setting.name, "scheme": one.setting.scheme, "changes": changes,
            "precision": changes.get("precision", "double"), "step": one.step, "penalty": row["penalty"], "tolerance": row["tolerance"],
            "status": line["status"], "status_reason": line["reason"], "branch_doubt": row["branch_doubt"], "warnings": line["warnings"],
            "verified_over": within(row["duration"], one.step, end),
            "error": {"estimate": row["estimate"], "low": low, "high": high, "exact": row["exact"]},
            **times, "step_us": times["step_us"] | {"mean": line["step_us_mean"], "p99": line["step_us_p99"]}, "deadline_misses": line["deadline_misses"], "steps": line["steps"],
            "command": advised(line["command"], advice.variants[one.implementation]["library"], within(advice.question.duration, one.step, end)),
            "raw_file": row["raw_file"]}


def _setting(setting, advice):
    found = advice.found.get(setting) or Found(setting, reason=fits(setting, advice.described) or (
        "no implementation simulates the scene" if serving(setting, advice.variants) else "no implementation serves it"))
    pilots = [pilot._asdict() | {"step_us": pilot.step_us if pilot.step_us > 0 else None, "order": halvings(found.pilots).get(pilot.step),
                                 "counts": counts(pilot.step, found.pilots, advice.pilot_error)} for pilot in found.pilots]
    return {"setting": setting.name, "step": found.chosen, "pilots": pilots, "reason": found.reason}


def _runner_up(candidates, told):
    """The second fastest candidate and why it lost; None if no other was timed."""
    timed = (one for one in candidates if one["rounds"] and not one["advised"])
    if not (second := min(timed, key=lambda one: (-one["rounds"], one["us_per_second"]["median"]), default=None)):
        return None
    times, best = second["us_per_second"], told["us_per_second"]
    ratio = times["median"] / best["median"]
    why = second["reason"] or (
        f"{ratio:.2f} times the time of a simulated second" + ", which the rounds do not tell apart" * (times["low"] <= best["high"]))
    return {key: second[key] for key in ("implementation", "setting", "step", "us_per_second")} | {"ratio": ratio, "why": why}


def _refused(advice):
    """Why what would be faster is not advised: whole runs that failed, and the slowest pilot of each such setting, the fastest first."""
    best = advice.chosen.us_per_second()[0]
    found = [(0.0, row["setting"], row["step"], row["refused"]) for row in advice.verifications[:-1]]
    late = [one for one in advice.candidates if one.late_us and one.reason not in {reason for *_, reason in found}]
    found += [(us, one.setting.name, one.step, one.reason) for one in late if (us := one.us_per_second()[0]) < best]
    for one in advice.found.values():
        faster = (pilot for pilot in one.pilots if pilot.step > 1.001 * (one.chosen or 0)
                  and (one.step_us() / pilot.step < best or one is advice.found[advice.chosen.setting]))
        if pilot := min(faster, key=lambda pilot: pilot.step, default=None):
            why = f"estimate {number(pilot.estimate)} m" if pilot.valid else f"{pilot.status}: {pilot.reason}"
            if pilot.valid and pilot.estimate <= advice.pilot_error:
                why += ", and halving the step does not show it to be right"
            found.append((one.step_us() / pilot.step, one.setting.name, pilot.step, why))
    return [{"setting": name, "step": step, "why": why} for _, name, step, why in sorted(found)]


def _why_not(advice):
    found, question = advice.found.values(), advice.question
    if not advice.speeds:
        return "no implementation simulates this scene: " + "; ".join(dict.fromkeys(f"{row['status']}, {row['reason']}" for row in advice.probe))
    if late := min((one for one in advice.candidates if one.late_us), key=lambda one: one.late_us, default=None):
        return (f"99 % of the steps are not done within the deadline: {late.reason} with {late.implementation}, "
                f"{late.setting.name}, step {late.step:g} s")
    if advice.verifications:
        return "no candidate kept it over the whole time"
    if any(one.chosen for one in found):
        return "no candidate could be timed"
    if slow := [one.reason for one in found if one.late]:
        return f"what is accurate enough is too slow: {slow[0]}"
    pilots = [pilot for one in found for pilot in one.pilots]
    if pilots and not any(pilot.status in FINISHED for pilot in pilots):
        reasons = (f"{pilot.status}, {pilot.reason}" for pilot in pilots[:MOST_REASONS])
        return f"no pilot gave a motion to go by: {'; '.join(dict.fromkeys(reasons))}"
    return ("no setting reaches the error" + (f" in steps of {question.step:g} s" if question.step else "")
            + (f" within the budget of {question.budget:g} s" if advice.hurried else ""))


def text(answer):
    return layout(Path(__file__).with_name("answer.txt.j2")).render(answer, **SHOWN)
