# What is simulated, and what its motion is compared with: the N-four-bar and the standard problems.
#
# Every reference has an error of its own; no error of a run is shown below it.
#   four-bar, closed forms  rounding: by how much the solution moves with an ulp of its argument
#   integrated              by how much a hundred times the tolerance of the integration changes it
#   extrapolated            by how much Richardson's value changes with one step less
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

import numpy

from study.pipeline import runs
from study.pipeline.errors import StudyError
from study.scenes import mechanics, metric
from study.scenes.extrapolate import extrapolate
from study.scenes.references import CLOSED, EXTRAPOLATED, KNOWN, four_bar, kind

# s, from where nobody keeps 1e-1 m
STEPS = tuple(8e-2 / 2**halvings for halvings in range(12))
AROUND = (4, 2, 1, 0.5, 0.25)  # a scene's own first step times these
JUDGED_S = 1e-2  # the error of a four-bar is evaluated once in as much; at every step that is longer than half of it
ULP = 2.0**-52
REFERENCE_SECONDS = 300
COLUMNS = ("subject", "title", "scene", "reference", "own_error", "unit", "own_error_from", "duration")


@dataclass(frozen=True)
class Subject:
    name: str
    title: str
    scene: str
    duration: float
    steps: tuple                # s, the largest first
    unit: str                   # of its errors
    reference: str              # in words, where it comes from
    own_error: float            # of the reference
    own_error_from: str
    loops: int | None = None    # of an N-four-bar
    base: tuple = ()            # options that the problem itself needs
    known: dict = field(default=None, hash=False, compare=False)  # {column: values} over its samples

    @property
    def file_name(self):
        return self.name.replace(" ", "-").replace(":", "-").lower()

    def every(self, step):
        """Samples of a problem's outputs: at those of the metric, or fewer that a large step meets."""
        return 0 if self.loops else _samples(self.duration, step)[0]

    def judging(self, step):
        """A four-bar is judged as often in a run at all steps below 5 ms."""
        return ["--judge-every", max(1, int(JUDGED_S / step + 1e-3))] if self.loops else []

    def error(self, record):
        """The largest position error (m), or the problem's metric (root mean square, relative)."""
        if self.loops:
            return record["summary"]["position_error_max"]
        outputs = record["outputs"]
        at = numpy.rint(numpy.array(outputs["t"]) / (self.duration / metric.SAMPLES)).astype(int)
        return metric.errors({column: numpy.array(outputs[column]) for column in self.known},
                             {column: values[at] for column, values in self.known.items()})[0]


def chain(loops, duration, fill=None):
    """The N-four-bar, judged against the exact motion."""
    times = numpy.linspace(0, duration, 401)
    moved = _largest(four_bar(times * (1 + ULP), loops), four_bar(times, loops), ("B0.x", "B0.y"))
    name = f"four-bar:{loops}" + (f",fill={fill:g}" if fill else "")
    return Subject(name, f"N = {loops}", name, duration, STEPS, "m", "closed form",
                   moved + ULP * (loops + 1), "rounding", loops)


def problem(entry, bench, default, reference_by):
    """A standard problem; an extrapolated reference is simulated by the contender `reference_by`."""
    times = numpy.linspace(0, entry.duration, metric.SAMPLES + 1)
    base = tuple((name.lstrip("-"), value) for name, value in zip(*[iter(entry.settings)] * 2))
    if entry.known == EXTRAPOLATED:
        known, own = _extrapolated(entry, bench, default, base, reference_by)
        origin = "the last two extrapolations"
    elif entry.known in CLOSED:
        known = CLOSED[entry.known](times)
        own, origin = metric.errors(CLOSED[entry.known](times * (1 + ULP)), known)[0], "rounding"
    else:
        known = KNOWN[entry.known](times)
        with mechanics.tolerance(100 * mechanics.TOLERANCE):
            own = metric.errors(KNOWN[entry.known](times), known)[0]
        origin = "a hundred times the tolerance"
    known = {column: values for column, values in known.items()
             if column.split(".")[0] in entry.judged}
    reference = (f"extrapolated runs of {reference_by.variant} (self-convergence)"
                 if entry.known == EXTRAPOLATED else kind(entry.known))
    return Subject(entry.name, entry.title, entry.scene, entry.duration,
                   tuple(entry.steps[0] * factor for factor in AROUND
                         if _samples(entry.duration, entry.steps[0] * factor)),
                   "relative", reference, own, origin, base=base, known=known)


def _extrapolated(entry, bench, default, base, contender):
    """({column: values}, own error) from runs with the finest step of AROUND, half and a quarter."""
    subject = Subject(entry.name, entry.title, entry.scene, entry.duration, (), "", "", 0, "", base=base)
    found = []
    for divisor in (1, 2, 4):
        step = entry.steps[0] * AROUND[-1] / divisor
        record = bench.run("reference", subject, contender, default, step, seconds=REFERENCE_SECONDS)
        if runs.status(record)[0] not in runs.FINISHED:
            raise StudyError(f"{entry.name}: no reference: {' '.join(runs.status(record))} "
                             f"({record['raw_file']})")
        found.append({column: numpy.array(values) for column, values in record["outputs"].items()
                      if column.split(".")[0] in entry.judged})
    coarse, known = ({column: extrapolate(first[column], second[column]) for column in first}
                     for first, second in zip(found, found[1:]))
    return known, metric.errors(coarse, known)[0]


def _samples(duration, step):
    """(steps from sample to sample, intervals of the metric between) or () if the step meets none."""
    ratio = Fraction(duration / metric.SAMPLES / step).limit_denominator(8)
    if abs(float(ratio) * step * metric.SAMPLES / duration - 1) > 1e-9:
        return ()
    return ratio.numerator, ratio.denominator


def _largest(found, known, columns):
    return max(float(numpy.max(numpy.abs(found[column] - known[column]))) for column in columns)


def rows(subjects):
    """The rows of references.csv."""
    return [{"subject": one.name, "title": one.title, "scene": Path(one.scene).name,
             "reference": one.reference, "own_error": one.own_error, "unit": one.unit,
             "own_error_from": one.own_error_from, "duration": one.duration} for one in subjects]
