# The N-four-bar, a double pendulum and Andrews' mechanism in the engines and solvers that people use, beside ours: curves
# of error against time, then common rounds of what may be the fastest at some error.
import json
import math
import random
from collections import namedtuple
from dataclasses import replace
from pathlib import Path

from analysis.core.controls import CONTROL
from analysis.core.files import ROOT, StudyError, read_yaml
from analysis.engines.equal_error import candidates, least_error
from analysis.engines.runs import ENGINE, OURS, ROUND, row
from analysis.engines.subjects import ANDREWS, SOLVERS, subject_of
from analysis.engines.tables import frame
from study.core.cell import Cell
from study.core.curves import Curve, follow
from study.core.setting import read_settings

SETTINGS = {"subjects": [str], "engine_settings": int, "implementations": [str], "settings": [str], "time_limit": float, "rounds": int}
CURVES = 0.3, 0.6    # of a column's budget, by when their curves and ours end; the rest is for the rounds
SHORT = 0.02         # s of steps: a shorter run says more of the machine's interruptions than of itself
REPEATS = 5          # of such a run in one process, theirs as ours; the least time of each of its pieces counts
SEED = 20080101
PAPER = ("default", "paper")  # of ours: the paper's scheme, which is to be followed however far from others it is
PROGRAMS = "study/engines"                              # in a build
NATIVE_PROGRAM = "../build-engines/study/engines/engine_ode"  # as seen from the build; study/engines/native makes it
SET_UP = "study/setup --engines"
LIST = Path(__file__).with_name("settings.yaml")


class EngineSetting(namedtuple("EngineSetting", "engine over values options", defaults=((),))):
    """What is passed to an engine's program; `over`: "step" (s) or "accuracy", of which `values` make its curve, the coarsest first."""
    def words(self, value):
        return ("--setting", *(f"{key}={text}" for key, text in (*self.options, (self.over, f"{value:g}"))))


def read_list(path=LIST):
    """{engine: [EngineSetting]}"""
    listed = read_yaml(path, values={"step": [float], "accuracy": [float]}, engines={...: [{"over": str, "options?": dict}]})
    values, found = listed["values"], {}
    for over, several in values.items():
        if several != sorted(several, reverse=True):
            raise StudyError(f"{path}: values of {over}: the coarsest must be the first")
    for engine, entries in listed["engines"].items():
        if unknown := [entry for entry in entries if entry["over"] not in values]:
            raise StudyError(f"{path}: {engine}: {unknown[0]}: over must be one of {', '.join(values)}")
        found[engine] = [EngineSetting(engine, one["over"], tuple(values[one["over"]]), tuple(one.get("options", {}).items())) for one in entries]
        if len(set(found[engine])) < len(entries):
            raise StudyError(f"{path}: {engine}: settings must differ")
    return found


def columns(settings):
    shares = {name: 1.0 if subject_of(name).loops else 0.5 for name in settings["subjects"]}  # the others are small
    return {name: settings["seconds"] * share / sum(shares.values()) for name, share in shares.items()}


def run(lab, column):
    subject, missing = subject_of(column), unavailable()
    asked = [engine for engine in read_list() if subject.name != ANDREWS or engine in SOLVERS]
    for engine in [one for one in asked if missing[one]]:
        lab.skip(Cell("", program=f"{PROGRAMS}/engine_{engine}", role=ENGINE), "unavailable", missing[engine])
    if not (there := [engine for engine in asked if not missing[engine]]):
        return  # nothing to be beside
    bench = Bench(lab, subject)
    engines = bench.engines(there)
    bench.rounds(engines, bench.ours(least_error(engines)))


def unavailable():
    """{engine: why its program cannot be run, or ""}"""
    path = ROOT / "build" / PROGRAMS / "engines.json"
    found = json.loads(path.read_text()) if path.exists() else {}
    return {engine: found.get(engine, f"its program is not built: {SET_UP}") for engine in read_list()}


