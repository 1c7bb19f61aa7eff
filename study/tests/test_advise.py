# study/advise: the choice on invented errors and times, what is refused, small questions to the real program.
import json
import math
import os
import shlex
import tempfile
from types import SimpleNamespace

import numpy
import pytest
from scipy.interpolate import CubicHermiteSpline

from analysis.core import records
from analysis.core.files import StudyError, read_json
from analysis.core.outcomes import FINISHED
from study.core.cell import Contender
from study.core.setting import Setting
from study.tools.advise import answer, evidence, main as advise_main, timing, validate
from study.tools.advise.advice import Advice, Question, advise as seek
from study.tools.advise.choice import Next, Pilot, apart, by_order, counts, local_order, most, next_at, next_step, tidy
from study.tools.advise.main import advise as command, duration
from study.tools.advise.probe import catalogue, find_speeds, fits, named, probe, serving
from study.tools.advise.runner import EXACT, HALVED, REPEATS, Runner, advised as advised_line, typed, within
from study.tools.advise.search import Found, Search
from study.tools.advise.truth import Truth, spread
from study.tools.advise.validate import _compare, _reference, fastest, search as exhaustive
from study.tools.advise.verify import verify, what_helps
from study.tests.conftest import ROOT, study

REAL = {"MBS_PROGRAM": os.environ.get("MBS_PROGRAM", str(ROOT / "build" / "mbs"))}
PENALTY, SADDLE = Setting("penalty"), Setting("saddle-point")
LOOSE = Setting("saddle-point", (("tolerance", "loose"),))


def pilots(*estimates, first=1e-2, status="ok"):
    return [Pilot(first / 2**k, status if value is not None else "diverged", value, 1.0)
            for k, value in enumerate(estimates)]


def choose(estimate, limit, start=1e-2, duration=1.0):
    """Pilots by the rules until they end; (their Next, all of them)."""
    found = []
    while len(found) < 40:
        after = next_step(found, limit, 2, start, duration)
        if after.step is None:
            return after, found
        value = estimate(after.step)
        found.append(Pilot(after.step, "diverged" if value is None else "ok", value, 1.0))
    raise AssertionError("no end")


def test_the_step_meets_the_limit_and_is_not_much_shorter_than_needed():
    for limit in (1e-1, 3e-3, 1e-5, 1e-7):
        after, found = choose(lambda step: 40 * step**2, limit)
        assert 0.85 * limit <= 40 * after.chosen**2 <= limit and len(found) <= 8


def test_estimates_that_agree_by_chance_do_not_count():
    chance = lambda step: 1e-4 if step > 6e-3 else 0.1 if step > 3e-3 else 4e3 * step**2
    after, _ = choose(chance, 1e-3)
    assert after.chosen < 3e-3 and chance(after.chosen) <= 1e-3
    assert not counts(1e-2, pilots(1e-4)) and not counts(1e-2, pilots(1e-4, 0.1))
    assert not counts(1e-2, pilots(1e-4, 9e-5)) and counts(5e-3, pilots(1e-4, 4e-5))
    assert not counts(5e-3, pilots(4e-4, 1e-4, 2e-4))  # the next halving contradicts it
    assert not counts(5e-3, pilots(4e-4, 1e-4, 8e-5))


def test_a_motion_that_no_step_changes_shows_no_order_but_counts():
    rest = pilots(1e-16, 1e-16)
    assert counts(1e-2, rest, 1e-3) and not counts(1e-2, rest, 1e-15)
    assert choose(lambda step: 0.0, 1e-3)[0].chosen == pytest.approx(8e-2)


def test_rounding_and_lost_runs_end_the_search():
    after, _ = choose(lambda step: step**2 + 1e-12 / step, 1e-14)
    assert after.chosen is None and "shorter steps do not help: estimate" in after.reason
    after, found = choose(lambda step: None, 1e-3)
    assert after.chosen is None and "diverged" in after.reason and len(found) < 30
    after, _ = choose(lambda step: None if step > 4e-3 else step**2, 1.0)
    assert after.chosen == pytest.approx(2.5e-3 * math.sqrt(2))  # half-way to a lost one, but no further
    after, _ = choose(lambda step: None if step > 3e-3 else step**2, 1.0)
    assert after.chosen == pytest.approx(2.5e-3)


def test_the_margin_is_what_an_order_a_little_below_the_shown_one_leaves():
    assert apart(2e-3, 2) == pytest.approx(1.5e-3)
    margin = lambda shown: by_order(1e-2, 2e-3, pilots(2e-3, 2e-3 / 2**shown), 2)
    assert 2e-3 < margin(2.0) < 2.2e-3
    assert margin(0.5) == pytest.approx(3e-3) and margin(3.0) == pytest.approx(2e-3)
    assert [local_order(step, pilots(16.0, 2.0, 1.0), 2) for step in (4e-3, 6e-3)] == [1.0, 3.0]
    assert local_order(4e-3, [], 2) == 2


@pytest.mark.parametrize("step, duration, expected", [
    (2.77e-3, 5, 2.77e-3), (2.6e-3, 5, 2.5e-3), (1.3e-3, 20, 1.28e-3), (1 / 3, 20, 0.333), (1e-2, 20, 1e-2)])
def test_steps_are_tidy(step, duration, expected):
    assert tidy(step, duration) == expected


def search(errors, times, settings, **more):
    """A Search on errors {setting: f(step), None where a run is lost} and times of a step {setting: us}."""
    def run(setting, step):
        value = errors[setting](step)
        return Pilot(step, "ok", value, times[setting]) if value is not None else Pilot(step, "diverged", None, times[setting])
    return searched_by(run, lambda setting, step: times[setting], settings, **more)


def searched_by(run, quick=lambda *_: 1.0, settings=(PENALTY,), **more):
    """(the Search, what it found)"""
    made = Search(asked(**more), settings, run, quick)
    made.search()
    return made, made.found


def square(step):
    return 40 * step**2


def test_the_search_follows_what_is_fast_and_says_why_others_are_left():
    times = {PENALTY: 10.0, SADDLE: 20.0, LOOSE: 9.0, Setting("rattle"): 100.0}
    made, found = search({setting: square for setting in times}, times, list(times))
    assert found[LOOSE].chosen and made.best() == pytest.approx(9.0 / found[LOOSE].chosen)
    assert "ms a simulated second" in found[Setting("rattle")].reason and len(found[Setting("rattle")].pilots) < 3


def test_a_change_is_tried_where_its_scheme_is_lost():
    _, found = search({SADDLE: lambda step: None, LOOSE: square}, {SADDLE: 10.0, LOOSE: 9.0}, [SADDLE, LOOSE])
    assert found[LOOSE].chosen and found[SADDLE].chosen is None


def test_a_change_is_tried_where_its_scheme_only_ends_once_and_far_off():
    """As RATTLE on the four-bar, whose tight tolerance loses it at singular positions that one pass goes through."""
    lost_but_once = lambda step: 0.5 if step < 2e-3 else None
    _, found = search({SADDLE: lost_but_once, LOOSE: square, PENALTY: lambda step: 160 * step**2},
                      {SADDLE: 10.0, LOOSE: 9.0, PENALTY: 10.0}, [PENALTY, SADDLE, LOOSE])
    assert found[LOOSE].chosen and not found[SADDLE].chosen


