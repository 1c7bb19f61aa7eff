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


def power_law_exponent(sizes, times):
    """Slope of log(time) over log(size) by least squares; NaN for fewer than three sizes."""
    if len(sizes) < 3:
        return numpy.nan
    return float(numpy.polyfit(numpy.log(sizes), numpy.log(times), 1)[0])


def power_law_interval(sizes, times):
    """(exponent, low, high): `power_law_exponent` with Student's interval of the slope, whose width also says how far the
    times are from a power law."""
    exponent = power_law_exponent(sizes, times)
    if numpy.isnan(exponent):
        return exponent, numpy.nan, numpy.nan
    from scipy.stats import linregress
    half = special.stdtrit(len(sizes) - 2, (1 + CONFIDENCE) / 2) * linregress(numpy.log(sizes), numpy.log(times)).stderr
    return exponent, exponent - half, exponent + half
