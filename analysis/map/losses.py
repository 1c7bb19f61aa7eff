# Rows of the page's other tables: step times, verdicts of the gate, what was not timed.
from analysis.core.registry import NULL
from analysis.map.results import FAILURES

LAST_CENTRED = 602  # variables; the harness centres stretches on the singular position up to here


def step_times(results):
    """Own fill: a row a size and contender that is ranked, with its spread over processes."""
    rows = []
    for size in results.sizes:
        scene = results.natural(size)
        timed = results.rows(scene)
        timed = timed[timed.status == "ok"]
        winner = {layer: results.fastest(scene, results.layer(layer)) for layer in ("libraries", "all")}
        for name in results.implementations:
            mine = timed[timed.implementation == name]
            if len(mine):
                rows.append({"variables": size, "implementation": name, "median": mine.step_us.median(), "low": mine.low_us.min(),
                             "high": mine.high_us.max(), "processes": len(mine), "samples": mine["samples"].map(len).sum(),
                             "steps": mine.steps.iloc[0], "passes": mine.passes.iloc[0] / mine.steps.iloc[0],
                             "per_pass": mine.step_us.median() * mine.steps.iloc[0] / mine.passes.iloc[0],
                             "setup": mine.setup_us.median(), "winner": name in winner.values()})
    return rows


def overhead(results):
    """Largest median of the null control, µs a step; NaN if it was not measured."""
    rows = results.timing[(results.timing.implementation == NULL) & (results.timing.status == "ok")]
    return rows.groupby("variables").step_us.median().max()


def verdicts(table, names):
    """Per implementation: how many scenes agree, and the scenes of every other verdict."""
    scenes = table.drop_duplicates(["scene", "implementation"]).groupby(["implementation", "verdict"], sort=False).scene.agg(list)
    found = {name: scenes[name].to_dict() if name in scenes else {} for name in names}
    return [{"implementation": name, "of": sum(map(len, mine.values())), "agreed": len(mine.pop("agrees", ())), "others": mine}
            for name, mine in found.items()]


def losses(results):
    """What was not timed or may not be ranked, grouped: [{"implementation", "status", "reason", "scenes"}]; exclusions of
    one implementation are one group, as their reasons differ in nothing but the factor."""
    lost = results.tidy[results.tidy.status.isin([*FAILURES, "excluded", "slower", "unavailable", "dropped"])]
    lost = lost.drop_duplicates(["kind", "scene", "implementation", "status", "reason"])
    kind = lost.reason.where(~lost.status.isin(["excluded", "dropped"]), "")
    rows = [{"implementation": name, "status": status, "reason": reason or "; ".join(dict.fromkeys(group.reason.iloc[[0, -1]])),
             "scenes": list(dict.fromkeys(group.scene))}
            for (name, status, reason), group in lost.groupby(["implementation", "status", kind], sort=False)]
    return sorted(rows, key=lambda row: row["status"] in ("excluded", "unavailable", "dropped"))
