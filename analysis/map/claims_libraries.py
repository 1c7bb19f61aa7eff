# Claims about BLAS, LAPACK and compilers: F2, C3, C5.
from analysis.core.registry import ANCHOR
from analysis.core.text import interval, number
from analysis.core.timing import rank
from analysis.map import paper
from analysis.map.compare import COVERED, Versus, best, over_sizes, phase_times, step_us
from analysis.map.ledger import at_least, at_most, compared, factor, judged, of, unmeasured

FIGURE_SIZES = 160    # variables; Figures 2 and 4 end here
SMALLEST = 22         # variables; the paper's small problem, where comparing compilers begins
DENSE_GAIN = 2, 3     # "a factor of 2-3 compared with our starting implementations" (abstract)
TUNED_GAIN = 5        # %, still "only 2-3 %"
ORDER_OF_MAGNITUDE = 10  # %, of the spread between implementations


def dense_pairs(results):
    """F2. Rules: starting ÷ best dense on any pair within the band around DENSE_GAIN; the same code on reference BLAS
    and LAPACK ÷ on its best pair above 1. Each at every size."""
    return [_against_starting(results), *_against_reference(results)]


def _against_starting(results):
    found = over_sizes(results, [paper.STARTING["dense"]], paper.dense(results), high=FIGURE_SIZES, reaching=COVERED)
    listed = ", ".join(f"{number(one.value)}× (n = {one.size:g}, {one.fast})" for one in found)
    return compared(("F2", "optimised dense versions on a BLAS+LAPACK pair beat the starting one 2-3 times", "2-3×"), found, factor(*DENSE_GAIN),
                    f"Starting ÷ best pair by size: {listed}. Pairs: {paper.dense_pairs(results)}.",
                    f"{paper.STARTING['dense']} and another dense version were not both timed at {COVERED} variables or more.")


_F2 = "tuned BLAS and LAPACK beat the reference ones in the same dense code"


def _against_reference(results):
    """A row a dense version, over its sizes from COVERED on."""
    rows = []
    for variant in paper.members(results, "optimised dense"):
        timed = results.alternatives(variant)
        pairs = timed.groupby("implementation").blas.first()
        found = over_sizes(results, list(pairs.index[pairs == "reference"]), list(pairs.index[pairs != "reference"]), COVERED, FIGURE_SIZES)
        if found:
            times = timed[timed.variables == found[-1].size].groupby("implementation").step_us.median().sort_values()
            listed = ", ".join(f"{pairs[name]} {number(times[name])}" for name in times.index)
            reason = (" The reference dsyrk leaves out zero entries of the Jacobian, which is nearly empty; tuned ones "
                      "multiply them." if any(one.high < 1 for one in found) else "")
            rows.append(compared(("F2", f"{_F2}: {variant}", "faster"), found, at_least(1),
                                 f"{variant} at n = {found[-1].size:g}, µs a step by pair: {listed}.{reason}"))
    return rows or [unmeasured(("F2", _F2, "faster"), "No optimised dense version was timed on the reference pair and on another "
                               f"at {COVERED} to {FIGURE_SIZES} variables.", at_least(1))]


_C3 = "tuned BLAS saves only 2-3 % of the time with a sparse solver"


def tuned_blas(results):
    """C3. Rule: 1 − tuned ÷ reference at most TUNED_GAIN at every size; one row a sparse variant that was timed on both."""
    rows = [row for name in paper.sparse(results) if (row := _tuned(results, name))]
    return rows or [unmeasured(("C3", _C3, "2-3 %"), "No sparse version was timed on the reference BLAS and on another at "
                               f"{COVERED} variables or more.", at_most(TUNED_GAIN), " %")]


def _tuned(results, name):
    if name == ANCHOR or results.usual(name) == "reference":
        return None
    found = over_sizes(results, [name], [f"{name}+reference"], reaching=COVERED)
    if not found:
        return None
    gains = {one.size: [100 * (1 - value) for value in (one.value, one.high, one.low)] for one in found}
    size = found[-1].size
    times, total = phase_times(results, name, size), step_us(results, name, size)
    share = (f" Factorization and solves, which alone may call BLAS often, are "
             f"{100 * (times['factorization'] + times['solve']) / total:.0f} % of its step at n = {size:g}." if times else "")
    listed = ", ".join(f"{gain:.1f} % (n = {at:g})" for at, (gain, _, _) in gains.items())
    return judged(("C3", f"{_C3}: {name}", "2-3 %"), [(f"n = {one.size:g}", gains[one.size], one.record) for one in found],
                  at_most(TUNED_GAIN), f"{name} on {results.usual(name)} against reference", f"Gain by size: {listed}.{share}", " %")


_C5 = "the compiler matters an order of magnitude less than the linear algebra"


def compilers(results):
    """C5. Rule: (slowest ÷ fastest build − 1) at most ORDER_OF_MAGNITUDE of (middle ÷ fastest implementation of today − 1)
    at every size."""
    rows = [row for name in [*paper.members(results, "optimised dense"), *paper.sparse(results)] if (row := _compilers(results, name))]
    rule, quoted = at_most(ORDER_OF_MAGNITUDE), "≤ 10 %"
    rows = rows or [unmeasured(("C5", _C5, quoted), "No variant was timed in builds of several compilers.", rule, " %")]
    return rows + [unmeasured(("C5", "the operating system matters an order of magnitude less than the linear algebra", quoted),
                              "The study runs on one operating system.", rule, " %")]


def _compilers(results, name):
    found = [_spread(results, size, cell) for size, cell in results.builds(name).groupby("variables") if size >= SMALLEST]
    found = [one for one in found if one]
    if not found:
        return None
    cases = [(f"n = {builds.size:g}", share, builds.record) for share, builds, _, _ in found]
    _, builds, spread, medians = max(found, key=lambda one: one[0][0])
    listed = ", ".join(f"{build} {number(value)} µs" for build, value in medians.items())
    why = (f"Builds at n = {builds.size:g}: {listed}; slowest ÷ fastest {interval(builds)}. Implementations of today there: "
           f"{spread.slow}, their middle, ÷ {spread.fast} = {number(spread.value)}. Only this study's code is built anew; libraries "
           "that are no headers stay as packaged.")
    return judged(("C5", f"{_C5}: {name}", "≤ 10 %"), cases, at_most(ORDER_OF_MAGNITUDE), ", ".join(medians), why, " %")


def _spread(results, size, cell):
    """((share, low, high) in %, Versus of builds, Versus of implementations, {build: µs}) of one size."""
    scene = results.natural(size)
    builds, today = rank(cell), results.rank(scene, [*paper.sparse(results), *paper.members(results, "optimised dense")])
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
