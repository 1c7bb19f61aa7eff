# Claims about the starting versions and the symbolic preprocessing: T1, T2, C2.
import numpy

from analysis.core.statistics import phase_shares, power_law_exponent
from analysis.core.text import interval, number
from analysis.map import paper
from analysis.map.compare import difference, group_shares, over_sizes, profiled, share_interval, split
from analysis.map.ledger import Rule, compared, factor, judged, unmeasured
from analysis.map.operations import not_optimised, table as table2
from analysis.map.tidy import PHASES

MAIN_SHARE = 10   # %; smaller shares of Table 1 get no row
SHARE_BAND = 10   # points around the paper's share that still confirm it
PROCESSES = 6     # of a cell, that an interval of shares needs
SAME_GROWTH = 0.5  # exponents closer than this: the ratio does not depend on the size
C2_SIZES = {22: 2, 1000: 3}  # the paper: "from 2 (small problems) to 3 (1,000 variables)"


def table1(results):
    """T1. Rule: our share within SHARE_BAND points of the paper's."""
    return [_share(results, kind, size, group, phases, share)
            for (kind, size), quoted in paper.TABLE1.items()
            for (group, phases), share in zip(paper.GROUPS.items(), quoted) if share >= MAIN_SHARE]


def _share(results, kind, size, group, phases, share):
    name = paper.STARTING[kind]
    cell = profiled(results, name, size)
    head = "T1", f"starting {kind} version, {size} variables: {group} takes {share} % of the time", f"{share} %"
    rule = Rule(share - SHARE_BAND, share + SHARE_BAND)
    if len(cell) < PROCESSES:
        what = f"{len(cell)} process{'es' if len(cell) > 1 else ''} of {name} profiled" if len(cell) else f"{name} not profiled"
        return unmeasured(head, f"{what} at n = {size}; an interval needs {PROCESSES}.", rule, " %")
    shares = phase_shares(cell, PHASES)
    inside = ", ".join(f"{phase} {100 * shares[phase]:.0f} %" for phase in phases)
    return judged(head, [(f"n = {size}", [100 * value for value in share_interval(cell, phases)], " ".join(cell.record))], rule, name,
                  f"{split(results, name, size)} This group: {inside}. {_against_paper(cell, kind, size)}", " %")


def _against_paper(cell, kind, size):
    """The groups that differ most from the paper's shares, upwards and downwards."""
    ours = group_shares(cell, paper.GROUPS)
    apart = {group: 100 * ours[group] - quoted for group, quoted in zip(paper.GROUPS, paper.TABLE1[kind, size])}
    more, less = max(apart, key=apart.get), min(apart, key=apart.get)
    return (f"Against the paper most time moved from {less} ({-apart[less]:.0f} points less) to {more} "
            f"({apart[more]:.0f} points more).")


def table2_claims(results):
    """T2. Rule: a variant that is not optimised, over the fastest optimised one, within the band around the paper's ratio;
    a row an operation and such a variant, judged at every size."""
    rows, found = [], table2(results)
    for operation, (before, after, quoted) in paper.TABLE2.items():
        mine = [row for row in found if row["operation"] == operation]
        claim = f"symbolic preprocessing makes the {paper.OPERATIONS[operation]} {quoted} times faster"
        quote = f"{quoted}× ({before} → {after} ms)"
        for slow in [name for name in not_optimised(results) if any(row["slow"] == name for row in mine)]:
            ratios = [row["ratio"] for row in mine if row["slow"] == slow]
            listed = ", ".join(f"{interval(one)} at n = {one.size:g}" for one in ratios)
            rows.append(compared(("T2", f"{claim} ({slow})", quote), ratios, factor(quoted), f"{listed}. {analysis_of(mine)}"))
        if not mine:
            rows.append(unmeasured(("T2", claim, quote), "The operations alone were not timed in this run.", factor(quoted)))
    return rows


def analysis_of(rows):
    """Which part of a plain operation is slow: how its variants and the optimised one grow with n, and how far the variants
    are apart. `rows`: of one operation."""
    exponents = {name: _growth(rows, name) for name in dict.fromkeys(row["slow"] for row in rows)}
    at_sizes = {row["variables"]: row["fast_us"] for row in rows}
    optimised = power_law_exponent(list(at_sizes), list(at_sizes.values()))
    if numpy.isnan(optimised):
        return ""
    grown = ", ".join(f"{name} as n^{power:.1f}" for name, power in exponents.items())
    text = f"Time grows as n^{optimised:.1f} optimised, {grown}"
    if max(exponents.values()) - optimised <= SAME_GROWTH:
        return f"{text}: the gain is a factor an entry, alike at all sizes.{_variants(rows)}"
    return (f"{text}: work that grows faster than the non-zeros is what is slow, so the ratio depends on the size, which the "
            f"paper does not state{_passing(rows)}.{_variants(rows)}")


def _growth(rows, name):
    mine = [row for row in rows if row["slow"] == name]
    return power_law_exponent([row["variables"] for row in mine], [row["slow_us"] for row in mine])


def _passing(rows):
    """The size at which the largest ratio passes the paper's, by interpolation of logarithms."""
    largest, quoted = {}, rows[0]["paper"]
    for row in rows:
        largest[row["variables"]] = max(row["ratio"].value, largest.get(row["variables"], 0))
    sizes = sorted(largest)
    for left, right in zip(sizes, sizes[1:]):
        if (largest[left] < quoted) != (largest[right] < quoted):
            logs = numpy.log([largest[left], largest[right], quoted, left, right])
            share = (logs[2] - logs[0]) / (logs[1] - logs[0])
            return f"; it passes {quoted} near n = {number(numpy.exp(logs[3] + share * (logs[4] - logs[3])), 2)}"
    return ""


def _variants(rows):
    """How far the plain variants are apart at the largest size."""
    size = max(row["variables"] for row in rows)
    times = {row["slow"]: row["slow_us"] for row in rows if row["variables"] == size}
    slow, fast = max(times, key=times.get), min(times, key=times.get)
    if times[slow] < 1.5 * times[fast]:
        return ""
    return (f" Written as in {fast} the same operation takes 1/{number(times[slow] / times[fast], 2)} of the time of {slow} at "
            f"n = {size:g}: how the library walks its matrices is slow, not the arithmetic.")


def starting_sparse(results):
    """C2. Rule: starting ÷ best optimised sparse within the band around the paper's factor."""
    return [compared(("C2", f"the best sparse version beats the starting one {quoted} times ({size} variables)", f"{quoted}×"),
                     over_sizes(results, [paper.STARTING["sparse"]], paper.sparse(results), size, size), factor(quoted),
                     lambda found: f"{difference(results, found.slow, found.fast, found.size)} MUMPS stands for MA27: what it costs a call, "
                                   "whatever the size, is its own.",
                     f"n = {size} lacks samples of {paper.STARTING['sparse']} or of an optimised one.") for size, quoted in C2_SIZES.items()]
