# The common look of all figures, and the command line that every figure script has.
import string
import sys

import matplotlib
import matplotlib.pyplot as plt

from analysis.loader import TableError, load

# Okabe and Ito (2008), safe for the colour-blind, ordered so that neighbours differ in lightness
# too; markers and dashes tell the series apart without colour.
COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#000000", "#8a8a00")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
DASHES = ("-", "--", "-.", (0, (1, 1)), (0, (5, 1)), (0, (3, 1, 1, 1, 1, 1)))
GREY = "#777777"

matplotlib.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 9.5, "axes.titlesize": 11, "axes.labelsize": 10,
    "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": "#444444",
    "axes.titlelocation": "left", "axes.titlepad": 10, "grid.color": "#dddddd",
    "grid.linewidth": 0.6, "legend.frameon": False, "figure.facecolor": "white",
    "svg.hashsalt": "mbs", "savefig.dpi": 160, "hatch.linewidth": 0.7, "hatch.color": "#00000066"})


class Look:
    """Colour, marker, dash and letter of each implementation by its place in the registry."""

    def __init__(self, results):
        names = [variant["name"] for entry in results.registry for variant in entry["variants"]]
        self.place = {name: index for index, name in enumerate(names)}

    def colour(self, name):
        return COLOURS[self.place[name] % len(COLOURS)]

    def letter(self, name):
        return string.ascii_uppercase[self.place[name] % 26]

    def marker(self, name):
        return MARKERS[self.place[name] % len(MARKERS)]

    def dash(self, name):
        return DASHES[self.place[name] % len(DASHES)]


def figure_main(draw):
    """Runs `draw(results) -> Figure` for the command line RESULTS_DIR OUTPUT..."""
    if len(sys.argv) < 3:
        sys.exit(f"usage: {sys.argv[0]} RESULTS_DIR OUTPUT.svg [OUTPUT.png ...]")
    try:
        figure = draw(load(sys.argv[1]))
    except TableError as error:
        sys.exit(f"error: {error}")
    for output in sys.argv[2:]:
        metadata = {"Date": None} if output.endswith(".svg") else None
        figure.savefig(output, bbox_inches="tight", metadata=metadata)
    plt.close(figure)
