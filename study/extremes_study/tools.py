# What all parts share: who takes part, the long-double reference, how a run becomes a row.
from dataclasses import dataclass
from multiprocessing.pool import ThreadPool
from pathlib import Path

import numpy

from study.pipeline import runs
from study.pipeline.errors import StudyError
from study.pipeline.layout import Layout, ROOT, program as mbs

AT_ONCE = 2
WHOLE = (*runs.FINISHED, "not-converged")  # these get to the end
FORMS = ("penalty", "saddle-point")
CONTROLS = "harness/tests/controls/mbs_controls"
STALE_PIVOTS = "implementations/csc_klu/csc_klu_stale_pivots"


@dataclass(frozen=True)
class Study:
    layout: Layout
    contenders: list      # who takes part, in the registry's order
    settings: dict        # {name: what `mbs list --json` says of it}
    contexts: dict
    seconds: float        # time limit of a run
    tell: object

    def serves(self, contender, *needed):
        return set(needed) <= {"penalty", *self.settings[contender.variant].get("settings", [])}

    def context(self, contender):
        return self.contexts.get(contender.environment) or next(iter(self.contexts.values()))


class Reference:
    """The long-double reference as a contender: it is among the harness's controls, not in `mbs`."""
    variant, file_name, environment = "control/reference", "control.reference", "own|system"

    @staticmethod
    def call(command, *arguments):
        return [built(CONTROLS), command, *arguments]


def built(program):
    """Another program of the build that `mbs` is of."""
    path = Path(mbs()).parent / program
    if not (ROOT / path).exists():
        raise StudyError(f"{path} is missing: build it with study/setup")
    return str(path)


def side_by_side(study, what, function, items):
    """[function(item)], two at once: for what is not timed; `what(item)` is told. Interrupted, it drops what has
    not begun."""
    done = []
    with ThreadPool(AT_ONCE) as pool:
        for item, result in zip(items, pool.imap(function, items)):
            done.append(result)
            study.tell(f"{what(item)}: run {len(done)} of {len(items)}", len(done) / len(items))
    return done


def path_of_scene(study, name, document):
    """Where the scene is, relative to ROOT if it can be, so that its command runs from there."""
    path = study.layout.results / "scenes" / f"{name}.json"
    return str(path.relative_to(ROOT)) if path.is_relative_to(ROOT) else str(path)


def error_of(record, solutions, length):
    """Largest distance of a point from where it should be at any time of a run's outputs, in lengths; where several
    motions are possible, from the nearest of them. NaN where it has not all of its motion, or nothing is known."""
    outputs = record.get("outputs", {})
    if runs.status(record)[0] not in WHOLE or not solutions or not outputs.get("t"):
        return float("nan")
    return min(distances(outputs, solution, length).max() for solution in solutions)


def is_silent(record, error, allowed):
    """Whether a run is reported ok or plausible though its error is beyond what that allows; one without
    positions is."""
    return runs.status(record)[0] in runs.GOOD and not error <= allowed


def distances(outputs, solution, length):
    """At each time of `outputs`, the largest distance of a point from `solution`, in lengths."""
    points = sorted({column.rpartition(".")[0] for column in solution})
    found = [numpy.hypot(*((numpy.asarray(outputs[f"{point}.{axis}"]) - solution[f"{point}.{axis}"]) / length
                           for axis in "xy")) for point in points]
    return numpy.max(found, axis=0)
