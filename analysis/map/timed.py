# Which processes of a timed scene count, and whose stretch took another number of passes.
import math
from collections import Counter
from dataclasses import replace

from analysis.core.registry import NULL
from analysis.core.timing import processes

ROLES = ("time", "time-left-out", "again")
AFTER = 100  # added to the numbers of the processes of role "again"


def layers(registry):
    """{layer: names of the variants that are ranked in it}; own code and libraries are two layers of every result."""
    return {"libraries": registry.libraries, "all": list(registry.variants)}


def timed_rows(records):
    """Rows as `analysis.core.timing.processes` gives them, of the timed scenes among `records`. Who ended a process or
    differed was left out, and the others were measured again: the smallest group of contenders counts."""
    chosen = [one for one in records if one.role in ROLES]
    least = {}
    for one in chosen:
        key = _group(one)
        least[key] = min(len(one.cell["contenders"]), least.get(key, math.inf))
    return processes([_numbered(one) for one in chosen
                      if one.role == "time-left-out" or len(one.cell["contenders"]) == least[_group(one)]])


def _group(record):
    return record.cell["scene"], record.cell["environment"], record.role


def _numbered(record):
    if record.role != "again":
        return record
    return replace(record, cell=record.cell | {"number": AFTER + record.cell["number"]})


def differing(rows):
    """{name: reason} of one scene: the passes over its stretch must be equal. The most common number among ranked
    contenders (others are copies of one code) stands; without one nobody can be trusted."""
    totals = {}
    for row in rows[(rows.status == "ok") & (rows.implementation != NULL)].itertuples():
        totals.setdefault(row.implementation, set()).add(row.passes)
    votes = Counter(min(values) for name, values in totals.items() if len(values) == 1 and "+" not in name)
    ranked = votes.most_common(2)
    tie = bool(totals) and (not ranked or len(ranked) > 1 and ranked[0][1] == ranked[1][1])
    right = None if tie or not ranked else ranked[0][0]
    return {name: f"{_text(values)} passes over the stretch, most others {_text({right})}" if right is not None else
            f"{_text(values)} passes over the stretch, and no number is that of most"
            for name, values in totals.items() if values != {right}}


def _text(values):
    return "/".join(f"{value:.0f}" for value in sorted(values))
