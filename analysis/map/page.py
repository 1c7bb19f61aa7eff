# What the page of the map says besides its figures; the answer to "Which implementation is fastest at which size and fill?".
from analysis.core import schema
from analysis.core.controls import judged, said
from analysis.core.gather import gather
from analysis.core.view import facts_of, others
from analysis.map import carry, paper, summary
from analysis.map.ledger import beside, by_id, told
from analysis.map.results import FAILURES, of

FEWER = "fewer processes"  # the budget ended before the last of them
SUMMED = ("excluded", "dropped", FEWER)  # whose reasons are not told apart
LAST_CENTRED = 602  # variables; the harness centres stretches on the singular position up to here


def context(tables, view):
    results = of(tables, view)
    libraries = results.layer("libraries")
    scenes, (processors, ledger) = tables["scenes"], ledgers(tables["claims"], view)
    timed = results.timing[results.timing.status == "ok"]
    null = timed.implementation.str.startswith("null/")  # the harness's control
    dense = timed[timed.implementation.isin(paper.dense(results))]
    pairs_of = lambda rows: ", ".join(sorted(rows.blas.unique())) or "none"  # "openblas, reference"
    ranked, overhead = timed[~null], timed[null].groupby("variables").step_us.median().max()
    return {"by_size": {layer: list(by_outcome(summary.by_size(results, results.layer(layer)), what))
                        for layer, what in (("libraries", "library"), ("all", "of all"))},
            "own": [name for name in results.layer("all") if name not in libraries],
            "settled": {layer: summary.settled(tables["cells"], layer) for layer in ("libraries", "all")},
            "dense_from": summary.dense_from(results), "prices": summary.prices(results, libraries),
            "times": [*step_times(results)], "overhead": overhead, "centred": LAST_CENTRED, "title": paper.TITLE,
            "processors": processors, "ledger": ledger, "by_id": by_id(tables["claims"]), "subjects": paper.SUBJECTS, "dense_pairs": pairs_of(dense),
            "filled_pairs": pairs_of(dense[dense.fill_asked.notna()]),
            "pairs": [pair | {"used": sorted(ranked.implementation[ranked.blas == pair["name"]].unique())}
                      for pair in view.registry.listed.get("blas", [])],
            "verdicts": verdicts(tables["verification"], results.implementations), "losses": losses(results),
            "not_reached": list(scenes[scenes.reason != ""].scene), "entries": view.registry.entries,
            "coverage": view.registry.coverage, "controls": judged(tables["controls"]), "twins": tables["controls"].to_dict("records"),
            "spread": [row | {"of": carry.SOURCES[row["source"]]} for row in tables["spread"].to_dict("records")]}


def ledgers(claims, view):
    """(processors of stored sets beside this one and of its commit, the ledgers of this and of these side by side)"""
    alike = {one: context["cpu_model"] for one in others(view.folder) for context in [facts_of(one)["context"]]
             if context["commit"] == view.context["commit"] and (one / "map" / schema.DIGESTS).exists()}
    return [*alike.values()], beside([claims, *(schema.read_table(one, "map", "claims") for one in alike)])


def step_times(results):
    """Own fill: a row a size and contender that is ranked, with its spread over processes."""
    for size, timed in results.samples(natural_only=True).groupby("variables"):
        winners = [results.fastest(results.natural(size), results.layer(layer)) for layer in ("libraries", "all")]
        for name in results.implementations:
            if len(mine := timed[timed.implementation == name]):
                steps, passes = mine.steps.iloc[0], mine.passes.iloc[0]
                yield {"variables": size, "implementation": name, "median": mine.step_us.median(), "low": mine.low_us.min(),
                       "high": mine.high_us.max(), "processes": len(mine), "samples": mine["samples"].map(len).sum(), "steps": steps,
                       "passes": passes / steps, "per_pass": mine.step_us.median() * steps / passes, "setup": mine.setup_us.median(),
                       "winner": name in winners}


def verdicts(table, names):
    """Per implementation: how many scenes agree, and the scenes of every other verdict."""
    scenes = table.drop_duplicates(["scene", "implementation"]).groupby(["implementation", "verdict"], sort=False).scene.agg(list)
    return [{"implementation": name, "of": sum(map(len, mine.values())), "agreed": len(mine.pop("agrees", ())), "others": mine}
            for name in names for mine in [scenes[name].to_dict() if name in scenes else {}]]


