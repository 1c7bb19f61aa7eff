# Claims about solvers at the mechanism's own fill: F4, C1, C4.
from analysis import paper
from analysis.compare import best_ratio, fastest, natural, ratio
from analysis.explain import difference
from analysis.ledger import at_least, of, tested, untested
from analysis.loader import FAILURES
from analysis.text import number

FIGURE4 = 160        # variables; the last of Figure 4
COVERED = 82         # variables that a run has to reach to speak of Figure 4
CHOLMOD_OF_KLU = 85  # %, of KLU's speed
SPEED_BAND = 10      # points around it that still confirm it
PIVOTING_BAND = 0.25  # around 1.5: half of the effect
ERROR_GROWS = 2      # times larger position error that counts as accumulated
C4_SIZES = {10: 1.5, 50: 5}
_NEEDED = f"No size from {COVERED} to {FIGURE4} variables has both "


def solvers(results):
    """F4. Rules: the best of CHOLMOD, WSMP and SuperLU ÷ KLU above 1 at its worst size; KLU ÷
    CHOLMOD within SPEED_BAND; WSMP ÷ CHOLMOD and SuperLU ÷ WSMP above 1."""
    klu = paper.members(results, "KLU")
    wsmp = paper.members(results, "WSMP")
    cholmod = [name for name in paper.members(results, "CHOLMOD") if name not in wsmp]
    superlu = paper.members(results, "SuperLU")
    others = cholmod + wsmp + superlu
    return [_fastest(results, klu, others, 0, FIGURE4),
            _fastest(results, klu, others, FIGURE4 + 1, 1000),
            _share_of_speed(results, klu, cholmod),
            _behind(results, "WSMP", wsmp, "CHOLMOD", cholmod),
            _behind(results, "SuperLU", superlu, "WSMP", wsmp)]


def _fastest(results, klu, others, low, high):
    span = f"to {high} variables" if low == 0 else f"from {low} to {high} variables"
    head = ("F4", f"KLU with refactor is the fastest sparse solver, {span}", "fastest")
    samples = natural(results)
    samples = samples[samples.variables.between(low, high)]
    found = [best_ratio(of_size, others, klu) for _, of_size in samples.groupby("variables")]
    found = [entry for entry in found if entry]
    if not found or found[-1].size < COVERED:
        return untested(*head, "KLU and another of the paper's solvers were not both timed at "
                        f"{COVERED} variables or more.", at_least(1))
    worst = min(found, key=lambda entry: entry.value)
    led = sum(entry.low > 1 for entry in found)
    today = fastest(samples[samples.variables == worst.size], paper.sparse(results))
    why = (f"Second ÷ KLU at its worst size; KLU leads at {led} of {len(found)} sizes. The fastest "
           f"of all sparse versions there is {today}. "
           f"{difference(results, worst.slow, worst.fast, worst.size)}")
    return tested(*head, of(worst), at_least(1), _where(worst), why)


def _last(results, slow, fast):
    """Ratio at the largest size of Figure 4 that has both; None if none from COVERED on has."""
    samples = natural(results)
    inside = samples.variables[samples.variables.between(COVERED, FIGURE4)]
    for size in sorted(inside.unique(), reverse=True):
        found = best_ratio(samples[samples.variables == size], slow, fast)
        if found:
            return found
    return None


def _share_of_speed(results, klu, cholmod):
    claim = f"CHOLMOD performs at {CHOLMOD_OF_KLU} % of KLU"
    head = "F4", claim, f"{CHOLMOD_OF_KLU} %"
    rule = CHOLMOD_OF_KLU - SPEED_BAND, CHOLMOD_OF_KLU + SPEED_BAND
    found = _last(results, klu, cholmod)
    if found is None:
        return untested(*head, f"{_NEEDED}KLU and CHOLMOD timed.", rule, " %")
    why = (f"KLU's time ÷ CHOLMOD's at the end of Figure 4; at other sizes "
           f"{_other_sizes(results, klu, cholmod, found.size, 100, ' %')}. "
           f"{difference(results, found.fast, found.slow, found.size)}")
    return tested(*head, [100 * value for value in of(found)], rule, _where(found), why, " %")


def _other_sizes(results, slow, fast, size, factor=1, unit="×"):
    samples = natural(results)
    found = [best_ratio(rows, slow, fast) for other, rows in samples.groupby("variables")
             if other != size]
    return ", ".join(f"{number(factor * entry.value)}{unit} (n = {entry.size:g})"
                     for entry in found if entry) or "not timed"


