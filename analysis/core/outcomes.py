# How runs end, and which of that counts as what; harness/src/run/README.md says what each means.
GOOD = ("ok", "plausible")       # nothing is known to be wrong
FINISHED = (*GOOD, "degraded")   # has all of its motion
WHOLE = (*FINISHED, "not-converged")  # got to the end


def of_run(record):
    """(status, reason) of a record of `mbs simulate`: the outcome, or why there is none."""
    if not record.done:
        return record.status, record.reason
    return record.output["status"], record.output["status_reason"]
