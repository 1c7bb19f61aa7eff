# One function a statistic; timing.py has those of timed cells.
import numpy


def median(values):
    """Median of finite values; NaN if there is none or one is not finite."""
    values = numpy.asarray(values, dtype=float)
    if values.size == 0 or not numpy.isfinite(values).all():
        return numpy.nan
    return float(numpy.median(values))


def power_law_exponent(sizes, times):
    """Slope of log(time) over log(size) by least squares; NaN for fewer than three sizes."""
    if len(sizes) < 3:
        return numpy.nan
    return float(numpy.polyfit(numpy.log(sizes), numpy.log(times), 1)[0])


def phase_shares(rows, phases):
    """{phase: share} of one cell: medians over its profiled runs, scaled so that they add up to 1
    (a median, because a run that the system interrupts books the interruption on one phase)."""
    shares = {phase: median(rows[f"phase_{phase}"]) for phase in phases}
    total = sum(shares.values())
    return {phase: share / total for phase, share in shares.items()}
