# What a column of accuracy runs: motions of a subject (untimed), and points of these in timed processes.
from contextlib import suppress
from dataclasses import replace

from analysis.accuracy import points, subjects
from analysis.core.controls import CONTROL
from analysis.core.files import StudyError
from analysis.core.registry import ANCHOR
from study.core import timing
from study.core.cell import Cell
from study.core.setting import read_settings

VALUES = 5e4      # steps of a stretch times variables, at most
OPERATIONS = 2e8  # and times the square of a filled row: a dense step takes longer
LEAST = 10        # steps of a stretch
SAMPLES = {"look": 3, "time": 6, CONTROL: 6, "pair": 3}  # of a process and contender
LOOK = 4          # share of the stretch in a look
PATIENCE = (0.5, 20)  # s: whose first stretch takes longer is not looked at; the longer where nobody is left
CAREFUL = 3  # times the time of a run, and of starting it, is its limit: predictions may be wrong


class Runs:
    """A subject in a column, with the records so far."""

    def __init__(self, lab, kind, entry):
        self.lab, self.subject = lab, subjects.of(kind, entry, lab.settings)
        chosen = lab.settings["settings"]
        self.settings = {one.name: one for one in read_settings() if not chosen or one.name in chosen}
        unknown = set(chosen) - set(self.settings)
        if unknown or "default" not in self.settings:
            raise StudyError(f"accuracy: settings: unknown, or without default: {', '.join(sorted(unknown)) or chosen}")
        own = [one for one in lab.contenders if one.variant in lab.registry.own]
        self.layers = {name: group for name, group in (("libraries", [one for one in lab.contenders if one not in own]), ("own", own)) if group}
        self.names = {one.name: one for group in self.layers.values() for one in group}
        self.longest, self.records, self.known = lab.settings["longest"], {}, None  # records: by name
        self.chosen = {}  # {scene: {(setting, step): contenders that are timed}}

    def serving(self, name, contenders):
        return [one for one in contenders if self.lab.registry.serves(one.variant, *self.settings[name].needs)]

    def refer(self):
        """Makes the reference; what is extrapolated is simulated by one contender, the same in every study."""
        one = self.lab.contender(ANCHOR) or next(iter(self.lab.contenders), None)
        cells = [replace(self.run_cell(one, "default", self.subject.steps[-1] / divisor), role="reference", seconds=300)
                 for divisor in (1, 2, 4) if self.subject.entry and self.subject.entry.known == "extrapolated"]
        with suppress(StudyError):  # said in references.csv: no error is known, nobody is timed
            self.known = subjects.reference(self.subject, self.lab.run(cells))

    def simulate(self, jobs):
        """Runs of (contender, setting, step, scene, duration), on all cores, as long as the budget lasts."""
        self.records |= {one.name: one for one in self.lab.run([self.run_cell(*job) for job in jobs], drop=True)}

    def run_cell(self, one, name, step, scene=None, duration=None):
        words = (*self.settings[name].words(self.subject.base), *self.subject.words(step, duration))
        return Cell("simulate", scene or self.subject.scene, (one,), words, f"run/{self.settings[name].file_name}",
                    seconds=CAREFUL * (1 + self.longest), keep=() if self.subject.loops else ("outputs",), every=self.subject.every(step))

    def row(self, record):
        """What a run came to; its record is kept."""
        self.records[record.name] = record
        return points.runs([record], self.subject, self.known).to_dict("records")[0]

    def quick(self, scene, step, contenders, behind, dense=False):
        """Those that end a look at the default setting and are at most `behind` times slower than the fastest, in its order."""
        for patience in PATIENCE if contenders else ():
            self.time("look", scene, "default", step, contenders, dense=dense, more=("--patience", patience))
            rows = self.measured().loc[
                lambda rows: (rows.scene == scene) & (rows.role == "look") & (rows.setting == "default") & (rows.status == "ok")
                & rows.implementation.isin([one.name for one in contenders])].sort_values("step_us", kind="stable")
            if near := list(rows[rows.step_us <= behind * rows.step_us.min()].implementation.unique()):
                return [self.names[name] for name in near]
        return []

    def time(self, role, scene, name, step, contenders, processes=1, dense=False, more=()):
        """Timed processes in which the contenders of a point take turns; role: "look", which is short, "time", CONTROL or "pair"."""
        steps = self.stretch(scene, step, dense)
        steps = max(LEAST, steps // LOOK) if role == "look" else steps
        words = (*self.settings[name].words(self.subject.base), "--step", f"{step:g}", "--start", 0, "--steps", steps, *more)
        self.records |= {one.name: one for one in timing.measure(
            self.lab, scene, contenders, processes=processes, repetitions=SAMPLES[role], settings=words,
            role=f"{role}/{self.settings[name].file_name}", seconds=60)}

    def stretch(self, scene, step, dense=False):
        """Steps from the start that are timed: of the whole run, but no more than take a few hundredths of a second."""
        n = 2 * self.subject.loops + 2 if self.subject.loops else 100
        fill = 1.0 if dense else float(scene.partition("fill=")[2] or 0)
        most = min(VALUES / n, OPERATIONS / (n**3 * fill**2) if fill else VALUES)
        return int(max(LEAST, min(most, round(self.subject.duration / step))))

    def made(self):
        return points.runs(self.records.values(), self.subject, self.known)

    def measured(self):
        return points.timed(self.records.values())

    def points(self):
        return points.points(self.made(), self.measured())

    def duration(self, seconds):
        """The longest duration of a run of its own, or None; `seconds`: of computation for a simulated second. After one
        second the first singular position has been passed, before which all are accurate."""
        whole = self.subject.duration
        return next((one for one in (whole, min(1.0, whole)) if one * seconds <= self.longest), None)
