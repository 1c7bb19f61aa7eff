# What was measured of a machine itself, beside the winners on it: rates of the processor, controls, and how long a step takes
# each library beside another machine.
import pandas
from scipy.stats import gmean

from analysis.core import records, schema
from analysis.core.controls import judged
from analysis.core.files import read_object
from analysis.core.registry import ANCHOR
from analysis.core.view import parts
from analysis.families import rule
from analysis.map import carry
from analysis.map.results import with_samples

RATES = {"vector_bytes": "widest vectors of the build, bytes", "flops_per_ns": "multiply-adds in the widest vectors, operations a ns",
         "divisions_per_ns": "divisions in the widest vectors, a ns",
         "add_ns": "latency of an addition, ns", "fused_ns": "latency of a multiply-add, ns", "divide_ns": "latency of a division, ns",
         "L1": "loads and stores in L1, bytes a ns", "L2": "in L2", "L3": "in L3", "memory": "in memory"}

PARTS = ("map", "families")  # that are merged
CONTROLLED = [part for part in parts() if "controls" in schema.of_part(part)]


def origins(studyset):
    """Digests of the records of each of PARTS; StudyError if its tables are of other ones."""
    for part in [part for part in PARTS if (studyset.folder / part / schema.DIGESTS).exists()]:
        yield schema.digest_of(schema.records_of(studyset.folder, part, studyset.facts["context"], drawn=True))


def rated(studyset):
    """The record of its `mbs limit`; None of a set without."""
    return next((one for one in records.read_part(studyset.folder, "limit") if one.role == "bounds" and "machine" in one.output), None)


def rates(studyset):
    """{name of RATES: value}, as `mbs limit` measured them; {} of a set without."""
    if not (found := rated(studyset)):
        return {}
    known = found.output["machine"]
    known |= {one["name"]: one["bytes_per_ns"] for one in known.get("levels", [])}
    return {name: known[name] for name in RATES if name in known}


def controls(studyset):
    """`judged` of all of a set's controls."""
    return judged(pandas.concat(table(studyset.folder, part, "controls") for part in CONTROLLED))


def of_seeds(studyset):
    """What timing.Paired takes of a scene with artificial fill: how far a ratio depends on where that lies, as the set's own map has found."""
    rows = table(studyset.folder, "map", "tidy")
    return carry.of_seeds(with_samples(rows[rows.kind == "seeds"]))


def no_evidence(studyset):
    """Why a set says nothing: its node's controls failed, or those of a part or of all, or its merged parts have none; "" if it may."""
    tables = {part: table(studyset.folder, part, "controls") for part in CONTROLLED}
    failed = [f"{one['false']} of {one['pairs']} A/A controls were decided, more than chance allows ({part})"
              for part, one in (("all parts", controls(studyset)), *((part, judged(one)) for part, one in tables.items()))
              if one["pairs"] and not one["sound"]]
    if not any(len(tables[part]) for part in PARTS) and {*PARTS} & {*studyset.facts["parts"]}:
        failed = ["it has no A/A controls"]
    return studyset.facts.get("no_evidence") or next(iter(failed), "")


def steps(sets, together=()):
    """Of each contender and scene of the families, in the penalty form, a step's time on each machine ÷ that on the first, where all timed it; of
    `together`: in scenes where all of these were."""
    rows = [table(one.folder, "families", "scenes").loc[lambda rows: (rows.status == "ok") & (rows.scheme == "penalty")] for one in sets]
    times = pandas.concat([one.set_index(["implementation", "scene"]).step_us for one in rows], axis=1, join="inner", keys=range(len(sets)))
    for name in together:
        times = times[times.index.isin(times.index[times.index.get_level_values(0) == name].get_level_values(1), level=1)]
    return times.div(times[0], axis=0)


def gains(sets, together=()):
    """{contender: [of each machine the geometric mean of `steps`]}. Means of two are over the same scenes only if both are in `together`."""
    return {name: [*gmean(one)] for name, one in steps(sets, together).groupby(level=0)}


def beside(sets):
    """{contender: (scenes that it shares with the ANCHOR, [its gain on each machine], [the ANCHOR's there])}, who gains most beside it first."""
    found, groups = {}, {name: one.droplevel(0) for name, one in steps(sets).groupby(level=0)}
    for name, one in groups.items():
        if shared := [scene for scene in one.index if ANCHOR in groups and scene in groups[ANCHOR].index]:
            found[name] = (len(shared), [*gmean(one.loc[shared])], [*gmean(groups[ANCHOR].loc[shared])])
    return dict(sorted(found.items(), key=lambda one: one[1][1][-1] / one[1][2][-1]))


def tables(folder, part):
    """{name: `table`} of a part."""
    return {name: table(folder, part, name) for name in schema.of_part(part)}


def table(folder, part, name):
    """A table of a set; empty where the set lacks the part, or is of an older schema without it."""
    kept = folder / part / schema.DIGESTS
    if kept.exists() and name in read_object(kept, tables=dict)["tables"]:
        return schema.read_table(folder, part, name)
    return schema.conform((), schema.of_part(part)[name], f"{part}/{name}.csv")


def carried(main, other):
    """What the rule of a set costs on the mechanisms of another one."""
    return rule.carried(*((tables(one.folder, "families"), one.registry) for one in (main, other)))
