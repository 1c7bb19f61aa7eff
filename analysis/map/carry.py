# What a result carries beyond its own run: controls, where nothing differs (A/A), and where the spread of a ratio comes from.
import math

import numpy
import pandas

from analysis.core import timing
from analysis.core.timing import CONFIDENCE, TWIN
from analysis.map.timed import AFTER

FALSE = 0.01  # a run is no evidence if its share of false decisions would be found by chance so seldom
SOURCES = {"round": "turns of one process", "process": "processes of one layout", "layout": "layouts of the program",
           "seed": "seeds of the artificial fill"}


def controls(timed):
    """A row for each contender that was timed twice in the same processes: {"scene", "implementation", "ratio", "low",
    "high", "decided", "record"}; decided: the interval excludes 1, which is false."""
    rows = []
    for scene, group in timed[(timed.status == "ok") & (timed.process > AFTER)].groupby("scene"):
        paired = timing.Paired(group)
        for twin in sorted(name for name in paired.logs if name.endswith(TWIN)):
            name = twin.removesuffix(TWIN)
            found = timing.ratio(paired, twin, name)
            rows.append({"scene": scene, "implementation": name, "ratio": found.value, "low": found.low, "high": found.high,
                         "decided": found.low > 1 or found.high < 1, "record": " ".join(group[group.implementation == twin].record)})
    return pandas.DataFrame(rows)


def judged(table):
    """{"pairs", "false", "widest", "chance", "sound"} of `controls`: how many were decided though nothing differs, the ratio
    furthest from 1, and how likely so many are by chance."""
    from scipy import stats
    pairs, false = len(table), int(table.decided.sum()) if len(table) else 0
    chance = float(stats.binom.sf(false - 1, pairs, 1 - CONFIDENCE)) if pairs else math.nan
    widest = max(table.ratio, key=lambda one: abs(math.log(one))) if pairs else math.nan
    return {"pairs": pairs, "false": false, "widest": widest, "chance": chance, "sound": bool(pairs) and chance >= FALSE}


def components(timed, seeds):
    """Where the spread of a ratio comes from: {"source", "percent", "scenes", "record"} a row. `percent`: the standard
    deviation of a ratio that this source alone makes, over all scenes. Of the two that lead in a scene, by nested analysis
    of variance: what the mean over processes of a layout still owes to its processes is taken off the layouts."""
    found = pandas.DataFrame([*_of_scenes(timed), *_of_seeds(seeds)], columns=["source", "variance", "record"])
    found = found.groupby("source").agg(percent=("variance", lambda one: 100 * math.sqrt(one.mean())), scenes=("variance", "size"),
                                        record=("record", lambda one: " ".join(dict.fromkeys(" ".join(one).split()))))
    return found.reindex([source for source in SOURCES if source in found.index]).reset_index()


def _of_scenes(timed):
    """The variances of each scene's leaders."""
    for _, group in timed[(timed.status == "ok") & (timed.process > AFTER)].groupby("scene"):
        paired = timing.Paired(group)
        pair = _leaders(paired)
        if pair:
            variances = nested(timing.by_layout(paired, timing.log_ratios(paired, *pair)), _rounds(paired, *pair))
            names = " ".join(group[group.implementation == pair[0]].record)
            yield from ({"source": source, "variance": variance, "record": names} for source, variance in variances.items())


def _of_seeds(seeds):
    """The variance between scenes that differ in the seed of their fill alone, for each size and fill."""
    for _, group in seeds[seeds.status == "ok"].groupby(["variables", "fill_asked"]):
        scenes = [timing.Paired(rows) for _, rows in group.groupby("scene")]
        pair = _leaders(scenes[0])
        logs = [list(timing.log_ratios(paired, *pair).values()) for paired in scenes] if pair else []
        logs = [one for one in logs if len(one) > 1]
        if len(logs) > 1:
            within = numpy.mean([numpy.var(one, ddof=1) / len(one) for one in logs])
            between = numpy.var([numpy.mean(one) for one in logs], ddof=1)
            yield {"source": "seed", "variance": max(0.0, between - within), "record": " ".join(group.record)}


def nested(groups, rounds):
    """{source: variance} of values in groups (processes in layouts); `rounds`: variance of one round within a process and
    of the median over rounds. A source that the design cannot tell is missing."""
    one, median = rounds
    found = {"round": one}
    repeated = [values for values in groups if len(values) > 1]
    if not repeated:
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
    ranking = timing.rank(paired, {name for name in paired.logs if not name.endswith(TWIN)})
    return (ranking.winner, ranking.second) if ranking and ranking.second else None


def _rounds(paired, first, second):
    """(variance of a round's logarithm of the ratio, variance of the median over a process's rounds), means over processes."""
    found = []
    for key in set(paired.logs[first]) & set(paired.logs[second]):
        count = min(len(paired.logs[first][key]), len(paired.logs[second][key]))
        if count > 2:
            one = float(numpy.var(paired.logs[first][key][:count] - paired.logs[second][key][:count], ddof=1))
            found.append((one, math.pi / 2 * one / count))
    return tuple(map(float, numpy.mean(found, axis=0))) if found else (0.0, 0.0)


def disturbance(records):
    """One row: how many timed processes there were, and in how many others ran on their processor."""
    timed = [one for one in records if one.cell.get("timed") and one.cell["kind"] == "bench" and one.done]
    found = [one for one in timed if timing.disturbed(one)]
    return pandas.DataFrame([{"processes": len(timed), "disturbed": len(found), "record": " ".join(one.name for one in found)}])
