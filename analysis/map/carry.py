# Where the spread of a ratio comes from: what a result carries beyond its own run.
import math

import numpy
import pandas

from analysis.core import timing
from analysis.map.timed import AFTER

SOURCES = {"round": "turns of one process", "process": "processes of one layout", "layout": "layouts of the program",
           "seed": "seeds of the artificial fill"}


def components(timed, seeds):
    """Where the spread of a ratio comes from: {"source", "percent", "scenes", "record"} a row. `percent`: the standard
    deviation of a ratio that this source alone makes, over all scenes. Of the two that lead in a scene, by nested analysis
    of variance: what the mean over processes of a layout still owes to its processes is taken off the layouts."""
    found = pandas.DataFrame([*_of_scenes(timed), *_of_seeds(seeds)], columns=["source", "variance", "record"])
    found = found.groupby("source").agg(percent=("variance", lambda one: 100 * math.sqrt(one.mean())), scenes=("variance", "size"),
                                        record=("record", lambda one: " ".join(dict.fromkeys(" ".join(one).split()))))
    return found.reindex([source for source in SOURCES if source in found.index]).reset_index()


def _of_scenes(timed):
    for _, group in timed[(timed.status == "ok") & (timed.process > AFTER)].groupby("scene"):
        paired = timing.Paired(group)
        if pair := _leaders(paired):
            variances = nested(timing.by_layout(paired, timing.log_ratios(paired, *pair)), timing.rounds(paired, *pair))
            names = " ".join(group[group.implementation == pair[0]].record)
            yield from ({"source": source, "variance": variance, "record": names} for source, variance in variances.items())


def of_seeds(seeds):
    """(variance of a ratio's logarithm between seeds of the fill, its degrees of freedom); timing.NO_VARIANCE where none was measured."""
    found = [*_of_seeds(seeds)]
    return (float(numpy.mean([one["variance"] for one in found])), sum(one["freedom"] for one in found)) if found else timing.NO_VARIANCE


def _of_seeds(seeds):
    """The variance between scenes that differ in the seed of their fill alone, for each size and fill."""
    for _, group in seeds[seeds.status == "ok"].groupby(["variables", "fill_asked"]):
        scenes = [timing.Paired(rows) for _, rows in group.groupby("scene")]
        pair = _leaders(scenes[0])
        logs = [timing.log_ratios(paired, *pair) for paired in scenes] if pair else []
        table = pandas.DataFrame([one for one in logs if one]).dropna(axis=1).to_numpy()  # a seed a row, a process of all a column
        if min(table.shape) > 1:
            means = table.mean(axis=1)  # all seeds have the same layouts, so that these tell nothing of the seeds
            rest = table - means[:, None] - table.mean(axis=0) + table.mean()
            within = (rest**2).sum() / (len(means) - 1) / (table.shape[1] - 1) / table.shape[1]
            yield {"source": "seed", "variance": max(0.0, float(numpy.var(means, ddof=1) - within)), "freedom": len(means) - 1,
                   "record": " ".join(group.record)}


def nested(groups, rounds):
    """{source: variance} of values in groups (processes in layouts); `rounds`: variance of one round within a process and
    of the median over rounds. A source that the design cannot tell is missing."""
    one, median = rounds
    found = {"round": one}
    if not (repeated := [values for values in groups if len(values) > 1]):
        return found
    within = sum(numpy.var(values, ddof=1) * (len(values) - 1) for values in repeated) / sum(len(values) - 1 for values in repeated)
    found["process"] = max(0.0, float(within) - median)
    if len(groups) > 1:
        size = len(groups) / sum(1 / len(values) for values in groups)  # harmonic mean
        between = float(numpy.var([numpy.mean(values) for values in groups], ddof=1))
        found["layout"] = max(0.0, between - float(within) / size)
    return found


def _leaders(paired):
    """The two that are fastest, without twins; None if there are not two."""
    ranking = timing.rank(paired, {name for name in paired.logs if not name.endswith(timing.TWIN)})
    return (ranking.winner, ranking.second) if ranking and ranking.second else None