@pytest.mark.parametrize("status", ["refused", "crashed"])
def test_a_pilot_that_fails_voids_no_step_that_others_have_shown(status):
    """As a driver that turns too far in a long step, which is refused."""
    def run(setting, step):
        return Pilot(step, status, None, reason="too long") if step > 1.5e-2 else Pilot(step, "ok", 1e-4 * step**2, 1.0)
    [one] = searched_by(run)[1].values()
    assert one.chosen >= 1e-2 if status == "refused" else one.chosen or one.reason.startswith("crashed: too long")


def test_where_forces_are_off_a_shorter_step_is_tried_but_not_with_a_change_that_is_to_blame():
    """As where accelerations are not projected: those of the scheme itself are right in the same steps."""
    def run(setting, step):
        is_off = step > (5e-3 if setting == SADDLE else 0.0)
        return Pilot(step, "forces-lost" if is_off else "ok", 1e-4 * step**2, 1.0, 'output "M" is off')
    _, found = searched_by(run, settings=[SADDLE, LOOSE])
    assert 2e-3 < found[SADDLE].chosen <= 5e-3 and found[LOOSE].chosen is None
    assert found[LOOSE].reason == 'forces-lost: output "M" is off' and len(found[LOOSE].pilots) < 4


def at_step(step, estimate, limit=1e-3):
    """(Next, steps that were run) of a setting whose step is given."""
    found = []
    while True:
        after = next_at(step, found, limit, 2, 1.0)
        if after.step is None:
            return after, [pilot.step for pilot in found]
        value = estimate(after.step)
        found.append(Pilot(after.step, "diverged" if value is None else "ok", value, 1.0, reason="lost"))


def test_a_given_step_is_shown_by_half_of_it_and_no_other_is_chosen():
    assert at_step(1e-2, lambda step: step**2) == (Next(chosen=1e-2), [1e-2, 5e-3])
    assert at_step(1e-2, lambda step: step**2 if step < 1.5e-2 else None)[0] == Next(chosen=1e-2)
    assert at_step(5e-2, lambda step: 1e-10)[0] == Next(chosen=5e-2)  # a motion that steps hardly change
    assert at_step(1e-2, lambda step: 0.5)[0].reason == "estimate 0.5 m at step 0.01 s"
    assert at_step(1e-2, lambda step: None)[0].reason == "diverged at step 0.01 s: lost"
    after, ran = at_step(1e-2, lambda step: 9e-4)
    assert after.chosen is None and "half the step does not show it" in after.reason and ran == [1e-2, 5e-3]
    _, found = search({PENALTY: lambda step: step**2, SADDLE: lambda step: step}, {PENALTY: 9.0, SADDLE: 1.0},
                      [PENALTY, SADDLE], step=2e-2)
    assert found[PENALTY].chosen == 2e-2 and found[SADDLE].chosen is None


def test_without_time_nothing_is_made_up():
    made, found = searched_by(lambda setting, step: False)
    assert made.cut and found[PENALTY].chosen is None and "no time was left" in found[PENALTY].reason
    made, found = searched_by(lambda setting, step: setting != LOOSE and Pilot(step, "ok", square(step), 10.0 if setting == PENALTY else 16.0),
                              lambda setting, step: setting != LOOSE and 10.0, [PENALTY, SADDLE, LOOSE])
    assert found[PENALTY].chosen and made.cut and "no time was left" in found[LOOSE].reason, "its scheme's time says nothing of it"


def test_a_setting_that_is_refused_or_late_is_not_tried_again():
    refused = lambda setting, step: Pilot(step, "unsupported", None, reason="not served")
    [one] = searched_by(refused, lambda *_: None, error=1)[1].values()
    assert one.reason == "unsupported: not served" and not one.pilots
    _, found = search({PENALTY: lambda step: step}, {PENALTY: 30.0}, [PENALTY], deadline_us=10.0)
    assert found[PENALTY].reason == "a step takes 30 us, beyond the deadline"


def race(times, p99=1.0, deadline_us=None, left=lambda: 1.0):
    candidates = [timing.Candidate(PENALTY, name, 1e-3) for name in times]
    run = lambda one, number: {"status": "ok", "reason": "", "step_us_p99": p99,
                               "step_us": times[one.implementation][number - 1]}
    whole = timing.race(candidates, run, left, deadline_us)
    return whole, {one.implementation: one for one in candidates}, timing.ranked(candidates, deadline_us)


def test_slow_candidates_drop_out_and_close_ones_get_more_rounds():
    whole, found, ranked = race({"a": [10] * 5, "b": [11, 9, 10.5, 11, 11], "c": [21], "d": [13] * 2})
    assert whole and [one.implementation for one in ranked] == ["a", "b"]
    assert [len(found[name].rows) for name in "abcd"] == [5, 5, 1, 2]
    assert found["c"].reason == "2.10 times slower after round 1"
    _, found, _ = race({"a": [10] * 3, "b": [10.5] * 3})
    assert len(found["b"].rows) == 3  # the rounds tell them apart


def test_a_timing_is_short_where_steps_are_dear():
    assert timing.stretch(20.0, 1e5, 10.0, 0.1) == timing.STRETCH and timing.stretch(1.0, 1e5, 10.0, 0.1) == 1.0
    assert timing.stretch(20.0, 2e6, 10.0, 0.1) == 0.5 and timing.stretch(20.0, 2e6, -1.0, 0.1) == 0.1


def test_a_deadline_is_for_the_99th_percentile_and_who_was_slower_than_a_late_one_comes_back():
    assert not race({"a": [1.0] * 5}, p99=12.0, deadline_us=10.0)[2]
    assert race({"a": [1.0] * 5}, p99=9.0, deadline_us=10.0)[2]
    p99 = {"a": 15.0, "b": 8.0, "c": 1.0, "d": 8.0}
    candidates = [timing.Candidate(PENALTY, name, 1e-3) for name in p99]
    candidates[3].reason, candidates[3].slower = "promises 1.80 times the least time", True
    run = lambda one, number: {"status": "ok", "step_us": dict(zip("abcd", (10.0, 13.0, 2e3, 18.0)))[one.implementation],
                               "step_us_p99": p99[one.implementation]}
    timing.race(candidates, run, lambda: 1.0, 10.0)
    assert [(one.implementation, len(one.rows)) for one in timing.ranked(candidates, 10.0)] == [("b", 3)] and not candidates[3].rows
    p99 |= {"b": 11.0, "c": 11.0}  # all are late: those left out are timed
    for one in candidates[:3]:
        one.rows, one.reason, one.slower = [], "", False
    timing.race(candidates, run, lambda: 1.0, 10.0)
    assert [(one.implementation, len(one.rows)) for one in timing.ranked(candidates, 10.0)] == [("d", 3)]


def test_a_step_longer_than_itself_is_not_in_real_time_whatever_the_deadline():
    late = timing.Candidate(PENALTY, "a/b", 1e-5, [{"step": 1e-5, "step_us": 9.0, "step_us_p99": 12.0}])
    assert not timing.ranked([late], 50.0) and late.reason == "99th percentile 12 us: longer than the step of 10 us, not in real time"
    _, found = search({PENALTY: lambda step: 1e7 * step**2}, {PENALTY: 30.0}, [PENALTY], deadline_us=50.0)
    assert found[PENALTY].late < 3e-5 and "not in real time" in found[PENALTY].reason
    advice = asked(deadline_us=50.0, candidates=[late], found=found)
    what_helps(advice, None)
    assert advice.helps == ["a larger --error: its steps are longer, and these take longer than the time that they simulate"]


