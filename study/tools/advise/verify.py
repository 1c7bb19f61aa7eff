# The last stage of an advice: the fastest candidate over the whole time, and what follows if it fails.
from study.tools.advise import timing
from study.tools.advise.choice import allowed, interval, local_order, tidy
from study.tools.advise.runner import HALVED
from analysis.core.outcomes import FINISHED

VERIFICATIONS = 20


def verify(advice, run, left, tell):
    """Whole runs of the fastest candidate, until one is as accurate as asked: `advice.chosen`, and its row
    `advice.verified`. `run` is a Runner, `left()` the seconds left."""
    question = advice.question
    for _ in range(VERIFICATIONS):
        order = timing.ranked(advice.candidates, question.deadline_us)
        if not order:
            return
        one = order[0]
        expected = 3e-6 * one.us_per_second()[0] * question.duration
        if advice.verifications and expected > left():
            advice.cut_short.append("no time was left to verify another candidate")
            return
        tell(f"verification: {one.implementation}, {one.setting.name}, step {one.step:g} s")
        row = {} | run("verification", one.setting, one.implementation, one.step, question.duration,
                  max(60.0, 5 * expected), checks=HALVED)
        row |= {"estimate": _at_least(row, advice)}
        advice.verifications.append(row)
        if accepted(row, one.setting, question):
            advice.chosen = one
            advice.verified = row | {"estimate": max(row["estimate"], row["exact"] or 0.0)}
            return
        _reconsider(one, row, advice)


def _at_least(row, advice):
    """The estimate of a whole run, or a larger one that the same setting has at a shorter step: then the two runs
    that gave it were wrong alike."""
    if row["estimate"] is None or advice.pilot_duration < advice.question.duration:
        return row["estimate"]
    found = next(found for setting, found in advice.found.items() if setting.name == row["setting"])
    return max([row["estimate"], *(pilot.estimate for pilot in found.pilots if pilot.valid and pilot.step < row["step"])])


def accepted(row, setting, question):
    """Whether a whole run is as accurate, and as punctual, as asked."""
    return (row["status"] in FINISHED and row["estimate"] is not None and _excess(row, setting, question) <= 1
            and (not question.deadline_us or row["step_us_p99"] <= question.deadline_us))


def _excess(row, setting, question):
    """How many times the allowed error that of a whole run is; only estimates need a margin."""
    return max(row["estimate"] / allowed(question.error, setting.order), (row["exact"] or 0.0) / question.error)


def _reconsider(one, row, advice):
    """What follows from a whole run that was not good enough: a shorter step for all candidates of its
    setting, their time scaled, or one candidate less."""
    timing.take_back(advice.candidates)
    question, found = advice.question, advice.found[one.setting]
    if row["status"] not in FINISHED or row["estimate"] is None:
        one.drop(f"{row['status']} when verified over {question.duration:g} s: {row['reason']}")
        return
    excess = _excess(row, one.setting, question)
    if excess <= 1:
        one.drop(f"99th percentile {row['step_us_p99']:.3g} us when verified: beyond the deadline")
        return
    failed = sum(other["setting"] == one.setting.name for other in advice.verifications)
    step = one.step * 0.95 * excess ** (-1 / one.setting.order)
    if failed > 1 and advice.pilot_duration == question.duration and found.rung() < one.step:
        step = found.rung()  # its pilot was good enough
    for other in (other for other in advice.candidates if other.setting == one.setting):
        if question.step or failed > 4 or step < one.step / 8:
            other.drop(f"estimate {row['estimate']:.2g} m when verified over {question.duration:g} s")
        else:
            other.step = tidy(step, question.duration)


def expected_error(advice):
    """(estimate, low, high) of the chosen run, m, by the orders that its setting's pilots show."""
    one, found = advice.chosen, advice.found[advice.chosen.setting]
    observed = local_order(one.step, found.pilots, one.setting.order)
    low, high = interval(advice.verified["estimate"], one.setting.order, observed)
    return advice.verified["estimate"], low, high
