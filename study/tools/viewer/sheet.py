# The contact sheet: a few instants of the motion beside each other, for documents.
import io

import matplotlib.pyplot as plt
import numpy
from matplotlib.transforms import ScaledTranslation

from analysis.core.errors import StudyError
from study.tools.viewer import picture
from study.tools.viewer.instant import INK, draw_instant, draw_triad

FRAMES = 8
INCHES = 10.0   # width of the sheet
TALLEST = 7.5   # inches
TITLE = 0.3     # inches over each instant
TRACES = ("#d1365b", "#00936b")
AZIMUTH, ELEVATION, DISTANCE = 0.6, 0.35, 4.0  # as the page starts; the last in radii


def draw(scene, motion, up, window=None):
    """The PNG file as bytes. `up` is the unit vector that points up in space; `window` the first
    and last time, s, or None for all of the motion. Raises StudyError if the motion has nothing in
    the window."""
    inside, frames = _choose_frames(motion, window)
    flat, depth = _flatten(motion.positions, scene, motion, up)
    axes_of_space = _paper(scene, up)[0]
    arrows, traced = picture.arrows(scene, motion), picture.traces(scene, motion)
    coils, faces = picture.coils(scene, motion), picture.faces(scene, motion)
    starts = [flat[:, arrow.at].mean(axis=1) for arrow in arrows]
    alongs = [arrow.length * motion.positions[:, arrow.vector] @ axes_of_space for arrow in arrows]
    shown = numpy.concatenate([flat[:, picture.places(scene)], *(
        (start + along)[:, None] for start, along in zip(starts, alongs))], axis=1)
    low, high = _limits(shown[inside])
    figure, all_axes = _grid(len(frames), high - low)
    for axes in all_axes:
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal", xticks=[],
                 yticks=[])
        axes.set_title(" ", fontsize=9, loc="left", pad=3)
    figure.draw_without_rendering()  # lays the axes out: springs are drawn in points of paper
    points_a_metre = all_axes[0].get_window_extent().width / figure.dpi * 72 / (high - low)[0]
    typical = picture.typical_length(scene, motion) * points_a_metre
    span = motion.times[frames[-1]] - motion.times[frames[0]]
    digits = max(0, int(1 - numpy.floor(numpy.log10(span))) + 1)
    for axes, frame in zip(all_axes, frames):
        for point, colour in zip(traced, TRACES):
            axes.plot(*flat[inside, point].T, color=colour, alpha=0.25, linewidth=0.8, zorder=1)
            axes.plot(*flat[inside[0]:frame + 1, point].T, color=colour, alpha=0.7, linewidth=1,
                      zorder=1)
        wires = [_flatten(picture.spiral(coil, motion.positions[frame]), scene, motion, up)[0]
                 for coil in coils]
        at_once = [(start[frame], along[frame]) for start, along in zip(starts, alongs)]
        draw_instant(axes, scene, flat[frame], depth[frame], faces, at_once, wires, typical)
        axes.set_title(f"{motion.times[frame]:.{digits}f} s", fontsize=9, loc="left", pad=3,
                       color=INK)
    if scene.dimension == 2:
        _scale_bar(all_axes[0], high - low)
    else:
        draw_triad(all_axes[0], axes_of_space)
    out = io.BytesIO()
    figure.savefig(out, format="png", dpi=160)
    plt.close(figure)
    return out.getvalue()


def _choose_frames(motion, window):
    """Indices of all frames in the window, and of those to draw."""
    first, last = window or (motion.times[0], motion.times[-1])
    inside = numpy.flatnonzero((motion.times >= first) & (motion.times <= last))
    if len(inside) < 2:
        raise StudyError(f"--window {first:g} {last:g}: the motion has fewer than two frames "
                         f"there; it lasts from {motion.times[0]:g} to {motion.times[-1]:g} s")
    wanted = numpy.linspace(motion.times[inside[0]], motion.times[inside[-1]], FRAMES)
    return inside, sorted({int(inside[numpy.abs(motion.times[inside] - t).argmin()])
                           for t in wanted})


def _paper(scene, up):
    """What turns a vector into one on the paper (dimension, 2), and the direction out of the paper:
    nothing in the plane, or the first view of the page."""
    if scene.dimension == 2:
        return numpy.eye(2), numpy.zeros(2)
    upward = numpy.array(up, float)
    towards = numpy.array([0.0, -1, 0]) if upward[2] else numpy.array([0.0, 0, 1])
    level = numpy.sin(AZIMUTH) * numpy.cross(upward, towards) + numpy.cos(AZIMUTH) * towards
    back = numpy.cos(ELEVATION) * level + numpy.sin(ELEVATION) * upward
    right = numpy.cross(upward, level)
    return numpy.stack([right, numpy.cross(back, right)], axis=1), back


def _flatten(positions, scene, motion, up):
    """Places on the paper (…, 2) of `positions` (…, dimension), and their depth behind it (…)."""
    if scene.dimension == 2:
        return positions, numpy.zeros(positions.shape[:-1])
    low, high = picture.bounds(scene, motion)
    paper, back = _paper(scene, up)
    offset = positions - (low + high) / 2
    distance = DISTANCE * picture.reach(scene, motion) / 2
    depth = distance - offset @ back
    return offset @ paper * (distance / depth)[..., None], depth


def _limits(shown):
    """Lowest and highest corner of a picture that holds all of `shown` (…, 2), and a margin."""
    low, high = shown.min(axis=(0, 1)), shown.max(axis=(0, 1))
    size = (high - low).max() or 1.0
    half = 0.6 * numpy.maximum(high - low, 0.08 * size) + 0.02 * size
    middle = (low + high) / 2
    return numpy.stack([middle - half, middle + half])


def _grid(count, size):
    """A figure with `count` axes for a picture of this size: as many columns as go without making
    the pictures much smaller than they could be."""
    shape = size[1] / size[0]

    def width(columns):
        rows = -(-count // columns)
        return min(INCHES / columns, (TALLEST / rows - TITLE) / shape)
    choices = [columns for columns in range(count, 0, -1) if count % columns == 0]
    largest = max(map(width, choices))
    columns = next(columns for columns in choices if width(columns) > 0.8 * largest)
    rows = count // columns
    figure, axes = plt.subplots(
        rows, columns, squeeze=False, layout="constrained", facecolor="white",
        figsize=(columns * width(columns), rows * (width(columns) * shape + TITLE) + 0.15))
    return figure, list(axes.flat)


def _scale_bar(axes, size):
    """Below the first instant: the largest of 1, 2, 5 times a power of ten that fits well."""
    most = size[0] / 3.5
    power = 10 ** numpy.floor(numpy.log10(most))
    length = max(k for k in (1, 2, 5) if k * power <= most) * power
    share = length / size[0]
    below = axes.transAxes + ScaledTranslation(0, -7 / 72, axes.figure.dpi_scale_trans)
    axes.plot([0, share], [0, 0], transform=below, color=INK, linewidth=1.6,
              solid_capstyle="butt", clip_on=False)
    axes.text(share + 0.02, 0, f"{length:g} m", transform=below, va="center", fontsize=8, color=INK)