def _behind(results, slow_system, slow, fast_system, fast):
    head = ("F4", f"{slow_system} is slower than {fast_system}", "slower")
    found = _last(results, slow, fast)
    if found is None:
        return untested(*head, f"{_NEEDED}{slow_system}'s and {fast_system}'s stand-ins "
                        "timed.", at_least(1))
    why = f"{difference(results, found.slow, found.fast, found.size)}"
    return tested(*head, of(found), at_least(1), _where(found), why)


def pivoting(results):
    """C1. Rules: full pivoting ÷ refactor within PIVOTING_BAND of 1.5; position error of refactor
    ÷ that of full pivoting at least ERROR_GROWS in some scene, or refactor alone fails."""
    klu = paper.SYSTEMS["KLU"][0]
    found = _last(results, [paper.FULL_PIVOTING], [klu])
    head = "C1", "KLU with full pivoting costs 50 % more than with refactor", "1.5×"
    rule = 1.5 - PIVOTING_BAND, 1.5 + PIVOTING_BAND
    if found is None:
        first = untested(*head, f"{_NEEDED}{paper.FULL_PIVOTING} and {klu} timed.", rule)
    else:
        guarded = ratio(natural(results, found.size), paper.GUARDED, klu)
        price = f" Pivoting only when needed ({paper.GUARDED}) costs {number(guarded.value)}×." \
            if guarded else ""
        sizes = _other_sizes(results, [paper.FULL_PIVOTING], [klu], found.size)
        first = tested(*head, of(found), rule, _where(found),
                       f"{difference(results, found.slow, found.fast, found.size)} Other sizes: "
                       f"{sizes}.{price}")
    return [first, _stale_pivots(results, klu)]


def _stale_pivots(results, klu):
    head = ("C1", "stale pivots may accumulate error when entries change violently", "may")
    rule = at_least(ERROR_GROWS)
    tidy = results.tidy
    failed = tidy[tidy.status.isin(FAILURES) & (tidy.implementation == klu)]
    firm = results.samples()[lambda rows: rows.implementation == paper.FULL_PIVOTING]
    lost = failed[failed.scene.isin(firm.scene)]
    errors = results.samples().groupby(["implementation", "scene"]).position_error.median()
    if len(lost):
        return untested(*head, f"Full pivoting was timed where {klu} failed "
                        f"({lost.scene.iloc[0]}: {lost.reason.iloc[0]}); whether its pivots are "
                        "the cause cannot be told from times.", rule)
    if klu not in errors.index or paper.FULL_PIVOTING not in errors.index:
        return untested(*head, f"{klu} and {paper.FULL_PIVOTING} were not both timed.", rule)
    shares = (errors[klu] / errors[paper.FULL_PIVOTING]).dropna()
    if shares.empty:
        return untested(*head, "No scene has a position error of both.", rule)
    scene, largest = shares.idxmax(), shares.max()
    why = (f"Error at the end of the stretch, {klu} ÷ {paper.FULL_PIVOTING}: at most "
           f"{number(largest, 5)} over {len(shares)} scenes ({scene}).")
    if largest < ERROR_GROWS:  # nothing is refuted: the mechanism has no violent change
        return untested(*head, f"{why} The tangent of this mechanism is positive definite and its "
                        "pivots stay diagonal: both are equally exact. What pivots forced off the "
                        "diagonal lose, the program csc_klu_stale_pivots shows "
                        "(implementations/csc_klu/README.md).", rule)
    return tested(*head, (largest,) * 3, rule, f"{scene}, {klu} ÷ {paper.FULL_PIVOTING}", why)


def sparse_against_dense(results):
    """C4. Rule: best dense ÷ best sparse at least the paper's factor."""
    rows = []
    for size, quoted in C4_SIZES.items():
        head = ("C4", f"sparse beats dense {quoted} times at {size} variables", f"{quoted}×")
        found = best_ratio(natural(results, size), paper.dense(results), paper.sparse(results))
        if found is None:
            why = f"Dense and sparse versions were not both timed at n = {size}."
            rows.append(untested(*head, why, at_least(quoted)))
        else:
            rows.append(tested(*head, of(found), at_least(quoted), _where(found),
                               difference(results, found.slow, found.fast, size)))
    return rows


def _where(found):
    return f"n = {found.size:g}, {found.slow} ÷ {found.fast}"
