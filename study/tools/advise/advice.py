# The advice on one scene: the question, what becomes known, and its stages one after the other.
import math
from collections import namedtuple
from dataclasses import dataclass, field

from study.tools.advise import timing
from study.tools.advise.choice import LEAST_STEPS, Pilot, tidy
from study.tools.advise.probe import find_speeds, fits, serving
from study.tools.advise.runner import QUICK, REPEATS
from study.tools.advise.search import Search
from study.tools.advise.verify import REFUSED, refusal, verify, what_helps

FIRST_STEP = 1e-2  # s; of the first pilot, where the run has enough such steps
SLOWER = 1.7       # times the time of the most promising, by pilots and probe: who is slower is not timed
PILOT_SHARE, TIMING_SHARE = 0.6, 0.8  # of the budget: when pilots, when timings must be done
NEVER = "refused at any step"  # a pilot's status
QUICK_SHARE = 1 / 500  # of the budget: a run for the time of a setting's step


class Question(namedtuple("Question", "scene error duration deadline_us budget step", defaults=(None,))):
    """`budget`: s; `step`: s, where it is given."""
    first_step = property(lambda self: self.step or min(FIRST_STEP, self.duration / (5 * LEAST_STEPS)))


@dataclass
class Advice:
    question: Question
    described: dict                                 # `mbs describe --json`
    variants: dict                                  # {implementation: what `mbs list --json` says}
    speeds: dict = field(default_factory=dict)      # {implementation that is tried: us a step}, fastest first
    probe: list = field(default_factory=list)       # rows
    everyone: bool = False                          # no implementation is left out
    left_out: dict = field(default_factory=dict)    # {implementation: why it is not tried}
    never: str = ""                                 # why a run of the whole duration is refused, whatever its step
    found: dict = field(default_factory=dict)       # {Setting: search.Found}
    candidates: list = field(default_factory=list)
    timed: object = None                            # (candidate, round) → its row
    race: object = bool                             # () → whether there was a candidate to time
    verifications: list = field(default_factory=list)
    chosen: object = None                           # timing.Candidate
    verified: dict | None = None                    # its row
    outcome: dict | None = None                     # the row of the advised line over all of the time
    pilot_duration: float = 0.0
    helps: list = field(default_factory=list)       # options that would help, each a sentence
    cut_short: list = field(default_factory=list)   # sentences
    hurried: bool = False                           # more time might have changed the answer

    # The share of the error that pilots of a part of the motion may have.
    pilot_error = property(lambda self: self.question.error * self.pilot_duration / self.question.duration)

    def serving(self, setting):
        """Who of those tried serves a setting, fastest first."""
        return serving(setting, {name: self.variants[name] for name in self.speeds})

    def hurry(self, sentence):
        self.hurried = True
        self.cut_short.append(sentence)


def advise(question, settings, described, variants, run, everyone=False):
    """The Advice; `run` is a Runner."""
    advice = Advice(question, described, variants, everyone=everyone)
    form = described["scheme"]["take"]  # goes first
    usable = [setting for setting in sorted(settings, key=lambda one: one.scheme != form)
              if not fits(setting, described) and serving(setting, variants)]
    find_speeds(advice, usable, run)
    if advice.speeds:
        search = _pilots(advice, [setting for setting in usable if advice.serving(setting)], run)
        advice.race = lambda: _race(advice, search, run)
        verify(advice, run)
        if not advice.verified:
            what_helps(advice, run)
    return advice


