# The answer as JSON (its keys: README.md) and as text.
from dataclasses import asdict

from analysis.core.outcomes import FINISHED, GOOD
from analysis.core.text import number
from study.tools.advise.choice import counts, halvings
from study.tools.advise.runner import advised
from study.tools.advise.settings import catalogue, fits, serving
from study.tools.advise.verify import expected_error

MOST_REASONS = 3  # of pilots that were lost
MOST_REFUSED = 5  # lines of settings that would be faster
BUSY = 0.05       # share of the time of runs in which other programs had the processor, from which it is said


def as_json(advice, run, described, variants, folder):
    answer = {"question": {name: value for name, value in asdict(advice.question).items() if name != "budget"},
              "met": advice.verified is not None,
              "advice": _advised(advice, variants[advice.chosen.implementation]["library"]) if advice.verified
              else None,
              "runner_up": None, "refused": _refused(advice) if advice.verified else [],
              "why_not": None if advice.verified else _why_not(advice), "helps": advice.helps,
              "pilot_duration": advice.pilot_duration, "cut_short": advice.cut_short + _busy(advice),
              "seconds": round(advice.seconds, 2),
              "settings": [_setting(setting, advice, described, variants) for setting in catalogue()],
              "left_out": advice.left_out,
              "candidates": [_candidate(one, advice) for one in advice.candidates],
              "runs": run.rows, "results": str(folder)}
    return answer | {"runner_up": _runner_up(answer)}


def _busy(advice):
    return [f"the machine is busy: other programs had the processor for {100 * advice.waited:.0f} % of the time of these "
            "runs, so that times, and above all a 99th percentile, may be too long; ask again when it is quiet"
            ] if advice.waited > BUSY else []


def _times(one):
    """Time of a step and of a simulated second, with the least and the most of the rounds, us."""
    middle, low, high = one.us_per_second()
    return {"step_us": {"median": middle * one.step, "low": low * one.step, "high": high * one.step,
                        "p99": one.p99_us()},
            "us_per_second": {"median": middle, "low": low, "high": high}, "rounds": len(one.rows)}


def _advised(advice, library):
    one, row = advice.chosen, advice.verified
    estimate = row["estimate"]
    low, high = expected_error(advice, one, row)
    return {"implementation": one.implementation, "setting": one.setting.name,
            "scheme": one.setting.scheme, "changes": dict(one.setting.changes),
            "precision": dict(one.setting.changes).get("precision", "double"), "step": one.step,
            "penalty": row["penalty"], "tolerance": row["tolerance"],
            "status": advice.outcome["status"], "status_reason": advice.outcome["reason"],
            "verified_over": row["duration"],
            "error": {"estimate": estimate, "low": low, "high": high, "exact": row["exact"]},
            **_times(one), "deadline_misses": row["deadline_misses"], "steps": row["steps"],
            "command": advised(advice.outcome["command"], library, advice.question.duration),
            "raw_file": row["raw_file"]}


