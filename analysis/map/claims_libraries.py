# Claims about BLAS, LAPACK and compilers: F2, C3, C5.
from analysis.core.registry import ANCHOR
from analysis.map import paper
from analysis.map.results import COVERED
from analysis.map.ledger import at_least, at_most, compared, factor, judged, unmeasured

FIGURE_SIZES = 160    # variables; Figures 2 and 4 end here
DENSE_GAIN = 2, 3     # "a factor of 2-3 compared with our starting implementations" (abstract)
TUNED_GAIN = 5        # %, still "only 2-3 %"
ORDER_OF_MAGNITUDE = 10  # %, of the spread between implementations


def dense_pairs(results):
    """F2. Rules: starting ÷ best dense on any pair within the band around DENSE_GAIN; the same code on reference BLAS
    and LAPACK ÷ on its best pair above 1. Each at every size."""
    found = results.over_sizes([paper.STARTING["dense"]], paper.dense(results), high=FIGURE_SIZES, reaching=COVERED)
    first = compared(("F2", "optimised dense versions on a BLAS+LAPACK pair beat the starting one 2-3 times", "2-3×"), found, factor(*DENSE_GAIN),
                     f"{paper.STARTING['dense']} and another dense version were not both timed at {COVERED} variables or more.")
    rows, claim = [], "tuned BLAS and LAPACK beat the reference ones in the same dense code"
    for variant in paper.members(results, "optimised dense"):  # over its sizes from COVERED on
        pairs = results.alternatives(variant).groupby("implementation").blas.first()
        found = results.over_sizes(list(pairs.index[pairs == "reference"]), list(pairs.index[pairs != "reference"]), COVERED, FIGURE_SIZES)
        if found:
            rows.append(compared(("F2", f"{claim}: {variant}", "faster"), found, at_least(1)))
    return [first, *(rows or [unmeasured(("F2", claim, "faster"), "No optimised dense version was timed on the reference pair and on another "
                                         f"at {COVERED} to {FIGURE_SIZES} variables.", at_least(1))])]


def tuned_blas(results):
    """C3. Rule: 1 − tuned ÷ reference at most TUNED_GAIN at every size; one row a sparse variant that was timed on both."""
    rows, claim = [], "tuned BLAS saves only 2-3 % of the time with a sparse solver"
    for name in paper.sparse(results):
        usual = results.usual(name)
        found = results.over_sizes([name], [f"{name}+reference"], reaching=COVERED) if name != ANCHOR and usual != "reference" else []
        cases = [(f"n = {one.size:g}", [100 * (1 - value) for value in (one.value, one.high, one.low)], one.record) for one in found]
        if cases:
            rows.append(judged(("C3", f"{claim}: {name}", "2-3 %"), cases, at_most(TUNED_GAIN), f"{name} on {usual} against reference", " %"))
    return rows or [unmeasured(("C3", claim, "2-3 %"), "No sparse version was timed on the reference BLAS and on another at "
                               f"{COVERED} variables or more.", at_most(TUNED_GAIN), " %")]


def compilers(results):
    """C5. What the study is not run with: other compilers and flags, which take minutes to build, and other operating systems."""
    return [unmeasured(("C5", f"the {what} matters an order of magnitude less than the linear algebra", "≤ 10 %"), reason,
                       at_most(ORDER_OF_MAGNITUDE), " %")
            for what, reason in (("compiler", "No variant was timed in builds of several compilers."),
                                 ("operating system", "The study runs on one operating system."))]
