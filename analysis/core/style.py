# The common look of all figures.
from pathlib import Path

import matplotlib
import matplotlib.pyplot as plt
import numpy
from matplotlib.colors import to_hex, to_rgb
from matplotlib.scale import LogScale, register_scale
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator
from matplotlib.transforms import Bbox

from analysis.core.files import write
from analysis.core.gather import gather
from analysis.core.text import number

# Warm colours are dense implementations, the others sparse: those who lead have colours of Okabe and Ito (2008), safe for the
# colour-blind, or such that all of them differ in grey; markers and dashes tell the series apart without colour.
DENSE = ("#E69F00", "#8C4A1F", "#D55E00", "#F2C14E", "#B03A48")
SPARSE = ("#7A1F5C", "#CC79A7", "#0072B2", "#56B4E9", "#3B1F80", "#8A8A00", "#009E73", "#006B1F", "#A6A6D9", "#00707A")
ALTERNATIVES = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#8A8A00", "#5B3A9E")
SHADES = ((None, 0.0), ("white", 0.42), ("black", 0.38), ("white", 0.68), ("black", 0.62))
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*", "<", "p", ">", "h", "d")
DASHES = ("-", (0, (4, 1.5)), (0, (1, 1)), (0, (6, 1.5, 1, 1.5)), (0, (3, 1, 1, 1, 1, 1)))
GREY = "#777777"

matplotlib.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 9.5, "axes.titlesize": 11, "axes.labelsize": 10,
    "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": "#444444",
    "axes.titlelocation": "left", "axes.titlepad": 10, "grid.color": "#dddddd",
    "grid.linewidth": 0.6, "legend.frameon": False, "figure.facecolor": "white",
    "svg.hashsalt": "mbs", "savefig.dpi": 160, "hatch.linewidth": 0.7, "hatch.color": "#00000066"})


class _Log(LogScale):
    """That of all figures: plain numbers; no minor ticks, which take half the time of a figure."""

    def set_default_locators_and_formatters(self, axis):
        super().set_default_locators_and_formatters(axis)
        axis.set_minor_locator(NullLocator())
        axis.set_major_formatter(FuncFormatter(lambda value, _: number(value)))


register_scale(_Log)


class Look:
    """How each implementation is drawn, by its place in the registry: a colour a folder, a shade of it and a dash a variant; its own marker."""

    def __init__(self, registry):
        self.place = {name: place for place, name in enumerate(registry.variants)}
        self.shade, self.hue, palettes = {}, {}, {True: iter(DENSE * 9), False: iter(SPARSE * 9)}
        for folder, names in gather((name.split("/")[0], name) for name in registry.variants).items():
            self.hue[folder] = next(palettes[names[0] in registry.dense])
            self.shade |= {name: shade for shade, name in enumerate(names)}

    def colour(self, name):
        towards, share = SHADES[self.shade[name] % len(SHADES)]
        mixed = numpy.array(to_rgb(self.hue[name.split("/")[0]])) * (1 - share)
        return to_hex(mixed + share if towards == "white" else mixed)

    def line(self, name):
        """Keywords of `plot` for the series of an implementation."""
        colour, marker, dash = self.colour(name), MARKERS[self.place[name] % len(MARKERS)], DASHES[self.shade[name] % len(DASHES)]
        return {"color": colour, "linestyle": dash, "linewidth": 1.4, "marker": marker, "markersize": 8 if marker in "*PX" else 5.5,
                "markeredgewidth": 0.6, "markerfacecolor": colour, "markeredgecolor": "white"}


