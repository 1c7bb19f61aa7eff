# Where nothing meets a question: the options that would help.
import math

from study.tools.advise.choice import LEAST_STEPS, Pilot, enough, known
from study.tools.advise.runner import HALVED

P99 = 1.2   # times the time of a step: its 99th percentile, about, where that was not measured
HALVES = 6  # of the duration, to find for how long an error can be kept


def what_helps(advice, run):
    """Fills `advice.helps`."""
    question, found = advice.question, advice.found.values()
    if advice.hurried:
        advice.helps.append(f"--budget {2 * question.budget:g}: time was short")
    pilots = [(one, pilot) for one in found for pilot in one.pilots]
    if not pilots:
        return
    best, pilot = min(pilots, key=lambda pair: (not pair[1].valid, pair[1].estimate if pair[1].valid else pair[1].step))
    least = min(known(other, one.pilots, advice.pilot_error, one.setting.order) for one, other in pilots)
    if advice.pilot_error < least < math.inf:
        advice.helps.append(f"--error {1.1 * question.error * least / advice.pilot_error:.2g}: so much pilots were seen to keep")
    setting = best.setting
    if question.step and pilot.valid and pilot.estimate > question.error:
        fewest = math.ceil((1.2 * pilot.estimate / question.error) ** (1 / setting.order))
        steps = [question.step / parts for parts in (fewest, 2 * fewest, 4 * fewest)]  # the order may not show in steps this long
        _first_kept(advice, setting, [(f"--step {step:g}", step, question.duration) for step in steps],
                    f"in such steps {setting.name} keeps the error", run)
    slow = [P99 * one.chosen_us for one in found if one.chosen_us > (question.deadline_us or math.inf)]
    late = [one.late_us for one in advice.candidates if one.late_us] + slow
    if late:
        advice.helps.append(f"--deadline-us {1.2 * min(late):.3g}: at best 99 % of the steps take up to about {min(late):.3g} us")
    else:
        step = question.step or pilot.step
        durations = [float(f"{question.duration / 2**halving:.3g}") for halving in range(1, HALVES + 1)]
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
        if run.left() <= 0:
            return False
        row = run("shorter", setting, advice.serving(setting)[0], at, duration, max(2.0, run.left()), checks=HALVED)
        pilots.append(Pilot(at, row["status"], row["estimate"]))
        if not pilots[-1].valid:
            return False
    return pilots[0] in enough(pilots, error, setting.order)
