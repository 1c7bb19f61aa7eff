# What a reader should choose: the winner by size, dense or sparse by fill, the price of one choice.
import numpy

from analysis import paper
from analysis.compare import best_ratio, natural
from analysis.loader import FAILURES
from analysis.maps import paired_rank


def by_size(results):
    """Neighbouring sizes with the same outcome at natural fill: [{"first", "last", "names",
    "low", "high"}]; names: the winner, or both of an undecided pair; low, high: margins."""
    groups = []
    for size, samples in natural(results).groupby("variables"):
        found = paired_rank(samples, results.natural_failures(size))
        names = (found.winner,) if found.decided or found.second is None else (
            found.winner, found.second)
        if groups and groups[-1]["names"] == names:
            groups[-1]["last"] = size
            groups[-1]["margins"].append(found.margin)
        else:
            groups.append({"first": size, "last": size, "names": names,
                           "margins": [found.margin]})
    return [group | {"low": min(group["margins"]), "high": max(group["margins"])}
            for group in groups]


def dense_from(results):
    """Sizes with filled scenes: [{"variables", "from", "last_sparse"}]; fills in %: "from"
    is the first of those at and above which the best dense version is faster than the best sparse
    one (None: at none), "last_sparse" the last fill with another outcome (None: at none)."""
    rows = []
    samples = results.samples()
    filled = samples[samples.fill_asked.notna()].variables.unique()
    for size, of_size in samples[samples.variables.isin(filled)].groupby("variables"):
        found = sorted(((scene.fill_percent.iloc[0],
                         best_ratio(scene, paper.dense(results), paper.sparse(results)))
                        for _, scene in of_size.groupby("scene")
                        if scene.implementation.isin(paper.sparse(results)).any()),
                       key=lambda entry: entry[0])
        if not found:
            continue
        start = len(found)
        while start and found[start - 1][1] and found[start - 1][1].high < 1:
            start -= 1
        rows.append({"variables": size, "from": found[start][0] if start < len(found) else None,
                     "last_sparse": found[start - 1][0] if start else None})
    return rows


def prices(results):
    """The price of always using one implementation: [{"implementation", "mean", "worst", "where",
    "cells", "rough", "failed"}], best mean first: geometric mean and largest of time ÷ best
    time over all cells; excluded cells count with their pilot's rough ratio, failed and missing
    ones do not count but are told."""
    samples, tidy = results.samples(), results.tidy
    medians = samples.groupby(["scene", "implementation"]).step_us.median().unstack()
    if medians.empty:
        return []
    losses = medians.div(medians.min(axis=1), axis=0)
    timing = tidy[(tidy.kind == "timing") & tidy.implementation.isin(list(results.variants))]
    rough = timing[(timing.status == "excluded") & timing.pilot_ratio.notna()].drop_duplicates(
        ["scene", "implementation"]).set_index(["scene", "implementation"]).pilot_ratio
    failed = timing[timing.status.isin(FAILURES)].groupby("implementation").scene.nunique()
    rows = []
    for name in results.implementations:
        mine = losses[name].dropna().to_dict() if name in losses else {}
        guessed = {scene: ratio for (scene, other), ratio in rough.items()
                   if other == name and scene in losses.index and scene not in mine}
        every = mine | guessed
        if every:
            worst = max(every, key=every.get)
            rows.append({"implementation": name, "worst": every[worst], "where": worst,
                         "mean": float(numpy.exp(numpy.mean(numpy.log(list(every.values()))))),
                         "cells": len(every), "rough": len(guessed),
                         "failed": int(failed.get(name, 0)), "of": len(losses)})
    return sorted(rows, key=lambda row: row["mean"])
