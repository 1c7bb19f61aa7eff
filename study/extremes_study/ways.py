# Ways out, compared: how far each extends the region that is safe, and what its steps cost.
from dataclasses import dataclass, field

import pandas

from study.extremes_study import scenes, scaling, tools
from study.extremes_study.cells import CLASS
from study.extremes_study.motions import Chain
from study.pipeline import runs
from study.pipeline.layout import write_json

# Of each folder the first variant that serves a way stands for it.
PREFERRED = {"eigen_dense": ("eigen_dense/llt",),
             "csc_klu": ("csc_klu/refactor", "csc_klu/guarded", "csc_klu/factor"),
             "eigen_superlu": ("eigen_superlu/simplicial_ldlt", "eigen_superlu/superlu")}
PLAIN = "α auto"
DURATION = 2.5           # s: past two singular positions
STEPS = tuple(1e-4 * 2**power for power in range(8))
LOOPS = (2, 10, 40)
COST_LOOPS, COST_STEP, ROUNDS = (10, 40), 1.25e-3, 3


@dataclass(frozen=True)
class Way:
    name: str
    options: tuple
    needed: tuple = ()      # settings that an implementation must serve


WAYS = (
    Way("α = 1e8", ("--penalty", "1e8")),
    Way(PLAIN, ()),
    Way("equations scaled", ("--scale-equations",)),
    Way("λ after Newton", ("--multipliers", "converged"), ("multipliers",)),
    Way("exact tangent", ("--geometric-stiffness",), ("geometric-stiffness",)),
    Way("saddle-point", ("--scheme", "saddle-point"), ("saddle-point",)),
    Way("saddle-point, exact tangent", ("--scheme", "saddle-point", "--geometric-stiffness"),
        ("saddle-point", "geometric-stiffness")),
    Way("mixed precision", ("--precision", "mixed"), ("mixed",)))


@dataclass(frozen=True)
class Place:
    """A cell of the region."""
    axis: str
    value: float
    loops: int
    chain: Chain = field(compare=False)
    step: float = COST_STEP

    @property
    def name(self):
        return f"{self.axis}-{self.value:g}-{self.loops}".replace(" ", "-")

    @property
    def built_in(self):
        return self.axis == "step"


def places():
    steps = [Place("step", step, loops, Chain(loops), step) for loops in LOOPS for step in STEPS]
    masses = [Place("mass ratio", ratio, 10, scenes.unlike_masses(10, ratio))
              for ratio in (1.0, 1e3, 1e6, 1e9)]
    lengths = [Place("length ratio", ratio, 10, scenes.unlike_lengths(10, ratio))
               for ratio in (1e1, 1e3, 1e6)]
    return [*steps, *masses, *lengths]


def run(study):
    """{"ways": outcomes over the region, "ways_cost": a row a timed run, "scaling": ...}"""
    for place in places():
        path = study.layout.results / "scenes" / f"ways-{place.name}.json"
        if not place.built_in and not path.exists():
            write_json(path, place.chain.document())
    served, rows = {}, []
    for way in WAYS:
        for folder, names in PREFERRED.items():
            if any(one.variant in names for one in study.contenders):
                one = stands_for(study, way, names)
                served[way, folder] = one
                if one is None:
                    rows.append({"way": way.name, "implementation": folder, "status": "unsupported",
                                 "reason": f"no variant serves {', '.join(way.needed)}"})
    jobs = [(way, one, place) for (way, _), one in served.items() if one for place in places()]
    records = tools.side_by_side(study, lambda job: f"ways {job[0].name}", lambda job: _record(study, *job),
                                 jobs)
    rows += [_row(study, *job, record) for job, record in zip(jobs, records)]
    names = [way.name for way in WAYS]
    rows.sort(key=lambda row: names.index(row["way"]))
    return {"ways": pandas.DataFrame(rows), "ways_cost": pandas.DataFrame(_costs(study, served)),
            "scaling": pandas.DataFrame(scaling.rows())}


def stands_for(study, way, names):
    by_name = {one.variant: one for one in study.contenders}
    return next((by_name[name] for name in names if name in by_name
                 and study.serves(by_name[name], *way.needed)), None)


def _path(study, way, one, rest):
    return (study.layout.results / "raw" / "ways" / f"{WAYS.index(way)}"
            / f"{one.file_name}-{rest}.json")


def _record(study, way, one, place):
    scene = (f"four-bar:{place.loops}" if place.built_in
             else tools.path_of_scene(study, f"ways-{place.name}", None))
    steps = round(DURATION / place.step)
    return runs.simulate(
        _path(study, way, one, place.name), one, scene, step=place.step, duration=steps * place.step,
        every=max(1, steps // 40), context=study.context(one), seconds=study.seconds,
        more=way.options, columns=list(place.chain.solutions([0.0])[0]))


def _row(study, way, one, place, record):
    status, reason = runs.status(record)
    error = tools.error_of(record, place.chain.solutions(record.get("outputs", {}).get("t", [])), 1.0)
    return {"way": way.name, "implementation": one.variant, "axis": place.axis, "value": place.value,
            "loops": place.loops, "status": status, "reason": reason, "true_error": error,
            "safe": status in runs.GOOD and error <= CLASS, "silent": tools.is_silent(record, error, CLASS),
            "passes_per_step": record.get("summary", {}).get("passes_per_step"),
            "raw_file": study.layout.relative(_path(study, way, one, place.name)),
            "command": runs.typed(record)}


def _costs(study, served):
    """Rounds of all ways in turn, one run at a time; `step_us` is the mean of a run, as passes differ by step."""
    rows = []
    jobs = [(number, loops, way, one) for number in range(1, ROUNDS + 1) for loops in COST_LOOPS
            for (way, _), one in served.items() if one]
    for done, (number, loops, way, one) in enumerate(jobs, start=1):
        path = _path(study, way, one, f"cost-{loops}-round{number}")
        record = runs.simulate(path, one, f"four-bar:{loops}", step=COST_STEP, duration=DURATION, every=0,
                               context=study.context(one), seconds=study.seconds, more=way.options)
        status, reason = runs.status(record)
        summary = record.get("summary", {})
        rows.append({"way": way.name, "implementation": one.variant, "folder": one.variant.split("/")[0],
                     "loops": loops, "round": number, "status": status, "reason": reason,
                     "step_us": summary.get("step_us", {}).get("mean"),
                     "passes_per_step": summary.get("passes_per_step"),
                     "raw_file": study.layout.relative(path), "command": runs.typed(record)})
        study.tell(f"ways times: run {done} of {len(jobs)}", done / len(jobs))
    return rows
