# Claims about BLAS, LAPACK and compilers: F2, C3, C5.
import pandas

from analysis import paper
from analysis.compare import best_ratio, natural, ratio
from analysis.explain import phase_times, step_us
from analysis.ledger import at_least, at_most, of, tested, untested
from analysis.text import interval, number

FIGURE_SIZES = 160    # variables; Figures 2 and 4 end here
COVERED = 82          # variables that a run has to reach to speak of them
SMALLEST = 22         # variables; the paper's small problem, where comparing compilers begins
DENSE_GAIN = 2        # "a factor of 2-3 compared with our starting implementations" (abstract)
TUNED_GAIN = 5        # %, still "only 2-3 %"
ORDER_OF_MAGNITUDE = 10  # %, of the spread between implementations


def dense_pairs(results):
    """F2. Rules: starting ÷ best dense pair at least DENSE_GAIN at its best size; the same code on
    reference BLAS and LAPACK ÷ on its best pair above 1."""
    own = [name for name in paper.dense(results) if not paper.starting(name)
           and _pairs(results, name).implementation.nunique() > 1]  # on pairs; others call no BLAS
    pool = pandas.concat([_small(_pairs(results, name)) for name in own] or [results.tidy[:0]])
    first = natural(results)
    starting = first[(first.implementation == paper.STARTING["dense"])
                     & (first.variables <= FIGURE_SIZES)]
    return [_against_starting(pool, starting), _against_reference(pool)]


def _pairs(results, name):
    """Samples at natural fill of a variant on all its BLAS pairs, in the study's own build."""
    rows = results.alternatives(name)
    return rows[(rows.build == "") & rows.fill_asked.isna()]


def _small(rows):
    return rows[rows.variables <= FIGURE_SIZES]


def _against_starting(pool, starting):
    head = ("F2", "optimised dense versions on a BLAS+LAPACK pair beat the starting one 2-3 times",
            "2-3×")
    both = pandas.concat([pool, starting])
    found = [best_ratio(rows, [paper.STARTING["dense"]], pool.implementation.unique())
             for _, rows in both.groupby("variables")]
    found = [entry for entry in found if entry]
    if not found or found[-1].size < COVERED:
        return untested(*head, f"{paper.STARTING['dense']} and another dense version were not both "
                        f"timed at {COVERED} variables or more.", at_least(DENSE_GAIN))
    best = max(found, key=lambda entry: entry.value)
    why = "Starting ÷ best pair by size: " + ", ".join(
        f"{number(entry.value)}× (n = {entry.size:g}, {entry.fast})" for entry in found) + "."
    return tested(*head, of(best), at_least(DENSE_GAIN), _where(best), why)


def _against_reference(pool):
    head = ("F2", "tuned BLAS and LAPACK beat the reference ones in the same dense code", "faster")
    reference = pool[pool.blas == "reference"]
    if reference.empty or reference.variables.max() < COVERED:
        return untested(*head, "No optimised dense version was timed on the reference pair at "
                        f"{COVERED} variables or more.", at_least(1))
    size = reference.variables.max()
    for name in reference[reference.variables == size].implementation.unique():
        variant = name.partition("+")[0]
        mine = pool[(pool.variables == size) & (pool.folder + "/" + pool.variant == variant)]
        tuned = mine[mine.blas != "reference"].implementation.unique()
        found = best_ratio(mine, [name], tuned)
        if found:
            medians = mine.groupby("blas").step_us.median().sort_values()
            listed = ", ".join(f"{pair or 'none'} {number(value)}" for pair, value
                               in medians.items())
            reason = (" The reference dsyrk leaves out zero entries of the Jacobian, which is "
                      "nearly empty; tuned ones multiply them." if found.high < 1 else "")
            return tested(*head, of(found), at_least(1), _where(found),
                          f"{variant} at n = {size:g}, µs a step by pair: {listed}.{reason}")
    return untested(*head, "No tuned pair was timed beside the reference one.", at_least(1))


def tuned_blas(results):
    """C3. Rule: 1 − tuned ÷ reference at most TUNED_GAIN at the size where it is largest; one row
    a sparse variant that was timed on both."""
    rows = [_tuned(results, name) for name in paper.sparse(results)]
    rows = [row for row in rows if row]
    return rows or [untested("C3", _C3, "2-3 %", "No sparse version was timed on the reference "
                             f"BLAS and on another at {COVERED} variables or more.",
                             at_most(TUNED_GAIN), " %")]


_C3 = "tuned BLAS saves only 2-3 % of the time with a sparse solver"


