# Results of a map with made-up times for tests: give every contender its times a process, get `Results`.
from types import SimpleNamespace

import pandas

from analysis.core import schema
from analysis.core.registry import Registry
from analysis.core.timing import PHASES
from analysis.map.results import Results

OWN_FILL = 5.0  # percent


def scene(variables, fill=None):
    return f"four-bar:{variables // 2 - 1}" + (f",fill={fill:.2f}" if fill else "")


def cell(name, variables, *times, fill=None, **more):
    """Rows of one timed contender, one process a time; `times`: µs a step, or tuples of samples."""
    blas = name.partition("+")[2] or "openblas"
    rows = []
    for number, time in enumerate(times, start=1):
        samples = time if isinstance(time, tuple) else (time,)
        middle = float(pandas.Series(samples).median())
        rows.append({"kind": "timing", "scene": scene(variables, fill), "variables": variables, "fill_asked": fill,
                     "fill_percent": 100 * fill if fill else OWN_FILL, "implementation": name,
                     "blas": blas, "environment": "own|openblas", "status": "ok", "reason": "", "process": number, "steps": 100,
                     "samples": len(samples), "step_us": middle, "low_us": min(samples), "high_us": max(samples),
                     "samples_us": " ".join(map(str, samples)), "passes": 220, "setup_us": 5.0, "record": f"r/{name}/{number}"}
                    | more)
    return rows


def failed(name, variables, status, reason="because", fill=None, pilot=None, **more):
    """The row of a contender that was not timed."""
    return cell(name, variables, float("nan"), fill=fill, status=status, reason=reason, process=None, samples_us="",
                pilot_us=pilot, **more)


def operation(name, variables, what, *times):
    return [row | {"kind": "operations", "operation": what, "operation_us": row["step_us"]}
            for row in cell(name, variables, *times)]


def phases(name, variables, *shares):
    """Rows of profiled processes, each with a tuple of shares in the order of PHASES."""
    return [row | {"kind": "phases", "process": number} | {f"phase_{key}": value for key, value in zip(PHASES, values)}
            for number, values in enumerate(shares, start=1) for row in cell(name, variables, 1.0)]


def registry(dense=(), sparse=(), own=(), pairs=()):
    return Registry({"implementations": [
        {"folder": name.split("/")[0], "available": True, "reason": "", "library": "none" if name in own else "L", "version": "1",
         "licence": "MIT", "variants": [{"name": name, "description": "", "dense": name in dense, "unsymmetric": False}]}
        for name in (*dense, *sparse)], "blas": list(pairs)})


def view(known, columns=()):
    context = {"cpu_model": "CPU", "compiler": "GNU 12", "flags": "-O3"}
    return SimpleNamespace(registry=known, settings={"columns": list(columns)}, context=context)


def results(rows, dense=(), sparse=(), own=(), columns=(), pairs=()):
    known = schema.of_part("map")
    tidy = schema.conform(pandas.DataFrame(rows, columns=list(known["tidy"])), known["tidy"], "tidy")
    return Results({"tidy": tidy}, view(registry(dense, sparse, own, pairs), columns))
