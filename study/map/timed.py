# A scene of the map, the N-four-bar at a size with its own fill or an artificial one, and how it is timed: a few processes of all,
# without those whose stretch takes another number of passes, and then more of those who lead.
from dataclasses import dataclass, field

from analysis.core.timing import LEFT_OUT, differing
from analysis.map import timed
from analysis.map.timed import layers, leaders, timed_rows
from study.core.cell import CONTROL, Cell, Contender, twin_of
from study.core.timing import measure

LEAST_SAMPLES, MOST_SAMPLES = 1, 40
BUSY = 1.5     # passes a step of a stretch, which crosses the singular position, over those of a pilot, about
TURN = 0.005   # s, the least that a sample takes
NATURAL = "natural"  # a scene with the mechanism's own fill


@dataclass(frozen=True)
class Scene:
    variables: int
    fill: float | None  # share of the tangent's n^2 positions; None: the mechanism's own

    @property
    def name(self):
        return f"four-bar:{self.variables // 2 - 1}" + ("" if self.fill is None else f",fill={self.fill:.2f}")

    @property
    def steps(self):
        """About those of its stretch, which `mbs bench` chooses by the size."""
        return max(40, min(800, 800 * 400 // self.variables))


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
            self.records = self.processes([*self.costs, *self._control()], count, "time")
            wrong = differing(timed_rows(self.records))
            if not wrong:
                return
            for one in [one for one in self.costs if one.name in wrong]:
                del self.costs[one]
                self.lab.skip(Cell("bench", self.scene.name, (one,), role=f"time{LEFT_OUT}"), "disagrees", wrong[one.name])

    def again(self, count):
        """Processes 1 … `count` of those who lead, among the libraries or among all, and of the fastest of all."""
        rankings = self.rankings
        names = leaders(rankings.values())
        if names:
            names.add(rankings["all"].winner)
        chosen = [one for one in self.costs if one.name in names]
        if len(chosen) > 1 and count:
            fastest = {ranking.winner for ranking in rankings.values() if ranking}
            twins = [twin_of(one) for one in chosen if one.name in fastest]
            self.records += self.processes([*chosen, *twins], count, "again")

    @property
    def rankings(self):
        """{layer: Ranking or None}"""
        scene = timed.Scene(timed_rows(self.records))
        return {layer: scene.rank(names) for layer, names in layers(self.lab.registry).items()}

    def _control(self):
        """The harness's own, which does nothing: at natural fill, on the pair of most."""
        if self.scene.fill is not None:
            return []
        pairs = [one.blas for one in self.costs if one.ranked]
        return [Contender(CONTROL.name, CONTROL.variant, max(pairs, key=pairs.count))] if pairs else []

    def processes(self, contenders, count, role):
        """Their records. The pilots decide how many samples fill a process, never what a sample is."""
        lab, limit = self.lab, self.lab.settings["limits"]["time"]
        sample = max(TURN * len(contenders),
                     1e-6 * BUSY * self.scene.steps * sum(self.costs.get(one, 0.0) for one in contenders))
        samples = min(max(round(lab.settings["process"] / sample), LEAST_SAMPLES), MOST_SAMPLES)
        return measure(lab, self.scene.name, contenders, processes=count, role=role, repetitions=samples,
                       seconds=limit, settings=("--patience", limit / 10))
