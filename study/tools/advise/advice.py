# The advice on one scene: who is tried, a probe, error pilots, timing, verification, what would help.
import math
import time
from dataclasses import dataclass, field

from analysis.core.outcomes import FINISHED
from study.core.setting import Setting
from study.tools.advise import timing
from study.tools.advise.choice import LEAST_STEPS, Pilot, enough, known, tidy
from study.tools.advise.runner import HALVED, QUICK, REPEATS
from study.tools.advise.search import LOST, Search
from study.tools.advise.settings import fits, serving
from study.tools.advise.verify import verify

FIRST_STEP = 1e-2  # s; of the first pilot, where the run has enough such steps
BEHIND = 3.0       # times the least time that the rule foresees: who is slower is not tried; its times are right to
                   # a factor of 1.5, mostly
DEAR = 100.0       # us a step from which probes are as short as they can be
SLOWER = 1.7       # times the time of the most promising, by pilots and probe: who is slower is not timed
PILOT_SHARE, TIMING_SHARE = 0.6, 0.8  # of the budget: when pilots, when timings must be done
P99 = 1.2          # times the time of a step: its 99th percentile, about, where that was not measured
HALVES = 6         # of the duration, to find for how long an error can be kept


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
    waited: float = 0.0                             # share of the time of runs in which other programs ran
    seconds: float = 0.0


def advise(question, settings, described, variants, run, tell):
    """The Advice; `run` is a Runner, `variants` are names with what `mbs list --json` says."""
    began = time.monotonic()
    advice = Advice(question)

    def left(share):
        return share * question.budget - (time.monotonic() - began)

    def say(text):
        tell(f"{time.monotonic() - began:.0f} of {question.budget:g} s, {text}")
    start = question.step or min(FIRST_STEP, question.duration / (5 * LEAST_STEPS))
    form = described["scheme"]["take"]  # goes first
    usable = [setting for setting in sorted(settings, key=lambda one: one.scheme != form)
              if not fits(setting, described) and serving(setting, variants)]
    speeds = _try(advice, described, dict(variants), usable, run, start, left, say)
    usable = [setting for setting in usable if set(serving(setting, variants)) & set(speeds)]
    if speeds:
        _pilots(advice, usable, speeds, variants, run, start, left, say)
        _race(advice, speeds, variants, run, left, say)
        verify(advice, run, left, say)
        if not advice.verified:
            _what_helps(advice, speeds, variants, run, left, say)
    advice.seconds, advice.waited = time.monotonic() - began, run.waited
    return advice


def _try(advice, described, able, settings, run, start, left, tell):
    """{implementation: us a step} of those near the fastest that simulates the scene, fastest first. The rule does not know who
    simulates it: whoever does not is no measure of who is near."""
    speeds, seen = {}, set()
    while True:
        tried, advice.left_out = named(described, able, [one for one in settings if serving(one, able)])
        rows, found = probe({name: able[name] for name in tried if name not in seen}, run, start, described,
                            advice.question, left, tell)
        advice.probe, speeds, seen = advice.probe + rows, speeds | found, seen | set(tried)
        unable = [row["implementation"] for row in rows if row["status"] == "unsupported"]
        if not unable:
            return dict(sorted(speeds.items(), key=lambda item: item[1]))
        able = {name: said for name, said in able.items() if name not in unable}


