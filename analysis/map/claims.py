# Claims about versions and solvers at the mechanism's own fill: T1, T2, F2, F4, C1 to C5.
from analysis.core.registry import ANCHOR
from analysis.core.text import number
from analysis.core.timing import PHASES, rank, ratio, student
from analysis.map import paper
from analysis.map.ledger import INCOMPARABLE, UNDECIDED, Rule, compared, factor, judged, row, unmeasured
from analysis.map.results import COVERED, Versus, with_samples

FIGURES_END = 160    # variables; Figures 2 and 4 end here
MAIN_SHARE = 10      # %; smaller shares of Table 1 get no row
SHARE_BAND = 10      # points around the paper's share that still confirm it
PROCESSES = 6        # of a cell, that an interval of shares needs
DENSE_GAIN = 2, 3    # "a factor of 2-3 compared with our starting implementations" (abstract)
CHOLMOD_OF_KLU = 85  # %, of KLU's speed
SPEED_BAND = 10      # points around it that still confirm it
PIVOTING = 1.5       # times the cost of refactor
ERROR_GROWS = 2      # times larger position error that counts as accumulated
C2_SIZES = {22: 2, 1000: 3}  # the paper: "from 2 (small problems) to 3 (1,000 variables)"
TUNED_GAIN = 5       # %, still "only 2-3 %"
C4_SIZES = {10: 1.5, 50: 5}
ORDER_OF_MAGNITUDE = 10  # %, of the spread between implementations


def table1(results):
    """T1. Rule: our share within SHARE_BAND points of the paper's."""
    profiled = results.tidy[(results.tidy.kind == "phases") & (results.tidy.status == "ok") & results.tidy.fill_asked.isna()]
    for (kind, size), quoted in paper.TABLE1.items():
        name = paper.STARTING[kind]
        cell = profiled[(profiled.implementation == name) & (profiled.variables == size)]
        what = f"{len(cell)} process{'es' if len(cell) > 1 else ''} of {name} profiled" if len(cell) else f"{name} not profiled"
        for (group, phases), share in zip(paper.GROUPS.items(), quoted):
            head = "T1", f"starting {kind} version, {size} variables: {group} takes {share} % of the time", f"{share} %"
            rule = Rule(share - SHARE_BAND, share + SHARE_BAND)
            if share >= MAIN_SHARE and len(cell) < PROCESSES:
                yield unmeasured(head, f"{what} at n = {size}; an interval needs {PROCESSES}.", rule, " %")
            elif share >= MAIN_SHARE:
                mine, whole = (cell[[f"phase_{phase}" for phase in some]].sum(axis=1) for some in (phases, PHASES))
                middle, half, *_ = student(100 * mine / whole)
                yield judged(head, [(f"n = {size}", (middle, middle - half, middle + half), " ".join(cell.record))], rule, name, " %")


def table2_claims(results):
    """T2. Rule: a variant that is not optimised, over the fastest optimised one, within the band around the paper's ratio;
    a row an operation and such a variant, judged at every size."""
    plain = [name for name in results.variants if name.split("/")[0] == paper.NOT_OPTIMISED]
    for operation, (before, after, quoted) in paper.TABLE2.items():
        claim = f"symbolic preprocessing makes the {paper.OPERATIONS[operation]} {quoted} times faster"
        quote = f"{quoted}× ({before} → {after} ms)"
        found = {slow: ratios for slow in plain if (ratios := _gains(results, operation, slow))}
        yield from (compared(("T2", f"{claim} ({slow})", quote), ratios, factor(quoted)) for slow, ratios in found.items())
        if not found:
            yield unmeasured(("T2", claim, quote), "The operations alone were not timed in this run.", factor(quoted))


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


def solvers(results):
    """F4. Rules, at every size: the best of CHOLMOD, WSMP and SuperLU ÷ KLU above 1; KLU ÷ CHOLMOD within SPEED_BAND;
    WSMP ÷ CHOLMOD and SuperLU ÷ WSMP above 1."""
    klu, cholmod, wsmp, superlu = (paper.members(results, one) for one in ("KLU", "CHOLMOD", "WSMP", "SuperLU"))
    others = list(dict.fromkeys(cholmod + wsmp + superlu))
    return [_fastest(results, klu, others, 0, FIGURES_END), _fastest(results, klu, others, FIGURES_END + 1, 1000),
            _share_of_speed(results, klu, cholmod), _behind(results, "WSMP", wsmp, "CHOLMOD", cholmod),
            _behind(results, "SuperLU", superlu, "WSMP", wsmp)]


def _fastest(results, klu, others, low, high):
    span = f"to {high} variables" if low == 0 else f"from {low} to {high} variables"
    found = results.over_sizes(others, klu, low, high, COVERED)
    return compared(("F4", f"KLU with refactor is the fastest sparse solver, {span}", "fastest"), found, Rule(low=1),
                    f"KLU and another of the paper's solvers were not both timed at {max(low, COVERED)} variables or more.")