def _tuned(results, name):
    rows = _pairs(results, name)
    reference = rows[rows.blas == "reference"].implementation.unique()
    tuned = rows[rows.blas != "reference"].implementation.unique()
    found = [best_ratio(cell, tuned, reference) for _, cell in rows.groupby("variables")]
    found = [entry for entry in found if entry]
    if not found or found[-1].size < COVERED:
        return None
    gains = [[100 * (1 - value) for value in (entry.value, entry.high, entry.low)]
             for entry in found]
    best = max(range(len(found)), key=lambda place: gains[place][0])
    size = found[best].size
    others = ", ".join(f"{gain[0]:.1f} % (n = {entry.size:g})"
                       for gain, entry in zip(gains, found))
    times, total = phase_times(results, name, size), step_us(results, name, size)
    share = (f" Factorization and solves, which alone may call BLAS often, are "
             f"{100 * (times['factorization'] + times['solve']) / total:.0f} % of its step."
             if times else "")
    pair = rows[rows.implementation == found[best].slow].blas.iloc[0]
    return tested("C3", f"{_C3}: {name}", "2-3 %", gains[best], at_most(TUNED_GAIN),
                  f"n = {size:g}, {name} on {pair} against reference",
                  f"Gain by size: {others}.{share}", " %")


def compilers(results):
    """C5. Rule: (slowest ÷ fastest build − 1) at most ORDER_OF_MAGNITUDE of (median ÷ fastest
    implementation of today − 1) at one size, taken at the size where that share is largest."""
    rows = [_compilers(results, name) for name in results.variants]
    rows = [row for row in rows if row] or [
        untested("C5", _C5, "≤ 10 %", "No variant was timed in builds of several compilers.",
                 at_most(ORDER_OF_MAGNITUDE), " %")]
    return rows + [untested("C5", "the operating system matters an order of magnitude less than "
                            "the linear algebra", "≤ 10 %", "The study runs on one operating "
                            "system.", at_most(ORDER_OF_MAGNITUDE), " %")]


_C5 = "the compiler matters an order of magnitude less than the linear algebra"


def _compilers(results, name):
    rows = results.alternatives(name)
    rows = rows[rows.fill_asked.isna() & (rows.variables >= SMALLEST)]
    others = rows[rows.build != ""]
    own = rows[(rows.implementation == name) & rows.variables.isin(others.variables)]
    rows = pandas.concat([others, own.assign(build=_own_build(results))])
    found = [entry for entry in (_spread(results, size, cell)
                                 for size, cell in rows.groupby("variables")) if entry]
    if not found:
        return None
    share, builds, spread = max(found, key=lambda entry: entry[0][0])
    cell = rows[rows.variables == builds.size]
    medians = cell.groupby("build").step_us.median().sort_values()
    listed = ", ".join(f"{build} {number(value)} µs" for build, value in medians.items())
    why = (f"Builds: {listed}; slowest ÷ fastest {interval(builds)}. Implementations of today at "
           f"that size: {spread.slow}, their middle, ÷ {spread.fast} = {number(spread.value)}. Only "
           "this study's code is built anew; libraries that are no headers stay as packaged.")
    return tested("C5", f"{_C5}: {name}", "≤ 10 %", share, at_most(ORDER_OF_MAGNITUDE),
                  f"n = {builds.size:g}, {', '.join(medians.index)}", why, " %")


def _own_build(results):
    """The study's own build in the words of the others, such as "gcc-O3"."""
    build = results.context
    family = "clang" if "clang" in build.get("compiler", "").lower() else "gcc"
    levels = [flag for flag in build.get("flags", "").split() if flag.startswith("-O")]
    return family + "".join(levels[-1:])


def _spread(results, size, cell):
    """((share, low, high) in %, Ratio of builds, Ratio of implementations) of one size."""
    today = paper.optimised(results) + [name for name in paper.dense(results)
                                        if not paper.starting(name)]
    of_size = natural(results, size)
    builds = _spread_of(cell, -1)
    spread = _spread_of(of_size[of_size.implementation.isin(today)], None)
    if builds is None or spread is None or spread.value <= 1:
        return None
    share = [max(0.0, 100 * (value - 1) / (spread.value - 1)) for value in of(builds)]
    return share, builds, spread


def _spread_of(samples, place):
    """Ratio of the slowest (place -1) or of the middle one (None) to the fastest."""
    medians = samples.groupby("implementation").step_us.median().sort_values()
    if len(medians) < 2:
        return None
    return ratio(samples, medians.index[len(medians) // 2 if place is None else place],
                 medians.index[0])


def _where(found):
    return f"n = {found.size:g}, {found.slow} ÷ {found.fast}"
