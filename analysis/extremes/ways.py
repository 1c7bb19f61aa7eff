# Ways out: how far each extends the region that is safe, and what its steps cost.
import shlex
from dataclasses import dataclass, field

import pandas

from analysis.core import timing
from analysis.core.errors import StudyError
from analysis.core.outcomes import FINISHED, GOOD, of_run
from analysis.core.statistics import median
from analysis.extremes import judge, scenes
from analysis.extremes.motions import Chain
from study.core.setting import Setting

PLAIN = "α auto"
STEP, DURATION = 1.25e-3, 2.5  # s; past two singular positions
STEPS = tuple(1e-4 * 2**power for power in range(8))
POINTS, INSTANTS = 6, 20       # that are kept of a motion
WAYS = {
    "α = 1e8": Setting("penalty", (("penalty", "1e8"),)),
    PLAIN: Setting(),
    "equations scaled": Setting("penalty", (("scale-equations", ""),)),
    "λ after Newton": Setting("penalty", (("multipliers", "converged"),)),
    "exact tangent": Setting("penalty", (("geometric-stiffness", ""),)),
    "saddle-point": Setting("saddle-point"),
    "saddle-point, exact tangent": Setting("saddle-point", (("geometric-stiffness", ""),)),
    "mixed precision": Setting("penalty", (("precision", "mixed"),))}
NOT_SERVED = ("unsupported", "refused")


@dataclass(frozen=True)
class Place:
    """A cell of the region."""
    axis: str
    value: float
    loops: int
    chain: Chain = field(compare=False)
    step: float = STEP

    @property
    def name(self):
        return f"ways-{self.axis}-{self.value:g}-{self.loops}".replace(" ", "-")

    @property
    def steps(self):
        return round(DURATION / self.step)

    @property
    def every(self):
        return max(1, self.steps // INSTANTS)


def places(sizes):
    """Cells of the region. Scenes are files: of `four-bar:N` the program knows the exact motion."""
    steps = [Place("step", step, loops, Chain(loops), step) for loops in sizes for step in STEPS]
    masses = [Place("mass ratio", ratio, 10, scenes.unlike_masses(10, ratio)) for ratio in (1.0, 1e3, 1e6, 1e9)]
    lengths = [Place("length ratio", ratio, 10, scenes.unlike_lengths(10, ratio)) for ratio in (1e1, 1e3, 1e6)]
    return [*steps, *masses, *lengths]


def build(records, settings, registry):
    """{"ways": outcomes over the region, "ways_cost": time of a step over that of the same variant by PLAIN}"""
    titles = {setting.file_name: title for title, setting in WAYS.items()}
    known = {place.name: place for place in places(settings["loops"]["ways"])}
    regions, times = [], []
    for record in records:
        role, scene = record.role.removeprefix("cost-").removeprefix("beside-"), judge.scene_of(record)
        if role not in titles or scene not in ("", *known) and record.role == role:
            raise StudyError(f"{record.name}: its cell is none of the ways out: the set is of another state of them")
        name = record.cell["contenders"][0]
        own = {"way": titles[role], "folder": name.split("/")[0], "implementation": name}
        order = list(WAYS).index(titles[role]), list(registry.variants).index(name)
        if record.role != role:
            times.append((order, own | {"beside": record.role.startswith("beside-")} | _time(record)))
        else:
            regions.append(((*order, list(known).index(scene) if scene else 0), own | _outcome(record, known.get(scene))))
    regions, times = (pandas.DataFrame([row for _, row in sorted(found, key=lambda one: one[0])]) for found in (regions, times))
    return {"ways": regions, "ways_cost": pandas.DataFrame(_costs(times) if len(times) else [])}


def _outcome(record, place):
    status, reason = of_run(record)
    if place is None:  # nobody of the folder serves it
        return {"status": status, "reason": reason, "record": record.name}
    error = judge.error_of(record, place.chain.solutions(record.series.get("t", [])), 1.0)
    silent = status in GOOD and not error <= judge.CLASS  # so is one without positions
    return {"axis": place.axis, "value": place.value, "loops": place.loops, "status": status, "reason": reason,
            "true_error": error, "safe": status in GOOD and error <= judge.CLASS, "silent": silent,
            "passes_per_step": record.output.get("passes_per_step"),
            "command": shlex.join(record.command) if silent else "", "record": record.name}


def _time(record):
    """What analysis/core/timing.py takes ratios of: a sample a process, the mean of each step's least time."""
    status, reason = of_run(record)
    done = status in FINISHED
    return {"loops": int(judge.scene_of(record).partition(":")[2]), "environment": "own",
            "process": record.cell["number"], "ended": status, "reason": reason, "record": record.name,
            "status": "ok" if done else status, "passes_per_step": record.output.get("passes_per_step"),
            "samples": (record.output["least_us"]["mean"],) if done else ()}


def _costs(times):
    for (way, name, loops), own in times[~times.beside].groupby(["way", "implementation", "loops"], sort=False):
        rows = times[(times.implementation == name) & (times.loops == loops)]
        found = timing.ratio(rows.assign(implementation=rows.way), way, PLAIN)
        lost = own[own.status != "ok"]
        first = (lost if len(lost) else own).iloc[0]
        yield {"way": way, "folder": first.folder, "implementation": name, "loops": loops,
               "processes": len(own) - len(lost), "ratio": found.value, "low": found.low, "high": found.high,
               "passes_per_step": median(own.passes_per_step), "status": first.ended, "reason": first.reason,
               "record": " ".join(own.record)}


def folders(ways):
    return list(dict.fromkeys(ways.folder))


def not_served(rows):
    """Why none of the rows of a way and folder was run; "" if one was."""
    if rows.empty:
        return "not asked"
    return rows.reason.iloc[0] if rows.status.isin(NOT_SERVED).all() else ""


def share(rows):
    """(cells that are safe, cells) of rows of one way and folder."""
    region = rows[(rows.axis != "") & (rows.status != "dropped")]
    return int(region.safe.sum()), len(region)


def factor(row):
    """A row of ways_cost.csv as text: "×1.52 (1.30–1.77)", or how it ended."""
    if row.ratio != row.ratio:
        return row.status
    return f"×{row.ratio:.2f}" + (f" ({row.low:.2f}–{row.high:.2f})" if row.low < row.high < float("inf") else "")