def _share_of_speed(results, klu, cholmod):
    head = "F4", f"CHOLMOD performs at {CHOLMOD_OF_KLU} % of KLU", f"{CHOLMOD_OF_KLU} %"
    rule = Rule(CHOLMOD_OF_KLU - SPEED_BAND, CHOLMOD_OF_KLU + SPEED_BAND)
    if not (found := results.over_sizes(klu, cholmod, high=FIGURES_END, reaching=COVERED)):
        return unmeasured(head, f"KLU and CHOLMOD were not both timed at {COVERED} to {FIGURES_END} variables.", rule, " %")
    cases = [(f"n = {one.size:g}", [100 * value for value in one[:3]], one.record) for one in found]
    return judged(head, cases, rule, f"KLU ÷ {', '.join(dict.fromkeys(one.fast for one in found))}", " %")


def _behind(results, slow_system, slow, fast_system, fast):
    head = "F4", f"{slow_system} is slower than {fast_system}", "slower"
    both = sorted(set(slow) & set(fast))
    if any(results.fastest(results.natural(size), slow) in both for size in results.sizes if size <= FIGURES_END):
        return row(head, INCOMPARABLE, f"{', '.join(both)} stands for both, and is {slow_system}'s fastest stand-in.", Rule(low=1).text("×"))
    return compared(head, results.over_sizes(slow, fast, high=FIGURES_END, reaching=COVERED), Rule(low=1),
                    f"{slow_system}'s and {fast_system}'s stand-ins were not both timed at {COVERED} to {FIGURES_END} variables.")


def pivoting(results):
    """C1. Rules: full pivoting ÷ refactor within the band around PIVOTING at every size; position error of refactor ÷ that
    of full pivoting at least ERROR_GROWS in some scene."""
    klu, full = paper.SYSTEMS["KLU"][0], paper.FULL_PIVOTING
    return [compared(("C1", "KLU with full pivoting costs 50 % more than with refactor", f"{PIVOTING}×"),
                     results.over_sizes([full], [klu], reaching=COVERED), factor(PIVOTING),
                     f"{full} and {klu} were not both timed at {COVERED} variables or more."), _stale_pivots(results, klu, full)]


def _stale_pivots(results, klu, full):
    head, rule = ("C1", "stale pivots may accumulate error when entries change violently", "may"), Rule(low=ERROR_GROWS)
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


def dense_pairs(results):
    """F2. Rules: starting ÷ best dense on any pair within the band around DENSE_GAIN; the same code on reference BLAS
    and LAPACK ÷ on its best pair above 1. Each at every size."""
    found = results.over_sizes([paper.STARTING["dense"]], paper.dense(results), high=FIGURES_END, reaching=COVERED)
    first = compared(("F2", "optimised dense versions on a BLAS+LAPACK pair beat the starting one 2-3 times", "2-3×"), found, factor(*DENSE_GAIN),
                     f"{paper.STARTING['dense']} and another dense version were not both timed at {COVERED} variables or more.")
    rows, claim = [], "tuned BLAS and LAPACK beat the reference ones in the same dense code"
    for variant in paper.members(results, "optimised dense"):  # over its sizes from COVERED on
        pairs = results.alternatives(variant).groupby("implementation").blas.first()
        found = results.over_sizes(list(pairs.index[pairs == "reference"]), list(pairs.index[pairs != "reference"]), COVERED, FIGURES_END)
        if found:
            rows.append(compared(("F2", f"{claim}: {variant}", "faster"), found, Rule(low=1)))
    return [first, *(rows or [unmeasured(("F2", claim, "faster"), "No optimised dense version was timed on the reference pair and on another "
                                         f"at {COVERED} to {FIGURES_END} variables.", Rule(low=1))])]


def tuned_blas(results):
    """C3. Rule: 1 − tuned ÷ reference at most TUNED_GAIN at every size; one row a sparse variant that was timed on both."""
    rows, claim = [], "tuned BLAS saves only 2-3 % of the time with a sparse solver"
    for name in paper.sparse(results):
        usual = next(iter(results.tidy.blas[results.tidy.implementation == name]), "")  # the pair that it is ranked on
        found = results.over_sizes([name], [f"{name}+reference"], reaching=COVERED) if name != ANCHOR and usual != "reference" else []
        cases = [(f"n = {one.size:g}", [100 * (1 - value) for value in (one.value, one.high, one.low)], one.record) for one in found]
        if cases:
            rows.append(judged(("C3", f"{claim}: {name}", "2-3 %"), cases, Rule(high=TUNED_GAIN), f"{name} on {usual} against reference", " %"))
    return rows or [unmeasured(("C3", claim, "2-3 %"), "No sparse version was timed on the reference BLAS and on another at "
                               f"{COVERED} variables or more.", Rule(high=TUNED_GAIN), " %")]


def compilers(results):
    """C5. What the study is not run with: other compilers and flags, which take minutes to build, and other operating systems."""
    return [unmeasured(("C5", f"the {what} matters an order of magnitude less than the linear algebra", "≤ 10 %"), reason,
                       Rule(high=ORDER_OF_MAGNITUDE), " %")
            for what, reason in (("compiler", "No variant was timed in builds of several compilers."),
                                 ("operating system", "The study runs on one operating system."))]
