# The advice on one scene: probe, error pilots, timing, verification.
import math
import time
from dataclasses import dataclass, field

from study.tools.advise import timing
from study.tools.advise.choice import LEAST_STEPS, tidy
from study.tools.advise.runner import REPEATS
from study.tools.advise.search import DOMINATED, Search
from study.core.setting import Setting
from study.tools.advise.settings import fits, serving
from study.tools.advise.verify import verify

FIRST_STEP = 1e-2        # s; of the first pilot, where the run has enough such steps
PROBE_STEPS = 100
PROBE_FACTOR = 4         # an implementation this times slower than the best in the probe is not timed
PILOT_SHARE, TIMING_SHARE = 0.55, 0.8  # of the budget: when pilots, when timings must be done


@dataclass
class Question:
    scene: str
    error: float
    duration: float
    deadline_us: float | None
    budget: float  # s
    step: float | None = None  # s, where it is given


@dataclass
class Advice:
    question: Question
    probe: list = field(default_factory=list)
    found: dict = field(default_factory=dict)       # {Setting: search.Found}
    candidates: list = field(default_factory=list)
    verifications: list = field(default_factory=list)
    chosen: object = None                           # timing.Candidate
    verified: dict | None = None                    # its row
    pilot_duration: float = 0.0
    cut_short: list = field(default_factory=list)   # sentences
    seconds: float = 0.0


def advise(question, settings, described, variants, run, tell):
    """The Advice; `run` is a Runner, `variants` are names with what `mbs list --json` says."""
    began = time.monotonic()
    advice = Advice(question)

    def left(share):
        return share * question.budget - (time.monotonic() - began)
    start = question.step or min(FIRST_STEP, question.duration / (5 * LEAST_STEPS))
    tell("probe: one short run of each implementation")
    advice.probe, speeds = probe(variants, run, start, question.duration)
    usable = [setting for setting in settings
              if not fits(setting, described) and set(serving(setting, variants)) & set(speeds)]
    _pilots(advice, usable, speeds, variants, run, start, left, tell)
    _race(advice, speeds, variants, run, left, tell)
    verify(advice, run, lambda: left(1.0), tell)
    advice.seconds = time.monotonic() - began
    return advice


def probe(variants, run, start, duration):
    """(rows, {implementation: us a step} of those that simulate the scene, fastest first)."""
    rows, speeds = [], {}
    for name in variants:
        limit = max(2.0, 20e-6 * PROBE_STEPS * min(speeds.values())) if speeds else 60
        rows.append(run("probe", Setting("penalty"), name, start, min(duration, PROBE_STEPS * start), limit))
        if rows[-1]["step_us"]:
            speeds[name] = rows[-1]["step_us"]
    return rows, dict(sorted(speeds.items(), key=lambda item: item[1]))


def _pilots(advice, settings, speeds, variants, run, start, left, tell):
    question = advice.question
    if not speeds:
        return
    duration = question.duration
    while 3e-6 * min(speeds.values()) * duration / start > question.budget / 20 and duration > 100 * start:
        duration /= 2  # a scene this dear gets pilots of a part of the motion
    if duration < question.duration:
        advice.cut_short.append(f"error pilots cover {duration:g} of {question.duration:g} s, and were held "
                                "to that share of the error")
    advice.pilot_duration = duration

    def pilot(setting, step):
        name = next(name for name in speeds if name in serving(setting, variants))
        seconds = left(PILOT_SHARE)
        known = search.found[setting].step_us()
        expected = 3e-6 * duration / step * (speeds[name] if math.isnan(known) else known)
        if expected > seconds:
            return None
        tell(f"error pilots: {setting.name}, step {step:g} s")
        return run.pilot(setting, name, step, duration, max(5.0, 4 * expected))
    search = Search(settings, pilot, error=question.error * duration / question.duration,
                    duration=duration, start=start, deadline_us=question.deadline_us, step=question.step)
    advice.found = search.search()
    if search.cut:
        advice.cut_short.append("some error pilots would have taken longer than the time left")


def _race(advice, speeds, variants, run, left, tell):
    question = advice.question
    chosen = {setting: found for setting, found in advice.found.items() if found.chosen}
    if not chosen:
        return
    promises = {setting: found.step_us() / found.chosen for setting, found in chosen.items()}
    least = min(promises.values())
    for setting, found in sorted(chosen.items(), key=lambda item: promises[item[0]]):
        step = question.step or tidy(found.chosen, question.duration)
        for name in (name for name in speeds if name in serving(setting, variants)):
            one = timing.Candidate(setting, name, step)
            advice.candidates.append(one)
            slower = speeds[name] / min(speeds.values())
            if promises[setting] > DOMINATED * least:
                one.drop(f"{promises[setting] / least:.2f} times slower in the pilots")
            elif slower > PROBE_FACTOR:
                one.drop(f"{slower:.1f} times slower than the best in the probe")
    length = timing.stretch(question.duration, least)
    limit = max(5.0, 1e-5 * REPEATS * least * length)

    def timed(one, number):
        tell(f"timing: round {number}, {one.implementation}, {one.setting.name}")
        return run(f"round{number}", one.setting, one.implementation, one.step, length, limit)
    if not timing.race(advice.candidates, timed, lambda: left(TIMING_SHARE), question.deadline_us):
        advice.cut_short.append("no time was left for all rounds of timing")
