# Bars of a step's time by phase.
import matplotlib.pyplot as plt

# Light to dark and back, so that neighbours stay apart in black and white.
FILLS = {"evaluation": "#cfe3f2", "assembly": "#6baed6", "factorization": "#08519c",
         "solve": "#e6a141", "projection": "#f6dcae", "other": "#e4e4e4"}
LABELS = {"evaluation": "evaluation (Φ, Φq, f)", "assembly": "tangent assembly",
          "factorization": "factorization", "solve": "solves", "projection": "projections (rhs)",
          "other": "other"}


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
