# Table 2: the operations alone, not optimised against optimised: time per call, and their ratio.
import matplotlib.pyplot as plt

from analysis.core.style import GREY, missing, nothing, number_axis, size_ticks
from analysis.core.text import bounded
from analysis.core.timing import rank, ratio
from analysis.map import paper
from analysis.map.compare import Versus, operations
from analysis.map.marks import footnote


def table(results):
    """Rows of Table 2: [{"operation", "variables", "slow", "fast", "slow_us", "fast_us", "ratio", "paper"}], a row for each
    operation, size and variant that is not optimised, against the fastest optimised variant there that stores as much:
    both halves of the symmetric matrices, as those for unsymmetric solvers do, or one."""
    rows = []
    for operation, (_, _, quoted) in paper.TABLE2.items():
        for (size, _), cell in operations(results, operation).groupby(["variables", "scene"]):
            times = cell.groupby("implementation").step_us.median()
            for slow in not_optimised(results):
                ranking = rank(cell, _alike(results, slow))
                found = ranking and ratio(cell, slow, ranking.winner)
                if found and found.value == found.value:
                    fast = ranking.winner
                    record = cell[cell.implementation == slow].record.iloc[0]
                    rows.append({"operation": operation, "variables": size, "slow": slow, "fast": fast,
                                 "slow_us": times[slow], "fast_us": times[fast], "paper": quoted,
                                 "ratio": Versus(found.value, found.low, found.high, slow, fast, size, 0.0, record)})
    return rows


def not_optimised(results):
    return [name for name in results.variants if name.split("/")[0] == paper.NOT_OPTIMISED]


def _alike(results, name):
    both_halves = results.variants[name].get("unsymmetric", False)
    return [other for other in paper.sparse(results) if results.variants[other].get("unsymmetric", False) == both_halves]


def draw(results, look):
    rows = table(results)
    if all(operations(results, operation).empty for operation in paper.OPERATIONS):
        return nothing("no operation of Table 2 was timed", (8.4, 3), "Table 2: operations without and with symbolic preprocessing")
    figure, panels = plt.subplots(2, 3, figsize=(10.4, 6.4), sharex=True, gridspec_kw={
        "hspace": 0.3, "wspace": 0.27, "height_ratios": [1.25, 1]})
    for (operation, label), (times, ratios) in zip(paper.OPERATIONS.items(), panels.T):
        samples = operations(results, operation)
        if samples.empty:
            missing(times, f"{label}:\nno operations were timed")
            missing(ratios, "")
            continue
        _times(times, samples, results, look)
        times.set_title(label, fontsize=10)
        _ratios(ratios, [row for row in rows if row["operation"] == operation], look, paper.TABLE2[operation][2])
    panels[0, 0].set_ylabel("µs a call")
    panels[1, 0].set_ylabel("not optimised ÷ fastest optimised")
    figure.suptitle("Table 2: operations without and with symbolic preprocessing",
                    x=0.125, ha="left", fontsize=11, y=0.965)
    handles = {label: handle for axes in panels[0] for handle, label in zip(*axes.get_legend_handles_labels())}
    if handles:
        figure.legend(handles.values(), handles.keys(), loc="upper center", ncol=4, fontsize=8.5, bbox_to_anchor=(0.5, 0.03))
    footnote(figure, ["above: medians; below: ratio to the fastest optimised of the size that stores as much (both halves of "
                      "symmetric matrices);", "bars: its 95 % interval over processes, none of a single one; dashed: the paper"], -0.03)
    return figure


def _times(axes, samples, results, look):
    slow = not_optimised(results)
    for name in results.variants:
        middle = samples[samples.implementation == name].groupby("variables").step_us.median()
        if len(middle):
            role = " (not optimised)" if name in slow else ""
            axes.plot(middle.index, middle, label=f"{name}{role}", **look.line(name))
    _ticks(axes, sorted(samples.variables.unique()))
    axes.set_xlabel("")


def _ratios(axes, rows, look, quoted):
    for slow in dict.fromkeys(row["slow"] for row in rows):
        mine = [row for row in rows if row["slow"] == slow]
        sizes = [row["variables"] for row in mine]
        axes.plot(sizes, [row["ratio"].value for row in mine], **look.line(slow))
        known = [row for row in mine if bounded(row["ratio"].low, row["ratio"].high)]
        axes.vlines([row["variables"] for row in known], [row["ratio"].low for row in known],
                    [row["ratio"].high for row in known], color=look.colour(slow), linewidth=3, alpha=0.35)
    axes.axhline(quoted, color="black", linewidth=1, linestyle=(0, (6, 3)))
    axes.set_title(f"paper: {quoted}", fontsize=9)
    axes.axhline(1, color=GREY, linewidth=0.8)
    _ticks(axes, sorted({row["variables"] for row in rows}))


def _ticks(axes, sizes):
    number_axis(axes.yaxis)
    size_ticks(axes, sizes)
    axes.grid(True, which="major")
