# Shares of a step's time by phase, of every variant. Table 1's claims compare those of the starting versions with the paper's.
import matplotlib.pyplot as plt

from analysis.core.statistics import phase_shares
from analysis.core.style import GREY, missing
from analysis.map.compare import profiled
from analysis.map.tidy import PHASES

SIZES = (22, 82)
WHOLE = 0.99  # of a step in "other": it has no phases
# Light to dark and back, so that neighbours stay apart in black and white.
FILLS = {"evaluation": "#cfe3f2", "assembly": "#6baed6", "factorization": "#08519c",
         "solve": "#e6a141", "projection": "#f6dcae", "other": "#e4e4e4"}
LABELS = {"evaluation": "evaluation (Φ, Φq, f)", "assembly": "tangent assembly",
          "factorization": "factorization", "solve": "solves", "projection": "projections (rhs)",
          "other": "other"}


def panel_sizes(results):
    """The two sizes of the paper if one of them was profiled, else the two largest that were."""
    there = sorted(profiled(results).variables.unique())
    return SIZES if not there or set(there) & set(SIZES) else there[-2:]


def draw(results):
    names, sizes = results.implementations, panel_sizes(results)
    figure, panels = plt.subplots(1, len(sizes), sharey=True, squeeze=False, figsize=(9.6, 1.6 + 0.2 * max(4, len(names))),
                                  gridspec_kw={"wspace": 0.06})
    for axes, size in zip(panels[0], sizes):
        all_panel(axes, results, size, names, axes is panels[0][0])
    return figure


def all_panel(axes, results, size, names, first):
    """A bar of all phases for each of `names`; `first`: with names, legend and title."""
    if not len(profiled(results, size=size)):
        missing(axes, f"no profiled runs at n = {size:g}")
        return
    for place, name in enumerate(names):
        rows = profiled(results, name, size)
        shares = phase_shares(rows, PHASES) if len(rows) else {}
        if not shares:
            axes.text(1, place, "not profiled at this size", va="center", fontsize=7.5, color=GREY)
        elif shares["other"] > WHOLE:
            axes.text(1, place, "all in the same sweeps", va="center", fontsize=7.5)
        else:
            bar(axes, place, [(phase, 100 * share) for phase, share in shares.items()], FILLS, False)
    axes.set_yticks(range(len(names)), names, fontsize=8.5)
    axes.set(xlim=(0, 100), ylim=(len(names) - 0.4, -0.6),
             xlabel=f"n = {size:g}: share of the time of a step, %")
    axes.tick_params(axis="y", length=0, labelleft=first)
    axes.spines["left"].set_visible(False)
    if first:
        legend(axes, FILLS, LABELS)
        axes.set_title("All phases, every variant", pad=26)


def bar(axes, place, shares, fills, outlined):
    left = 0.0
    for key, share in shares:
        axes.barh(place, share, left=left, height=0.8, color=fills[key],
                  edgecolor="black" if outlined else "white", linewidth=0.8 if outlined else 0.5)
        if share >= 3.5:
            axes.text(left + share / 2, place, f"{share:.0f}", ha="center", va="center",
                      fontsize=7.5, color="white" if fills[key] == "#08519c" else "#222222")
        left += share


def legend(axes, fills, labels):
    handles = [plt.Rectangle((0, 0), 1, 1, facecolor=colour, edgecolor="white", label=labels[key])
               for key, colour in fills.items()]
    axes.legend(handles=handles, ncol=len(handles), loc="lower left", fontsize=8.5,
                bbox_to_anchor=(-0.01, 0.99), handlelength=1.2, columnspacing=1.2, borderpad=0.2)
