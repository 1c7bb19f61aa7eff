# The report's tables, as rows of texts and numbers computed from the tidy tables.
from analysis.loader import FAILURES, NULL
from analysis.maps import paired_rank
from analysis.statistics import median

LAST_CENTRED = 602  # variables; the harness centres stretches on the singular position up to here
BEFORE_SINGULAR = (f"sizes above {LAST_CENTRED} variables are timed before the singular position, "
                   "as crossing it multiplies rounding there")


def step_times(results):
    """Natural fill: per size the median, spread and set-up time of each implementation."""
    samples = results.samples(natural_only=True)
    rows = []
    for size, of_size in samples.groupby("variables"):
        ranking = paired_rank(of_size, results.natural_failures(size))
        for name in results.implementations:
            mine = of_size[of_size.implementation == name]
            if len(mine):
                rows.append({
                    "variables": size, "implementation": name, "median": median(mine.step_us),
                    "low": mine.step_us.min(), "high": mine.step_us.max(), "samples": len(mine),
                    "rounds": mine["round"].nunique(), "steps": mine.stretch_steps.iloc[0],
                    "passes": mine.passes.iloc[0] / mine.stretch_steps.iloc[0],
                    "setup": median(mine.setup_us),
                    "winner": ranking.decided and ranking.winner == name})
    return rows


def overhead(results):
    """Largest median of the null control, µs a step; NaN if it was not measured."""
    tidy = results.tidy
    null = tidy[(tidy.implementation == NULL) & (tidy.status == "ok")]
    return null.groupby("variables").step_us.median().max()


def verdicts(results):
    """Per implementation: how many scenes agree, and the scenes of every other verdict."""
    table = results.verification.drop_duplicates(["scene", "implementation"])
    scenes = list(dict.fromkeys(table.scene))
    found = {(row.scene, row.implementation): row for row in table.itertuples()}
    rows = []
    for name in results.implementations:
        others = {}
        cells = [(scene, found[scene, name].verdict) for scene in scenes if (scene, name) in found]
        for scene, verdict in cells:
            if verdict != "agrees":
                others.setdefault(verdict, []).append(scene)
        agreed = len(cells) - sum(map(len, others.values()))
        rows.append({"implementation": name, "agreed": agreed, "of": len(cells), "others": others})
    return rows


def checks(results):
    """Per implementation and check: how many ran, how many passed, and the worst value."""
    table = results.verification[results.verification.check != ""]
    rows = []
    for (name, check), group in table.groupby(["implementation", "check"], sort=False):
        ran = group[group.passed != ""]
        share = ran.value / ran.tolerance.where(ran.tolerance > 0, 1.0)
        worst = ran.loc[share.idxmax()] if share.notna().any() else None
        rows.append({"implementation": name, "check": check, "ran": len(ran),
                     "skipped": len(group) - len(ran),
                     "passed": int((ran.passed == "True").sum()), "worst": worst})
    order = {name: place for place, name in enumerate(results.implementations)}
    return sorted(rows, key=lambda row: order.get(row["implementation"], len(order)))


def accuracy(results):
    """Whole simulations, one row an implementation, grouped by scene and penalty."""
    groups = []
    for (scene, penalty), rows in results.accuracy.groupby(["scene", "penalty_asked"], sort=False):
        groups.append({"scene": scene, "asked": penalty, "rows": rows.to_dict("records"),
                       "failures": int((~rows.status.isin(["ok", "excluded"])).sum())})
    return groups


def losses(results):
    """What was not timed or may not be ranked, grouped by implementation, status and reason:
    [{"implementation", "status", "reason", "scenes", "cells", "low", "high"}]. Exclusions of one
    implementation are one group, as their reasons differ in nothing but the factor `low` to `high`
    (pilot's time ÷ best of the scene)."""
    tidy = results.tidy
    lost = tidy[tidy.status.isin([*FAILURES, "excluded", "unavailable"])]
    lost = lost.drop_duplicates(["kind", "scene", "implementation", "status", "reason"])
    kind = lost.reason.where(lost.status != "excluded", "")
    rows = []
    for (name, status, reason), group in lost.groupby(["implementation", "status", kind],
                                                      sort=False):
        scenes = list(dict.fromkeys(scene for scene in group.scene if scene))
        rows.append({"implementation": name, "status": status, "scenes": scenes,
                     "reason": reason or group.reason.iloc[0], "cells": len(scenes),
                     "low": group.pilot_ratio.min(), "high": group.pilot_ratio.max()})
    return sorted(rows, key=lambda row: row["status"] in ("excluded", "unavailable"))


def not_reached(results):
    """Scenes whose asked fill is below the mechanism's own."""
    tidy = results.tidy
    return tidy[tidy.status == "not-reached"].to_dict("records")


def stages(results):
    """{stage: (cells, samples)} of the ranked timing: the grid, and what refinement added."""
    samples = results.samples()
    return {stage or "grid": (rows.groupby(["scene", "implementation"]).ngroups, len(rows))
            for stage, rows in samples.groupby("stage")}


def builds(results):
    """[{"build", "compiler", "flags", "blas", "files"}] of run.json's contexts, one row a build
    and BLAS pair that took part; the study's own build is "own"."""
    rows = []
    for key, context in results.run.get("contexts", {}).items():
        build, _, pair = key.partition("|")
        rows.append({"build": build or "own", "blas": pair,
                     "compiler": context.get("compiler", ""), "flags": context.get("flags", ""),
                     "files": [path for path in context.get("blas_loaded", "").split(";") if path]})
    return rows


def blas_pairs(results):
    """The BLAS + LAPACK pairs of `mbs list --json`, each with the library files that the study's
    own build loaded for it ([] if it was not used)."""
    own = {row["blas"]: row["files"] for row in builds(results) if row["build"] == "own"}
    return [pair | {"files": own.get(pair["name"], [])} for pair in results.pairs]
