# The trials: true error over the distance from a change point, or over a light mass; colour: what the program said.
import matplotlib.pyplot as plt
import numpy
from matplotlib.lines import Line2D

from analysis.core.outcomes import GOOD
from analysis.extremes import judge, verdicts
from analysis.extremes.battery_figure import LOOKS, SILENT

FLOOR, TOP = 1e-16, 10.0  # errors beyond are drawn at these
STOPPED = 1e2             # where runs are drawn that stopped: they have no error at the end
PANELS = {"driven": "driven linkages", "free": "free linkages", "light": "light parts"}


def draw(table):
    """The figure of the rows of battery.csv that have a distance."""
    table = table[table.near.notna() & (table.verdict != "") & ~table.axis.str.startswith("uneven")]
    panels = [(word, rows) for word in PANELS for rows in [table[table.axis.str.startswith(word)]] if len(rows)]
    figure, grid = plt.subplots(1, len(panels), sharey=True, squeeze=False, constrained_layout=True, figsize=(4.6 * len(panels) + 1, 4.8))
    used = {}
    for axes, (word, rows) in zip(grid[0], panels):
        aside = numpy.random.default_rng(1).uniform(-0.3, 0.3, len(rows))
        error = rows.true_error.clip(FLOOR, TOP).fillna(STOPPED)
        colours = [SILENT if row.verdict == verdicts.SILENT else _look(row.status)[0] for row in rows.itertuples()]
        at, error = rows.near * 10**aside, error * numpy.where(rows.true_error.isna(), 10**aside[::-1], 1)
        axes.scatter(at, error, c=colours, s=9, linewidths=0)
        wrong = rows.verdict.isin((verdicts.SILENT, verdicts.FALSE)).to_numpy()
        axes.scatter(at[wrong], error[wrong], facecolors="none", edgecolors="black", s=26, linewidths=0.7)
        used |= {_look(status)[1]: _look(status)[0] for status in rows.status}
        axes.axhline(judge.CLASS, color="black", linewidth=0.8)
        axes.set(xscale="log", yscale="log", ylim=(FLOOR / 3, STOPPED * 6), title=f"{PANELS[word]}: {len(rows)} runs",
                 xlabel="mass of the light part, kg" if word == "light" else "distance from the change point, m")
        axes.grid(True, axis="y")
    grid[0][0].set_ylabel("true error, lengths of the shortest link (above: stopped)")
    handles = [Line2D([], [], marker="o", linestyle="", color=colour, label=label) for label, colour in used.items()]
    handles += [Line2D([], [], marker="o", linestyle="", color=SILENT, label="silently wrong"),
                Line2D([], [], marker="o", linestyle="", markerfacecolor="none", color="black", label="silently wrong or false alarm")]
    figure.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=6, fontsize=8)
    counts = [(table.verdict == what).sum() for what in (verdicts.SILENT, verdicts.FALSE)]
    figure.suptitle(f"{counts[0]} silently wrong, {counts[1]} false alarms of {len(table)} runs; line: a hundredth of a link", x=0.01, ha="left")
    return figure


def _look(status):
    """(colour, label) of an outcome."""
    name = "ok" if status in GOOD else status if status in LOOKS else "other"
    return LOOKS[name][0], LOOKS[name][2] or name
