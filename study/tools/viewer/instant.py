# One instant of the motion on matplotlib axes, from far to near.
import numpy
from matplotlib.colors import to_rgb
from scipy.spatial import ConvexHull, QhullError

INK, ROD, GROUND, DRIVEN, SPRING, ACCENT = ("#1b2330", "#49627c", "#6d7683", "#b0479a", "#c4501b",
                                            "#0b5cad")
HUES = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#8a8a00", "#7a5cc0")
BULK = 300  # more rods than these are one line, not sorted by depth
COILS = 7
LIGHT = numpy.array([0.3, 0.65, 0.7])  # direction towards it: right, above, out of the paper; as in elements.js


def draw_instant(axes, scene, at, depth, faces, arrows, wires, typical):
    """`at` has all places on the paper (points, 2), `depth` how far behind it they are; `faces` the triangles of each
    body; `arrows`
    pairs of a place and a vector on the paper; `wires` the ways of torsion springs; `typical` is the length of an element in points of
    paper, which the widths of lines go by."""
    width = float(numpy.clip(0.06 * typical, 0.8, 4.0))
    solid = numpy.column_stack([at, -depth])
    items = [(_body, element.points, (HUES[index % len(HUES)], solid[faces[index]]))
             for index, element in enumerate(scene.bodies) if element.points]
    items += [(_spring, element.points, SPRING) for element in scene.springs]
    if len(scene.rods) > BULK:
        _many_rods(axes, at[[rod.points for rod in scene.rods]], width)
    else:
        items += [(_rod, element.points, ROD) for element in scene.rods]
    items.sort(key=lambda item: -depth[item[1]].mean())  # stable: planar ones stay in order
    for order, (draw, points, look) in enumerate(items):
        draw(axes, at[points], look, width, 2 + order / len(items))
    for start, along in arrows:
        axes.annotate("", start + along, start, zorder=3.5, annotation_clip=False, arrowprops={
            "arrowstyle": "-|>", "color": ACCENT, "linewidth": 1, "shrinkA": 0, "shrinkB": 0,
            "mutation_scale": 7})
    for wire in wires:
        _line(axes, wire, SPRING, 1, 3.4)
    _points(axes, scene, at, float(numpy.clip(0.11 * typical, 1.0, 5.0)))
    axes.spines[:].set_visible(True)
    axes.spines[:].set_color("#dcdfe4")


def draw_triad(axes, axes_of_space):
    """The directions of x, y, z, in the lower left corner."""
    corner = numpy.array([22.0, 25.0])  # points
    for name, along, colour in zip("xyz", axes_of_space, ("#c9403a", "#3c8d40", "#3a6fc9")):
        axes.annotate("", corner + 14 * along, corner, xycoords="axes points",
                      textcoords="axes points", arrowprops={
                          "arrowstyle": "-|>", "color": colour, "linewidth": 1, "shrinkA": 0,
                          "shrinkB": 0, "mutation_scale": 6})
        axes.annotate(name, corner + 19 * along, xycoords="axes points", fontsize=7, color=INK,
                      ha="center", va="center")


def _line(axes, way, colour, width, order):
    axes.plot(*way.T, color=colour, linewidth=width, zorder=order, solid_capstyle="round",
              solid_joinstyle="round")


def _rod(axes, ends, colour, width, order):
    _line(axes, ends, "white", width + 1.2, order)
    _line(axes, ends, colour, width, order)


def _many_rods(axes, ends, width):
    gap = numpy.full((len(ends), 1, 2), numpy.nan)
    _line(axes, numpy.concatenate([ends, gap], axis=1).reshape(-1, 2), ROD, width, 2)


def _body(axes, corners, look, width, order):
    hue, faces = look
    outline = hull(corners)
    closed = numpy.vstack([outline, outline[:1]])
    light = _mixed(hue, 0.4, 1)
    wide = width * (1.3 if len(outline) > 1 else 2.5)
    _line(axes, closed, hue, wide + 1.4, order)
    _line(axes, closed, light, wide, order)
    axes.fill(*outline.T, color=light, zorder=order, linewidth=0)
    for face in faces:
        normal = numpy.cross(face[1] - face[0], face[2] - face[0])
        if normal[2] > 0:  # seen from outside
            shine = max(LIGHT @ normal / numpy.linalg.norm(normal), 0)
            axes.fill(*face[:, :2].T, color=_mixed(_mixed(hue, 0.55, 1), 0.6 + 0.4 * shine, 0), zorder=order,
                      linewidth=0.4)


def _mixed(colour, share, other):
    """With so much of a grey (0: black, 1: white)."""
    return tuple(share * channel + (1 - share) * other for channel in to_rgb(colour))


def hull(corners):
    """Corners of the convex hull in order; of those on one line the ends."""
    try:
        return corners[ConvexHull(corners).vertices]
    except QhullError:  # flat, or too few
        ordered = numpy.unique(corners, axis=0)
        return ordered[[0, -1]] if len(ordered) > 1 else ordered


def _spring(axes, ends, colour, width, order):
    """A zigzag whose height on the paper does not change."""
    place = axes.transData.transform(ends)
    along = place[1] - place[0]
    height = 1.6 * width * axes.figure.dpi / 72
    side = numpy.array([-along[1], along[0]]) / (numpy.linalg.norm(along) or 1) * height
    turns = numpy.arange(2 * COILS)
    shares = numpy.concatenate([[0, 0.14], 0.14 + 0.72 * (turns + 0.5) / len(turns), [0.86, 1]])
    swings = numpy.concatenate([[0, 0], (-1.0) ** turns, [0, 0]])
    way = place[0] + shares[:, None] * along + swings[:, None] * side
    _line(axes, axes.transData.inverted().transform(way), colour, 1, order)


def _points(axes, scene, at, size):
    looks = {"fixed": ("^", GROUND, 1.5), "driven": ("D", DRIVEN, 1.2), "free": ("o", INK, 0.6),
             "marker": ("o", GROUND, 0.5)}
    for kind, (marker, colour, scale) in looks.items():
        chosen = [index for index, (_, other) in enumerate(scene.points) if other == kind]
        if chosen and (kind in ("fixed", "driven") or len(chosen) <= BULK):
            axes.plot(*at[chosen].T, linestyle="none", marker=marker, markersize=size * scale,
                      markerfacecolor="white", markeredgecolor=colour, zorder=4,
                      markeredgewidth=min(0.9, 0.25 * size))
