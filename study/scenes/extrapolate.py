# Richardson's extrapolation of runs with a step, half of it and a quarter of it.
import numpy


def extrapolate(finer, finest):
    """The limit of two runs of second order of which the second has half the step of the first."""
    return finest + (finest - finer) / 3


def observed_order(coarse, finer, finest):
    """log2 of the ratio of successive differences; NaN where the differences vanish."""
    with numpy.errstate(divide="ignore", invalid="ignore"):
        return numpy.log2(numpy.abs((coarse - finer) / (finer - finest)))
