# Distributions of step times against the deadline, and the largest scenes in real time.
import matplotlib.pyplot as plt
import numpy

from analysis.style import GREY

LEFT = 0.7  # of the axis of sizes
FORMS = {"penalty": ("#0072B2", "o"), "saddle-point": ("#D55E00", "s")}


def distributions(table):
    """A panel a size and step: from the median to the largest step, one line an implementation."""
    steps, sizes = sorted(table.step.unique(), reverse=True), sorted(table.loops.unique())
    names = order(table)
    figure, panels = plt.subplots(len(steps), len(sizes), sharey=True, squeeze=False,
                                  constrained_layout=True,
                                  figsize=(5.2 * len(sizes) + 1.5, (0.27 * len(names) + 1.1) * len(steps)))
    for line, step in zip(panels, steps):
        for axes, loops in zip(line, sizes):
            rows = table[(table.step == step) & (table.loops == loops)]
            _panel(axes, rows, names)
            axes.axvline(1e6 * step, color="black", linewidth=1.2, linestyle=(0, (4, 2)))
            axes.set_title(f"N = {loops}, deadline {1e3 * step:g} ms")
    for axes in panels[-1]:
        axes.set_xlabel("time of a step, µs")
    handles = [plt.Line2D([], [], color=colour, marker=marker, label=f"{form}: median")
               for form, (colour, marker) in FORMS.items()]
    handles += [plt.Line2D([], [], color=GREY, marker="|", linestyle="none", markersize=9,
                           label="99 %, 99.9 %"),
                plt.Line2D([], [], color=FORMS["penalty"][0], marker="x", linestyle="none", label="largest"),
               plt.Line2D([], [], color=GREY, marker="x", linestyle="none", alpha=0.6, markersize=4,
                          label="largest with what interrupts"),
                plt.Line2D([], [], color="black", linestyle=(0, (4, 2)), label="deadline")]
    others = sorted(set(table.status[table.median_us.notna()]) - {"ok"})
    if others:
        handles.append(plt.Line2D([], [], color=GREY, marker="o", markerfacecolor="white", linestyle="none",
                                  label=f"hollow: {', '.join(others)}"))
    figure.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=len(handles))
    return figure


def order(table):
    """Implementations, the fastest first: by their median in penalty form over all panels."""
    rows = table[table.scheme == "penalty"]
    return list(rows.groupby("implementation").median_us.apply(
        lambda times: numpy.log(times).mean()).sort_values().index)


def _panel(axes, rows, names):
    for place, name in enumerate(names):
        for form, (colour, marker) in FORMS.items():
            for row in rows[(rows.implementation == name) & (rows.scheme == form)].itertuples():
                y = place + (0.17 if form == "saddle-point" else -0.17)
                axes.plot([row.median_us, row.max_us], [y, y], color=colour, linewidth=1, alpha=0.6)
                if row.median_us != row.median_us:  # there are no times
                    axes.text(0.02, y, row.status, transform=axes.get_yaxis_transform(), color=colour,
                              va="center", fontsize=6.5)
                axes.plot(row.median_us, y, marker, color=colour, markersize=4.5,
                          markerfacecolor=colour if row.status == "ok" else "white")
                axes.plot([row.p99_us, row.p999_us], [y, y], "|", color=colour, markersize=8)
                axes.plot(row.max_us, y, "x", color=colour, markersize=4.5)
                axes.plot(row.observed_max_us, y, "x", color=GREY, alpha=0.6, markersize=3.5)
    axes.set_xscale("log")
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.grid(axis="x")


def answer(row):
    """The largest N of a row of largest.csv, with what else must be known of it."""
    end = row.next != row.next  # nothing larger was tried
    remarks = [row.status] if row.largest and row.status != "ok" else []
    if end or not row.next_reason.endswith("deadline"):
        remarks.append(row.next_reason if end else f"{row.next_reason.split(':')[0]} above")
    remarks += [] if row.confirmed else ["not confirmed"]
    return f"{row.largest}{' or more' * end}" + (f" ({'; '.join(remarks)})" if remarks else "")


def sizes(table):
    """Bars: the largest N in real time, a panel a step; what ended the search beside each."""
    steps = sorted(table.step.unique(), reverse=True)
    names = list(table.groupby("implementation").largest.max().sort_values(ascending=False).index)
    figure, panels = plt.subplots(1, len(steps), sharey=True, squeeze=False, constrained_layout=True,
                                  figsize=(5.8 * len(steps) + 1.5, 0.36 * len(names) + 1.3))
    for axes, step in zip(panels[0], steps):
        for place, name in enumerate(names):
            for form, (colour, _) in FORMS.items():
                rows = table[(table.step == step) & (table.implementation == name)
                             & (table.scheme == form)]
                for row in rows.itertuples():
                    y = place + (0.19 if form == "saddle-point" else -0.19)
                    axes.barh(y, max(row.largest, LEFT) - LEFT, 0.36, left=LEFT, color=colour)
                    axes.text(max(row.largest, LEFT) * 1.12, y, answer(row), va="center", fontsize=7.5)
        axes.set_xscale("log")
        axes.set_xlim(LEFT, 300 * max(table.largest.max(), 1))
        axes.set_title(f"step and deadline {1e3 * step:g} ms")
        axes.set_xlabel("largest N in real time (n = 2N + 2)")
        axes.set_yticks(range(len(names)), names)
        axes.set_ylim(len(names) - 0.4, -0.6)
        axes.grid(axis="x")
    figure.legend(handles=[plt.Rectangle((0, 0), 1, 1, color=colour, label=form)
                           for form, (colour, _) in FORMS.items()],
                  loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=2)
    return figure