def test_a_short_run_that_does_not_end_takes_no_setting_away():
    _, found = searched_by(lambda setting, step: Pilot(step, "ok", square(step), 7.0), lambda *_: math.inf)
    assert found[PENALTY].chosen and found[PENALTY].chosen_us == 7.0
    whole, found, ranked = race({"a": [1.0] * 5, "b": [1.0] * 5}, left=iter([1, 0, 0]).__next__)
    assert not whole and [one.implementation for one in ranked] == ["a"]
    assert found["b"].reason == "no time was left to time it"


class Runs:
    """Stands in for a Runner: `row` gives what a run of (kind, setting, implementation, step, duration) comes to; `ran` has these."""

    slowdown = 1.0

    def __init__(self, row):
        self.row, self.ran, self.scene, self.limits = row, [], "bar", []

    def __call__(self, *asked, **_):
        self.ran.append(asked[:5])
        self.limits += asked[5:6]
        return {"status": "ok", "reason": "", "implementation": asked[2], "forces_lost": ""} | self.row(*asked[:5])

    def left(self, share=1.0):
        return 1.0

    def tell(self, text):
        pass


def asked(**more):
    """An Advice on a second of a scene "bar" within a millimetre."""
    question = {"scene": "bar", "error": 1e-3, "duration": 1.0, "deadline_us": None, "budget": 45.0}
    given = {name: more.pop(name) for name in (*question, "step") if name in more}
    return Advice(Question(**question | given), **({"described": {}, "variants": {"a/b": {"settings": []}}, "speeds": {"a/b": 1.0},
                                                    "pilot_duration": 1.0} | more))


class Invented(Runs):
    """A scene on which errors are a power of the step, and which costs what its setting and its implementation cost."""

    DESCRIBED = {"scheme": {"take": "penalty"}, "terms": {"driven_constraints": 0, "factors": 0, "damping": False},
                 "driven_points": 0, "driven_vectors": 0, "drivers_end": None,
                 "recommendation": [{"implementation": name, "step_us": us} for name, us in (("one/a", 2.0), ("two/b", 3.0))]}
    VARIANTS = {"one/a": {"settings": ["saddle-point"], "dense": False, "library": "none"},
                "two/b": {"settings": ["saddle-point", "rattle", "multistep6"], "dense": False, "library": "none"}}
    ERRORS, COSTS = {"penalty": 40.0, "saddle-point": 10.0}, {"penalty": 1.0, "saddle-point": 1.5}
    seconds, waited = 1.0, 0.0

    def __init__(self):
        super().__init__(None)
        self.rows = []

    def __call__(self, kind, setting, name, step, duration, limit, checks="", repeats=REPEATS):
        error = self.ERRORS.get(setting.scheme, 1e3) * step**setting.order * (1 + 2 * len(setting.changes))
        us = {"one/a": 2.0, "two/b": 3.0}[name] * self.COSTS.get(setting.scheme, 4.0) * (1 - 0.1 * len(setting.changes))
        self.rows.append({"kind": kind, "setting": setting.name, "implementation": name, "step": step, "duration": duration,
                          "status": "ok", "reason": "", "estimate": error if checks == HALVED else None,
                          "exact": error if checks == EXACT else None, "step_us": us, "step_us_median": us, "step_us_p99": 2 * us,
                          "step_us_mean": us, "deadline_misses": None, "steps": round(duration / step), "penalty": 1e7, "tolerance": 1e-9,
                          "branch_doubt": "", "forces_lost": "", "warnings": [],
                          "command": f"build/mbs simulate bar --step {step:g} --duration {duration:g}", "raw_file": "raw"})
        return self.rows[-1]

    def pilot(self, setting, name, step, duration, limit):
        row = self("pilots", setting, name, step, duration, limit, HALVED)
        return Pilot(step, row["status"], row["estimate"], 1.0 if row["status"] == "ok" else math.nan, row["reason"])


@pytest.mark.parametrize("error", [1e-2, 1e-4, 1e-8])
def test_on_an_invented_scene_the_advice_is_about_the_best_of_an_exhaustive_search(error):
    run, duration = Invented(), 2.0
    advice = seek(Question("bar", error, duration, None, 45.0), catalogue(), run.DESCRIBED, run.VARIANTS, run)
    told = answer.as_json(advice, run, "folder")
    assert told["met"] and told["advice"]["error"]["estimate"] <= error and not told["cut_short"]
    assert f"--step {told['advice']['step']:g} --duration 2\n" in answer.text(told)
    found, speeds = exhaustive(run, run.VARIANTS, run.DESCRIBED, duration, [error])
    assert list(speeds) == ["one/a", "two/b"]
    row = _compare(error, duration, told, run, run.VARIANTS, found, speeds)
    assert row["meets"] and 1.0 <= row["ratio"] <= evidence.MOST and row["best_us_per_second"] > 0
    assert _compare(error, duration, told | {"met": False, "advice": None, "why_not": "no"}, run, run.VARIANTS, found, speeds)[
        "ratio"] is None


def test_where_all_that_was_timed_is_late_settings_that_promised_less_are_tried():
    class Late(Invented):
        COSTS = {"penalty": 5.0, "saddle-point": 1.5}

        def __call__(self, kind, setting, *more, **words):
            return super().__call__(kind, setting, *more, **words) | ({"step_us_p99": 35.0} if setting.scheme == "saddle-point" else {})
    for deadline, scheme in ((None, "saddle-point"), (30.0, "penalty")):
        run = Late()
        told = answer.as_json(seek(Question("bar", 1e-3, 2.0, deadline, 45.0), [PENALTY, SADDLE], run.DESCRIBED, run.VARIANTS, run), run, "folder")
        assert told["advice"]["scheme"] == scheme and told["advice"]["step_us"]["p99"] == (20.0 if deadline else 35.0)
    assert any("99th percentile 35 us: beyond the deadline" == one["why"] for one in told["refused"])


def test_a_motion_that_is_refused_at_any_step_is_not_tried_in_shorter_ones():
    class Hoist(Invented):  # its rope is gone after three seconds
        def __call__(self, kind, setting, name, step, duration, *more, **words):
            row = super().__call__(kind, setting, name, step, duration, *more, **words)
            return row | ({"status": "refused", "reason": "a value of 0 at t = 3 s", "estimate": None} if duration > 3 else {})
    run = Hoist()
    told = answer.as_json(seek(Question("bar", 1e-3, 20.0, None, 45.0), catalogue(), run.DESCRIBED, run.VARIANTS, run), run, "folder")
    assert sum(row["kind"] == "pilots" for row in run.rows) == 1 and told["helps"] == ["--duration 2.5: a run so long is not refused"]
    assert told["why_not"] == "no pilot gave a motion to go by: refused at any step, a value of 0 at t = 3 s"
    assert json.dumps(told, allow_nan=False) and told["settings"][0]["pilots"][0]["step_us"] is None


def told_with(**advice):
    """The text of an answer that is met, with some of its advice in place of its own."""
    run = Invented()
    told = answer.as_json(seek(Question("bar", 1e-3, 2.0, None, 45.0), [PENALTY], run.DESCRIBED, run.VARIANTS, run), run, "folder")
    return answer.text(told | {"advice": told["advice"] | advice})


