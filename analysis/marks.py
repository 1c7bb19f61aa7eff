# Cells that have no time: rough pilots drawn hollow, failures as crosses, and all reasons as text.
import textwrap

import numpy

from analysis.style import GREY

SYMBOLS = {"excluded": "○"}  # every other status is a failure
FAILED = "✕"  # the mark of those
ROUGH = "too slow, rough time of the pilot"
TOP = 0.985  # share of the axes' height at which the first row of crosses stands


def lost(rows, kind="timing"):
    """One row a cell for what `rows` of the tidy table could not time, in their order."""
    cells = rows[(rows.kind == kind) & ~rows.status.isin(["ok", "not-reached"])]
    return cells.drop_duplicates(["scene", "implementation"])


def natural_cells(results, names):
    """All timing rows at natural fill of these names, whatever their status."""
    tidy = results.tidy
    return tidy[(tidy.kind == "timing") & tidy.fill_asked.isna() & tidy.implementation.isin(names)]


def rough(cells):
    """Of lost cells those that have a pilot's rough time."""
    return cells[(cells.status == "excluded") & cells.pilot_step_us.notna()]


def draw_hollow(axes, cells, line, x="variables", scale=None):
    """Rough times of excluded cells as hollow markers without a line. `line(name)` gives the
    keywords of the series, `scale(row)` what its time is divided by (None: not drawn)."""
    for row in rough(cells).itertuples():
        divisor = 1.0 if scale is None else scale(row)
        if divisor and numpy.isfinite(getattr(row, x)):
            colour = line(row.implementation)["color"]
            axes.plot(getattr(row, x), row.pilot_step_us / divisor, linestyle="none",
                      marker=line(row.implementation)["marker"], markersize=6, label="_",
                      markerfacecolor="none", markeredgecolor=colour, markeredgewidth=1.1)


def draw_crosses(axes, cells, line, x="variables"):
    """A cross at the top of the axes for every failed cell, and for every excluded one without a
    rough time; a row of crosses a series."""
    marked = cells.drop(rough(cells).index)
    marked = marked[marked[x].notna()]
    for place, (name, mine) in enumerate(marked.groupby("implementation", sort=False)):
        axes.plot(mine[x], [TOP - 0.035 * place] * len(mine), linestyle="none", marker="x",
                  markersize=6, markeredgewidth=1.8, color=line(name)["color"], label="_",
                  transform=axes.get_xaxis_transform(), clip_on=False)


def reasons(cells, where=lambda row: f"{row.variables:g}", form="n = {}", width=150):
    """Lines that name every lost cell: "✕ disagrees, <reason>: a/x (n = 50, 82), …"."""
    groups, pilots = {}, set(rough(cells).index)
    for row in cells.itertuples():
        reason = f"hollow: {ROUGH}" if row.Index in pilots else row.reason
        places = groups.setdefault((row.status, reason), {}).setdefault(row.implementation, [])
        if numpy.isfinite(row.variables):
            places.append(where(row))
    lines = []
    for (status, reason), names in groups.items():
        text = "; ".join(f"{name} ({form.format(', '.join(places))})" if places else name
                         for name, places in names.items())
        symbol = SYMBOLS.get(status, FAILED)
        lines += textwrap.wrap(f"{symbol} {status} – {reason}: {text}", width,
                               subsequent_indent="    ")
    return lines


def footnote(figure, lines, y=0.0):
    """Small text below all axes of a figure."""
    figure.text(figure.subplotpars.left, y, "\n".join(lines), fontsize=7.5, color=GREY, va="top",
                linespacing=1.35)
