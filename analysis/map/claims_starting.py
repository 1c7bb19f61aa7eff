# Claims about the starting versions and the symbolic preprocessing: T1, T2, C2.
from analysis.core.timing import PHASES, rank, ratio, student
from analysis.map import paper
from analysis.map.ledger import Rule, compared, factor, judged, unmeasured
from analysis.map.results import Versus, with_samples

MAIN_SHARE = 10   # %; smaller shares of Table 1 get no row
SHARE_BAND = 10   # points around the paper's share that still confirm it
PROCESSES = 6     # of a cell, that an interval of shares needs
C2_SIZES = {22: 2, 1000: 3}  # the paper: "from 2 (small problems) to 3 (1,000 variables)"


def table1(results):
    """T1. Rule: our share within SHARE_BAND points of the paper's."""
    found, profiled = [], results.tidy[(results.tidy.kind == "phases") & (results.tidy.status == "ok")]
    for (kind, size), quoted in paper.TABLE1.items():
        name = paper.STARTING[kind]
        cell = profiled[(profiled.implementation == name) & (profiled.variables == size)]
        what = f"{len(cell)} process{'es' if len(cell) > 1 else ''} of {name} profiled" if len(cell) else f"{name} not profiled"
        for (group, phases), share in zip(paper.GROUPS.items(), quoted):
            head = "T1", f"starting {kind} version, {size} variables: {group} takes {share} % of the time", f"{share} %"
            rule = Rule(share - SHARE_BAND, share + SHARE_BAND)
            if share >= MAIN_SHARE and len(cell) < PROCESSES:
                found.append(unmeasured(head, f"{what} at n = {size}; an interval needs {PROCESSES}.", rule, " %"))
            elif share >= MAIN_SHARE:
                mine, whole = (cell[[f"phase_{phase}" for phase in some]].sum(axis=1) for some in (phases, PHASES))
                middle, half, *_ = student(100 * mine / whole)
                found.append(judged(head, [(f"n = {size}", (middle, middle - half, middle + half), " ".join(cell.record))], rule, name, " %"))
    return found


def table2_claims(results):
    """T2. Rule: a variant that is not optimised, over the fastest optimised one, within the band around the paper's ratio;
    a row an operation and such a variant, judged at every size."""
    rows, plain = [], [name for name in results.variants if name.split("/")[0] == paper.NOT_OPTIMISED]
    for operation, (before, after, quoted) in paper.TABLE2.items():
        claim = f"symbolic preprocessing makes the {paper.OPERATIONS[operation]} {quoted} times faster"
        quote = f"{quoted}× ({before} → {after} ms)"
        found = {slow: ratios for slow in plain if (ratios := _gains(results, operation, slow))}
        rows += [compared(("T2", f"{claim} ({slow})", quote), ratios, factor(quoted)) for slow, ratios in found.items()]
        if not found:
            rows.append(unmeasured(("T2", claim, quote), "The operations alone were not timed in this run.", factor(quoted)))
    return rows


def _gains(results, operation, slow):
    """[Versus] by size, of the times of a call: to the fastest optimised variant that stores as much, both halves of the symmetric
    matrices, as those for unsymmetric solvers do, or one."""
    rows, found = results.tidy, []
    rows = rows[(rows.kind == "operations") & (rows.status == "ok") & (rows.operation == operation)]
    both_halves = lambda name: results.variants[name].get("unsymmetric", False)
    alike = [name for name in paper.sparse(results) if both_halves(name) == both_halves(slow)]
    for (size, _), cell in with_samples(rows).groupby(["variables", "scene"]):
        ranking = rank(cell, alike)
        one = ranking and ratio(cell, slow, ranking.winner)
        if one and one.value == one.value:
            found.append(Versus(one.value, one.low, one.high, slow, ranking.winner, size, 0.0, cell[cell.implementation == slow].record.iloc[0]))
    return found


def starting_sparse(results):
    """C2. Rule: starting ÷ best optimised sparse within the band around the paper's factor."""
    return [compared(("C2", f"the best sparse version beats the starting one {quoted} times ({size} variables)", f"{quoted}×"),
                     results.over_sizes([paper.STARTING["sparse"]], paper.sparse(results), size, size), factor(quoted),
                     f"n = {size} lacks samples of {paper.STARTING['sparse']} or of an optimised one.") for size, quoted in C2_SIZES.items()]
