# Distributions of step times against the deadline, and the largest mechanisms in real time.
import matplotlib.pyplot as plt
import numpy

from analysis.core.outcomes import FINISHED
from analysis.core.style import GREY, below, line_each, nothing, number_axis, panels

FORMS = {"penalty": ("#0072B2", "o", -0.17), "saddle-point": ("#D55E00", "s", 0.17)}  # colour, marker, place in a line
LEFT = 0.7  # of the axis of sizes
DEADLINE = {"color": "black", "linewidth": 1.2, "linestyle": (0, (4, 2)), "label": "deadline"}
GAP = {"color": GREY, "linewidth": 1.2, "linestyle": (0, (1, 1.5)), "label": "longest gap of the null process"}


def draw(tables, view):
    return {"steps": distributions(tables["steps"], tables["machine"]), "largest": sizes(tables["largest"])}


def distributions(table, machine):
    """A panel a deadline and size: from the median to the longest step, a line an implementation. Deadlines of one size stand side by side."""
    table, left = run_of(table, table.status == "dropped")
    if table.median_us.notna().sum() == 0:
        return nothing("No run of which there are step times.")
    steps, loops, names = sorted(table.step.unique(), reverse=True), sorted(table.loops.unique()), order(table)
    asked = [(step, size) for step in steps for size in loops]
    figure, grid = panels(len(asked), len(loops) if len(loops) > 1 else len(steps), 5.2, 0.27 * len(names) + 1.1,
                          "Times of steps, as observed in one run: libraries and code of our own", "time of a step, µs")
    for axes, (step, size) in zip(grid, asked):
        for scheme, rows in table[(table.step == step) & (table.loops == size)].groupby("scheme", sort=False):
            _form(axes, rows, names, scheme)
        axes.axvline(1e6 * step, **DEADLINE)
        for gap in machine[(machine.after == "distributions") & (machine.step == step)].largest_us.dropna():
            axes.axvline(gap, **GAP)
        axes.set(xscale="log", title=f"N = {size:g}, deadline {1e3 * step:g} ms")
        line_each(axes, names)
    others = sorted(set(table.status[table.median_us.notna()]) - {"ok"})
    below(figure, 4, left + [_entry(f"hollow: {', '.join(others)}", GREY, "o", markerfacecolor="white")] * bool(others))
    return figure


def run_of(table, dropped):
    """Without what the budget dropped; and an entry of the legend that counts it."""
    return table[~dropped], [_entry(f"not drawn: {dropped.sum()} that the budget dropped")] if dropped.any() else []


def _entry(label, colour="none", marker="", **more):
    return plt.Line2D([], [], linestyle="none", color=colour, marker=marker, label=label, **more)


def order(table):
    """Implementations, the fastest first: by their median in the first scheme over all panels; without times last."""
    rows = table[table.scheme == table.scheme.iloc[0]]
    middle = rows.groupby("implementation", sort=False).median_us.apply(lambda times: numpy.log(times).mean())
    return list(middle.sort_values(na_position="last", kind="stable").index)


def _form(axes, rows, names, scheme):
    """The runs of one form of the step."""
    colour, marker, shift = FORMS[scheme]
    y, good = rows.implementation.map(names.index) + shift, rows.status == "ok"
    axes.hlines(y, rows.median_us, rows.max_us, color=colour, linewidth=1, alpha=0.6)
    axes.plot(rows.median_us[good], y[good], marker, color=colour, markersize=4.5, label=f"{scheme}: median")
    axes.plot(rows.median_us[~good], y[~good], marker, color=colour, markersize=4.5, markerfacecolor="white")
    axes.plot(rows[["p99_us", "p999_us"]], y, "|", color=colour, markersize=8)
    axes.plot(rows.max_us, y, "x", color=colour, markersize=4.5)
    axes.plot([], [], "|", color=GREY, markersize=9, label="99 %, 99.9 %")
    axes.plot([], [], "x", color=GREY, label="longest")
    for row in rows[rows.median_us.isna()].itertuples():  # there are no times
        axes.text(0.02, y[row.Index], row.status, transform=axes.get_yaxis_transform(), color=colour, va="center", fontsize=7)


def sizes(table):
    """The largest size that was kept up with and the next one that was not, with the misses of both."""
    table, left = run_of(table, table.largest.isna())
    if table.empty:
        return nothing("No search was made.")
    steps = sorted(table.step.unique(), reverse=True)
    names = list(table.groupby("implementation").largest.max().sort_values(ascending=False, kind="stable").index)
    shown = [form for form in FORMS if form in set(table.scheme)]
    figure, grid = panels(len(steps), len(steps), 6.6, (0.2 + 0.22 * len(shown)) * len(names) + 0.8,
                          "Largest N in real time: libraries and code of our own", "N of the four-bar (n = 2N + 2 variables)")
    for axes, step in zip(grid, steps):
        for row in table[table.step == step].itertuples():
            _search(axes, row, names.index(row.implementation), len(shown) > 1)
        axes.set_title(f"step and deadline {1e3 * step:g} ms")
        line_each(axes, names)
    known = [size for size in (*table.largest.dropna(), *table.next.dropna()) if size > 0]
    grid[0].set_xlim(LEFT if (table.largest == 0).any() else 0.6 * min(known, default=1), 1.6 * max(known, default=1))
    number_axis(grid[0].xaxis)
    below(figure, 4, [*(_entry(f"{form}: kept up with", *FORMS[form][:2]) for form in shown),
                      _entry("next size tried: not kept up with", GREY, "X"), _entry("right: N, steps missed (lost by the null process)"), *left])
    return figure


def _search(axes, row, place, several):
    colour, marker, shift = FORMS[row.scheme]
    y = place + (shift if several else 0)
    start, end = max(row.largest, LEFT), row.next if row.next == row.next else max(row.largest, LEFT)
    axes.plot([start, end], [y, y], color=colour, linewidth=1.4, alpha=0.6)
    axes.plot(start, y, marker, color=colour, markersize=5.5, markerfacecolor=colour if row.complete else "white")
    if row.next == row.next:
        axes.plot(end, y, "X", color=colour, markersize=5.5)
    axes.text(1.02, y, answer(row), transform=axes.get_yaxis_transform(), va="center", fontsize=8.5)


def answer(row):
    """The largest N of a row of largest.csv, with the misses there and at the next size."""
    text = f"{row.largest:.0f}"
    if row.largest:
        text += f": {row.missed} ({row.null_missed})" + (f", {row.status}" if row.status != "ok" else "")
    if row.next == row.next:
        text += f"; {row.next:.0f}: " + (f"{row.next_missed} ({row.next_null_missed})" if row.next_status in FINISHED else row.next_status)
    if not row.complete or row.next != row.next:
        text += "; or more" + (", as the budget was spent" if not row.complete else "")
    return text