def panels(count, columns, wide, high, title, x="", y=""):
    """(figure, axes of `count` panels, `wide` and `high` inches each, in lines of so many columns); they share their axes and the labels of these."""
    columns = max(1, min(count, columns))
    lines = -(-count // columns) or 1
    figure, grid = plt.subplots(lines, columns, figsize=(wide * columns + 1.2, high * lines + 0.9), sharex=True, sharey=True,
                                squeeze=False, constrained_layout=True)
    for place, axes in enumerate(grid.flat):
        axes.set_visible(place < count)
        axes.tick_params(labelbottom=place + columns >= count)
    for label, text in ((figure.supxlabel, x), (figure.supylabel, y)):
        if text:
            label(text, fontsize=10)
    figure.suptitle(title, x=0.01, ha="left", fontsize=12)
    return figure, list(grid.flat[:count])


def below(figure, columns, more):
    """A legend below all of a figure, of what its axes have labels for and of `more` handles."""
    found = {label: handle for axes in figure.axes for handle, label in zip(*axes.get_legend_handles_labels())}
    handles = [*found.values(), *more]
    figure.legend(handles, [*found, *(one.get_label() for one in more)], loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=columns, fontsize=9)


def legend(axes, order):
    """A legend right of the axes, entries sorted by `order(label)`."""
    if pairs := sorted(zip(*axes.get_legend_handles_labels()), key=lambda entry: order(entry[1])):
        axes.legend(*zip(*pairs), loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=8.5)


def nothing(text):
    """A figure that says what is missing, and no more."""
    return missing(text, plt.subplots(figsize=(6, 1.2))[1])


def missing(text, *those):
    """The figure of these axes, which say what is missing."""
    for axes in those:
        axes.set_axis_off()
        axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", color=GREY, fontsize=10, wrap=True)
    return those[0].figure


def size_ticks(axes, sizes):
    """Ticks at the measured numbers of variables; labels that would touch their left neighbours are left out."""
    axes.set_xscale("log")
    place = numpy.log(sizes)
    gap, last, labels = 0.055 * (max(place, default=0) - min(place, default=0)), -numpy.inf, []
    for size, at in zip(sizes, place):
        labels.append(f"{size:g}" if at - last >= gap else "")
        last = at if labels[-1] else last
    axes.set_xticks(sizes, labels)
    axes.set_xlabel("variables n")


def number_axis(axis, unit=""):
    """Makes an axis that has its data logarithmic, with more numbers a decade if it spans few."""
    if axis.get_scale() != "log":
        (axis.axes.set_xscale if axis.axis_name == "x" else axis.axes.set_yscale)("log")
    low, high = axis.get_view_interval()
    decades = numpy.log10(high / low)
    axis.set_major_locator(LogLocator(subs=(1, 1.5, 2, 3, 5, 7) if decades < 0.9 else (1, 2, 5) if decades < 3.3 else (1,)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: number(value) + unit))


def line_each(axes, labels, **text):
    """A line for each label, the first on top."""
    axes.set_yticks(range(len(labels)), labels, **text)
    axes.set_ylim(len(labels) - 0.4, -0.6)
    axes.grid(axis="x")
    axes.set_axisbelow(True)


def save(figure, path, above=""):
    """Writes a figure in the format of the suffix of `path`; equal figures give equal files. `above`: a line over all of it, which
    says of which machine and day it is, wherever it is shown."""
    if figure.get_layout_engine():  # made once here, where `savefig` with "tight" would draw all of the figure for that
        figure.get_layout_engine().execute(figure)
        figure.set_layout_engine(None)
    kind, (width, height), inches = Path(path).suffix, figure.get_size_inches(), figure.dpi_scale_trans.inverted()
    # Each of its children once, with all that they hold: figure.get_tightbbox() asks axes twice and legends three times.
    shown = [one for one in figure.get_children() if one is not figure.patch and one.get_visible()] or [figure.patch]
    box = Bbox.union([one.get_tightbbox() for one in shown]).transformed(inches)
    if above:
        line = figure.text(box.x0 / width, (box.y1 + 0.08) / height, above, fontsize=8, color=GREY, va="bottom")
        box = Bbox.union([box, line.get_window_extent().transformed(inches)])
    box = box.padded(matplotlib.rcParams["savefig.pad_inches"])
    write(path, lambda partial: figure.savefig(partial, format=kind[1:] or "png", bbox_inches=box,
                                               metadata={"Date": None} if kind == ".svg" else None))
