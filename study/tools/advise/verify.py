# The last stage of an advice: the fastest candidate over the whole time, and what follows if it fails; where nothing meets a question, the
# options that would help.
import math

from analysis.core.outcomes import FINISHED
from analysis.core.text import number
from study.tools.advise import timing
from study.tools.advise.choice import LEAST_STEPS, Pilot, apart, by_order, enough, known, most, tidy
from study.tools.advise.runner import FORCES_LOST, HALVED

VERIFICATIONS = 20
LEAST_SHARE = 0.3  # of the budget that a first verification may take, however little of it is left
P99 = 1.2   # times the time of a step: its 99th percentile, about, where that was not measured
REFUSED, SHORTER, AT_ONCE = "refused", 128, 1.0  # a status; times a step, and s, by which a refusal does not depend on the step
HALVES = 6  # of the duration, to find for how long an error can be kept


def verify(advice, run):
    """Whole runs of the fastest candidate, until one is as accurate as asked; then `advice.outcome`, the line as advised, without a check."""
    question = advice.question
    for _ in range(VERIFICATIONS):
        while not (ranked := timing.ranked(advice.candidates, question.deadline_us)) and advice.race():
            pass
        if not ranked:
            return
        one = ranked[0]
        seconds = max(run.left(), 0.0 if advice.verifications else LEAST_SHARE * question.budget)
        if not (duration := _affordable(one, question, seconds / run.slowdown)):
            advice.hurry("no time was left to verify another candidate")
            return
        run.tell(f"verification: {one.implementation}, {one.setting.name}, step {one.step:g} s")
        row = {} | run("verification", one.setting, one.implementation, one.step, duration, 1.5 * seconds + 2, checks=HALVED)
        if row["estimate"] is not None and advice.pilot_duration >= duration:  # a larger one at a shorter step: the two runs of it were wrong alike
            row["estimate"] = max([row["estimate"], *(pilot.estimate for pilot in advice.found[one.setting].pilots
                                                      if pilot.valid and pilot.step < one.step)])
        advice.verifications.append(row)
        row["refused"] = _refused(one, row, advice) or _as_advised(one, advice, run, duration, seconds + 2)
        if row["refused"]:
            timing.come_back(advice.candidates, [one])  # what beat them has become slower itself, or is out
            continue
        again = range(1, timing.ROUNDS + 1) if one.rows[-1]["step"] != one.step else ()
        one.rows = [row for row in (advice.timed(one, number) for number in again if run.left() > 0) if row["status"] in FINISHED] or one.rows
        advice.chosen, advice.verified = one, row | {"estimate": max(row["estimate"], row["exact"] or 0.0)}
        if duration < question.duration:
            advice.cut_short.append(f"verified over {duration:g} of {question.duration:g} s, held to that share of the error: "
                                    f"--budget {question.budget * question.duration / duration:.2g} is enough for all")
        return


def _affordable(one, question, seconds):
    """The simulated time that a verification can cover, s; 0 if that is not worth it."""
    share = seconds / (4e-6 * one.us_per_second()[0] * question.duration)  # 3 for the check, 1 for the line itself
    if share >= 1:
        return question.duration
    return float(f"{share * question.duration:.2g}") if share > 0.05 and share * question.duration > 20 * one.step else 0.0


def _refused(one, row, advice):
    """Why a whole run is not as accurate as asked, after which there is a shorter step for all candidates of its setting, or one candidate less;
    "" if it is."""
    question, exact, over = advice.question, row["exact"], f"over {row['duration']:g} s"
    lost = row["status"] not in FINISHED or row["estimate"] is None
    allowed = question.error * row["duration"] / question.duration
    excess = 0 if lost else (expected_error(advice, one, row)[1] if exact is None else exact) / allowed  # what is known exactly needs no margin
    if row["forces_lost"]:  # whoever the implementation is
        for other in (other for other in advice.candidates if other.setting == one.setting):
            other.slower, other.reason = False, f"{FORCES_LOST} when verified {over}: {row['forces_lost']}"
        return f"{FORCES_LOST}: {row['forces_lost']}"
    if not lost and excess <= 1:
        return ""
    if lost:
        one.reason = f"{row['status']} when verified {over}: {row['reason']}"
        return f"{row['status']}: {row['reason']}"
    _shorten(one, row, excess, advice)
    return f"estimate {number(row['estimate'])} m {over}, and no margin" if exact is None else f"error {number(exact)} m {over}"


def _as_advised(one, advice, run, duration, seconds):
    """Why the advised line itself, without a check, does not end or is not as punctual as asked, after which there is one candidate less; or ""."""
    run.tell("the advised line itself")
    row = advice.outcome = run("outcome", one.setting, one.implementation, one.step, duration, seconds, repeats=1)
    if row["status"] not in FINISHED:
        one.reason = f"{row['status']} as it would be advised: {row['reason']}"
    elif row["forces_lost"]:
        one.reason = f"{FORCES_LOST} as it would be advised: {row['forces_lost']}"
    else:
        one.drop_late(row["step_us_p99"], advice.question.deadline_us, f" over {duration:g} s, as it would be advised")
    return one.reason


