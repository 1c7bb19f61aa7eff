# How figures show what has no time: rough pilots hollow, failures as crosses at the top. The page has the reasons.
import numpy

TOP = 0.985  # share of the axes' height at which the first row of crosses stands
NOTE = "hollow: excluded, rough time of the pilot; crosses: failed (reasons: table of failures)"


def lost(rows):
    """One row a scene and contender of what was not timed, in their order."""
    found = rows[~rows.status.isin(["ok", "dropped"])]
    timed = rows[rows.status == "ok"].set_index(["scene", "implementation"]).index
    found = found[~found.set_index(["scene", "implementation"]).index.isin(timed)]
    return found.drop_duplicates(["scene", "implementation"])


def draw_lost(axes, cells, line, x, scale=None):
    """`line(name)`: keywords of the series; `scale(row)`: what a time is divided by (None: not drawn)."""
    crosses = []
    for row in cells[cells[x].notna()].itertuples():
        divisor = 1.0 if scale is None else scale(row)
        if row.status not in ("excluded", "slower") or not row.pilot_us > 0:
            crosses.append(row)
        elif divisor and numpy.isfinite(getattr(row, x)):
            axes.plot(getattr(row, x), row.pilot_us / divisor, linestyle="none", marker=line(row.implementation)["marker"],
                      markersize=6, label="_", markerfacecolor="none", markeredgecolor=line(row.implementation)["color"],
                      markeredgewidth=1.1)
    places = {name: place for place, name in enumerate(dict.fromkeys(row.implementation for row in crosses))}
    for row in crosses:
        axes.plot(getattr(row, x), TOP - 0.035 * places[row.implementation], linestyle="none", marker="x", markersize=6,
                  markeredgewidth=1.8, color=line(row.implementation)["color"], label="_",
                  transform=axes.get_xaxis_transform(), clip_on=False)


def footnote(figure, lines, y):
    """Small text below all axes of a figure."""
    figure.text(figure.subplotpars.left, y, "\n".join(lines), fontsize=7.5, color="#777777", va="top", linespacing=1.35)