def test_an_error_that_is_known_exactly_is_said_before_its_estimate():
    error = {"estimate": 0.0114, "low": 0.0103, "high": 0.0125, "exact": None}
    assert "  expected error        0.0114 m (0.0103 to 0.0125), verified over 2 s\n" in told_with(error=error)
    exact = "0.0098 m, from the exact motion; by half the step 0.0114 m (0.0103 to 0.0125), verified over"
    assert f"  expected error        {exact} 2 s\n" in told_with(error=error | {"exact": 0.0098})


def verified(estimate, p99=1.0, deadline_us=None, others=(), exact=None, step=None, plain=(), forces=(), outcome_forces=()):
    """Advice on two implementations of a setting whose pilots at 10 and 5 ms were good, and `others`; what
    was run."""
    advice = asked(deadline_us=deadline_us, step=step, candidates=[
        timing.Candidate(PENALTY, name, 8e-3, [{"step": 8e-3, "step_us": us, "step_us_p99": 1.0}] * 3)
        for name, us in (("a", 10.0), ("b", 11.0))])
    advice.candidates += others
    advice.found = {setting: Found(setting, pilots(8e-4, 2e-4), chosen=8e-3) for setting in (PENALTY, SADDLE)}

    def row(kind, setting, name, step, duration):
        return {"status": dict(plain).get(name, "ok") if kind == "outcome" else "ok", "setting": setting.name, "step": step,
                "step_us_p99": p99 if kind == "outcome" else 1e3, "step_us": 20.0, "estimate": estimate(step), "exact": exact, "duration": duration,
                "forces_lost": dict(outcome_forces).get(name, "") if kind == "outcome" else dict(forces).get(setting, "")}
    run = Runs(row)
    advice.timed = lambda one, number: run(f"round{number}", one.setting, one.implementation, one.step, 1.0)
    verify(advice, run)
    return advice, [(name, step) for kind, _, name, step, _ in run.ran if kind == "verification"]


def test_a_candidate_that_fails_gets_a_shorter_step_and_then_one_that_is_known():
    advice, ran = verified(lambda step: 10 * step**2)
    assert ran == [("a", 8e-3)] and advice.chosen.implementation == "a"
    advice, ran = verified(lambda step: 20 * step**2)
    assert ran[0] == ("a", 8e-3) and ran[1][1] < 8e-3 and advice.verified["estimate"] <= 1e-3
    assert [(row["step"], row["step_us"]) for row in advice.chosen.rows] == [(advice.chosen.step, 20.0)] * 3  # timed again
    advice, ran = verified(lambda step: 2e-4 if step < 5.1e-3 else 1.4e-3)
    assert ran[-1][1] == 5e-3 and len(ran) == 3 and advice.chosen
    advice, _ = verified(lambda step: 1.0)
    assert advice.chosen is None and all("when verified" in one.reason for one in advice.candidates)


def test_a_given_step_is_not_made_shorter():
    advice, ran = verified(lambda step: 20 * step**2, step=8e-3)
    assert ran == [("a", 8e-3)] and advice.chosen is None
    assert advice.candidates[1].reason == "estimate 0.0013 m when verified over 1 s"


@pytest.mark.parametrize("us, then", [(12.0, "c"), (30.0, "a")])
def test_who_was_only_slower_comes_back_when_the_fastest_needs_a_shorter_step(us, then):
    slower = timing.Candidate(SADDLE, "c", 8e-3, [{"step": 8e-3, "step_us": us, "step_us_p99": 1.0}] * 3)
    timing.drop_slow([timing.Candidate(PENALTY, "a", 8e-3, [{"step_us": 10.0}]), slower], 1.1, 3)
    assert slower.reason == f"{us / 10:.2f} times slower after round 3"
    estimates = iter([1.5e-3, 5e-4, *[0.0] * 5])
    advice, ran = verified(lambda step: next(estimates), others=[slower])
    assert [name for name, _ in ran] == ["a", then] and advice.chosen.implementation == then
    assert advice.chosen.reason == ""


def test_forces_that_are_off_refuse_a_setting_whoever_has_it():
    other = timing.Candidate(SADDLE, "a", 8e-3, [{"step": 8e-3, "step_us": 30.0, "step_us_p99": 1.0}] * 3)
    advice, ran = verified(lambda step: 1e-4, others=[other], forces={PENALTY: 'output "M" is off'})
    assert len(ran) == 2 and advice.chosen is other
    assert advice.verifications[0]["refused"] == 'forces-lost: output "M" is off'
    record = SimpleNamespace(done=True, seconds=0.1, command=["mbs"], name="x", machine={}, output={
        "status": "degraded", "status_reason": "both", "forces_lost": "off", "position_error_estimate": 1e-6})
    pilot = Runner(SimpleNamespace(one=lambda cell: record, names={}), "bar", 4, [Contender("a/b", "a/b")]).pilot(PENALTY, "a/b", 1e-2, 1.0, 60)
    assert (pilot.status, pilot.reason, pilot.valid) == ("forces-lost", "off", False)


def test_a_line_whose_forces_are_off_without_half_the_step_is_not_advised():
    advice, _ = verified(lambda step: 1e-4, outcome_forces={"a": 'output "M" is off'})
    assert advice.chosen.implementation == "b"
    assert advice.candidates[0].reason == 'forces-lost as it would be advised: output "M" is off'


def test_an_estimate_below_that_of_a_shorter_step_is_raised():
    advice, _ = verified(lambda step: 1e-5)
    assert advice.verified["estimate"] == 2e-4  # the pilot's at 5 ms


def test_a_pilot_that_is_longer_than_half_a_step_bounds_it_by_the_order_that_it_shows():
    found = pilots(1.6e-3, 4e-4, first=5e-3)
    between = most(3.4e-3, 7.4e-4, found, 2, 1e-3)
    half = most(2.5e-3, 4e-4, found, 2, 1e-3)
    assert between == pytest.approx(0.75 * 7.4e-4 + half * (1.7 / 2.5) ** 1.7) and between < 9e-4 < 0.75 * 7.4e-4 + half
    assert most(5e-3, 1.6e-3, found, 2, 1e-3) == pytest.approx(0.75 * 1.6e-3 + half)  # half the step itself: as it is


def test_where_the_exact_error_is_known_it_counts_if_it_is_larger():
    assert verified(lambda step: 1e-5, exact=3e-4)[0].verified["estimate"] == 3e-4
    assert verified(lambda step: 1e-5, exact=1e-2)[0].chosen is None


def test_the_deadline_is_verified_too_by_the_line_that_is_advised():
    advice, ran = verified(lambda step: 1e-4, p99=12.0, deadline_us=10.0)
    assert advice.chosen is None and [name for name, _ in ran] == ["a", "b"]
    assert advice.candidates[0].reason == "99th percentile 12 us over 1 s, as it would be advised: beyond the deadline"
    assert verified(lambda step: 1e-4, p99=9.0, deadline_us=10.0)[0].outcome["step_us_p99"] == 9.0


def test_what_a_whole_run_was_refused_for_is_told():
    advice, _ = verified(lambda step: 1e-4, plain={"a": "wrong-branch"})
    assert answer._refused(advice)[0]["why"].startswith("wrong-branch as it would be advised")
    for more, why in (({"p99": 12.0, "deadline_us": 10.0}, "99th percentile 12 us over 1 s, as it would be advised: beyond the deadline"),
                      ({"exact": 1e-2}, "error 0.01 m over 1 s"), ({}, "")):
        assert verified(lambda step: 1e-4, **more)[0].verifications[0]["refused"] == why