class Bench(namedtuple("Bench", "lab subject")):
    """Runs of one subject."""

    def engines(self, names):
        """Their curves, all settings at once; then, of ODE, the candidates in the build with our flags."""
        listed = read_list()
        curves = [Curve(engine, [(value, self.engine_cell(f"{PROGRAMS}/engine_{engine}", setting.words(value)))
                                 for value in setting.values], {"step": 2.0, "accuracy": 2.5}[setting.over])
                  for place in range(self.lab.settings["engine_settings"]) for engine in names
                  for setting in listed[engine][place:place + 1]]
        found = self._followed(curves, 0.0, CURVES[0])
        if "ode" not in names:
            return found
        if not (ROOT / "build" / NATIVE_PROGRAM).exists():
            self.lab.skip(Cell("", program=NATIVE_PROGRAM, role=ENGINE), "unavailable", "not built with our flags: study/engines/native")
            return found
        chosen, _ = candidates(found[found.name == "ode"], frame([]), ())
        cells = [replace(cell, program=NATIVE_PROGRAM) for cell in chosen.get("cell", ())]
        return frame([*found.to_dict("records"), *(row(record) | {"cell": cell} for cell, record in zip(cells, self.lab.run(cells)))])

    def engine_cell(self, program, settings):
        return Cell("", program=program, role=ENGINE, seconds=1.0 + 3 * self.lab.settings["time_limit"],
                    settings=(*self.subject.words, "--duration", f"{self.subject.duration:g}", *settings, "--json"))

    def ours(self, least):
        """Our curves, down to the `least` error that is asked for."""
        wanted = {one.name: one for one in read_settings() if one.name in self.lab.settings["settings"]}
        curves = [Curve(f"{variant} {name in PAPER}", [(step, self.our_cell(one, wanted[name], step)) for step in self.steps()],
                        2.0)
                  for name in self.lab.settings["settings"] for variant in self.lab.settings["implementations"]
                  for one in [self.lab.contender(variant)] if one and self.lab.registry.serves(variant, *wanted[name].needs)]
        return self._followed(curves, least, CURVES[1])

    def _followed(self, curves, least, share):
        """The rows of all curves."""
        follow(self.lab, curves, row, self.lab.settings["time_limit"], least, share)
        return frame([one for curve in curves for one in curve.rows])

    def steps(self):
        """A fixed ladder, each half of the one before."""
        longest, shortest = self.subject.steps
        return [float(f"{longest / 2**k:.6g}") for k in range(math.ceil(math.log2(longest / (0.99 * shortest))))]

    def our_cell(self, one, setting, step):
        judged = ("--judge-every", max(1, int(self.subject.judged / step + 1e-3))) if self.subject.loops else ()
        cell = Cell("simulate", self.subject.scene, (one,), (
            *setting.words(), "--step", f"{step:g}", "--duration", f"{self.subject.duration:g}", *judged), OURS,
            seconds=1.0 + 3 * self.lab.settings["time_limit"])
        return cell if judged else replace(cell, keep=("outputs",), every=max(1, round(self.subject.judged / step)))

    def rounds(self, engines, ours):
        """What may be the fastest at some error, theirs and ours in turn, in an order that is new in every round."""
        theirs, mine = candidates(engines, ours, self.lab.registry.own)
        often = [(one["cell"], ("--repeats", REPEATS) if one["time"] * self.subject.duration <= SHORT else ())
                 for one in [*theirs.to_dict("records"), *mine.to_dict("records")]]
        cells = [replace(cell, settings=(*cell.settings, *more), role=ROUND, timed=True, keep=(), every=0) for cell, more in often]
        cells += [replace(cell, role=CONTROL) for cell in (*cells[:1], *cells[len(theirs):][:1])]  # of each side one is there twice
        for number in range(1, self.lab.settings["rounds"] + 1):
            order = random.Random(f"{SEED}:{self.subject.name}:{number}").sample(cells, len(cells))
            self.lab.tell(f"round {number} of {self.lab.settings['rounds']}")
            self.lab.run([replace(cell, number=number) for cell in order], drop=True)
