# Distributions of step times against the deadline, and the largest mechanisms in real time.
import matplotlib.pyplot as plt
import numpy

from analysis.core.outcomes import FINISHED
from analysis.core.style import GREY, line_each, nothing, number_axis

FORMS = {"penalty": ("#0072B2", "o", -0.17), "saddle-point": ("#D55E00", "s", 0.17)}  # colour, marker, place in a line
LEFT = 0.7  # of the axis of sizes


def draw(tables, view):
    return {"steps": distributions(tables["steps"], tables["machine"]),
            "largest": sizes(tables["largest"])}


def distributions(table, machine):
    """A panel a deadline and size: from the median to the longest step, a line an implementation. Deadlines of one size stand side
    by side."""
    table, left = run_of(table, table.status == "dropped")
    if table.median_us.notna().sum() == 0:
        return nothing("No run of which there are step times.")
    steps, loops, names = sorted(table.step.unique(), reverse=True), sorted(table.loops.unique()), order(table)
    lines, columns = (len(steps), len(loops)) if len(loops) > 1 else (1, len(steps))
    figure, panels = plt.subplots(lines, columns, sharey=True, squeeze=False, constrained_layout=True,
                                  figsize=(5.2 * columns + 1.5, (0.27 * len(names) + 1.1) * lines + 0.4))
    for line, step in zip(panels.reshape(len(steps), len(loops)), steps):
        gaps = machine[(machine.after == "distributions") & (machine.step == step)].largest_us.dropna()
        for axes, size in zip(line, loops):
            _panel(axes, table[(table.step == step) & (table.loops == size)], names)
            axes.axvline(1e6 * step, color="black", linewidth=1.2, linestyle=(0, (4, 2)))
            for gap in gaps:
                axes.axvline(gap, color=GREY, linewidth=1.2, linestyle=(0, (1, 1.5)))
            axes.set_title(f"N = {size:g}, deadline {1e3 * step:g} ms")
    for axes in panels[-1]:
        axes.set_xlabel("time of a step, µs")
    figure.suptitle("Times of steps, as observed in one run", x=0.01, ha="left", fontsize=12)
    handles = [plt.Line2D([], [], color=colour, marker=marker, label=f"{form}: median")
               for form, (colour, marker, _) in FORMS.items() if form in set(table.scheme)]
    handles += [plt.Line2D([], [], color=GREY, marker="|", linestyle="none", markersize=9, label="99 %, 99.9 %"),
                plt.Line2D([], [], color=GREY, marker="x", linestyle="none", label="longest"),
                plt.Line2D([], [], color="black", linestyle=(0, (4, 2)), label="deadline"),
                plt.Line2D([], [], color=GREY, linestyle=(0, (1, 1.5)), label="longest gap of the null process")]
    handles += left
    others = sorted(set(table.status[table.median_us.notna()]) - {"ok"})
    if others:
        handles.append(plt.Line2D([], [], color=GREY, marker="o", markerfacecolor="white", linestyle="none",
                                  label=f"hollow: {', '.join(others)}"))
    figure.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=4)
    return figure


def run_of(table, dropped):
    """Without what the budget dropped; and an entry of the legend that counts it."""
    return table[~dropped], [plt.Line2D([], [], color="none", label=f"not drawn: {dropped.sum()} that the budget dropped")] if dropped.any() else []


def order(table):
    """Implementations, the fastest first: by their median in the first scheme over all panels; without times last."""
    rows = table[table.scheme == table.scheme.iloc[0]]
    middle = rows.groupby("implementation", sort=False).median_us.apply(lambda times: numpy.log(times).mean())
    return list(middle.sort_values(na_position="last", kind="stable").index)


def _panel(axes, rows, names):
    for row in rows.itertuples():
        colour, marker, shift = FORMS[row.scheme]
        y = names.index(row.implementation) + shift
        if row.median_us != row.median_us:  # there are no times
            axes.text(0.02, y, row.status, transform=axes.get_yaxis_transform(), color=colour, va="center", fontsize=7)
            continue
        axes.plot([row.median_us, row.max_us], [y, y], color=colour, linewidth=1, alpha=0.6)
        axes.plot(row.median_us, y, marker, color=colour, markersize=4.5,
                  markerfacecolor=colour if row.status == "ok" else "white")
        axes.plot([row.p99_us, row.p999_us], [y, y], "|", color=colour, markersize=8)
        axes.plot(row.max_us, y, "x", color=colour, markersize=4.5)
    axes.set_xscale("log")
    line_each(axes, names)


def sizes(table):
    """The largest size that was kept up with and the next one that was not, with the misses of both."""
    table, left = run_of(table, table.largest.isna())
    if table.empty:
        return nothing("No search was made.")
    steps = sorted(table.step.unique(), reverse=True)
    names = list(table.groupby("implementation").largest.max().sort_values(ascending=False, kind="stable").index)
    shown = [form for form in FORMS if form in set(table.scheme)]
    figure, panels = plt.subplots(1, len(steps), sharey=True, squeeze=False, constrained_layout=True,
                                  figsize=(6.6 * len(steps) + 1.5, (0.2 + 0.22 * len(shown)) * len(names) + 1.7))
    for axes, step in zip(panels[0], steps):
        for row in table[table.step == step].itertuples():
            _search(axes, row, names.index(row.implementation), len(shown) > 1)
        known = [size for size in (*table.largest.dropna(), *table.next.dropna()) if size > 0]
        axes.set_xlim(LEFT if (table.largest == 0).any() else 0.6 * min(known, default=1), 1.6 * max(known, default=1))
        number_axis(axes.xaxis)
        axes.set_title(f"step and deadline {1e3 * step:g} ms")
        axes.set_xlabel("N of the four-bar (n = 2N + 2 variables)")
        line_each(axes, names)
    figure.suptitle("Largest N in real time", x=0.01, ha="left", fontsize=12)
    handles = [plt.Line2D([], [], color=FORMS[form][0], marker=FORMS[form][1], linestyle="none",
                          label=f"{form}: kept up with") for form in shown]
    handles += [plt.Line2D([], [], color=GREY, marker="X", linestyle="none", label="next size tried: not kept up with"),
                plt.Line2D([], [], color="none", label="right: N, steps missed (lost by the null process)")]
    figure.legend(handles=[*handles, *left], loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=4)
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
        text += f"; {row.next:.0f}: " + (f"{row.next_missed} ({row.next_null_missed})" if row.next_status in FINISHED
                                         else row.next_status)
    if not row.complete or row.next != row.next:
        text += "; or more" + (", as the budget was spent" if not row.complete else "")
    return text
