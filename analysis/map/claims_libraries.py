# Claims about BLAS, LAPACK and compilers: F2, C3, C5.
from analysis.core.registry import ANCHOR
from analysis.core.text import interval, number
from analysis.core.timing import rank
from analysis.map import paper
from analysis.map.compare import Versus, best, extreme, over_sizes, step_us
from analysis.map.explain import phase_times
from analysis.map.ledger import at_least, at_most, compared, of, tested, unmeasured

FIGURE_SIZES = 160    # variables; Figures 2 and 4 end here
COVERED = 82          # variables that a run has to reach to speak of them
SMALLEST = 22         # variables; the paper's small problem, where comparing compilers begins
DENSE_GAIN = 2        # "a factor of 2-3 compared with our starting implementations" (abstract)
TUNED_GAIN = 5        # %, still "only 2-3 %"
ORDER_OF_MAGNITUDE = 10  # %, of the spread between implementations


def dense_pairs(results):
    """F2. Rules: starting ÷ best dense on any pair at least DENSE_GAIN at its best size; the same code on reference
    BLAS and LAPACK ÷ on its best pair above 1."""
    return [_against_starting(results), _against_reference(results)]


def _against_starting(results):
    head = "F2", "optimised dense versions on a BLAS+LAPACK pair beat the starting one 2-3 times", "2-3×"
    found = over_sizes(results, [paper.STARTING["dense"]], paper.dense(results, pairs=True), high=FIGURE_SIZES)
    if not found or found[-1].size < COVERED:
        return unmeasured(head, f"{paper.STARTING['dense']} and another dense version were not both timed at {COVERED} "
                        "variables or more.", at_least(DENSE_GAIN))
    largest = extreme(found, max)
    why = "Starting ÷ best pair by size: " + ", ".join(f"{number(one.value)}× (n = {one.size:g}, {one.fast})" for one in found)
    return compared(head, largest, at_least(DENSE_GAIN), f"{why}.")


def _against_reference(results):
    head = "F2", "tuned BLAS and LAPACK beat the reference ones in the same dense code", "faster"
    for size in reversed([size for size in results.sizes if COVERED <= size <= FIGURE_SIZES]):
        for variant in paper.dense(results):
            rows = results.alternatives(variant)
            pairs = dict(rows[rows.variables == size].groupby("implementation").blas.first())
            found = best(results, results.natural(size), [name for name, pair in pairs.items() if pair == "reference"],
                         [name for name, pair in pairs.items() if pair != "reference"])
            if found:
                times = results.medians(results.natural(size))
                listed = ", ".join(f"{pairs[name] or 'none'} {number(times[name])}" for name in sorted(pairs, key=times.get))
                reason = (" The reference dsyrk leaves out zero entries of the Jacobian, which is nearly empty; tuned ones "
                          "multiply them." if found.high < 1 else "")
                return compared(head, found, at_least(1), f"{variant} at n = {size:g}, µs a step by pair: {listed}.{reason}")
    return unmeasured(head, f"No optimised dense version was timed on the reference pair and on another at {COVERED} to "
                    f"{FIGURE_SIZES} variables.", at_least(1))


_C3 = "tuned BLAS saves only 2-3 % of the time with a sparse solver"


def tuned_blas(results):
    """C3. Rule: 1 − tuned ÷ reference at most TUNED_GAIN at the size where it is largest; one row a sparse variant that
    was timed on both."""
    rows = [row for name in paper.sparse(results) if (row := _tuned(results, name))]
    return rows or [unmeasured(("C3", _C3, "2-3 %"), "No sparse version was timed on the reference BLAS and on another at "
                             f"{COVERED} variables or more.", at_most(TUNED_GAIN), " %")]


def _tuned(results, name):
    found = over_sizes(results, [name], [f"{name}+reference"]) if name != ANCHOR and results.usual(name) != "reference" else []
    if not found or found[-1].size < COVERED:
        return None
    least = extreme(found, min)  # of tuned ÷ reference: the largest gain
    size, gain = least.size, [100 * (1 - value) for value in (least.value, least.high, least.low)]
    others = ", ".join(f"{100 * (1 - one.value):.1f} % (n = {one.size:g})" for one in found)
    times, total = phase_times(results, name, size), step_us(results, name, size)
    share = (f" Factorization and solves, which alone may call BLAS often, are "
             f"{100 * (times['factorization'] + times['solve']) / total:.0f} % of its step." if times else "")
    return tested(("C3", f"{_C3}: {name}", "2-3 %"), gain, at_most(TUNED_GAIN),
                  f"n = {size:g}, {name} on {results.usual(name)} against reference", f"Gain by size: {others}.{share}", " %",
                  least.record)


_C5 = "the compiler matters an order of magnitude less than the linear algebra"


def compilers(results):
    """C5. Rule: (slowest ÷ fastest build − 1) at most ORDER_OF_MAGNITUDE of (middle ÷ fastest implementation of today − 1)
    at one size, taken at the size where that share is largest."""
    rows = [row for name in results.variants if (row := _compilers(results, name))]
    rule, quoted = at_most(ORDER_OF_MAGNITUDE), "≤ 10 %"
    rows = rows or [unmeasured(("C5", _C5, quoted), "No variant was timed in builds of several compilers.", rule, " %")]
    return rows + [unmeasured(("C5", "the operating system matters an order of magnitude less than the linear algebra", quoted),
                            "The study runs on one operating system.", rule, " %")]


def _compilers(results, name):
    found = [_spread(results, size, cell) for size, cell in results.builds(name).groupby("variables") if size >= SMALLEST]
    found = [one for one in found if one]
    if not found:
        return None
    _, builds, spread, medians = max(found, key=lambda one: one[0][0])
    share = [max(ends) for ends in zip(*(one[0] for one in found))]  # and the ends of its interval, over all sizes
    listed = ", ".join(f"{build} {number(value)} µs" for build, value in medians.items())
    why = (f"Builds: {listed}; slowest ÷ fastest {interval(builds)}. Implementations of today at that size: {spread.slow}, "
           f"their middle, ÷ {spread.fast} = {number(spread.value)}. Only this study's code is built anew; libraries that are "
           "no headers stay as packaged.")
    return tested(("C5", f"{_C5}: {name}", "≤ 10 %"), share, at_most(ORDER_OF_MAGNITUDE),
                  f"n = {builds.size:g}, {', '.join(medians)}", why, " %", builds.record)


def _spread(results, size, cell):
    """((share, low, high) in %, Versus of builds, Versus of implementations, {build: µs}) of one size."""
    scene = results.natural(size)
    builds, today = rank(cell), results.rank(scene, [*paper.sparse(results), *paper.dense(results)])
    if not builds or not builds.second or not today or not today.second:
        return None
    slow, apart = list(builds.ratios.items())[-1]
    spread = best(results, scene, [list(today.ratios)[len(today.ratios) // 2]], [today.winner])
    if not spread or spread.value <= 1:
        return None
    times = cell.groupby("implementation").step_us.median()
    medians = {name.partition("+")[2] or own_build(results): times[name] for name in builds.ratios}
    share = [max(0.0, 100 * (value - 1) / (spread.value - 1)) for value in of(apart)]
    return share, Versus(*of(apart), slow, builds.winner, size, 0.0, cell.record.iloc[0]), spread, medians


def own_build(results):
    """The study's own build in the words of the others, such as "gcc-O3"."""
    context = results.view.context
    family = "clang" if "clang" in context.get("compiler", "").lower() else "gcc"
    return family + "".join([flag for flag in context.get("flags", "").split() if flag.startswith("-O")][-1:])
