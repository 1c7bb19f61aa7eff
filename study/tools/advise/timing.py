# Which candidate is fastest: short runs in interleaved rounds, from which the slow ones drop out.
import math
from dataclasses import dataclass, field
from statistics import median

from analysis.core.outcomes import FINISHED

ROUNDS, TIE_BREAKS = 3, 2
SLOWER = (2.0, 1.25, 1.1)  # this times the best one's time drops out after the first, second, later rounds
STRETCH = 2.0              # simulated s of a timing: past singular positions, as far as there are such
LOST_AT_MOST = 4           # times a candidate's step may become shorter
SHORTEST = 0.05            # wall s of its steps at least, if the whole duration has as many
TIMINGS = 10               # so many are expected


@dataclass
class Candidate:
    """An implementation with a setting at its step."""
    setting: object
    implementation: str
    step: float
    rows: list = field(default_factory=list)
    reason: str = ""       # why it dropped out
    slower: bool = False   # than others as they were then, or by what it promises, and then it has no rows: that is why
    late_us: float = 0.0   # its 99th percentile, where that is why
    promise: float = field(default=math.nan, compare=False)  # of a simulated second, us
    kept: bool = field(default=False, compare=False)  # it is timed in every round, however slow

    out = property(lambda self: bool(self.reason))

    def us_per_second(self):
        """(median, least, most) over the rounds of the time of a simulated second."""
        found = [row["step_us"] / self.step for row in self.rows]
        return (median(found), min(found), max(found)) if found else (math.inf,) * 3

    def p99_us(self):
        """Median over the rounds."""
        return median(row["step_us_p99"] for row in self.rows) if self.rows else math.inf

    def drop_late(self, p99_us, deadline_us, when="", times=1):
        """Drops it if that is beyond so many times the deadline, or the step itself; says whether."""
        if late := bool(deadline_us) and p99_us > times * in_time(self.step, deadline_us):
            self.reason, self.late_us = f"99th percentile {p99_us:.3g} us{when}: {beyond(self.step, p99_us, deadline_us)}", p99_us
        return late


def in_time(step, deadline_us):
    """How long a step may take, us: no longer than itself, or a loop cannot hold it. Any time without a deadline."""
    return min(deadline_us, 1e6 * step) if deadline_us else math.inf


def beyond(step, us, deadline_us):
    return "beyond the deadline" if us > deadline_us else f"longer than the step of {1e6 * step:.3g} us, not in real time"


def stretch(duration, us_per_second, seconds, least):
    """Simulated time of a timing of which all runs may take so many seconds; `least` of it, however long that takes."""
    wanted = min(duration, max(STRETCH, 1e6 * SHORTEST / max(us_per_second, 1.0)))
    return max(least, min(wanted, 1e6 * seconds / TIMINGS / us_per_second))


def race(candidates, run, left, deadline_us=None, shorter=False):
    """Times the candidates that have no rows of a round yet; `run(candidate, round)` gives one, `left()` the seconds left. Returns whether there
    was time for all; slow and late ones have dropped out, with the reason. `shorter`: a candidate that is lost, as its pilot covered less of the
    motion, gets a shorter step."""
    number = 1
    while number <= ROUNDS + TIE_BREAKS:
        running = _running(candidates)
        if number > ROUNDS and (len(running) < 2 or decided(running)):
            break
        for one in (one for one in running if len(one.rows) < number):
            if left() <= 0 and any(other.rows for other in candidates):
                for other in _running(candidates):
                    other.reason = "" if other.rows else "no time was left to time it"
                return False
            row = run(one, number)
            for _ in range(LOST_AT_MOST if shorter else 0):
                if row["status"] in FINISHED or left() <= 0:
                    break
                one.step, one.rows = float(f"{one.step / math.sqrt(2):.3g}"), []
                row = run(one, number)
            if row["status"] in FINISHED:
                one.rows.append(row)
            else:  # a stretch may end lost where the whole run is not: another candidate, then
                one.reason = f"{row['status']} while it was timed: {row['reason']}"
        if drop_late(candidates, deadline_us, ROUNDS):
            number = 1  # for those that came back
        else:
            drop_slow(candidates, SLOWER[min(number, len(SLOWER)) - 1], number)
            number += 1
    return True


def _running(candidates):
    return [one for one in candidates if not one.out]


def drop_late(candidates, deadline_us, rounds=1):
    """Drops who is late by so many rounds, or by far after fewer. Returns whether that changes who may be the fastest: see `come_back`."""
    late = [one for one in _running(candidates) if one.rows and one.drop_late(one.p99_us(), deadline_us, times=1 if len(one.rows) >= rounds else 2)]
    return come_back(candidates, late) or bool(late)


def come_back(candidates, dropped):
    """If any were dropped, those that were slower than they come back, and if nobody is left, those that promised less. Returns whether any do."""
    slower = [one for one in candidates if one.slower]
    back = [one for one in slower if one.rows and dropped] or ([] if _running(candidates) else slower)
    for one in back:
        one.slower, one.reason = False, ""
    return bool(back)


def drop_slow(candidates, factor, number):
    best = min((one.us_per_second()[0] for one in _running(candidates)), default=math.inf)
    for one in _running(candidates):
        ratio = one.us_per_second()[0] / best
        if ratio > factor and not one.kept:
            one.reason, one.slower = f"{ratio:.2f} times slower after round {number}", True


def decided(running):
    """Whether the fastest one's slowest round is faster than every other's fastest one."""
    first, *others = sorted(running, key=lambda one: one.us_per_second()[0])
    return all(first.us_per_second()[2] < one.us_per_second()[1] for one in others)


def ranked(candidates, deadline_us=None):
    """Those that may be advised, fastest first; a 99th percentile beyond the deadline is a reason to drop."""
    while drop_late(candidates, deadline_us):
        pass
    return sorted((one for one in _running(candidates) if one.rows), key=lambda one: one.us_per_second()[0])
