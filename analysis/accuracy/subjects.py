# What the columns of accuracy simulate, and what its motion is compared with: the N-four-bar and the standard problems of study/scenes.
#
# Every reference has an error of its own; no error of a run is shown below it.
#   four-bar, closed forms  rounding: by how much the solution moves with an ulp of its argument
#   integrated              by how much a hundred times the tolerance of the integration changes it
#   extrapolated            by how much Richardson's value changes with one step less
from collections import namedtuple

import numpy

from analysis.core.files import StudyError
from analysis.core.outcomes import FINISHED, of_run
from study.scenes import metric
from study.scenes.mechanics import TOLERANCE
from study.scenes.problems import read_list
from study.scenes.references import CLOSED, EXTRAPOLATED, four_bar, kind, solution

STEPS = tuple(4e-2 / 2**halvings for halvings in range(11))  # s, from where hardly anybody keeps 1e-1 m
AROUND = (20, 10, 4, 2, 1, 0.5, 0.25)  # a problem's own first step times these
JUDGED_S = 1e-2  # the error of a four-bar is evaluated once in as much; at every step that is longer than half of it
SAMPLES = metric.SAMPLES // 8  # of a problem's motion: so that records stay small
ULP = 2.0**-52
# Of the columns as a profile lists them: sizes of the N-four-bar, standard problems, sizes for pairs of settings.
KEYS = {"loops": {"seconds", "fills"}, "problem": {"seconds"}, "pairs": {"seconds"}}  # beside the kind itself
PREFIX = {"loops": "four-bar-", "problem": "", "pairs": "pairs-"}


def columns(settings):
    """{column: (kind, entry)}; kind: one of KEYS."""
    found = {}
    for entry in settings["columns"]:
        kind = next((kind for kind, keys in KEYS.items() if isinstance(entry, dict) and set(entry) == {kind} | keys), None)
        if kind is None:
            raise StudyError(f"accuracy: columns: {entry} needs seconds and one of loops (with fills), problem, pairs")
        found[PREFIX[kind] + str(entry[kind]).replace(" ", "-")] = kind, entry
    return found


class Subject(namedtuple("Subject", "name title scene duration steps loops entry", defaults=(None, None))):
    """steps: s, the largest first; loops: of a four-bar; entry: the study.scenes.problems.Problem of another."""
    unit = property(lambda self: "m" if self.loops else "relative")
    base = property(lambda self: self.entry.options if self.entry else ())  # that the problem itself needs

    def every(self, step):
        """Steps from sample to sample; 0 of a four-bar, whose error the program tells."""
        return 0 if self.loops else round(self.duration / SAMPLES / step)

    def words(self, step, duration=None):
        """What a run of a step and duration is asked for, besides its setting. A four-bar is judged as often in a run at all steps below 5 ms."""
        judged = ("--judge-every", f"{max(1, int(JUDGED_S / step + 1e-3))}") if self.loops else ()
        return ("--step", f"{step:g}", "--duration", f"{duration or self.duration:g}", *judged)


def chain(loops, duration, fill=None):
    """The N-four-bar, judged against the exact motion."""
    name = f"four-bar:{loops}" + (f",fill={fill:g}" if fill else "")
    return Subject(name, f"N-four-bar, N = {loops}", name, duration, STEPS, loops)


def problem(name):
    entry = next((one for one in read_list()[1] if one.name == name and not one.scene.startswith("four-bar:")), None)
    if entry is None:
        raise StudyError(f"accuracy: columns: '{name}' is no standard problem of its own scene (study/scenes/problems.yaml)")
    return Subject(name, entry.title, entry.scene, entry.duration, tuple(entry.steps[0] * factor for factor in AROUND), entry=entry)


def of(kind, entry, settings):
    """The Subject of a column."""
    return problem(entry["problem"]) if kind == "problem" else chain(entry[kind], settings["duration"])


# kind: in words, where it comes from; origin: of its own error; known: {column: values} at the samples of a problem.
Reference = namedtuple("Reference", "kind own_error origin known", defaults=(None,))


def reference(subject, runs=()):
    """The Reference of a subject; StudyError if there is none. `runs`: records with the subject's finest step, half and
    a quarter of it, for what is extrapolated."""
    if subject.loops:
        times = numpy.linspace(0, subject.duration, 401)
        first, second = (four_bar(at, subject.loops) for at in (times * (1 + ULP), times))
        moved = max(float(abs(first[name] - second[name]).max()) for name in ("B0.x", "B0.y"))
        return Reference("closed form", moved + ULP * (subject.loops + 1), "rounding")
    times = numpy.linspace(0, subject.duration, SAMPLES + 1)
    name = subject.entry.known
    if name == EXTRAPOLATED:
        lost = next((of_run(one) for one in runs if of_run(one)[0] not in FINISHED), None)
        if lost or len(runs) < 3:
            raise StudyError(": ".join(lost) if lost else "its runs were not made")
        less, known = ({column: metric.extrapolate(*(numpy.array(one.series[column]) for one in both)) for column in both[0].series if column != "t"}
                       for both in zip(runs, runs[1:]))
        word, origin = f"extrapolated runs of {runs[0].cell['contenders'][0]} (self-convergence)", "one step less"
    else:
        known, word = solution(name, tuple(times)), kind(name)
        if name in CLOSED:
            less, origin = CLOSED[name](times * (1 + ULP)), "rounding"
        else:
            less, origin = solution(name, tuple(times), tolerance=100 * TOLERANCE), "a hundred times the tolerance"
    known, less = ({column: one[column] for column in subject.entry.columns(one)} for one in (known, less))
    return Reference(word, metric.errors(less, known)[0], origin, known)


def error(subject, known, record):
    """The largest position error (m), or the problem's metric (root mean square, relative), of a finished run."""
    if subject.loops:
        return record.output["position_error_max"]
    at = numpy.rint(numpy.array(record.series["t"]) / (subject.duration / SAMPLES)).astype(int)
    return metric.errors({column: numpy.array(record.series[column]) for column in known.known},
                         {column: values[at] for column, values in known.known.items()})[0]
