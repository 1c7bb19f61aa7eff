# Whether times may be believed. Controls: a contender that was timed twice in the same processes (A/A). Nothing differs, so what is
# decided is decided falsely. Disturbance: in how many timed processes others ran, how much of its time a host took, frequencies.
import math

import pandas
from scipy import special

from analysis.core import timing

CONTROL = "control"  # role of runs that are there once more, where each run has a process of its own
FALSE = 0.01  # a run is no evidence if its share of false decisions would be found by chance so seldom


def controls(timed):
    """A row for each scene and contender with a twin: {"scene", "implementation", "ratio", "low", "high", "decided", "record"};
    decided: the interval excludes 1."""
    for scene, group in timed[timed.status == "ok"].groupby("scene"):
        paired = timing.Paired(group)
        for twin in sorted(name for name in paired.logs if name.endswith(timing.TWIN)):
            name = twin.removesuffix(timing.TWIN)
            found = timing.ratio(paired, twin, name)
            yield {"scene": scene, "implementation": name, **found.columns(), "decided": found.low > 1 or found.high < 1,
                   "record": " ".join(group[group.implementation == twin].record)}


def controls_in(records):
    """`controls` of those records that have a twin."""
    twinned = [one for one in records if any(name.endswith(timing.TWIN) for name in one.cell["contenders"])]
    return controls(timing.processes(timing.counted(twinned)))


def repeated(rows, again, column="step_us"):
    """`controls` of runs that follow each other: `again` are some of `rows` once more, of a process the first: what slows it slows all in it."""
    twins = again.drop_duplicates("record")
    twins = twins.assign(implementation=[name + timing.TWIN for name in twins.implementation])
    return [*controls(timing.apart(pandas.concat([rows, twins], ignore_index=True), column))]


def judged(table):
    """{"pairs", "false", "widest", "chance", "sound"} of `controls`: how many were decided though nothing differs, the ratio
    furthest from 1, and how likely so many are by chance."""
    pairs, false = len(table), int(table.decided.sum()) if len(table) else 0
    chance = float(special.bdtrc(false - 1, pairs, 1 - timing.CONFIDENCE)) if pairs else math.nan  # scipy.stats takes as long to load as all else
    widest = max(table.ratio, key=lambda one: abs(math.log(one))) if pairs else math.nan
    return {"pairs": pairs, "false": false, "widest": widest, "chance": chance, "sound": bool(pairs) and chance >= FALSE}


def said(table):
    """What `judged` finds, in words; "" without controls."""
    if not (found := judged(table))["pairs"]:
        return ""
    return (f"Controls, where nothing differs: {found['false']} of {found['pairs']} decided falsely"
            f"{'' if found['sound'] else '. More than chance allows: this run is no evidence'}.")


def disturbance(records):
    """{"processes", "disturbed", "steal", "mhz"} of timed records: how many tell whether others ran, in how many they did; the largest
    share of the processors that the host took; [least, largest] frequency. None where nothing tells it."""
    timed = [one for one in records if one.cell.get("timed") and one.done and (one.machine or one.cell["kind"] == "bench")]
    steal, mhz = ([one.machine[key] for one in timed if one.machine.get(key) is not None] for key in ("steal", "mhz"))
    return {"processes": len(timed), "disturbed": sum(map(timing.disturbed, timed)), "steal": max(steal, default=None),
            "mhz": [min(mhz), max(mhz)] if mhz else None}


def told(one):
    """What `disturbance` found, in words; "" where nothing was timed, or nothing is known of it."""
    if not one or not one["processes"]:
        return ""
    return (f"others ran on the processor in {one['disturbed']} of {one['processes']} timed processes"
            + ("" if one["steal"] is None else f"; the host took up to {100 * one['steal']:.1f} % of its time")
            + ("" if one["mhz"] is None else f"; {' to '.join(dict.fromkeys(f'{mhz:.0f}' for mhz in one['mhz']))} MHz"))
