# The bounds that this study has to hold, computed from the tidy tables.
import pandas

from analysis import paper
from analysis.claims_starting import analysis_of, fair_ratio
from analysis.compare import best_ratio, natural, profiled
from analysis.figures.t2_operations import table as table2
from analysis.loader import NULL, PHASES
from analysis.statistics import phase_shares, power_law_exponent
from analysis.tables import BEFORE_SINGULAR
from analysis.text import interval, number

[KLU] = paper.SYSTEMS["KLU"]
FASTER_THAN_STARTING = 3     # best library-backed sparse version against the starting one ...
STARTING_SIZES = (22, 82, 1000)  # ... at these sizes


def must_hold(results):
    """[{"claim", "subject", "note", "bound", "value", "holds"}]; value None where this profile
    does not measure it."""
    rows = [_share("outside factorization and solves, N = 40", KLU, results, 82, 0.40,
                   ("factorization", "solve")), _exponent(results, KLU)]
    rows += [_share("outside factorization, solves and tangent products, n = 22", name, results,
                    22, 0.30, ("factorization", "solve", "assembly"))
             for name in paper.dense(results) if not paper.starting(name)]
    rows += [_operation(results, operation) for operation in paper.TABLE2]
    rows += [_faster(results, size) for size in STARTING_SIZES]
    return rows + [_verified(results)]


def _row(claim, subject, bound, value, holds, note=""):
    return {"claim": claim, "subject": subject, "bound": bound, "value": value, "note": note,
            "holds": bool(holds)}


def _share(claim, name, results, size, bound, inside):
    mine, share = profiled(results, name, size), None
    if len(mine):
        shares = phase_shares(mine, PHASES)
        share = 1 - sum(shares[phase] for phase in inside)
    return _row(claim, name, f"≤ {100 * bound:.0f} %",
                None if share is None else f"{100 * share:.1f} %",
                share is not None and share <= bound)


def _exponent(results, name):
    samples = natural(results)
    mine = samples[(samples.implementation == name) & (samples.variables >= 100)]
    medians = mine.groupby("variables").step_us.median()
    value = power_law_exponent(medians.index, medians)
    passes = (mine.passes / mine.stretch_steps).groupby(mine.variables).median()
    note = "; ".join(f"n = {size:g}: {count:.2f}" for size, count in passes.items())
    return _row("exponent of the step time over n, n ≥ 100", name, "≤ 1.1",
                None if pandas.isna(value) else f"{value:.2f}", value <= 1.1,
                note and f"passes a step at {note}; {BEFORE_SINGULAR}")


def _operation(results, operation):
    """The largest ratio of one of Table 2's operations; where it misses the bound, what is slow."""
    quoted = paper.TABLE2[operation][2]
    rows = [row for row in table2(results) if row["operation"] == operation]
    claim = f"{paper.OPERATIONS[operation]}, not optimised ÷ optimised, at the best size"
    if not rows:
        return _row(claim, "", f"≥ {quoted}", None, False)
    best = max(rows, key=lambda row: row["ratio"].value)
    fair = fair_ratio(rows)
    holds = best["ratio"].value >= quoted
    note = (f"n = {best['variables']:g}; fair ratio, with the faster plain version, at most "
            f"{interval(fair['ratio'])}" if holds else
            f"n = {best['variables']:g}; the bound's alternative, an analysis: {analysis_of(rows)}")
    return _row(claim, f"{best['slow']} ÷ {best['fast']}", f"≥ {quoted}",
                number(best["ratio"].value), holds, note)


def _faster(results, size):
    claim = f"starting sparse ÷ best library-backed sparse, n = {size}"
    found = best_ratio(natural(results, size), [paper.STARTING["sparse"]],
                       paper.library_backed(results))
    if found is None:
        return _row(claim, paper.STARTING["sparse"], f"≥ {FASTER_THAN_STARTING}", None, False)
    return _row(claim, f"{found.slow} ÷ {found.fast}", f"≥ {FASTER_THAN_STARTING}",
                number(found.value), found.value >= FASTER_THAN_STARTING,
                f"interval {number(found.low)} to {number(found.high)}")


def _verified(results):
    """Every timed cell, alternatives too, has rows of the gate, and every check that ran passed."""
    tidy, table = results.tidy, results.verification
    timed = tidy[(tidy.kind == "timing") & (tidy.status == "ok") & (tidy.implementation != NULL)]
    timed = timed[["scene", "implementation"]].drop_duplicates()
    ran = table[table.passed != ""].groupby(["scene", "implementation"]).passed
    clean = {cell for cell, passed in ran if (passed == "True").all()}
    passed = sum(tuple(cell) in clean for cell in timed.values)
    return _row("timed cells that passed every check of the gate", "all", f"{len(timed)}",
                f"{passed}" if len(timed) else None, passed == len(timed))
