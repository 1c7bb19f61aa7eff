# Sentences that say where the time of a step goes, from medians and profiles.
from analysis.core.statistics import phase_shares
from analysis.core.text import number
from analysis.map.compare import profiled, step_us
from analysis.map.tidy import PHASES


def phase_times(results, name, size):
    """{phase: µs a step}: shares of the profiled processes times the median of the timed ones; empty if one of them is
    missing."""
    rows, total = profiled(results, name, size), step_us(results, name, size)
    if not len(rows) or total != total:
        return {}
    return {phase: share * total for phase, share in phase_shares(rows, PHASES).items()}


def split(results, name, size):
    """"X takes 14.2 µs a step at n = 22, of which assembly 45 %, factorization 30 %, ..."."""
    times, total = phase_times(results, name, size), step_us(results, name, size)
    text = f"{name} takes {number(total)} µs a step at n = {size:g}"
    if not times:
        return f"{text} (not profiled at this size)."
    largest = sorted(times, key=times.get, reverse=True)[:3]
    return f"{text}, of which " + ", ".join(f"{phase} {100 * times[phase] / total:.0f} %" for phase in largest) + "."


def difference(results, slow, fast, size):
    """Which two phases make up most of the difference between two contenders."""
    slow_us, fast_us = (step_us(results, name, size) for name in (slow, fast))
    text = f"{slow} {number(slow_us)} µs a step at n = {size:g}, {fast} {number(fast_us)} µs"
    before, after = (phase_times(results, name, size) for name in (slow, fast))
    if not before or not after:
        return f"{text} (phases not profiled for both at this size)."
    apart = {phase: before[phase] - after[phase] for phase in PHASES}
    sign = 1 if slow_us >= fast_us else -1
    largest = sorted(PHASES, key=lambda phase: -sign * apart[phase])[:2]
    parts = " and ".join(f"{phase} ({number(before[phase])} against {number(after[phase])} µs)" for phase in largest)
    return f"{text}; most of the difference lies in {parts}."