def test_without_the_automatic_tolerance_none_is_made_up():
    asked = []

    def one(cell):
        asked.append(cell.settings)
        found = {"tolerance": 1e-6, "status": "ok", "status_reason": ""} if works else {}
        return records.Record("runs/x", cell.settled().document(), "done" if works else "crashed", "" if works else "SIGSEGV",
                              0.1, ["build/mbs"], {}, found)
    works = True
    run = Runner(SimpleNamespace(one=one, names={}), "four-bar:1", 4, [Contender("one/a", "one/a")])
    assert run("search", LOOSE, "one/a", 1e-2, 1.0, 60)["status"] == "ok" and len(asked) == 2
    assert asked[1][asked[1].index("--tolerance") + 1] == "0.001"
    run("search", SADDLE, "one/a", 5e-3, 1.0, 60)
    run("search", LOOSE, "one/a", 5e-3, 1.0, 60)
    assert len(asked) == 4  # the scheme's own run has told it
    works = False
    row = run("search", LOOSE, "one/a", 2e-2, 1.0, 60)
    assert (row["status"], row["reason"], row["step_us"]) == ("crashed", "SIGSEGV", None) and len(asked) == 5


def test_settings_are_served_by_name_and_fit_the_scene():
    variants = {"one/a": {"settings": []}, "two/b": {"settings": ["saddle-point", "mixed", "rattle"]}}
    assert serving(PENALTY, variants) == ["one/a", "two/b"]
    assert serving(LOOSE, variants) == ["two/b"] == serving(Setting("rattle6"), variants)
    assert not serving(Setting("saddle-point", (("precision", "single"),)), variants)
    for terms in ({"damping": True}, {"factors": 1}):
        scene = {"terms": {"driven_constraints": False, "factors": 0, "damping": False} | terms,
                 "driven_points": 0, "driven_vectors": 0}
        assert fits(Setting("rattle4"), scene) and not fits(SADDLE, scene)
    assert len({setting.file_name for setting in catalogue()}) == len(catalogue())


def test_who_is_tried_is_near_the_fastest_by_the_rule_or_needed():
    described = {"scheme": {"take": "penalty"}, "recommendation": [
        {"implementation": name, "step_us": us} for name, us in (("slow/a", 9.0), ("quick/b", 1.0), ("near/c", 2.0))]}
    variants = {name: {"settings": settings, "dense": dense} for name, settings, dense in (
        ("slow/a", ["rattle"], False), ("quick/b", [], False), ("near/c", [], False), ("new/d", [], False), ("new/e", [], True))}
    tried, left_out = named(described, variants, [PENALTY])
    assert list(tried) == ["quick/b", "near/c", "new/d"] and left_out["slow/a"].startswith("9.0 times the time of quick/b")
    assert list(named(described, variants, [PENALTY, Setting("rattle")])[0])[-1] == "slow/a"
    assert list(named(described | {"recommendation": []}, variants, [PENALTY])[0]) == list(variants)
    assert {**named(described, variants, [PENALTY], everyone=True)[0]}.keys() == variants.keys()


def test_who_does_not_simulate_the_scene_is_no_measure_of_who_is_near():
    described = {"scheme": {"take": "penalty"}, "recommendation": [
        {"implementation": name, "step_us": us} for name, us in (("chains/a", 1.0), ("far/b", 5.0), ("near/c", 2.0))]}
    variants = {name: {"settings": [], "dense": False} for name in ("chains/a", "far/b", "near/c")}
    run = Runs(lambda kind, setting, name, *_: {"status": "unsupported" if name == "chains/a" else "ok",
                                                "step_us": 1.0 if name == "near/c" else 4.0})
    advice = asked(described=described, variants=variants, speeds={})
    find_speeds(advice, [PENALTY], run)
    assert list(advice.speeds) == ["near/c", "far/b"] and [name for _, _, name, _, _ in run.ran] == ["chains/a", "near/c", "far/b"]


def test_a_probe_is_halved_until_it_ends_and_stops_when_the_time_is_spent():
    described, names = {"scheme": {"take": "penalty"}, "recommendation": [{"implementation": "c", "step_us": 1e7}]}, ("a", "b", "c")
    variants = {name: {"settings": [], "dense": False} for name in names}
    ends = 3e-3
    run = Runs(lambda kind, setting, name, step, *_: {"status": "ok" if step < ends else "refused", "step_us": 5.0})
    rows, speeds = probe(variants, described, run, 1e-2, 1.0)
    assert speeds == dict.fromkeys(names, 5.0) and [step for *_, step, _ in run.ran] == [1e-2, 5e-3, 2.5e-3, 2.5e-3, 2.5e-3]
    ends = 0.0
    speeds = probe(variants, described, run, 1e-2, 1.0)[1]
    assert list(speeds) == ["c", "a", "b"] and speeds["c"] == 1e7 and math.isnan(speeds["a"])
    ends, run.left = 1.0, lambda share=1.0: -1.0
    advice = asked(described=described | {"recommendation": []}, variants=variants, speeds={})
    find_speeds(advice, [PENALTY], run)
    assert list(advice.speeds) == ["a"] and advice.cut_short == ["no time was left to try b, c"] and max(run.limits) <= 20.0


def test_the_reference_is_the_fastest_that_simulates_the_scene_in_both_forms():
    described = {"recommendation": [{"implementation": "chains/a", "step_us": 1.0}, {"implementation": "near/c", "step_us": 2.0}]}
    serves = {name: {"settings": ["saddle-point"]} for name in ("new/d", "near/c", "chains/a")}
    run = Runs(lambda kind, setting, name, *_: {"status": "unsupported" if name == "chains/a" else "ok"})
    assert _reference(described, serves, run) == "near/c"
    assert _reference({"recommendation": []}, {"new/d": serves["new/d"]}, run) == "new/d"  # the rule knows nothing of it
    with pytest.raises(StudyError, match="bar: no implementation that takes part simulates it in both forms"):
        _reference(described, {"chains/a": serves["chains/a"], "near/c": {"settings": []}}, run)


def test_runs_are_held_to_a_motion_between_its_instants():
    truth = object.__new__(Truth)
    truth.columns, truth.shape = ("p.x", "p.y"), (1, 2)
    t = numpy.linspace(0, 1, 21)
    truth.motion = CubicHermiteSpline(t, numpy.stack([numpy.cos(t), numpy.sin(t)]).T, numpy.stack([-numpy.sin(t), numpy.cos(t)]).T)
    t = [0.0, 0.33, 0.77]
    series = {"t": t, "p.x": [math.cos(x) for x in t], "p.y": [math.sin(x) + 1e-3 * (x > 0.5) for x in t]}
    assert truth.error(series) == pytest.approx(1e-3, rel=1e-3)


def test_points_of_every_kind_are_compared_whatever_their_order():
    assert list(spread(3)) == [0, 1, 2]
    for count in (100, 1000, 20000):  # of rods one after the other, whose ends are every second or third point
        places = spread(count)
        assert len(places) >= 35 and places[0] < 0.1 * count and places[-1] > 0.9 * count
        assert all(sum(place % kinds == kind for place in places) >= 4 for kinds in (2, 3, 4) for kind in range(kinds))


