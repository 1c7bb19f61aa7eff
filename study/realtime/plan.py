# Steps against the deadline that real time sets them, their own length: distributions of their times, what judging them costs,
# and the search for the largest N-four-bar that keeps it.
from collections import namedtuple
from functools import cache

from analysis.core.controls import CONTROL
from analysis.realtime.tables import judge, needs_null
from study.core.cell import Cell
from study.core.profile import by_share
from study.core.setting import Setting

SETTINGS = {"implementations": [str], "others": bool, "schemes": [str], "steps": [float], "loops": [int], "duration": float, "pilot": float,
            "most": int}
GRID = sorted({round(2 ** (power / 4)) for power in range(60)})  # the sizes of the search
JUMP = 8             # places on the grid, of the search's first steps: a factor of four
PATIENCE = 2.0       # times real time that a run may take, besides its set-up
SET_UP = 4.0         # s
JUDGED = ("harness/scenes/double_pendulum.json", "harness/scenes/four_bar_2.json", "harness/scenes/problems/spatial_slider_crank.json",
          "harness/scenes/problems/half_car.json", "four-bar:10", "scissors:5", "loop:12", "ladder:12", "harness/scenes/problems/a04_bricard.json",
          "vehicle:4", "four-bar:40", "scissors:20", "robot:10", "grid:5x5", "bodies:10")  # scenes, from small to large
JUDGED_STEP, JUDGED_STEPS, JUDGED_RUNS = 1e-3, 16000, 5
TWICE = ("harness/scenes/four_bar_2.json", "four-bar:10")  # of these: run once more, as a control
FASTEST = ("compiled_chains/sweeps", "compiled_ldl/fronts")  # what judging costs most beside
NULL = "../study/realtime/null_process"  # as seen from the build


class Case(namedtuple("Case", "contender scheme step")):
    def cell(self, role, loops, duration, number=0):
        return Cell("simulate", f"four-bar:{loops}", (self.contender,), (
            "--scheme", self.scheme, "--step", f"{self.step:g}", "--duration", f"{duration:g}",
            "--deadline-us", f"{1e6 * self.step:g}"), role, number, timed=True, seconds=PATIENCE * duration + SET_UP)


def cases(lab):
    """What is worth most comes first."""
    settings = lab.settings
    chosen = [one for one in map(lab.contender, settings["implementations"]) if one]
    chosen += [one for one in lab.contenders if settings["others"] and one not in chosen]
    return [Case(one, scheme, step) for scheme in settings["schemes"] for step in settings["steps"] for one in chosen
            if lab.registry.serves(one.variant, *Setting(scheme).needs)]


def distributions(lab):
    for step in lab.settings["steps"]:
        null(lab, step, lab.settings["duration"], "distributions")
    lab.run([case.cell("steps", loops, lab.settings["duration"]) for case in cases(lab) for loops in lab.settings["loops"]], drop=True)


def judging(lab):
    """The fastest that take part: beside their steps judging costs most."""
    fastest = [one for one in map(lab.contender, (*FASTEST, *lab.settings["implementations"])) if one][:len(FASTEST)]
    words = ("--step", f"{JUDGED_STEP:g}", "--duration", f"{JUDGED_STEPS * JUDGED_STEP:g}")
    runs = [("judging", scene, one) for scene in JUDGED for one in fastest] + [(CONTROL, scene, one) for scene in TWICE for one in fastest[:1]]
    lab.run([Cell("simulate", scene, (one,), words, role, number, timed=True, seconds=PATIENCE * JUDGED_STEPS * JUDGED_STEP + SET_UP)
             for number in range(1, JUDGED_RUNS + 1) for role, scene, one in runs], drop=True)


def null(lab, step, seconds, name):
    """The record of a null process; `name`: the record of the run that it comes after, or distributions."""
    return lab.one(Cell("", settings=("--deadline-us", f"{1e6 * step:g}", "--seconds", f"{seconds:.3g}", "--after", name),
                        role="null", program=NULL, timed=True, seconds=PATIENCE * seconds + SET_UP))


def largest(lab):
    grid = [loops for loops in GRID if loops <= lab.settings["most"]]
    for case in cases(lab):
        probe = Probe(lab, case, grid)
        found = search(probe, len(grid))
        if found is not None and found >= 0:
            probe.null(found)  # of the answer both numbers are shown


class Probe:
    """What the search asks of a place on the grid: "kept", "failed", "unsure" or, without budget, None."""

    def __init__(self, lab, case, grid):
        self.lab, self.case, self.grid, self.runs = lab, case, grid, {}

    def __call__(self, place):
        first = self._verdict(place, 1)
        if first is None or first.kept or first.hopeless:
            return first and ("kept" if first.kept else "failed")
        second = self._verdict(place, 2)
        return second and ("unsure" if second.kept else "failed")

    def null(self, place):
        """After the run of a place, for as long as its steps took."""
        run = self.runs[place]
        return null(self.lab, self.case.step, 1e-6 * run.output["step_us"]["mean"] * run.output["steps"], run.name)

    def _verdict(self, place, number):
        cell = self.case.cell("search", self.grid[place], self.lab.settings["pilot"], number)
        self.runs[place] = record = self.lab.run([cell], drop=True)[0]
        return None if record.status == "dropped" else judge(record, self.null(place) if needs_null(record) else None)


def search(probe, count):
    """The last place below `count` that `probe` says is "kept", -1 if none is, None where it gives up. Upwards in jumps, then by bisection. A place
    that is "unsure", since one of its two runs failed, may have been interrupted: the search goes on above it, but it is no answer."""
    low, high, ask = -1, count, cache(probe)
    while high - low > 1:
        at = (low + high) // 2 if high < count else min(low + JUMP, count - 1)
        answer = ask(at)
        if answer is None:
            return None
        low, high = (low, at) if answer == "failed" else (at, high)
    while low >= 0 and ask(low) != "kept":
        if ask(low) is None:
            return None
        low -= 1
    return low


columns, run = by_share({"distributions": (0.23, distributions), "judging": (0.17, judging), "largest": (0.60, largest)})
