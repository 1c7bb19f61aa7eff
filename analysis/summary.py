# What a reader should choose: the winner by size, dense or sparse by fill, the price of one choice.
from analysis import paper
from analysis.compare import best_ratio, natural
from analysis.maps import map_cells, paired_rank
from analysis.regret import regrets


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
    """Sizes with filled scenes: [{"variables", "from", "last_sparse", "between"}]; fills in %:
    "from" is the first of those at and above which the best dense version is faster than the best sparse
    one (None: at none), "last_sparse" the last fill with another outcome (None: at none), "between"
    the first and last fill at which dense is faster if it is not up to the last one (or None)."""
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
        ahead = [fill for fill, ratio in found if ratio and ratio.high < 1]
        rows.append({"variables": size, "from": found[start][0] if start < len(found) else None,
                     "last_sparse": found[start - 1][0] if start else None,
                     "between": (ahead[0], ahead[-1]) if ahead and start == len(found) else None})
    return rows


def prices(results):
    """The price of always using one implementation, as the regret map orders and draws it:
    [{"implementation", "mean", "worst", "where", "cells", "of", "rough", "failed", "unknown"}];
    excluded cells count with their pilot's rough ratio; cells that failed or that were not even
    tried do not count but are told."""
    cells = map_cells(results)
    return [{"implementation": regret.name, "mean": regret.mean, "worst": regret.worst,
             "where": regret.where, "cells": len(regret.ratios) - regret.unknown,
             "rough": len(regret.rough) - regret.unknown, "failed": len(regret.failed),
             "unknown": regret.unknown, "of": len(cells)}
            for regret in regrets(results, cells) if len(regret.ratios) > regret.unknown]