class Turning:
    """A lab of one point that turns at 40 rad/s, but for `off` times the third power of the step, in all schemes alike."""

    def __init__(self, off=0.0):
        self.off = off

    def run(self, cells):
        found = []
        for cell in cells:
            words = dict(zip(cell.settings[::2], cell.settings[1::2]))
            t = numpy.arange(0, round(float(words["--duration"]) / float(words["--step"])) + 1, cell.every) * float(words["--step"])
            off = self.off * float(words["--step"])**3
            series = {"t": t, "p.x": numpy.cos(40 * t) + off, "p.y": numpy.sin(40 * t), "p.vx": -40 * numpy.sin(40 * t), "p.vy": 40 * numpy.cos(40 * t)}
            found.append(SimpleNamespace(done=True, output={"status": "ok", "status_reason": ""}, series=series))
        return found


def truth_of(lab, duration, enough):
    described = {"dimension": 2, "elements": {"points": [{"name": "p", "kind": "free"}]}}
    return Truth(lab, "scene.json", described, Contender("lib/one", "lib/one"), duration, enough)


def test_the_reference_has_as_many_instants_as_a_fast_motion_needs():
    truth = truth_of(Turning(), 5.0, 1e-6)
    t = [0.31234, 4.87654]
    assert truth.uncertainty <= 1e-6 and truth.error({"t": t, "p.x": numpy.cos(40 * numpy.array(t)), "p.y": numpy.sin(
        40 * numpy.array(t))}) <= 1e-6


def test_the_search_keeps_the_fastest_row_of_each_setting_that_meets_an_error_and_no_luck():
    found = [{"setting": name, "step": step, "status": status, "exact": exact, "us_per_second": time}
             for name, step, status, exact, time in (
                 ("a", 0.8, "ok", 2e-2, 5.0), ("a", 0.4, "degraded", 9e-3, 10.0), ("a", 0.2, "ok", 1e-3, 20.0),
                 ("b", 0.4, "ok", 1e-3, 14.0), ("c", 0.4, "ok", 1e-3, 21.0), ("d", 0.8, "diverged", 1e-9, 1.0))]
    assert [row["us_per_second"] for row in fastest(found, 1e-2)] == [10.0, 14.0]
    assert fastest(found, 1e-4) == []
    found = [{"setting": "a", "step": step, "status": "ok", "exact": exact, "us_per_second": time}
             for step, exact, time in ((0.8, 9e-3, 4.0), (0.57, 9e-3, 5.0), (0.4, 2e-2, 7.0), (0.28, 8e-3, 10.0), (0.2, 1e-3, 20.0))]
    assert [row["us_per_second"] for row in fastest(found, 1e-2)] == [10.0]  # half the step of the others fails
    between = found + [{"setting": "a", "step": 0.26, "status": "ok", "exact": 3e-2, "us_per_second": None}]
    assert [row["us_per_second"] for row in fastest(between, 1e-2)] == [20.0]


@pytest.mark.parametrize("arguments, what", [
    (["four-bar:2"], "--error E are needed"), (["four-bar:2", "--error", "0"], "0 is not a positive number"),
    (["four-bar:2", "--error", "-1e-3"], "argument"), (["four-bar:2", "--error", "small"], "'small'"),
    (["four-bar:2", "--error", "1", "--deadline-us", "0"], "0 is not a positive number"),
    (["four-bar:2", "--error", "1", "--duration", "nan"], "nan is not a positive number"),
    (["nothing", "--error", "1"], 'scene "nothing": no such file'),
    (["four-bar:2", "--error", "1", "--only", "nobody"], "unknown implementation 'nobody'"),
    (["nothing", "--validate"], 'scene "nothing": no such file'), (["four-bar:1", "four-bar:2", "--error", "1"], "one SCENE"),
    (["--validate", "--deadline-us", "9", "--duration", "1", "--budget", "3"],
     "its own: --deadline-us, --duration, --budget do not go"),
    (["--validate", "--json", "--error", "1"], "its own: --error, --json do not go"),
    (["four-bar:2", "--error", "1", "--step", "0"], "argument --step: 0 is not a positive number"),
    (["four-bar:2", "--error", "1", "--step", "1/0"], "argument --step: 0 is not a positive number"),
    (["four-bar:2", "--error", "1", "--step", "60 Hz"], "argument --step: invalid seconds value: '60 Hz'"),
    (["four-bar:2", "--error", "1", "--step", "3"], "--step 3: a run of 20 s has 10 to 1e+07 steps, so from 2e-06 to 2 s"),
    (["four-bar:2", "--error", "1", "--step", "1/240", "--deadline-us", "16666"],
     "--deadline-us 16666: more than the step itself, 4166.67 us"),
    (["--validate", "--step", "1/60"], "its own: --step does not go")])
def test_what_is_wrong_is_said_in_a_line(tmp_path, monkeypatch, arguments, what):
    monkeypatch.setenv("MBS_PROGRAM", REAL["MBS_PROGRAM"])
    with pytest.raises(StudyError) as wrong:  # which the command prints
        command([*arguments, "--results", str(tmp_path / "results")])
    assert what in str(wrong.value) and "\n" not in str(wrong.value) and not (tmp_path / "results").exists()


def test_a_stored_validation_goes_on_and_a_folder_of_a_user_is_left_alone(tmp_path, monkeypatch):
    ran = []
    monkeypatch.setattr(advise_main, "validate", lambda options, *_: ran.append(options.results))
    for names in ([evidence.QUESTIONS, evidence.SEARCHED, evidence.PAGE], [".lock", "scenes"], []):  # of a clone; begun; new
        folder = tmp_path / str(len(names))
        folder.mkdir()
        for name in names:
            (folder / name).touch()
        command(["--validate", "four-bar", "--results", str(folder)])
        (folder / "mine.txt").touch()
        with pytest.raises(StudyError, match="is not empty and holds no set"):
            command(["--validate", "four-bar", "--results", str(folder)])
    assert len(ran) == 3


def test_what_is_wrong_is_all_that_the_command_prints(tmp_path):
    done = study("advise", "nothing", "--error", "1", "--results", tmp_path / "results", **REAL)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1) and done.stderr.startswith('study/advise: scene "nothing"')


def test_scenes_without_a_free_point_and_times_beyond_a_table_are_refused():
    with pytest.raises(StudyError, match="bar has no free points"):
        duration("bar", None, {"free_points": 0})
    with pytest.raises(StudyError, match="--duration 6: the drivers of bar end at 5 s"):
        duration("bar", 6.0, {"free_points": 1, "drivers_end": 5.0})
    assert duration("bar", None, {"free_points": 1, "drivers_end": 5.0}) == 5.0
    assert duration("bar", None, {"free_points": 1, "drivers_end": None}) == 20.0


def ask(folder, *more):
    done = study("advise", "four-bar:2", "--duration", "0.8", "--only", "csc_klu/refactor", "--json", "--results",
                 folder / "results", *more, **REAL)
    return done, json.loads(done.stdout)


def record_of(folder, run):
    return records.read(folder / "results" / run["raw_file"], run["raw_file"])


@pytest.fixture(scope="module")
def advised(tmp_path_factory):
    folder = tmp_path_factory.mktemp("advised")
    return folder, *ask(folder, "--error", "3e-5", "--budget", "300")  # others may run beside


