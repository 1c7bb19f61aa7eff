# The tables of the map from its records.
import pandas

from analysis.core import timing
from analysis.core.controls import controls
from analysis.core.registry import NULL
from analysis.core.schema import conform, of_part
from analysis.map import carry
from analysis.map.cells import table as cells
from analysis.map.claims import (compilers, dense_pairs, pivoting, solvers, sparse_against_dense, starting_sparse, table1, table2_claims, tuned_blas)
from analysis.map.claims_maps import over_fill, regions
from analysis.map.results import Results, with_samples
from analysis.map.timed import AFTER, timed_rows

# The claims ledger: each claim of the paper with our figure, its interval and a computed verdict; in the order of the rows.
LEDGER = (table1, table2_claims, dense_pairs, solvers, pivoting, starting_sparse, tuned_blas, sparse_against_dense, over_fill, regions, compilers)
QUESTION = ["constraints", "start", "steps", "step", "passes", "penalty", "tolerance", "fill_seed", "record"]


def claims(results):
    return [row for claim in LEDGER for row in claim(results)]


def build(records, view):
    found = {name: conform(make(records), of_part("map")[name], f"map/{name}.csv")
             for name, make in (("tidy", tidy), ("scenes", scenes), ("verification", verification))}
    results = Results(found, view)
    return found | {"cells": cells(results), "claims": claims(results),
                    "spread": carry.components(results.timing, with_samples(results.tidy[results.tidy.kind == "seeds"])),
                    "controls": controls(results.timing[results.timing.process > AFTER])}


def tidy(records):
    timed, pilots, skipped = timed_rows(records), _of(records, "pilot"), _of(records, "excluded", "unavailable")
    told = (pilots.status == "timeout") & _pairs(pilots).isin(_pairs(skipped))  # ran out of time: that may be enough to exclude
    lost = pandas.concat([pilots[(pilots.status != "ok") & ~told], pandas.DataFrame(_rejected(records)), skipped]).assign(process=0)
    found = pandas.concat([rows.assign(kind=kind) for kind, rows in (
        ("timing", timed), ("timing", lost), ("phases", _of(records, "phases")), ("seeds", _of(records, "seeds")),
        ("operations", pandas.DataFrame(_operations(records))))], ignore_index=True)
    if found.empty:
        return found.filter(["kind"])
    timed_after_all = _pairs(found).isin(_pairs(timed[timed.status == "ok"]))
    found = found[(found.status != "timeout") | (found.process > 0) | ~timed_after_all]

    samples = found["samples"].map(lambda one: one if isinstance(one, tuple) else ())
    known = pilots[pilots.status == "ok"]
    found = found.assign(
        blas=found.environment.str.partition("|")[2], **_asked(found.scene), process=found.process.where(found.process > 0),
        samples=samples.map(len).where(samples.map(bool)), samples_us=[" ".join(f"{value:.6g}" for value in one) for one in samples],
        fill_percent=found.scene.map(dict(zip(known.scene, known.get("fill_percent", ())))),
        pilot_us=_pairs(found).map(dict(zip(_pairs(known), known.step_us))))
    return found.filter(list(of_part("map")["tidy"]))


def _of(records, *roles):
    return timing.processes([one for one in records if one.role in roles])


def _pairs(rows):
    return pandas.Series(list(zip(rows.scene, rows.implementation)), rows.index, dtype=object)


def _asked(scenes):
    """{"variables", "fill_asked"} of N-four-bars' names."""
    found = scenes.astype(str).str.extract(r"four-bar:(\d+)(?:,fill=([\d.]+))?").astype(float)
    return {"variables": 2 * found[0] + 2, "fill_asked": found[1]}


def _rejected(records):
    """A row for each verdict of the gate that is not "agrees", and for each gate that ended without one."""
    for one, cell in ((one, one.cell) for one in records if one.role == "gate"):
        for name, (status, reason) in one.verdicts.items():
            if status != "agrees" and (one.done or len(cell["contenders"]) == 1):  # else one by one they are checked again
                yield {"scene": cell["scene"], "implementation": name, "environment": cell["environment"], "status": status,
                       "reason": reason, "record": one.name}


def _operations(records):
    """A row for each operation that was timed alone, and for each contender of a process that gave none."""
    for one, cell in ((one, one.cell) for one in records if one.role == "operations"):
        base = {"scene": cell["scene"], "environment": cell["environment"], "process": cell["number"], "record": one.name}
        if not one.done:
            yield from (base | {"implementation": name, "status": one.status, "reason": one.reason} for name in cell["contenders"])
        for name, row in one.output.get("rows", {}).items():
            contender = next((one for one in cell["contenders"] if name.startswith(f"{one.partition('+')[0]}/")), "")
            status, reason = timing.outcome(one, row)
            yield base | {"implementation": contender, "operation": name.rsplit("/", 1)[-1], "status": status, "reason": reason} | (
                {"samples": tuple(row["cpu_us"]), "operation_us": timing.median(row["cpu_us"])} if status == "ok" else {})


def scenes(records):
    """What each scene asks: counters that its contenders share, of the first that was timed, else of its first pilot."""
    pilots, timed = _of(records, "pilot"), timed_rows(records)
    timed = timed[timed.implementation != NULL]
    first, pilot = (rows[rows.status == "ok"].drop_duplicates("scene").set_index("scene") for rows in (timed, pilots))
    lost = pandas.DataFrame([{"scene": one.cell["scene"], "reason": one.reason, "record": one.name} for one in records
                             if one.role == "not-reached"], columns=["scene", "reason", "record"]).set_index("scene")
    found = first.reindex(columns=QUESTION).combine_first(pilot.reindex(columns=["fill_percent", "constraints", "record"]))
    found = found.combine_first(lost).reset_index()
    return found.assign(**_asked(found.scene)).sort_values(["variables", "fill_asked"], na_position="first")


def verification(records):
    """A row for each check of the gate, or for a verdict without any."""
    return pandas.DataFrame([
        {"environment": one.cell["environment"], "record": one.name, "check": check.get("name")}
        | {key: row[key] for key in ("scene", "implementation", "verdict", "reason")}
        | {key: check.get(key) for key in ("value", "tolerance", "passed", "detail")}
        for one in records if one.role == "gate" for row in one.output.get("rows", []) for check in row["checks"] or [{}]])
