# One run against a deadline, and the search for the largest scene that keeps it.
import math
from dataclasses import dataclass

from study.pipeline import runs
from study.pipeline.contenders import Contender

REPEATS = 2          # of every motion: what the system interrupts in one run it hardly does in another
AGAIN = 4            # in the second probe of the sizes that decide: two late steps may be interruptions
ALLOWED = 1e-3       # share of steps that may miss the deadline, by the least times of the repeats
PILOT = 2000, 1.3    # steps and seconds of a run of the search, at least: past a singular position
SECONDS = 300        # limit of a run
LEAST, MOST = 1, 8000  # loops
FINE = 2 ** 0.25     # the search ends when two sizes are this close
LATE, END = "miss the deadline", "end of the search"


@dataclass(frozen=True)
class Case:
    contender: Contender
    scheme: str
    step: float  # s, the deadline too


def simulate(case, loops, layout, contexts, duration, repeats=REPEATS):
    """The record of one run, its steps held against the step's length."""
    path = (layout.results / "raw" / f"{case.contender.file_name}" /
            f"{case.scheme}-{case.step:g}-{loops}-{duration:g}{'-again' * (repeats == AGAIN)}.json")
    return runs.simulate(
        path, case.contender, f"four-bar:{loops}", step=case.step, duration=duration, every=0,
        context=contexts[case.contender.environment], seconds=SECONDS,
        more=["--scheme", case.scheme, "--deadline-us", f"{1e6 * case.step:g}",
              "--repeats", str(repeats)]), path


def in_real_time(record):
    """Whether the run was simulated properly and in real time; else why not."""
    status, reason = runs.status(record)
    if status not in runs.FINISHED:
        return False, f"{status}: {reason}"
    summary = record["summary"]
    share = summary["least_us"]["deadline_misses"] / summary["steps"]
    if share > ALLOWED:
        return False, f"{100 * share:.3g} % of the steps {LATE}"
    return True, ""


def largest(case, layout, contexts, tell):
    """The row of largest.csv. The two sizes that decide are probed again, with more repeats: from a larger one that
    was only interrupted the search goes on, and the answer is confirmed if it keeps the deadline then."""
    probed, late_once = {0: (True, "", {})}, set()  # {loops: fits, why not, figures}: the last probe counts

    def probe(loops, repeats):
        tell(f"largest so far {good}, trying {loops}{' again' * (repeats == AGAIN)}")
        duration = max(PILOT[0] * case.step, PILOT[1])
        record, path = simulate(case, loops, layout, contexts, duration, repeats)
        return *in_real_time(record), _figures(record, path, layout)
    while True:
        good = max(loops for loops, (fits, *_) in probed.items() if fits)
        bad = min((loops for loops, (fits, *_) in probed.items() if not fits), default=None)
        loops = _between(good, bad)
        if loops is not None:
            probed[loops] = probe(loops, REPEATS)
            late_once |= {loops} if probed[loops][1].endswith(LATE) else set()
        elif bad in late_once:
            probed[bad] = probe(bad, AGAIN)
            late_once.remove(bad)
        else:
            break
    again = probe(good, AGAIN) if good else probed[good]
    return {"implementation": case.contender.variant, "scheme": case.scheme, "step": case.step,
            "largest": good, "confirmed": again[0], "next": bad,
            "next_reason": END if bad is None else probed[bad][1]} | (again if again[0] else probed[good])[2]


def _between(good, bad):
    """The next size of the search: doubling, then bisection of the logarithm; None at its end."""
    if good == MOST or (bad is not None and bad <= max(good + 1, FINE * good)):
        return None
    if bad is None:
        return min(2 * good, MOST) or LEAST
    return max(good + 1, min(bad - 1, round(math.sqrt(max(good, 1) * bad))))


def step_row(case, loops, layout, contexts, duration):
    """The row of steps.csv."""
    record, path = simulate(case, loops, layout, contexts, duration)
    fits, reason = in_real_time(record)
    return {"implementation": case.contender.variant, "scheme": case.scheme, "step": case.step,
            "loops": loops, "in_real_time": fits, "reason": reason} | _figures(record, path, layout)


def _figures(record, path, layout):
    """Times of steps: the least over the repeats, and as `observed` in the first run."""
    summary = record.get("summary", {})
    least, observed = summary.get("least_us") or {}, summary.get("step_us", {})
    status, _ = runs.status(record)
    return {"status": status} | {f"{key}_us": least.get(key) for key in
                                 ("mean", "median", "p99", "p999", "max")} | {
        "deadline_misses": least.get("deadline_misses")} | {
        f"observed_{key}_us": observed.get(key) for key in ("mean", "median", "p99", "p999", "max")} | {
        "observed_misses": observed.get("deadline_misses")} | {
        key: summary.get(key) for key in ("judge_us", "steps", "deadline_us", "passes_per_step",
                                          "position_error_max")} | {
        "raw_file": layout.relative(path),
        "command": runs.typed(record)}