def test_the_advice_is_as_accurate_as_asked_and_traces_to_its_raw_files(advised):
    folder, done, answer = advised
    assert done.returncode == 0 and answer["met"], done.stderr
    told = answer["advice"]
    assert told["error"]["exact"] <= 3e-5 and told["status"] in FINISHED
    for run in answer["runs"]:
        record = record_of(folder, run)
        assert run["command"] == typed(record)
        assert run["estimate"] == record.output["position_error_estimate"]
    assert {entry["setting"] for entry in answer["settings"]} == {setting.name for setting in catalogue()}
    assert all(entry["step"] or entry["reason"] for entry in answer["settings"])
    assert all(one["reason"] or one["advised"] or one["rounds"] for one in answer["candidates"])
    assert read_json(folder / "results" / "advice.json") == answer


def test_what_is_advised_is_what_was_timed_and_errors_are_judged_after_every_step(advised):
    command = shlex.split(advised[2]["advice"]["command"])
    place = command.index("--duration") + 1

    def alike(run):  # but for the time that a timing covers
        words = shlex.split(run["command"].replace(f" --repeats {REPEATS}", ""))
        return words[:place] + words[place + 1:] == command[:place] + command[place + 1:]
    runs = advised[2]["runs"]
    assert {run["kind"] for run in runs if alike(run)} >= {"round1", "outcome"}
    checked = {run["kind"]: " --half-step --judge-every 1 " in run["command"] for run in runs}
    assert {kind for kind, yes in checked.items() if yes} == {"pilots", "verification"}
    repeated = {run["kind"]: f" --repeats {REPEATS}" in run["command"] for run in runs}
    assert {kind for kind, yes in repeated.items() if not yes} == {"pilots", "verification", "outcome"} | (
        {"automatic"} & set(repeated))


def test_the_advised_line_is_over_all_of_the_time_and_without_a_blas_where_it_uses_none():
    line = "build/mbs simulate four-bar:2 --duration 2 --blas openblas"
    assert advised_line(line, "none", 5.0) == "build/mbs simulate four-bar:2 --duration 5"
    assert advised_line(line, "KLU", 2.0) == line


def test_a_run_ends_before_the_drivers_do():
    assert [within(5.0, step, 5.0) for step in (1 / 60, 0.0166666666667, 0.0166667)] == [5.0, 5.0, pytest.approx(299 * 0.0166667)]
    assert within(5.0, 0.0131, None) == within(5.0, 0.0131, 6.0) == 5.0 and within(5.0, 0.0131, 5.0) == pytest.approx(381 * 0.0131)
    assert advise_main.seconds("1/60") == 0.0166666666667


def test_runs_are_ranked_by_what_interruptions_do_not_reach(advised):
    folder, _, answer = advised
    timed = [run for run in answer["runs"] if run["kind"].startswith("round")]
    assert timed
    for run in timed:
        summary = record_of(folder, run).output
        assert run["step_us"] == summary["least_us"]["mean"] <= summary["step_us"]["mean"] * (1 + 1e-6)  # both are rounded
        assert run["step_us_p99"] == summary["step_us"]["p99"]


def test_estimates_that_count_are_near_the_exact_errors(advised):
    exact = {(run["setting"], run["step"]): run["exact"] for run in advised[2]["runs"] if run["kind"] == "pilots"}
    ratios = [pilot["estimate"] / exact[entry["setting"], pilot["step"]] for entry in advised[2]["settings"]
              for pilot in entry["pilots"] if pilot["counts"] and entry["setting"] in ("penalty", "saddle-point")]
    assert len(ratios) >= 3 and all(0.67 < ratio < 1.5 for ratio in ratios)


def test_a_deadline_that_nothing_meets_is_said(tmp_path):
    done = study("advise", "four-bar:2", "--duration", "0.6", "--only", "csc_klu/refactor", "--error", "1e-2",
                 "--deadline-us", "1e-3", "--results", tmp_path / "late", **REAL)
    assert done.returncode == 1 and "No setting meets this: what is accurate enough is too slow: a step takes" in done.stdout


def test_a_given_step_is_advised_or_nothing(tmp_path):
    done, answer = ask(tmp_path, "--error", "1e-2", "--step", "1/240")
    assert done.returncode == 0 and answer["question"]["step"] == answer["advice"]["step"] == 0.00416666666667
    assert {one["step"] for one in answer["candidates"]} == {0.00416666666667}
    done, answer = ask(tmp_path / "exact", "--error", "1e-9", "--step", "1/240")
    assert done.returncode == 1 and not answer["met"] and answer["advice"] is None
    assert answer["why_not"] == "no setting reaches the error in steps of 0.00416667 s" and answer["helps"][0].startswith("--duration")


def test_where_every_pilot_was_lost_the_answer_says_how():
    advice = asked()
    advice.hurry("some error pilots would have taken longer than the time left")
    lost = [Pilot(1e-2 / 2**k, "diverged", None, reason="constraints violated: rod rocker") for k in range(3)]
    advice.found = {PENALTY: Found(PENALTY, lost)}
    assert answer._why_not(advice) == "no pilot gave a motion to go by: diverged, constraints violated: rod rocker"
    advice.found[SADDLE] = Found(SADDLE, pilots(1.0))
    assert answer._why_not(advice) == "no setting reaches the error within the budget of 45 s"


def test_a_line_that_ends_as_degraded_says_why_and_why_that_is_no_objection():
    told = {"status": "degraded", "status_reason": "local errors add up", "error": {"estimate": 1e-3, "low": 1e-3, "high": 2e-3, "exact": None}, "warnings": []}
    next_line = "\n" + 24 * " "
    objection = f"{next_line}by the program's own bounds, which know nothing of the error that you asked for; half the step shows 0.002 m at most\n"
    assert f"  ends as               degraded: local errors add up{objection}  time per step" in told_with(**told)
    assert "  ends as               ok\n  time per step" in told_with(**told | {"status": "ok"})
    warned = told_with(**told | {"status": "ok", "warnings": ["the tolerance is loose", "it is Monday"]})
    assert f"  ends as               ok{next_line}warning: the tolerance is loose{next_line}warning: it is Monday{objection}" in warned


def test_what_half_the_step_does_not_tell_is_said():
    class Singular(Invented):
        def __call__(self, *asked, **words):
            return super().__call__(*asked, **words) | {"branch_doubt": "a singular position was passed"}
    run = Singular()
    told = answer.as_json(seek(Question("bar", 1e-3, 2.0, None, 45.0), [PENALTY], run.DESCRIBED, run.VARIANTS, run), run, "folder")
    assert "  but                   a singular position was passed\n" in answer.text(told)


def test_a_busy_machine_is_said():
    assert not answer._busy(0.01) and "50 %" in answer._busy(0.5)[0]


def test_a_shorter_step_is_said_to_help_only_where_it_was_seen_to():
    run = Runs(lambda kind, setting, name, step, *_: {"estimate": 5e-2 if step > 2e-3 else 100 * step**2})  # shows no order above
    advice = asked(step=1e-2, found={PENALTY: Found(PENALTY, pilots(9e-3))})
    what_helps(advice, run)
    assert advice.helps == ["--step 0.00125: in such steps penalty keeps the error"]
    lost = asked(step=1e-2, found={PENALTY: Found(PENALTY, pilots(None))})
    what_helps(lost, run)
    assert lost.helps == ["--step 0.00125: in such steps penalty keeps the error"]


