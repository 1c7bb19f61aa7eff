# One function a statistic; timing.py has those of timed cells.
import numpy
from scipy import special

from analysis.core.timing import CONFIDENCE


def median(values):
    """Median of finite values; NaN if there is none or one is not finite."""
    values = numpy.asarray(values, dtype=float)
    if values.size == 0 or not numpy.isfinite(values).all():
        return numpy.nan
    return float(numpy.median(values))


def power_law(sizes, times):
    """(exponent, low, high): slope of log(time) over log(size) by least squares, with Student's interval, whose width also says how far
    the times are from a power law; NaN for fewer than three sizes."""
    if len(sizes) < 3:
        return (numpy.nan,) * 3
    from scipy.stats import linregress
    exponent = float(numpy.polyfit(numpy.log(sizes), numpy.log(times), 1)[0])
    half = special.stdtrit(len(sizes) - 2, (1 + CONFIDENCE) / 2) * linregress(numpy.log(sizes), numpy.log(times)).stderr
    return exponent, exponent - half, exponent + half
