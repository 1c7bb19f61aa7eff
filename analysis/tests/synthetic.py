# Results of made-up times for tests: give every cell a constant or its samples, get `Results`.
import json

from analysis.loader import PHASES, load
from analysis.tests.conftest import timing, write


def cell(name, variables, *times, fill=None, **more):
    """Rows of one timed cell, one round a time; at natural fill (5 %) unless `fill` (share)."""
    where = {"scene": f"n{variables}" + (f",fill={fill}" if fill else ""), "variables": variables,
             "fill_asked": fill or "", "fill_percent": 100 * fill if fill else 5}
    names = {"variant": name.split("/")[1].split("+")[0]}
    return [timing(name, number, 1, time) | where | names | more
            for number, time in enumerate(times, start=1)]


def failed(name, variables, status, reason, fill=None, pilot="", **more):
    """The row of a cell that was not timed."""
    return cell(name, variables, "", fill=fill, status=status, reason=reason, round="",
                repetition="", stretch_us="", pilot_step_us=pilot, **more)


def operation(name, variables, what, time, **more):
    return cell(name, variables, "", kind="operations", operation=what, operation_us=time,
                stretch_us="", **more)


def phases(name, variables, *shares):
    """Rows of profiled processes, each with a tuple of shares in the order of PHASES."""
    return [row | {"round": number} | {f"phase_{key}": value for key, value in zip(PHASES, values)}
            for number, values in enumerate(shares, start=1)
            for row in cell(name, variables, 1.0, kind="phases")]


def results(folder, rows, dense=(), sparse=(), pairs=(), libraries=None, unavailable=()):
    """Loads `rows` with a registry of these names; `libraries`: {folder: library}."""
    write(folder / "tidy.csv", "tidy", rows)
    write(folder / "verification.csv", "verification", [])
    write(folder / "accuracy.csv", "accuracy", [])
    entries = [{"folder": name.split("/")[0], "available": True, "reason": "",
                "library": (libraries or {}).get(name.split("/")[0], "L"),
                "variants": [{"name": name, "description": "", "dense": name in dense,
                              "unsymmetric": False}]} for name in (*dense, *sparse)]
    entries += [{"folder": name, "available": False, "reason": reason, "library": "",
                 "variants": []} for name, reason in unavailable]
    listed = {"implementations": entries, "blas": list(pairs)}
    (folder / "implementations.json").write_text(json.dumps(listed))
    (folder / "run.json").write_text(json.dumps({"profile": "test", "only": []}))
    (folder / "context.json").write_text("{}")
    return load(folder)