def named(described, variants, settings):
    """({implementation: foreseen us a step or nan} to try, fastest first; {implementation: why it is left out}): those
    near the fastest by the rule of `mbs describe`, who is sparse and unknown to it, as it was fitted to general code, and who
    else is needed for a setting; all without a rule."""
    foreseen = {one["implementation"]: one["step_us"] for one in described["recommendation"]
                if one["implementation"] in variants}
    if not foreseen:
        return dict.fromkeys(variants, math.nan), {}
    order = sorted(foreseen, key=foreseen.get)
    tried = [name for name in order if foreseen[name] <= BEHIND * foreseen[order[0]]]
    form = Setting(described["scheme"]["take"])
    tried += [name for name in serving(form, variants) if name not in foreseen and not variants[name]["dense"]]
    for setting in settings:
        serves = serving(setting, variants)
        if not set(serves) & set(tried):
            tried.append(min(serves, key=lambda name: foreseen.get(name, math.inf)))
    return {name: foreseen.get(name, math.nan) for name in tried}, {
        name: f"{foreseen[name] / foreseen[order[0]]:.1f} times the time of {order[0]} by the rule of mbs describe"
        if name in foreseen else "the rule of mbs describe does not name it" for name in variants if name not in tried}


def probe(variants, run, start, described, question, left, tell):
    """(rows, {implementation: us a step} of those that simulate the scene, fastest first), in the form that the rule is of;
    where the first step is too long for it, times are those foreseen."""
    rows, speeds = [], {}
    foreseen = {one["implementation"]: one["step_us"] for one in described["recommendation"]}
    form = Setting(described["scheme"]["take"])
    for name in variants:
        tell(f"probe: {name}")
        usual = min([*speeds.values(), foreseen.get(name, math.inf)])
        limit = 1.0 + 20e-6 * QUICK * usual if speeds else max(2.0, left(0.3))
        setting = form if name in serving(form, variants) else Setting()
        steps = QUICK if usual < DEAR else LEAST_STEPS
        rows.append(run("probe", setting, name, start, min(question.duration, steps * start), limit))
        if rows[-1]["status"] in FINISHED:
            speeds[name] = rows[-1]["step_us"]
        elif rows[-1]["status"] in LOST:  # passes of steps that are too long say little
            speeds[name] = foreseen.get(name, rows[-1]["step_us"] or 10.0 * len(rows))
    return rows, dict(sorted(speeds.items(), key=lambda item: item[1]))


def fastest(setting, speeds, variants):
    return next(name for name in speeds if name in serving(setting, variants))


def _pilots(advice, settings, speeds, variants, run, start, left, tell):
    question = advice.question
    duration = question.duration
    while 3e-6 * run.slowdown * min(speeds.values()) * duration / start > question.budget / 40 and duration > 100 * start:
        duration /= 2  # a scene this dear gets pilots of a part of the motion
    if duration < question.duration:
        advice.cut_short.append(f"error pilots cover {duration:g} of {question.duration:g} s, and were held to that "
                                "share of the error")
    advice.pilot_duration = duration

    def pilot(setting, step):
        name = fastest(setting, speeds, variants)
        known = search.found[setting].step_us()
        expected = 3e-6 * run.slowdown * duration / step * (speeds[name] if math.isnan(known) else known)
        if expected > left(PILOT_SHARE):
            return None
        tell(f"error pilots: {setting.name}, step {step:g} s")
        found = run.pilot(setting, name, step, duration, min(question.budget / 10 + 4 * expected, max(1.0, left(TIMING_SHARE))))
        return None if found.status == "timeout" else found

    def quick(setting, step):
        """Time of a step, us; infinite where it is far above those of the probe."""
        name = fastest(setting, speeds, variants)
        steps = max(LEAST_STEPS, round(question.budget / 500 / (REPEATS * 1e-6 * speeds[name])))
        if left(PILOT_SHARE) < 0:
            return None
        row = run("quick", setting, name, step, min(duration, steps * step), run.slowdown * question.budget / 30)
        return math.inf if row["status"] == "timeout" else row["step_us"]
    search = Search(settings, pilot, quick, error=question.error * duration / question.duration, duration=duration,
                    start=start, deadline_us=question.deadline_us, step=question.step)
    advice.found = search.search()
    if search.cut:
        advice.cut_short.append("some error pilots would have taken longer than the time left")


