# What the page of the map says besides its figures.
from analysis.core.controls import judged
from analysis.map import carry, losses, paper, summary
from analysis.map.ledger import by_id
from analysis.map.results import of
from analysis.map.sentences import by_outcome


def context(tables, view):
    results = of(tables, view)
    libraries = results.layer("libraries")
    scenes, ledger = tables["scenes"], tables["claims"].to_dict("records")
    timed = results.timing[results.timing.status == "ok"]
    ranked = timed[~timed.implementation.str.startswith("null/")]
    return {"by_size": {layer: list(by_outcome(summary.by_size(results, results.layer(layer)), what))
                        for layer, what in (("libraries", "library"), ("all", "of all"))},
            "own": [name for name in results.layer("all") if name not in libraries],
            "settled": {layer: summary.settled(tables["cells"], layer) for layer in ("libraries", "all")},
            "dense_from": summary.dense_from(results), "prices": summary.prices(results, libraries),
            "times": losses.step_times(results), "overhead": losses.overhead(results), "centred": losses.LAST_CENTRED,
            "ledger": ledger, "by_id": by_id(tables["claims"]), "subjects": paper.SUBJECTS, "dense_pairs": paper.dense_pairs(results), "title": paper.TITLE,
            "pairs": [pair | {"used": sorted(ranked.implementation[ranked.blas == pair["name"]].unique())}
                      for pair in view.registry.listed.get("blas", [])],
            "verdicts": losses.verdicts(tables["verification"], results.implementations), "losses": losses.losses(results),
            "not_reached": list(scenes[scenes.reason != ""].scene), "entries": view.registry.entries,
            "coverage": view.registry.coverage,
            "controls": judged(tables["controls"]), "twins": tables["controls"].to_dict("records"), "spread": [
                row | {"of": carry.SOURCES[row["source"]]} for row in tables["spread"].to_dict("records")],
            "processes": timed.record.nunique()}