def losses(results):
    """What was not timed, timed in fewer processes, or may not be ranked, grouped: [{"implementation", "status", "reason", "scenes"}];
    exclusions of one implementation are one group, as their reasons differ in nothing but the factor."""
    lost = results.tidy[results.tidy.status.isin([*FAILURES, "excluded", "slower", "unavailable", "dropped"])]
    lost = lost.drop_duplicates(["kind", "scene", "implementation", "status", "reason"])
    pairs = lambda rows: list(zip(rows.kind, rows.scene, rows.implementation))  # a process of one that others have timed is no loss of it
    timed = set(pairs(results.tidy[results.tidy.status == "ok"]))
    lost = lost.assign(status=lost.status.mask([pair in timed for pair in pairs(lost)] & (lost.status == "dropped"), FEWER))
    kind = lost.reason.where(~lost.status.isin(SUMMED), "")
    rows = [{"implementation": name, "status": status, "reason": reason or "; ".join(dict.fromkeys(group.reason.iloc[[0, -1]])),
             "scenes": list(dict.fromkeys(group.scene))}
            for (name, status, reason), group in lost.groupby(["implementation", "status", kind], sort=False)]
    return sorted(rows, key=lambda row: row["status"] in (*SUMMED, "unavailable"))


def answers(tables, view):
    results = of(tables, view)
    libraries = results.layer("libraries")
    groups = summary.by_size(results, libraries)
    if all(group["kind"] == "none" for group in groups):
        return [{"text": "Nothing was timed: no library took part or agreed with the reference.", "anchor": "losses"}]
    found = [{"text": f"The four-bar at its own fill. {' '.join(by_outcome(groups))}", "anchor": "answer"}]
    dense = [f"n = {row['variables']:g} from {row['from']:.0f} %" for row in summary.dense_from(results) if row["from"] is not None]
    filled = [f"the paper's dense versions overtake the sparse libraries at {', '.join(dense)}"] * bool(dense) + _hybrid(tables["cells"])
    if filled:
        found.append({"text": f"As the tangent fills, {'; '.join(filled)}.", "anchor": "maps"})
    if whole := [row for row in summary.prices(results, libraries) if not row["failed"] and row["cells"] == row["of"]]:
        first, safest = whole[0], min(whole, key=lambda row: row["worst"])
        found.append({"text": f"The single library that costs least is {_price(first)}, over {first['of']} cells."
                              + (f" The one with the least worst case is {_price(safest)}." if safest != first else ""), "anchor": "regret"})
    claims = f"Claims of the paper of 2008 (T, F: its tables and figures; C: its text): {told(tables['claims'])}."
    return [*found, {"text": f"{claims} {said(tables['controls'])}".rstrip(), "anchor": "claims"}]


def _hybrid(cells):
    filled = cells[(cells.layer == "libraries") & cells.fill_asked.notna() & (cells.winner != "")]
    count = filled.equivalent.str.contains("hybrid_dense/").sum()
    return [f"sparse assembly with a dense solver (hybrid_dense) leads, or is as fast, in {count} of {len(filled)} filled cells"] if count else []


def _price(row):
    return f"{row['implementation']}: {row['mean']:.2f} times the best on average, {row['worst']:.3g} times at worst"


def by_outcome(groups, what="library"):
    """A sentence for each that is shown to be fastest at some sizes, one for sizes of each other kind."""
    told = gather(((group["kind"], group["names"][0] if group["kind"] == "decided" else ""), group) for group in groups)
    for (kind, name), mine in told.items():
        sizes = "n = " + ", ".join(" to ".join(dict.fromkeys(f"{group[end]:g}" for end in ("first", "last"))) for group in mine)
        margins = [value for group in mine for value in group["margins"] if value == value]
        names = ", ".join(dict.fromkeys(one for group in mine for one in group["names"]))
        ahead = " to ".join(dict.fromkeys(f"{value:.2f}" for value in (min(margins), max(margins)))) if margins else ""
        ahead = f", {ahead} times ahead of the second" if ahead else ""
        yield {"decided": f"{name} is the fastest {what} at {sizes}{ahead}.", "equivalent": f"At {sizes} several are as fast as each other: {names}.",
               "open": f"At {sizes} it is not decided; the fastest is among {names}.",
               "few": f"At {sizes} too few processes were timed to tell.", "none": f"At {sizes} nobody was timed."}[kind]
