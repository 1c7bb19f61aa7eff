# The advice on one scene: the question, what becomes known, and its stages one after the other.
import math
from collections import namedtuple
from dataclasses import dataclass, field

from study.tools.advise import timing
from study.tools.advise.choice import LEAST_STEPS, tidy
from study.tools.advise.probe import find_speeds, fits, serving
from study.tools.advise.runner import REPEATS
from study.tools.advise.search import Search
from study.tools.advise.verify import verify, what_helps

FIRST_STEP = 1e-2  # s; of the first pilot, where the run has enough such steps
SLOWER = 1.7       # times the time of the most promising, by pilots and probe: who is slower is not timed
PILOT_SHARE, TIMING_SHARE = 0.6, 0.8  # of the budget: when pilots, when timings must be done
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
    left_out: dict = field(default_factory=dict)    # {implementation: why it is not tried}
    found: dict = field(default_factory=dict)       # {Setting: search.Found}
    candidates: list = field(default_factory=list)
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


def advise(question, settings, described, variants, run):
    """The Advice; `run` is a Runner."""
    advice = Advice(question, described, variants)
    form = described["scheme"]["take"]  # goes first
    usable = [setting for setting in sorted(settings, key=lambda one: one.scheme != form)
              if not fits(setting, described) and serving(setting, variants)]
    find_speeds(advice, usable, run)
    if advice.speeds:
        _pilots(advice, [setting for setting in usable if advice.serving(setting)], run)
        _race(advice, run)
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
        usual = advice.found[setting].step_us()
        expected = 3e-6 * run.slowdown * duration / step * (advice.speeds[name] if math.isnan(usual) else usual)
        if expected > run.left(PILOT_SHARE):
            return None
        run.tell(f"error pilots: {setting.name}, step {step:g} s")
        found = run.pilot(setting, name, step, duration, min(question.budget / 10 + 4 * expected, max(1.0, run.left(TIMING_SHARE))))
        return None if found.status == "timeout" else found

    def quick(setting, step):
        """Time of a step, us; infinite where it is far above those of the probe; None if no time is left."""
        if run.left(PILOT_SHARE) < 0:
            return None
        name = advice.serving(setting)[0]
        steps = max(LEAST_STEPS, round(question.budget * QUICK_SHARE / (REPEATS * 1e-6 * advice.speeds[name])))
        row = run("quick", setting, name, step, min(duration, steps * step), run.slowdown * question.budget / 30)
        return math.inf if row["status"] == "timeout" else row["step_us"]
    search = Search(advice, settings, pilot, quick)
    search.search()
    if search.cut:
        advice.hurry("some error pilots would have taken longer than the time left")


def _race(advice, run):
    question = advice.question
    promises = {}  # {(setting, implementation): us a simulated second}
    for setting, found in advice.found.items():
        names = advice.serving(setting) if found.chosen else []
        promises |= {(setting, name): found.step_us() / found.chosen * advice.speeds[name] / advice.speeds[names[0]] for name in names}
    if not promises:
        return
    least = min(promises.values())
    for (setting, name), promise in sorted(promises.items(), key=lambda item: item[1]):
        one = timing.Candidate(setting, name, question.step or tidy(advice.found[setting].chosen, question.duration))
        advice.candidates.append(one)
        if promise > SLOWER * least:
            one.reason = f"promises {promise / least:.2f} times the least time, by pilots and probe"
    length = timing.stretch(question.duration, least, run.left(TIMING_SHARE) / (run.slowdown * REPEATS),
                            LEAST_STEPS * max(one.step for one in advice.candidates if not one.out))
    limit = max(5.0, 1e-5 * run.slowdown * REPEATS * least * length)

    def timed(one, number):
        run.tell(f"timing: round {number}, {one.implementation}, {one.setting.name}")
        return run(f"round{number}", one.setting, one.implementation, one.step, length, limit)
    if not timing.race(advice.candidates, timed, lambda: run.left(TIMING_SHARE), question.deadline_us, shorter=not question.step):
        advice.hurry("no time was left for all rounds of timing")