def _pilots(advice, settings, run):
    question, start = advice.question, advice.question.first_step
    duration = question.duration
    while 3e-6 * run.slowdown * min(advice.speeds.values()) * duration / start > question.budget / 40 and duration > 100 * start:
        duration /= 2  # a scene this dear gets pilots of a part of the motion
    if duration < question.duration:
        advice.cut_short.append(f"error pilots cover {duration:g} of {question.duration:g} s, and were held to that share of the error")
    advice.pilot_duration = duration

    def pilot(setting, step):
        name = advice.serving(setting)[0]
        if advice.never:
            return Pilot(step, NEVER, None, reason=advice.never)
        usual = advice.found[setting].step_us()
        expected = 3e-6 * run.slowdown * duration / step * (usual if math.isfinite(usual) else advice.speeds[name])
        if expected > run.left(PILOT_SHARE):
            return False
        run.tell(f"error pilots: {setting.name}, step {step:g} s")
        found = run.pilot(setting, name, step, duration, min(max(1.0, run.left(TIMING_SHARE)), question.budget / 10 + 4 * expected))
        if found.status == REFUSED and not any(pilot.status == REFUSED for pilot in advice.found[setting].pilots):
            advice.never = refusal(setting, name, step, duration, run)
        return found.status != "timeout" and found

    def quick(setting, step):
        """Time of a step, us; infinite where it is far above those of the probe."""
        if run.left(PILOT_SHARE) < 0:
            return False
        name = advice.serving(setting)[0]
        seconds = REPEATS * 1e-6 * advice.speeds[name]  # a step
        steps = QUICK if math.isnan(seconds) else max(LEAST_STEPS, round(question.budget * QUICK_SHARE / seconds))
        row = run("quick", setting, name, step, min(duration, steps * step), run.slowdown * question.budget / 30)
        return math.inf if row["status"] == "timeout" else row["step_us"]
    search = Search(advice, settings, pilot, quick)
    search.search()
    if search.cut:
        advice.hurry("some error pilots would have taken longer than the time left")
    return search


def _race(advice, search, run):
    """Times the candidates; if all that there were are out, those of settings that had promised less. Returns whether there was any to time."""
    question = advice.question
    if advice.candidates and all(one.out for one in advice.candidates):
        search.again()
    _enlist(advice)
    if not (new := [one for one in advice.candidates if not one.out and not one.rows]):
        return False
    least = min((one.promise for one in new if math.isfinite(one.promise)), default=1e6)
    length = timing.stretch(question.duration, least, run.left(TIMING_SHARE) / (run.slowdown * REPEATS), LEAST_STEPS * max(one.step for one in new))
    limit = max(5.0, 1e-5 * run.slowdown * REPEATS * least * length)

    def timed(one, number):
        run.tell(f"timing: round {number}, {one.implementation}, {one.setting.name}")
        return run(f"round{number}", one.setting, one.implementation, one.step, max(length, LEAST_STEPS * one.step), limit)
    advice.timed = timed
    if not timing.race(advice.candidates, timed, lambda: run.left(TIMING_SHARE), question.deadline_us, shorter=not question.step):
        advice.hurry("no time was left for all rounds of timing")
    return True


def _enlist(advice):
    """Makes candidates of the settings that have a step and none yet."""
    promises = {}  # {(setting, implementation): us a simulated second}
    known = {one.setting for one in advice.candidates}
    for setting, found in advice.found.items():
        names = advice.serving(setting) if found.chosen and setting not in known else []
        promises |= {(setting, name): found.step_us() / found.chosen * (advice.speeds[name] / advice.speeds[names[0]] if name != names[0] else 1.0)
                     for name in names}
    if unknown := sorted({name for (_, name), promise in promises.items() if not math.isfinite(promise)}):
        advice.cut_short.append(f"no short run of {', '.join(unknown)} came to its end: timed without knowing how fast they are")
    least = min((promise for promise in promises.values() if math.isfinite(promise)), default=math.inf)
    for (setting, name), promise in sorted(promises.items(), key=lambda item: (not math.isfinite(item[1]), item[1])):
        one = timing.Candidate(setting, name, advice.question.step or tidy(advice.found[setting].chosen, advice.question.duration), promise=promise)
        advice.candidates.append(one)
        if math.isfinite(promise) and promise > SLOWER * least:
            one.reason, one.slower = f"promises {promise / least:.2f} times the least time, by pilots and probe", True
