# Figure 5: time against tangent fill at about 100 variables.
import matplotlib.pyplot as plt

from analysis.core.style import legend, nothing, number_axis
from analysis.map import paper
from analysis.map.marks import footnote

PAPER_SIZE = 100  # variables
DENSE_LINE = {"color": "black", "linewidth": 2.4, "linestyle": "-", "marker": "", "zorder": 1.5}


def chosen_size(results):
    """The measured size nearest the paper's among those with at least half as many fills as the size that has most of
    them; None if no size has three."""
    fills = results.samples().groupby("variables").scene.nunique()
    enough = fills[fills >= max(3, fills.max() / 2)] if len(fills) else fills
    return min(enough.index, key=lambda size: (abs(size - PAPER_SIZE), -size), default=None)


def draw(results, look):
    size = chosen_size(results)
    if size is None:
        return nothing("no size was timed at three or more fills", (8.4, 3), "Figure 5: time against tangent fill")
    samples = results.samples()
    scenes = samples[samples.variables == size].groupby("fill_percent").scene.first()
    times = {fill: results.medians(scene) for fill, scene in scenes.items()}
    figure, axes = plt.subplots(figsize=(8.4, 5.4))
    for name in paper.sparse(results, others=True):
        mine = {fill: known[name] for fill, known in times.items() if name in known}
        if mine:
            axes.plot(list(mine), list(mine.values()), label=name, **look.line(name))
    dense = {fill: name for fill, scene in scenes.items() if (name := results.fastest(scene, paper.dense(results)))}
    if dense:
        who = "\n".join(dict.fromkeys(f"   {name}" for name in dense.values()))
        axes.plot(list(dense), [times[fill][name] for fill, name in dense.items()], label=f"fastest dense:\n{who}", **DENSE_LINE)
    axes.set_title(f"Figure 5: time against tangent fill, n = {size:g}")
    axes.set(xlabel="non-zeros of the tangent, % of n²", ylabel="time per step, µs")
    number_axis(axes.yaxis)
    axes.grid(True, which="major")
    legend(axes)
    footnote(figure, ["medians over processes; who is not there was not timed (reasons: table of failures)",
                      f"dense: the best one timed; pairs of BLAS and LAPACK: {paper.dense_pairs(results)}"], 0.02)
    return figure
