# Share of a step's time by phase, natural fill: one panel a size, one bar an implementation.
import matplotlib.pyplot as plt

from analysis.style import GREY, figure_main
from analysis.loader import PHASES
from analysis.statistics import phase_shares

# Light to dark and back, so that neighbours stay apart in black and white; hatches mark algebra.
FILLS = {"evaluation": ("#cfe3f2", ""), "assembly": ("#6baed6", ""),
         "factorization": ("#08519c", ""), "solve": ("#e6a141", ""),
         "projection": ("#f6dcae", ""), "other": ("#e4e4e4", "....")}
LABELS = {"evaluation": "evaluation (Φ, Φq, f)", "assembly": "tangent assembly",
          "factorization": "factorization", "solve": "solves", "projection": "projections (rhs)",
          "other": "other"}


def draw(results):
    tidy = results.tidy
    rows = tidy[(tidy.kind == "phases") & (tidy.status == "ok")]
    sizes = sorted(rows.variables.unique())
    count = max(1, len(sizes))
    widest = max([1, *rows.groupby("variables").implementation.nunique()])
    figure, panels = plt.subplots(count, 1, sharex=True, squeeze=False,
                                  figsize=(7.6, 1.0 + count * (0.12 + 0.25 * widest)),
                                  gridspec_kw={"hspace": 0.5 / widest})
    for size, axes in zip(sizes, panels[:, 0]):
        _panel(axes, size, rows[rows.variables == size], results.implementations)
    bottom = panels[-1, 0]
    bottom.set_xlabel("share of the time of a step, %")
    handles = [plt.Rectangle((0, 0), 1, 1, facecolor=colour, hatch=hatch, edgecolor="white",
                             label=LABELS[phase]) for phase, (colour, hatch) in FILLS.items()]
    panels[0, 0].legend(handles=handles, ncol=3, loc="lower left", bbox_to_anchor=(-0.01, 1.0),
                        fontsize=8.5, handlelength=1.4, columnspacing=1.4)
    panels[0, 0].set_title("Share of a step's time by phase, natural fill", pad=48)
    return figure


def _panel(axes, size, rows, names):
    present = [name for name in names if name in set(rows.implementation)]
    for place, name in enumerate(reversed(present)):
        shares = phase_shares(rows[rows.implementation == name], PHASES)
        left = 0.0
        for phase in PHASES:
            share = 100 * shares[phase]
            colour, hatch = FILLS[phase]
            axes.barh(place, share, left=left, height=0.78, color=colour, hatch=hatch,
                      edgecolor="white", linewidth=0.6)
            if share >= 5:
                axes.text(left + share / 2, place, f"{share:.0f}", ha="center", va="center",
                          fontsize=8, color="white" if phase == "factorization" else "#222222")
            left += share
    axes.set_yticks(range(len(present)), reversed(present), fontsize=8.5)
    axes.set(xlim=(0, 100), ylim=(-0.6, len(present) - 0.4))
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    if not axes.get_subplotspec().is_last_row():
        axes.spines["bottom"].set_visible(False)
        axes.tick_params(axis="x", length=0)
    axes.text(1.01, 0.5, f"n = {size:g}", transform=axes.transAxes, va="center", color=GREY)


if __name__ == "__main__":
    assert set(FILLS) == set(PHASES)
    figure_main(draw)
