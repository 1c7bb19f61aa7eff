# Figure 2: dense implementations on every BLAS + LAPACK pair against the starting dense version.
import matplotlib.pyplot as plt

from analysis.core.style import legend, missing, number_axis
from analysis.map import paper
from analysis.map.compare import versus
from analysis.map.marks import footnote, side_by_side


def series(results):
    """{name: {size: Versus of the starting dense version to it}} of the optimised dense ones on all pairs."""
    found = {}
    for name in paper.dense(results):
        for size in results.sizes:
            one = versus(results, results.natural(size), paper.STARTING["dense"], name)
            if one:
                found.setdefault(name, {})[size] = one
    return found


def draw(results, look):
    found = series(results)
    sizes = sorted({size for mine in found.values() for size in mine})
    figure, axes = plt.subplots(figsize=(max(6.5, 1.2 * len(sizes) + 1), 5.2))
    axes.set_title("Figure 2: dense versions on pairs of BLAS and LAPACK")
    if not found:
        missing(axes, f"{paper.STARTING['dense']} and another dense version were not both timed")
        return figure
    labels = {name: _label(results, name) for name in found}
    side_by_side(axes, found, sizes, look, labels.get)
    axes.set_ylabel(f"times as fast as {paper.STARTING['dense']}")
    number_axis(axes.yaxis, "×")
    legend(axes, order=list(labels.values()).index)
    tried = {results.usual(name) for name in results.tidy.implementation.unique()}
    gone = [f"{name}: {reason}" for name, reason in results.registry.pairs.items() if reason]
    notes = ["bars: 95 % interval over processes"]
    notes += [f"not installed: {'; '.join(gone)}"] * bool(gone)
    others = [name for name, reason in results.registry.pairs.items() if not reason and name not in tried]
    notes += [f"pairs that were not part of this run: {', '.join(others)}"] * bool(others)
    footnote(figure, notes, 0.0)
    return figure


def _label(results, name):
    plain, _, pair = name.partition("+")
    return f"{plain} on {pair}" if pair else f"{plain} on {results.usual(name)} (usual)"