def _setting(setting, advice, described, variants):
    found = advice.found.get(setting)
    reason = fits(setting, described) or (
        "" if serving(setting, variants) else "no implementation serves it")
    orders = halvings(found.pilots) if found else {}
    error = advice.question.error * advice.pilot_duration / advice.question.duration
    return {"setting": setting.name, "step": found.chosen if found else None,
            "reason": found.reason if found else reason or "no implementation simulates the scene",
            "pilots": [asdict(pilot) | {"order": orders.get(pilot.step),
                                        "counts": counts(pilot.step, found.pilots, error)}
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


def _refused(advice):
    """Why what would have been faster than the advice is not advised: [{"setting", "step", "why"}], whole runs that failed,
    and the slowest pilot of each such setting, the fastest first."""
    best, asked = advice.chosen.us_per_second()[0], advice.question.error * advice.pilot_duration / advice.question.duration
    found = []
    for one in advice.found.values():
        faster = [pilot for pilot in one.pilots if pilot.step > 1.001 * (one.chosen or 0)
                  and (one.step_us() / pilot.step < best or one is advice.found[advice.chosen.setting])]
        if faster:
            pilot = min(faster, key=lambda pilot: pilot.step)
            why = f"{pilot.status}: {pilot.reason}" if not pilot.valid else f"estimate {number(pilot.estimate)} m" + (
                ", and halving the step does not show it to be right" if pilot.estimate <= asked else "")
            found.append((one.step_us() / pilot.step, one.setting.name, pilot.step, why))
    whole = [(0.0, row["setting"], row["step"], f"estimate {number(row['estimate'])} m over {row['duration']:g} s, and no margin"
              if row["status"] in FINISHED else f"{row['status']}: {row['reason']}") for row in advice.verifications[:-1]]
    return [{"setting": name, "step": step, "why": why} for _, name, step, why in sorted(whole + found)]


def _why_not(advice):
    if not any(row["step_us"] for row in advice.probe) and not advice.found:
        return "no implementation simulates this scene: " + "; ".join(
            dict.fromkeys(f"{row['status']}, {row['reason']}" for row in advice.probe))
    late = min((one for one in advice.candidates if one.late_us), key=lambda one: one.late_us, default=None)
    if late:
        return (f"99 % of the steps are not done within the deadline: {late.reason} with {late.implementation}, "
                f"{late.setting.name}, step {late.step:g} s")
    if advice.verifications:
        return "no candidate kept it over the whole time"
    slow = [found.reason for found in advice.found.values() if "beyond the deadline" in found.reason]
    if any(found.chosen for found in advice.found.values()):
        return "no candidate could be timed"
    if slow:
        return f"what is accurate enough is too slow: {slow[0]}"
    pilots = [pilot for found in advice.found.values() for pilot in found.pilots]
    if pilots and not any(pilot.status in FINISHED for pilot in pilots):
        return "no pilot came to its end: " + "; ".join(
            dict.fromkeys(f"{pilot.status}, {pilot.reason}" for pilot in pilots[:MOST_REASONS]))
    return "no setting reaches the error" + (
        f" in steps of {advice.question.step:g} s" if advice.question.step else "") + (
        f" within the budget of {advice.question.budget:g} s" if any("left" in cut for cut in advice.cut_short) else "")


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


def _advice_lines(answer):
    told, times = answer["advice"], answer["advice"]["us_per_second"]
    error, step = told["error"], told["step_us"]
    lines = ["", "Run this (--half-step checks its error):", "", f"  {told['command']}", "",
             _row("implementation", told["implementation"]), _row("settings", told["setting"]),
             _row("step", f"{told['step']:g} s"),
             _row("penalty factor", f"{number(told['penalty'], 4)}, automatic"),
             _row("tolerance", f"{number(told['tolerance'])} m"), _row("precision", told["precision"]),
             _row("expected error", f"{_spread(error['estimate'], error, 'm')}, verified over {told['verified_over']:g} s"),
             *_ends_as(told),
             _row("time per step", f"{_spread(step['median'], step, 'us')} without interruptions, {told['rounds']} "
                  f"round{'s' * (told['rounds'] > 1)}; with them 99th percentile {number(step['p99'])} us"),
             _row("per simulated second", _spread(times["median"] / 1e3, {
                 key: times[key] / 1e3 for key in ("low", "high")}, "ms"))]
    if told["deadline_misses"] is not None:
        lines.append(_row("deadline", f"{told['deadline_misses']} of {told['steps']} steps took longer"))
    second = answer["runner_up"]
    if second:
        lines += [_row("runner-up", f"{second['implementation']}, {second['setting']}, step {second['step']:g} s"), _row("", second["why"])]
    refused = answer["refused"][:MOST_REFUSED]
    lines += [_row("faster, but refused" * (one is refused[0]), f"{one['setting']}, step {one['step']:g} s: {one['why']}")
              for one in refused]
    return lines


def _ends_as(told):
    """How the advised line ends, and why that is no objection."""
    if told["status"] in GOOD:
        return [_row("ends as", told["status"])]
    return [_row("ends as", f"{told['status']}: {told['status_reason']}"),
            _row("", "by the program's own bounds, which know nothing of the error that you asked for; half the step shows "
                     f"{number(told['error']['high'])} m at most")]


def _refusal_lines(answer):
    return ["", f"No setting meets this: {answer['why_not']}."] + [
        _row("would help" * (one is answer["helps"][0]), one) for one in answer["helps"]]


def _tried(answer):
    runs = answer["runs"]
    settings = [entry for entry in answer["settings"] if entry["pilots"]]
    return (f"{len(settings)} settings in {sum(run['kind'] == 'pilots' for run in runs)} error pilots, "
            f"{len({run['implementation'] for run in runs})} implementations, "
            f"{sum(bool(one['rounds']) for one in answer['candidates'])} candidates timed; {answer['seconds']:.0f} s")
