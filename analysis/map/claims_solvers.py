# Claims about solvers at the mechanism's own fill: F4, C1, C4.
from analysis.core.text import number
from analysis.map import paper
from analysis.map.results import COVERED
from analysis.map.ledger import INCOMPARABLE, UNDECIDED, Rule, at_least, compared, factor, judged, of, row, unmeasured

FIGURE4 = 160        # variables; the last of Figure 4
CHOLMOD_OF_KLU = 85  # %, of KLU's speed
SPEED_BAND = 10      # points around it that still confirm it
PIVOTING = 1.5       # times the cost of refactor
ERROR_GROWS = 2      # times larger position error that counts as accumulated
C4_SIZES = {10: 1.5, 50: 5}


def solvers(results):
    """F4. Rules, at every size: the best of CHOLMOD, WSMP and SuperLU ÷ KLU above 1; KLU ÷ CHOLMOD within SPEED_BAND;
    WSMP ÷ CHOLMOD and SuperLU ÷ WSMP above 1."""
    klu, cholmod, wsmp, superlu = (paper.members(results, one) for one in ("KLU", "CHOLMOD", "WSMP", "SuperLU"))
    others = list(dict.fromkeys(cholmod + wsmp + superlu))
    return [_fastest(results, klu, others, 0, FIGURE4), _fastest(results, klu, others, FIGURE4 + 1, 1000),
            _share_of_speed(results, klu, cholmod), _behind(results, "WSMP", wsmp, "CHOLMOD", cholmod),
            _behind(results, "SuperLU", superlu, "WSMP", wsmp)]


def _needed(pair):
    return f"{pair} were not both timed at {COVERED} to {FIGURE4} variables."


def _fastest(results, klu, others, low, high):
    span = f"to {high} variables" if low == 0 else f"from {low} to {high} variables"
    found = results.over_sizes(others, klu, low, high, COVERED)
    return compared(("F4", f"KLU with refactor is the fastest sparse solver, {span}", "fastest"), found, at_least(1),
                    f"KLU and another of the paper's solvers were not both timed at {max(low, COVERED)} variables or more.")


def _share_of_speed(results, klu, cholmod):
    head = "F4", f"CHOLMOD performs at {CHOLMOD_OF_KLU} % of KLU", f"{CHOLMOD_OF_KLU} %"
    rule = Rule(CHOLMOD_OF_KLU - SPEED_BAND, CHOLMOD_OF_KLU + SPEED_BAND)
    found = results.over_sizes(klu, cholmod, high=FIGURE4, reaching=COVERED)
    if not found:
        return unmeasured(head, _needed("KLU and CHOLMOD"), rule, " %")
    cases = [(f"n = {one.size:g}", [100 * value for value in of(one)], one.record) for one in found]
    return judged(head, cases, rule, f"KLU ÷ {', '.join(dict.fromkeys(one.fast for one in found))}", " %")


def _behind(results, slow_system, slow, fast_system, fast):
    head = "F4", f"{slow_system} is slower than {fast_system}", "slower"
    both = sorted(set(slow) & set(fast))
    if any(results.fastest(results.natural(size), slow) in both for size in results.sizes if size <= FIGURE4):
        return row(head, INCOMPARABLE, f"{', '.join(both)} stands for both, and is {slow_system}'s fastest stand-in.", at_least(1).text("×"))
    return compared(head, results.over_sizes(slow, fast, high=FIGURE4, reaching=COVERED), at_least(1),
                    _needed(f"{slow_system}'s and {fast_system}'s stand-ins"))


def pivoting(results):
    """C1. Rules: full pivoting ÷ refactor within the band around PIVOTING at every size; position error of refactor ÷ that
    of full pivoting at least ERROR_GROWS in some scene."""
    klu, full = paper.SYSTEMS["KLU"][0], paper.FULL_PIVOTING
    return [compared(("C1", "KLU with full pivoting costs 50 % more than with refactor", f"{PIVOTING}×"),
                     results.over_sizes([full], [klu], reaching=COVERED), factor(PIVOTING),
                     f"{full} and {klu} were not both timed at {COVERED} variables or more."), _stale_pivots(results, klu, full)]


def _stale_pivots(results, klu, full):
    head, rule = ("C1", "stale pivots may accumulate error when entries change violently", "may"), at_least(ERROR_GROWS)
    errors = results.samples().groupby(["implementation", "scene"]).position_error.median()
    if klu not in errors.index or full not in errors.index:
        return unmeasured(head, f"{klu} and {full} were not both timed.", rule)
    shares = (errors[klu] / errors[full]).dropna()
    if shares.empty:
        return unmeasured(head, "No scene has a position error of both.", rule)
    scene, largest = shares.idxmax(), shares.max()
    if largest < ERROR_GROWS:  # nothing is refuted: the mechanism has no violent change
        return row(head, UNDECIDED, "Nothing changes violently here.", rule.text("×"),
                   f"Error at the end of the stretch: at most {number(largest, 5)}× over {len(shares)} scenes. What pivots forced off the diagonal "
                   "lose is a question of the part extremes.")
    record = " ".join(results.rows(scene).set_index("implementation").record[[klu, full]].unique())
    return judged(head, [(scene, (largest,) * 3, record)], rule, f"{klu} ÷ {full}")


def sparse_against_dense(results):
    """C4. Rule: best dense, on any pair, ÷ best sparse within the band around the paper's factor."""
    return [compared(("C4", f"sparse beats dense {quoted} times at {size} variables", f"{quoted}×"),
                     results.over_sizes(paper.dense(results), paper.sparse(results), size, size), factor(quoted),
                     f"Dense and sparse versions were not both timed at n = {size}.") for size, quoted in C4_SIZES.items()]