def test_the_error_that_pilots_keep_is_named():
    advice = asked(error=1e-6, found={PENALTY: Found(PENALTY, pilots(4e-3, 1e-3, 2.5e-4, 6.25e-5))})
    what_helps(advice, Runs(lambda *_: {"estimate": 1.0}))
    [help] = advice.helps
    value, words = help.removeprefix("--error ").split(": ")
    assert words == "so much pilots were seen to keep" and 6.25e-5 < float(value) < 1.2e-4


def test_a_deadline_that_would_do_is_named_also_where_no_candidate_was_timed():
    advice = asked(deadline_us=2.0, found={PENALTY: Found(
        PENALTY, pilots(9e-4, 2e-4), reason="a step takes 5 us, beyond the deadline", chosen_us=5.0, late=1e-2)})
    what_helps(advice, None)
    assert advice.helps == ["--deadline-us 7.2: at best 99 % of the steps take up to about 6 us"]
    assert answer._why_not(advice) == "what is accurate enough is too slow: a step takes 5 us, beyond the deadline"


def test_what_was_too_late_is_named_with_its_time():
    late = timing.Candidate(PENALTY, "a/b", 1e-3, [{"step_us": 1.0, "step_us_p99": 12.0}])
    assert timing.ranked([late], 10.0) == []
    advice = asked(deadline_us=10.0, candidates=[late], found={PENALTY: Found(PENALTY, chosen=1e-3)})
    assert answer._why_not(advice).startswith("99 % of the steps are not done within the deadline: 99th percentile 12 us")


def test_each_scene_of_a_validation_has_a_folder_of_its_own(tmp_path, monkeypatch):
    folders = []

    def runner_of(folder, *_):
        folders.append(folder)
        raise StudyError("enough")
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))  # of the machine's locks
    described = {"judged_length": 1.0, "variables": 4, "drivers_end": None}
    for name, value in (("listed", lambda: None), ("select", lambda *_: []), ("describe", lambda scene: described)):
        monkeypatch.setattr(validate, name, value)
    scenes = ("a/bar.json", "b/bar.json", "ladder:9,fill=0.2", "ladder:9,fill=0.4", "ladder:9")
    for scene in scenes:
        with pytest.raises(StudyError, match="enough"):
            validate.validate(SimpleNamespace(scene=[scene], only=[], wait=True), None, runner_of, tmp_path)
    assert len(set(folders)) == len(scenes) and {folder.parent for folder in folders} == {tmp_path / "scenes"}


@pytest.mark.parametrize("duration", [0.03, 2.0])
def test_the_reference_is_what_half_the_step_leaves_as_it_is(duration):
    first = duration / 400 / numpy.ceil(duration / 400 / 5e-4)  # its first step
    truth = truth_of(Turning(off=1e-5 / first**3), duration, 1e-7)
    t = numpy.linspace(0.1, 0.9, 7) * duration
    assert truth.uncertainty <= 1e-7 and truth.error({"t": t, "p.x": numpy.cos(40 * t), "p.y": numpy.sin(40 * t)}) <= 1e-7


def question(scene, error, **more):
    """A row of a validation."""
    return {"kind": scene.partition(":")[0], "n": 4, "error": error, "asked": True, "commit": "0123456789", "processor": "CPU",
            "date": "2026-01-01", "met": True, "meets": True, "exact": error / 2, "ratio": 1.2, "seconds": 3.0, "others": 0.25,
            "why_not": "", **{f"{who}_{key}": value for who in ("advised", "best") for key, value in (
                ("implementation", "one/a"), ("setting", "penalty"), ("step", 1e-2))}} | more


def searched(setting):
    return {key: "" for key in evidence.SHOWN[1:]} | {"setting": setting, "command": "long"}


def test_a_validation_keeps_what_it_knows_of_other_scenes_and_its_page_is_that_of_its_table(tmp_path):
    errors = (1e-2, 1e-3)
    evidence.keep(tmp_path, "four-bar:1", [question("four-bar:1", error) for error in errors], [searched("rattle")])
    table = evidence.read(tmp_path)
    assert evidence.held(table).all(axis=None)
    assert evidence.sentence(table).startswith("2 questions on 1 mechanisms of 1 kinds: 2 advised runs are as accurate as asked, 2 take")
    evidence.keep(tmp_path, "chain:1", [question("chain:1", 1e-2, ratio=1.6, seconds=70.0), question("chain:1", 1e-3, asked=False)], [])
    evidence.keep(tmp_path, "four-bar:1", [question("four-bar:1", error, meets=error > 5e-3, ratio=None) for error in errors],
                  [searched("penalty")])
    table, page = evidence.read(tmp_path), (tmp_path / "README.md").read_text()
    assert list(zip(table.scene, table.error)) == [("chain:1", 1e-3), ("chain:1", 1e-2), ("four-bar:1", 1e-3), ("four-bar:1", 1e-2)]
    assert evidence.read(tmp_path, evidence.SEARCHED).setting.to_list() == ["penalty"]
    assert page == evidence.page(table) and "3 questions on 2 mechanisms of 2 kinds: 2 advised runs are as accurate" in page
    assert "| chain | 1 | 4 | 1 | 1 | 0 | 1.6 | 0 | 70 | 25 | penalty (1) |" in page
    assert "| chain:1 | 0.01 | 0.005 | 1.6 | 70 | one/a, penalty, 0.01 s | one/a, penalty, 0.01 s |" in page
    assert page.count("| four-bar:1 | ") == 2 and "| chain:1 | 0.001 |" in page  # what did not hold; what was not asked
    assert "| 0123456789 | CPU | 2026-01-01 | 2 |" in page


def test_a_question_that_nothing_was_advised_on_is_no_success(tmp_path):
    nothing = {f"{who}_{key}": None for who in ("advised", "best") for key in ("implementation", "setting", "step")}
    evidence.keep(tmp_path, "chain:1", [question("chain:1", 1e-2, met=False, meets=False, ratio=None, exact=None,
                                                 why_not="no setting reaches the error", **nothing)], [])
    assert not evidence.held(evidence.read(tmp_path)).accurate.any()
    assert "| chain:1 | 0.01 | – | – | 3 | no setting reaches the error | – |" in (tmp_path / "README.md").read_text()


STORED = ROOT / "results" / "advice"


@pytest.mark.skipif(not STORED.exists(), reason="no validation is stored")
def test_the_stored_validation_is_of_clean_commits_and_its_page_is_that_of_its_table():
    table = evidence.read(STORED)
    assert (STORED / evidence.PAGE).read_text(encoding="utf-8") == evidence.page(table)
    assert not table.commit.str.contains("-").any()
    found = evidence.read(STORED, evidence.SEARCHED)
    assert set(table[table.asked].scene) == set(found.scene)


def test_what_is_measured_from_a_changed_tree_says_so():
    context = {"commit": "0" * 40, "dirty": "false", "cpu_model": "CPU"}
    assert evidence.origin(context)["commit"] == "0000000000-dirty"  # a program of another commit than the tools


def test_a_line_that_is_lost_without_its_check_is_not_advised():
    advice, ran = verified(lambda step: 1e-4, plain={"a": "wrong-branch"})
    assert advice.chosen.implementation == "b" and advice.candidates[0].reason.startswith("wrong-branch as it would be advised")