def _race(advice, speeds, variants, run, left, tell):
    question = advice.question
    chosen = {setting: found for setting, found in advice.found.items() if found.chosen}
    if not chosen:
        return
    promises = {(setting, name): found.step_us() / found.chosen * speeds[name] / speeds[fastest(setting, speeds, variants)]
                for setting, found in chosen.items() for name in speeds if name in serving(setting, variants)}
    least = min(promises.values())
    for (setting, name), promise in sorted(promises.items(), key=lambda item: item[1]):
        one = timing.Candidate(setting, name, question.step or tidy(chosen[setting].chosen, question.duration))
        advice.candidates.append(one)
        if promise > SLOWER * least:
            one.drop(f"promises {promise / least:.2f} times the least time, by pilots and probe")
    length = timing.stretch(question.duration, least)
    limit = max(5.0, 1e-5 * run.slowdown * REPEATS * least * length)

    def timed(one, number):
        tell(f"timing: round {number}, {one.implementation}, {one.setting.name}")
        return run(f"round{number}", one.setting, one.implementation, one.step, length, limit)
    if not timing.race(advice.candidates, timed, lambda: left(TIMING_SHARE), question.deadline_us, shorter=not question.step):
        advice.cut_short.append("no time was left for all rounds of timing")


def _what_helps(advice, speeds, variants, run, left, tell):
    """Fills `helps`, where nothing meets the question."""
    question = advice.question
    if any("left" in cut for cut in advice.cut_short):
        advice.helps.append(f"--budget {2 * question.budget:g}: time was short")
    valid = [(found.setting, pilot) for found in advice.found.values() for pilot in found.pilots]
    if not valid:
        return
    setting, best = min(valid, key=lambda item: (not item[1].valid, item[1].estimate if item[1].valid else item[1].step))
    error = question.error * advice.pilot_duration / question.duration
    least = min(known(pilot, advice.found[one].pilots, error, one.order) for one, pilot in valid)
    if error < least < math.inf:
        advice.helps.append(f"--error {1.1 * question.error * least / error:.2g}: so much pilots were seen to keep")
    name = fastest(setting, speeds, variants)

    def keeps(step, duration):
        return left(1.0) > 0 and _keeps(question.error, setting, name, step, duration, run, left)
    if question.step and best.valid and best.estimate > question.error:
        fewest = math.ceil((1.2 * best.estimate / question.error) ** (1 / setting.order))
        for parts in (fewest, 2 * fewest, 4 * fewest):  # the order may not show in steps this long
            tell(f"what would help: --step {question.step / parts:g}")
            if keeps(question.step / parts, question.duration):
                advice.helps.append(f"--step {question.step / parts:g}: in such steps {setting.name} keeps the error")
                break
    late = [one.late_us for one in advice.candidates if one.late_us]
    slow = [one.chosen_us for one in advice.found.values() if one.chosen_us > (question.deadline_us or math.inf)]
    if late or slow:
        soonest = min([*late, *(P99 * us for us in slow)])
        advice.helps.append(f"--deadline-us {1.2 * soonest:.3g}: at best 99 % of the steps take up to about {soonest:.3g} us")
        return
    for halving in range(1, HALVES + 1):
        duration = float(f"{question.duration / 2**halving:.3g}")
        step = question.step or best.step
        if duration < LEAST_STEPS * step:
            return
        tell(f"what would help: --duration {duration:g}")
        if keeps(step, duration):
            advice.helps.append(f"--duration {duration:g}: so long {setting.name} at step {step:g} s keeps the error")
            return


def _keeps(error, setting, name, step, duration, run, left):
    """Whether a run keeps the error, by half the step, which another one with half of both must show to be right."""
    pilots = []
    for at in (step, step / 2):
        row = run("shorter", setting, name, at, duration, max(2.0, left(1.0)), checks=HALVED)
        pilots.append(Pilot(at, row["status"], row["estimate"]))
        if not pilots[-1].valid:
            return False
    return pilots[0] in enough(pilots, error, setting.order)
