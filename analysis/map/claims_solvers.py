# Claims about solvers at the mechanism's own fill: F4, C1, C4.
from analysis.core.text import number
from analysis.map import paper
from analysis.map.compare import best, extreme, over_sizes, versus
from analysis.map.explain import difference
from analysis.map.ledger import at_least, compared, of, tested, undecided, unmeasured

FIGURE4 = 160        # variables; the last of Figure 4
COVERED = 82         # variables that a run has to reach to speak of Figure 4
CHOLMOD_OF_KLU = 85  # %, of KLU's speed
SPEED_BAND = 10      # points around it that still confirm it
PIVOTING_BAND = 0.25  # around 1.5: half of the effect
ERROR_GROWS = 2      # times larger position error that counts as accumulated
C4_SIZES = {10: 1.5, 50: 5}
_NEEDED = f"No size from {COVERED} to {FIGURE4} variables has both "


def solvers(results):
    """F4. Rules: the best of CHOLMOD, WSMP and SuperLU ÷ KLU above 1 at its worst size; KLU ÷ CHOLMOD within SPEED_BAND;
    WSMP ÷ CHOLMOD and SuperLU ÷ WSMP above 1."""
    klu, wsmp = paper.members(results, "KLU"), paper.members(results, "WSMP")
    cholmod = [name for name in paper.members(results, "CHOLMOD") if name not in wsmp]
    superlu = paper.members(results, "SuperLU")
    others = cholmod + wsmp + superlu
    return [_fastest(results, klu, others, 0, FIGURE4), _fastest(results, klu, others, FIGURE4 + 1, 1000),
            _share_of_speed(results, klu, cholmod), _behind(results, "WSMP", wsmp, "CHOLMOD", cholmod),
            _behind(results, "SuperLU", superlu, "WSMP", wsmp)]


def _fastest(results, klu, others, low, high):
    span = f"to {high} variables" if low == 0 else f"from {low} to {high} variables"
    head = "F4", f"KLU with refactor is the fastest sparse solver, {span}", "fastest"
    found = over_sizes(results, others, klu, low, high)
    if not found or found[-1].size < COVERED:
        return unmeasured(head, f"KLU and another of the paper's solvers were not both timed at {COVERED} variables or more.",
                        at_least(1))
    worst = extreme(found, min)
    led = sum(one.low > 1 for one in found)
    today = results.rank(results.natural(worst.size), paper.sparse(results))
    why = (f"Second ÷ KLU at its worst size; KLU is shown to lead at {led} of {len(found)} sizes. Of all sparse solvers of libraries "
           f"{today.winner} has the least time there, {'decided' if today.decided else 'not decided'}. {difference(results, worst.slow, worst.fast, worst.size)}")
    return compared(head, worst, at_least(1), why)


def _last(results, slow, fast):
    """Versus at the largest size of Figure 4 that has both; None if none from COVERED on has."""
    return next(iter(over_sizes(results, slow, fast, COVERED, FIGURE4)[::-1]), None)


def _share_of_speed(results, klu, cholmod):
    head = "F4", f"CHOLMOD performs at {CHOLMOD_OF_KLU} % of KLU", f"{CHOLMOD_OF_KLU} %"
    rule = CHOLMOD_OF_KLU - SPEED_BAND, CHOLMOD_OF_KLU + SPEED_BAND
    found = _last(results, klu, cholmod)
    if found is None:
        return unmeasured(head, f"{_NEEDED}KLU and CHOLMOD timed.", rule, " %")
    why = (f"KLU's time ÷ CHOLMOD's at the end of Figure 4; at other sizes "
           f"{_other_sizes(results, klu, cholmod, found.size, 100, ' %')}. "
           f"{difference(results, found.fast, found.slow, found.size)}")
    return tested(head, [100 * value for value in of(found)], rule, found.where, why, " %", found.record)


def _other_sizes(results, slow, fast, size, factor=1, unit="×"):
    return ", ".join(f"{number(factor * one.value)}{unit} (n = {one.size:g})" for one in over_sizes(results, slow, fast)
                     if one.size != size) or "not timed"


