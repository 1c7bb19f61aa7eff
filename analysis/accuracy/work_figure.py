# Error against time of one subject: all implementations with the default setting, then the settings of the
# sparse and of the dense implementation that is best with it. The Pareto front of all runs is in every panel.
import matplotlib.pyplot as plt
import matplotlib.patheffects as effects
import numpy
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator

from analysis.accuracy import names
from analysis.accuracy.front import FINISHED, finished, pareto
from analysis.style import DASHES, GREY, MARKERS, missing, number_axis

PLATE = [effects.withStroke(linewidth=2.5, foreground="white")]
DEFAULT = "default"


def draw(rows, look, dense, unit, title):
    """The figure of one subject's rows of work.csv. `dense`: {implementation: bool}."""
    figure, panels = plt.subplots(1, 3, figsize=(16, 6.4), sharex=True, sharey=True)
    figure.subplots_adjust(left=0.05, right=0.99, bottom=0.1, top=0.88, wspace=0.05)
    usual = rows[rows.setting == DEFAULT]
    _default_panel(panels[0], usual, look)
    panels[0].set_title("every implementation, default setting")
    for axes, kind in zip(panels[1:], (False, True)):
        name = best(usual[usual.implementation.map(dense) == kind], rows)
        word = "dense" if kind else "sparse"
        if name is None:
            missing(axes, f"no {word} implementation has a curve")
            continue
        _settings_panel(axes, rows[rows.implementation == name])
        axes.set_title(f"settings of {name} ({word})")
    members = front_members(rows)
    for axes in panels:
        if axes.axison:
            _front(axes, rows, members)
            axes.set(xscale="log", yscale="log", xlabel="computation for a simulated second, s")
            axes.grid(True)
    for axis in (panels[0].xaxis, panels[0].yaxis) if members else ():
        number_axis(axis)
    if members and numpy.ptp(numpy.log10(panels[0].get_xlim())) > 1.5:
        panels[0].xaxis.set_major_locator(LogLocator())  # the panels are narrow
    panels[0].set_ylabel(f"error, {unit}")
    figure.suptitle(title, x=0.01, ha="left", fontsize=13)
    _key(figure, members)
    return figure


def best(rows, everything):
    """The implementation whose settings are worth a panel: it ran the most of them, and among those the
    least time with the default one (`rows`), over the steps that it shares with others."""
    done = finished(rows)
    if done.empty:
        return None
    times = done.pivot_table(index="step", columns="implementation", values="time")
    slowness = times.div(times.min(axis=1), axis=0).median()
    settings = finished(everything).groupby("implementation").setting.nunique()
    return min(slowness.index, key=lambda name: (-settings[name], slowness[name]))


def front_members(rows):
    """{(implementation, setting): its rows on the front, the fastest first}, the fastest member first."""
    found = {}
    for row in rows.loc[pareto(rows)].itertuples():
        found.setdefault((row.implementation, row.setting), []).append(row)
    return found


def _default_panel(axes, rows, look):
    for name, mine in rows.groupby("implementation", sort=False):
        _curve(axes, mine, look.line(name) | {"linewidth": 1.1, "markersize": 4.5}, name)
    _legend(axes, 3 if rows.implementation.nunique() > 12 else 2)


def _settings_panel(axes, rows):
    """Colours by kind; markers tell the settings of a kind apart."""
    used = {}
    for setting, mine in rows.groupby("setting", sort=False):
        kind = names.family(setting)
        place = used[kind] = used.get(kind, -1) + 1
        colour = names.FAMILIES[kind](0.92 - 0.11 * place)
        _curve(axes, mine, {"color": colour, "linewidth": 1.1, "markersize": 4.5,
                            "marker": MARKERS[place % len(MARKERS)],
                            "linestyle": DASHES[place % len(DASHES)]}, setting)
    _legend(axes, 3)


def _curve(axes, rows, line, label):
    """A curve over the step; runs that did not finish are crosses at the upper edge, at their time."""
    done = finished(rows).sort_values("step")
    clipped = done.at_most.astype(bool)
    if done.empty:
        lost = next((reason for status, reason in (("not-run", "left out"), ("unsupported", "unsupported"))
                     if rows.status.isin((status, "not-run")).all()), "no run finished")
        axes.plot([], [], **line, label=f"{label}: {lost}")
    else:
        axes.plot(done.time, done.error, **line, label=label)
    axes.plot(done.time[clipped], done.error[clipped], linestyle="none", marker="v", markersize=9,
              markerfacecolor="none", markeredgecolor=line["color"])
    # What is unsupported has made no step.
    lost = rows[~rows.status.isin((*FINISHED, "not-run", "unsupported")) & (rows.step_us > 0)]
    times = 1e-6 * lost.step_us / lost.step
    axes.plot(times, numpy.full(len(lost), 0.985), "x", color=line["color"], markersize=5,
              transform=axes.get_xaxis_transform(), clip_on=False)


def _front(axes, rows, members):
    line = rows.loc[pareto(rows)]
    axes.plot(line.time, line.error, color="black", linewidth=3.2, alpha=0.28, zorder=1,
              solid_capstyle="round", drawstyle="steps-post")
    numbers = {(row.time, row.error): number for number, mine in enumerate(members.values(), start=1)
               for row in mine}
    last = None
    for (time, error), number in sorted(numbers.items()):
        at = numpy.log10([time, error])
        if last is not None and numpy.abs(at - last).max() < 0.12:
            continue  # it would cover its neighbour's number
        last = at
        axes.annotate(f"{number}", (time, error), xytext=(-7, -8), fontsize=8.5, zorder=9, ha="center",
                      textcoords="offset points", fontweight="bold", path_effects=PLATE)


def _legend(axes, columns):
    axes.legend(fontsize=7.5, loc="upper left", bbox_to_anchor=(-0.02, -0.1), ncols=columns,
                handlelength=2.0, labelspacing=0.3, columnspacing=0.7)


def _key(figure, members):
    """The members of the front, by their numbers, below the panels; and the marks."""
    entries = []
    for number, ((implementation, setting), mine) in enumerate(members.items(), start=1):
        steps = " … ".join(dict.fromkeys(names.step(row.step) for row in (mine[0], mine[-1])))
        entries.append(Line2D([], [], linestyle="none",
                              label=f"{number}  {implementation}, {setting}: {steps}"))
    marks = [Line2D([], [], color="black", alpha=0.28, linewidth=3.2,
                    label="Pareto front of all runs; its members:"),
             Line2D([], [], color=GREY, marker="x", linestyle="none",
                    label="upper edge: did not finish (status in work.csv)"),
             Line2D([], [], color=GREY, marker="v", markerfacecolor="none", linestyle="none",
                    label="at most: below the reference's own error")]
    figure.legend(handles=[*marks, *entries], loc="upper center", bbox_to_anchor=(0.5, -0.15), ncols=4,
                  fontsize=8, handlelength=1.6, columnspacing=1.2)
