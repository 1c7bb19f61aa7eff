# A scene of the map, the N-four-bar at a size with its own fill or an artificial one: who is fit to be timed there, and how it is timed (README.md).
import math
from collections import namedtuple
from dataclasses import dataclass, field

from analysis.core.timing import LEFT_OUT, differing
from analysis.map import timed
from study.core import contest
from study.core.cell import CONTROL, Cell, Contender, twin_of
from study.core.timing import measure

LEAST_SAMPLES, MOST_SAMPLES = 1, 40
BUSY = 1.5     # passes a step of a stretch, which crosses the singular position, over those of a pilot, about
TURN = 0.005   # s, the least that a sample takes
NATURAL = "natural"  # a scene with the mechanism's own fill
FAMILY = 5
SLOW = 4  # of those who take as long as they may, that a process of the gate has time for
RUNS = 3  # of a pilot; the fastest counts
WORK = 3200  # variables times steps of a pilot


class Scene(namedtuple("Scene", "variables fill")):
    """`fill`: share of the tangent's n^2 positions; None: the mechanism's own."""
    name = property(lambda self: f"four-bar:{self.variables // 2 - 1}" + ("" if self.fill is None else f",fill={self.fill:.2f}"))
    # About those of its stretch, which `mbs bench` chooses by the size.
    steps = property(lambda self: max(40, min(800, 800 * 400 // self.variables)))


@dataclass
class TimedScene:
    lab: object
    scene: Scene
    costs: dict  # {contender: µs a step of its pilot}
    fill: float  # percent, measured
    records: list = field(default_factory=list)

    def time(self, count):
        """Processes 1 … `count` of all."""
        while self.costs:
            # At natural fill the harness's own control, which does nothing, on the pair of most.
            pairs = [one.blas for one in self.costs if one.ranked and self.scene.fill is None]
            control = [Contender(CONTROL.name, CONTROL.variant, max(pairs, key=pairs.count))] if pairs else []
            self.records = self.processes([*self.costs, *control], count, "time")
            if not (wrong := differing(timed.timed_rows(self.records))):
                return
            for one in [one for one in self.costs if one.name in wrong]:
                del self.costs[one]
                self.lab.skip(Cell("bench", self.scene.name, (one,), role=f"time{LEFT_OUT}"), "disagrees", wrong[one.name])

    def again(self, count):
        """Processes 1 … `count` of those who lead, among the libraries or among all, and of the fastest of all."""
        rankings = self.rankings
        if names := timed.leaders(rankings.values()):
            names.add(rankings["all"].winner)
        chosen = [one for one in self.costs if one.name in names]
        if len(chosen) > 1 and count:
            fastest = {ranking.winner for ranking in rankings.values() if ranking}
            self.records += self.processes([*chosen, *(twin_of(one) for one in chosen if one.name in fastest)], count, "again")

    @property
    def rankings(self):
        scene = timed.Scene(timed.timed_rows(self.records))
        return {layer: scene.rank(names) for layer, names in timed.layers(self.lab.registry).items()}

    def processes(self, contenders, count, role):
        """Their records. The pilots decide how many samples fill a process, never what a sample is."""
        lab, limit = self.lab, self.lab.settings["limits"]["time"]
        sample = max(TURN * len(contenders), 1e-6 * BUSY * self.scene.steps * sum(self.costs.get(one, 0.0) for one in contenders))
        samples = min(max(round(lab.settings["process"] / sample), LEAST_SAMPLES), MOST_SAMPLES)
        return measure(lab, self.scene.name, contenders, processes=count, role=role, repetitions=samples,
                       seconds=limit, settings=("--patience", limit / 10))


class Pilot(namedtuple("Pilot", "record step_us fill", defaults=(math.nan,))):
    """`step_us`: infinite if it failed; the least that is proved if it ran out of time."""
    alive = property(lambda self: math.isfinite(self.step_us))


def fit(lab, scene, contenders):
    """({contender: µs a step of its pilot} of those to be timed, the scene's fill in %); each other one gets a record that says why not."""
    pilots = dict(zip(contenders, _pilots(lab, scene, contenders)))
    verdicts, rule, limit = {}, Rule(lab, scene, pilots), lab.settings["limits"]["check"]
    while todo := [one for one in rule.chosen(verdicts) if one not in verdicts]:
        [said] = contest.verdicts(lab, [contest.Asked(scene.name, todo)], each=limit / SLOW, seconds=limit)
        verdicts |= {one: found == "agrees" for one, (found, _) in said.items()}
    best = rule.best(verdicts)
    for one, pilot in pilots.items():
        if pilot.alive and one not in verdicts:
            late = "at least " if not pilot.record.done else ""
            lab.skip(Cell("bench", scene.name, (one,), role="excluded"), "excluded",
                     f"its pilot takes {late}{pilot.step_us / best:.3g} times as long as the fastest library's")
    fill = next((pilot.fill for pilot in pilots.values() if not math.isnan(pilot.fill)), math.nan)
    return {one: pilot.step_us for one, pilot in pilots.items() if verdicts.get(one)}, fill


def _pilots(lab, scene, contenders):
    steps = max(2, min(16, WORK // scene.variables))
    limit = lab.settings["limits"]["pilot"]
    cells = [Cell("bench", scene.name, (one,), ("--steps", steps, "--start", 0, f"--benchmark_repetitions={RUNS}",
                                                "--benchmark_min_time=0"), "pilot", seconds=limit) for one in contenders]
    for record in lab.run(cells):
        if rows := [row for row in record.output.get("rows", {}).values() if not row.get("error_occurred")]:
            yield Pilot(record, min(rows[0]["cpu_us"]) / steps, rows[0]["fill_percent"])
        else:  # a warm-up and RUNS stretches were not done within the limit
            yield Pilot(record, 1e6 * limit / (steps * (RUNS + 1)) if record.status == "timeout" else math.inf)


class Rule(namedtuple("Rule", "lab scene pilots")):
    def best(self, verdicts):
        """Least time of the ranked ones that are not rejected; of the libraries, unless there is nobody else."""
        alive = {one: pilot.step_us for one, pilot in self.pilots.items() if pilot.alive and one.ranked and verdicts.get(one, True)}
        return min([time for one, time in alive.items() if one.variant not in self.lab.registry.own] or alive.values(), default=math.inf)

    def chosen(self, verdicts):
        known, filled = self.lab.settings["slower"], self.scene.fill is not None
        [column] = [one for one in self.lab.settings["columns"] if one["variables"] == self.scene.variables]
        limit = (known["filled"] if filled else column.get("slower", known["natural"])) * self.best(verdicts)
        kept = {one for one, pilot in self.pilots.items() if pilot.alive and pilot.step_us <= limit}
        if filled:  # the two fastest of each family
            near = [one for one, pilot in self.pilots.items() if pilot.step_us <= FAMILY * limit and verdicts.get(one, True)]
            near.sort(key=lambda one: self.pilots[one].step_us)
            said = self.lab.registry.variants
            kept |= {one for key in ("dense", "unsymmetric") for value in (True, False)
                     for one in [one for one in near if said[one.variant].get(key, False) == value][:2]}
        return [one for one in self.pilots if one in kept]


def alternatives(lab, scene):
    """Contenders of the profile's other pairs at this size; what is missing gets a record that says why."""
    found = {Contender(f"{one.name}+{pair}", one.variant, pair): lab.registry.pairs.get(pair, "unknown pair")
             for entry in lab.settings["alternatives"] if scene.variables in entry["columns"] for one in lab.contenders
             if {one.variant, one.variant.split("/")[0]} & set(entry["implementations"]) for pair in entry["blas"] if pair != one.blas}
    for one, reason in found.items():
        if reason:
            lab.skip(Cell("bench", scene.name, (one,), role="unavailable"), "unavailable", reason)
    return [one for one, reason in found.items() if not reason]