def _shorten(one, row, excess, advice):
    question, found = advice.question, advice.found[one.setting]
    failed = sum(other["setting"] == one.setting.name for other in advice.verifications)
    step = one.step * 0.97**failed * excess ** (-1 / one.setting.order)
    if advice.pilot_duration == question.duration and found.rung() < one.step:  # a pilot that was good enough
        step = found.rung() if failed > 2 else max(step, found.rung())
    for other in (other for other in advice.candidates if other.setting == one.setting):
        if question.step or failed > 4 or step < one.step / 8:
            other.slower, other.reason = False, f"estimate {row['estimate']:.2g} m when verified over {row['duration']:g} s"
        else:
            other.step = tidy(step, question.duration)


def expected_error(advice, one, row):
    """(least, most) of a verified candidate's error, m, by its setting's pilots."""
    estimate, pilots, order = row["estimate"], advice.found[one.setting].pilots, one.setting.order
    covered = advice.pilot_duration == row["duration"]  # else theirs are the errors of less motion
    high = most(one.step, estimate, pilots, order, advice.question.error) if covered else math.inf
    return apart(estimate, order), max(estimate, high if math.isfinite(high) else by_order(one.step, estimate, pilots, order))


def refusal(setting, name, step, duration, run):
    """Why a run so long is refused before it starts, in far shorter steps too, as where a driver leaves its range; "" if it is not."""
    row = run("whole", setting, name, step / SHORTER, duration, AT_ONCE, repeats=1)
    return row["reason"] if row["status"] == REFUSED else ""


def what_helps(advice, run):
    """Fills `advice.helps`."""
    question, found = advice.question, advice.found.values()
    if advice.hurried:
        advice.helps.append(f"--budget {2 * question.budget:g}: time was short")
    if not (pilots := [(one, pilot) for one in found for pilot in one.pilots]):
        return
    durations = [float(f"{question.duration / 2**halving:.3g}") for halving in range(1, HALVES + 1)]
    if advice.never:
        setting = pilots[0][0].setting
        if so_long := next((one for one in durations if not refusal(setting, advice.serving(setting)[0], question.first_step, one, run)), None):
            advice.helps.append(f"--duration {so_long:g}: a run so long is not refused")
        return
    best, pilot = min(pilots, key=lambda pair: (not pair[1].valid, pair[1].estimate if pair[1].valid else pair[1].step))
    least = min(known(other, one.pilots, advice.pilot_error, one.setting.order) for one, other in pilots)
    if advice.pilot_error < least < math.inf:
        advice.helps.append(f"--error {1.1 * question.error * least / advice.pilot_error:.2g}: so much pilots were seen to keep")
    setting = best.setting
    if question.step and not (pilot.valid and pilot.estimate <= question.error):
        fewest = math.ceil((1.2 * pilot.estimate / question.error) ** (1 / setting.order)) if pilot.valid else 2
        steps = [question.step / parts for parts in (fewest, 2 * fewest, 4 * fewest)]  # the order may not show in steps this long
        _first_kept(advice, setting, [(f"--step {step:.12g}", step, question.duration) for step in steps],
                    f"in such steps {setting.name} keeps the error", run)
    late = [(one.late_us, one.step) for one in advice.candidates if one.late_us] + [(P99 * one.chosen_us, one.late) for one in found if one.late]
    if soon := min((us for us, step in late if 1.2 * us <= 1e6 * step), default=None):
        advice.helps.append(f"--deadline-us {1.2 * soon:.3g}: at best 99 % of the steps take up to about {soon:.3g} us")
    elif late:
        advice.helps.append("a larger --error: its steps are longer, and these take longer than the time that they simulate")
    else:
        step = question.step or pilot.step
        _first_kept(advice, setting, [(f"--duration {one:g}", step, one) for one in durations if one >= LEAST_STEPS * step],
                    f"so long {setting.name} at step {step:g} s keeps the error", run)


def _first_kept(advice, setting, tried, words, run):
    """Adds the first option of those `tried`, [(option, step, duration)], with which a run keeps the error; `words` say why it helps."""
    for option, step, duration in tried:
        run.tell(f"what would help: {option}")
        if _keeps(advice, setting, step, duration, run):
            advice.helps.append(f"{option}: {words}")
            return


def _keeps(advice, setting, step, duration, run):
    """Whether a run keeps the error, by half the step, which another one with half of both must show to be right."""
    pilots, error = [], advice.question.error
    for at in (step, step / 2):
        if run.left() <= 0 or not all(pilot.valid for pilot in pilots):
            return False
        row = run("shorter", setting, advice.serving(setting)[0], at, duration, max(2.0, run.left()), checks=HALVED)
        pilots.append(Pilot(at, row["status"], row["estimate"]))
    return pilots[0] in enough(pilots, error, setting.order)
