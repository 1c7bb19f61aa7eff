# Whether a run kept its deadline: every observed step did, but for as many as a null process after it lost.
from dataclasses import dataclass

from analysis.core.outcomes import FINISHED, of_run

HOPELESS = 0.01  # share of the steps beyond the null process's losses: no interruption explains as many


@dataclass(frozen=True)
class Verdict:
    kept: bool
    reason: str      # why not
    hopeless: bool   # another run of the same would not keep it either


def missed(record):
    """Steps that took longer than the deadline; None if there is no such count."""
    return (record.output.get("step_us") or {}).get("deadline_misses")


def observed(record):
    """Seconds that the steps of a run took together."""
    return 1e-6 * record.output["step_us"]["mean"] * record.output["steps"]


def lost(null):
    """Deadlines that a null process lost: 0 if there was none, or if it did not work."""
    return null.output["lost"] if null is not None and null.done else 0


def needs_null(record):
    """Whether a null process can matter: a run that is whole and missed nothing needs no excuse."""
    return of_run(record)[0] in FINISHED and missed(record) > 0


def judge(record, null):
    """The Verdict on a run. `null`: the record of the null process after it, or None."""
    status, reason = of_run(record)
    if status not in FINISHED:
        return Verdict(False, f"{status}: {reason}", True)
    beyond = missed(record) - lost(null)
    steps = record.output["steps"]
    if beyond <= 0:
        return Verdict(True, "", False)
    return Verdict(False, f"{missed(record)} of {steps} steps missed, {lost(null)} by the null process",
                   beyond > HOPELESS * steps)