def _behind(results, slow_system, slow, fast_system, fast):
    head = "F4", f"{slow_system} is slower than {fast_system}", "slower"
    found = _last(results, slow, fast)
    if found is None:
        return unmeasured(head, f"{_NEEDED}{slow_system}'s and {fast_system}'s stand-ins timed.", at_least(1))
    return compared(head, found, at_least(1), difference(results, found.slow, found.fast, found.size))


def pivoting(results):
    """C1. Rules: full pivoting ÷ refactor within PIVOTING_BAND of 1.5; position error of refactor ÷ that of full pivoting
    at least ERROR_GROWS in some scene, or refactor alone fails."""
    klu, full = paper.SYSTEMS["KLU"][0], paper.FULL_PIVOTING
    found = _last(results, [full], [klu])
    head = "C1", "KLU with full pivoting costs 50 % more than with refactor", "1.5×"
    rule = 1.5 - PIVOTING_BAND, 1.5 + PIVOTING_BAND
    if found is None:
        first = unmeasured(head, f"{_NEEDED}{full} and {klu} timed.", rule)
    else:
        guarded = versus(results, results.natural(found.size), paper.GUARDED, klu)
        price = f" Pivoting only when needed ({paper.GUARDED}) costs {number(guarded.value)}×." if guarded else ""
        first = compared(head, found, rule, f"{difference(results, found.slow, found.fast, found.size)} Other sizes: "
                         f"{_other_sizes(results, [full], [klu], found.size)}.{price}")
    return [first, _stale_pivots(results, klu, full)]


def _stale_pivots(results, klu, full):
    head, rule = ("C1", "stale pivots may accumulate error when entries change violently", "may"), at_least(ERROR_GROWS)
    samples = results.samples()
    lost = [scene for scene in samples[samples.implementation == full].scene.unique() if results.failed(scene, [klu])]
    if lost:
        rows = results.rows(lost[0])
        reason = rows[(rows.implementation == klu) & (rows.status != "ok")].reason.iloc[0]
        return undecided(head, "Times do not tell whether pivots are the cause.", rule,
                         f"Full pivoting was timed where {klu} failed ({lost[0]}: {reason}).")
    errors = samples.groupby(["implementation", "scene"]).position_error.median()
    if klu not in errors.index or full not in errors.index:
        return unmeasured(head, f"{klu} and {full} were not both timed.", rule)
    shares = (errors[klu] / errors[full]).dropna()
    if shares.empty:
        return unmeasured(head, "No scene has a position error of both.", rule)
    scene, largest = shares.idxmax(), shares.max()
    why = (f"Error at the end of the stretch, {klu} ÷ {full}: at most {number(largest, 5)} over {len(shares)} scenes ({scene}).")
    if largest < ERROR_GROWS:  # nothing is refuted: the mechanism has no violent change
        return undecided(head, "Nothing changes violently here.", rule,
                         f"{why} The tangent of this mechanism is positive definite and its pivots stay diagonal: both are equally "
                         "exact. What pivots forced off the diagonal lose is a question of the part extremes.")
    return tested(head, (largest,) * 3, rule, f"{scene}, {klu} ÷ {full}", why,
                  record=" ".join(results.rows(scene).set_index("implementation").record[[klu, full]].unique()))


def sparse_against_dense(results):
    """C4. Rule: best dense, on any pair, ÷ best sparse at least the paper's factor."""
    rows = []
    for size, quoted in C4_SIZES.items():
        head = "C4", f"sparse beats dense {quoted} times at {size} variables", f"{quoted}×"
        found = best(results, results.natural(size), paper.dense(results, pairs=True), paper.sparse(results))
        rows.append(unmeasured(head, f"Dense and sparse versions were not both timed at n = {size}.", at_least(quoted))
                    if found is None else
                    compared(head, found, at_least(quoted), difference(results, found.slow, found.fast, size)))
    return rows
