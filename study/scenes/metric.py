# The accuracy metric of the IFToMM library of computational benchmark problems; Richardson's extrapolation of runs with a step, half of
# it and a quarter of it.
#
# M. Gonzalez, D. Dopico, U. Lugris, J. Cuadrado: A benchmarking system for MBS simulation software, Multibody Syst. Dyn. 16 (2006) 179-190: the error
# of each component at each of the samples, divided by the larger of the reference and a threshold; the whole is their root mean square.
import numpy

SAMPLES = 400
THRESHOLD = 1e-3
CLASSES = (("high", 1e-3), ("low", 1e-1))


def errors(found, known):
    """(root mean square, maximum) over samples and components of {column: values} each."""
    relative = numpy.array([(found[column] - known[column]) / numpy.maximum(numpy.abs(known[column]), THRESHOLD) for column in known])
    return float(numpy.sqrt(numpy.mean(relative**2))), float(numpy.max(numpy.abs(relative)))


def precision(error):
    """The class of an error: "high", "low" or "none"; of NaN "none"."""
    return next((name for name, limit in CLASSES if error <= limit), "none")


def extrapolate(finer, finest):
    """The limit of two runs of second order of which the second has half the step of the first."""
    return finest + (finest - finer) / 3


def observed_order(coarse, finer, finest):
    """log2 of the ratio of successive differences; NaN where the differences vanish."""
    with numpy.errstate(divide="ignore", invalid="ignore"):
        return numpy.log2(numpy.abs((coarse - finer) / (finer - finest)))
