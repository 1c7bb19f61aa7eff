# Stale pivots: worst backward error by sequence, strategy and choice of pivots; what a solve costs.
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D

STRATEGIES = {"refactor": ("o", -0.24), "guarded": ("s", 0.0), "factor": ("^", 0.24)}
COLOURS = {"diagonal": "#009E73", "default": "#0072B2", "largest": "#D55E00"}
ROUNDING = 2.0**-53


def draw(table):
    """The figure of pivots.csv."""
    sequences = list(dict.fromkeys(zip(table.form, table.sequence)))
    sequences.sort(key=lambda one: one[0])  # stable: by form
    figure, (errors, times) = plt.subplots(1, 2, sharey=True, constrained_layout=True, width_ratios=(3, 2),
                                           figsize=(11, 0.48 * len(sequences) + 1.8))
    for place, (form, sequence) in enumerate(sequences):
        rows = table[(table.form == form) & (table.sequence == sequence)]
        for row in rows.itertuples():
            marker, shift = STRATEGIES[row.strategy]
            look = _look(marker, row.pivoting)
            errors.plot(row.error_worst, place + shift, **look)
            if row.ratio_high < float("inf"):
                times.plot((row.ratio_low, row.ratio_high), (place + shift,) * 2, color=look["color"], linewidth=1, zorder=1)
            times.plot(row.time_ratio, place + shift, **look)
        if place % 2:
            for axes in (errors, times):
                axes.axhspan(place - 0.5, place + 0.5, color="#f4f5f7", zorder=0)
    figure.suptitle("Pivots that are kept: what they lose, and what choosing them anew costs", x=0.01, ha="left")
    errors.set_yticks(range(len(sequences)), [f"{sequence} ({form})" for form, sequence in sequences], fontsize=8.5)
    errors.set_ylim(len(sequences) - 0.5, -0.5)
    errors.set_xscale("log")
    errors.axvline(ROUNDING, color="black", linewidth=0.8, linestyle=":")
    errors.set_xlabel("worst backward error of a solve (dotted: rounding, 2⁻⁵³)")
    times.set_xlabel("time of factorization and solve, over\nrefactor with default pivots (95 % intervals)")
    times.axvline(1, color="black", linewidth=0.8)
    figure.legend(handles=[*(Line2D([], [], marker=marker, linestyle="none", color="#555555", label=name)
                             for name, (marker, _) in STRATEGIES.items()),
                           *(Line2D([], [], label=f"{name} pivots", **_look("o", name))
                             for name in COLOURS if name in set(table.pivoting))],
                  loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=6, fontsize=9)
    return figure


def _look(marker, pivoting):
    """Diagonal pivots are a ring, as default ones often lie on them."""
    ring = pivoting == "diagonal"
    return {"marker": marker, "linestyle": "none", "color": COLOURS[pivoting], "markersize": 10 if ring else 6,
            "markerfacecolor": "none" if ring else COLOURS[pivoting], "markeredgewidth": 1.2 if ring else 0.6,
            "markeredgecolor": COLOURS[pivoting] if ring else "white"}
