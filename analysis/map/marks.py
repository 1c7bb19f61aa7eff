# What figures of ratios over sizes share.
from analysis.core.text import bounded

DODGE = 0.6  # width over which the contenders of a size are spread


def side_by_side(axes, found, sizes, look, label=str):
    """Marks and intervals of {name: {size: Versus, or None of the one that all are compared with}}, at their places among `sizes`."""
    for number, (name, series) in enumerate(found.items()):
        shift = DODGE * ((number + 0.5) / len(found) - 0.5)
        places = [sizes.index(size) + shift for size in series]
        known = [(place, one) for place, one in zip(places, series.values()) if one and bounded(one.low, one.high)]
        axes.plot(places, [one.value if one else 1.0 for one in series.values()], label=label(name), **look.line(name) | {"linestyle": "none"})
        axes.vlines([place for place, _ in known], [one.low for _, one in known], [one.high for _, one in known],
                    color=look.colour(name), linewidth=2.2, alpha=0.6)
    axes.axhline(1, color="#444444", linewidth=0.8)
    axes.set(xlabel="variables n, own fill", xlim=(-0.5, len(sizes) - 0.5))
    axes.set_xticks(range(len(sizes)), [f"{size:g}" for size in sizes])
    axes.grid(True, axis="y", which="major")


def footnote(figure, lines, y):
    """Small text below all axes of a figure."""
    figure.text(figure.subplotpars.left, y, "\n".join(lines), fontsize=7.5, color="#777777", va="top", linespacing=1.35)
