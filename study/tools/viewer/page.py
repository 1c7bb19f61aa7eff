# Writes the HTML page: template, style and scripts of page/, the motion packed as text, and what is drawn beside the elements of the scene:
# extent, which points to trace, where vectors sit.
import base64
import json
from pathlib import Path

import jinja2
import numpy
from scipy.spatial import ConvexHull, QhullError

from study.tools.viewer.program import NO_PLACES

FOLDER = Path(__file__).parent / "page"
SCRIPTS = ("data.js", "camera.js", "grid.js", "elements.js", "symbols.js", "stage.js", "charts.js", "playback.js", "pointer.js", "controls.js",
           "sheet.js")
TRACES = 2         # by default, at most
CANDIDATES = 50    # points that are looked at for a trace
DISTINCT = 0.1     # of the extent: how far traces must differ to be shown both


def render(scene, motion, note, up, sheet=False):
    """The whole page as text; nothing in it refers to anything outside. `sheet`: it draws a contact sheet when it is loaded."""
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(FOLDER), trim_blocks=True, undefined=jinja2.StrictUndefined, autoescape=True)
    moving = [index for index in range(len(scene.points)) if numpy.ptp(motion.positions[:, index], axis=0).max() > 0]
    return environment.get_template("page.html.j2").render(
        scene=scene, note=note, has_curves=bool(motion.curves), outputs=motion.outputs,
        style=_text("page.css"), scripts="\n".join(map(_text, SCRIPTS)),
        data=json.dumps(_data(scene, motion, moving, up) | {"sheet": sheet}, separators=(",", ":"), allow_nan=False)
        .replace("<", "\\u003c"),  # no text in it can end the script element
        packed=base64.b64encode(motion.positions[:, moving].astype("<f4").tobytes()).decode())


def _text(name):
    return (FOLDER / name).read_text(encoding="utf-8")


def _data(scene, motion, moving, up):
    low, high = bounds(scene, motion)
    bodies = [{"name": body.name, "points": body.points, "faces": faces(motion.positions[0], body.points) if scene.dimension == 3 else []}
              for body in scene.bodies]
    return {
        "dimension": scene.dimension, "up": up, "times": _rounded(motion.times, 9),
        "points": [{"name": name, "kind": kind, "start": _rounded(at, 9)} for (name, kind), at in zip(scene.points, motion.positions[0])],
        "moving": moving, "low": _rounded(low), "high": _rounded(high), "typical": typical_length(scene, motion),
        "rods": scene.rods, "springs": scene.springs, "bodies": bodies,
        "arrows": arrows(scene, motion), "coils": coils(scene, motion), "traces": traces(scene, motion),
        "curves": {name: _rounded(values) for name, values in motion.curves.items()} or None,
        "outputs": {name: {column: _rounded(values) for column, values in columns.items()} for name, columns in motion.outputs.items()}}


def _rounded(values, digits=7):
    return [float(f"{value:.{digits}g}") for value in values]


def places(scene):
    """Indices of points that are drawn as places: neither vectors nor hidden."""
    return [index for index, (_, kind) in enumerate(scene.points) if kind not in NO_PLACES]


def bounds(scene, motion):
    """Lowest and highest corner of everywhere that a point gets to, m."""
    shown = motion.positions[:, places(scene)]
    return shown.min(axis=(0, 1)), shown.max(axis=(0, 1))


def reach(scene, motion):
    """The diagonal of `bounds`, m; never zero."""
    low, high = bounds(scene, motion)
    return float(numpy.linalg.norm(high - low)) or 1.0


def traces(scene, motion):
    """The point with the longest way and others whose ways look different, TRACES at most."""
    lengths = numpy.cumsum(numpy.linalg.norm(numpy.diff(motion.positions, axis=0), axis=2), axis=0)[-1]  # of each point's way
    order = [int(index) for index in numpy.argsort(-lengths, kind="stable") if scene.points[index][1] in ("free", "marker")]
    apart, chosen = DISTINCT * reach(scene, motion), {}  # {point: its way about its mean}
    for index in order[::max(1, len(order) // CANDIDATES)]:
        way = motion.positions[:, index] - motion.positions[:, index].mean(axis=0)
        if numpy.ptp(motion.positions[:, index], axis=0).max() > 0 and all(
                numpy.linalg.norm(way - other, axis=1).max() > apart for other in chosen.values()):
            chosen[index] = way
    return [*chosen][:TRACES]


def typical_length(scene, motion):
    """Median distance of what rods, bodies and springs join, m: the size of symbols goes by it."""
    joined = (*scene.rods, *scene.springs, *(body.points for body in scene.bodies))
    lengths = [numpy.linalg.norm(at - at[0], axis=1).max() for points in joined if len(points) > 1 for at in [motion.positions[0][points]]]
    return float(numpy.median(lengths)) if lengths else 0.1 * reach(scene, motion)


def faces(at, points):
    """The triangles of the hull of a body's points in space, triples of points counter-clockwise seen from outside; none where the hull is flat.
    A body is rigid: those of the start are those of all instants. `at`: where all points are then."""
    places = numpy.array(points)[numpy.unique(at[points].round(12), axis=0, return_index=True)[1]] if points else []
    if len(places) < 4:
        return []
    try:
        found = ConvexHull(at[places])
    except QhullError:  # flat
        return []
    triangles = places[found.simplices]
    a, b, c = at[triangles].swapaxes(0, 1)
    turned = (numpy.cross(b - a, c - a) * found.equations[:, :3]).sum(axis=1) < 0
    return numpy.where(turned[:, None], triangles[:, [0, 2, 1]], triangles).tolist()


def arrows(scene, motion):
    """Unit vectors of bodies, each drawn at the mean of the points `at` with this `length`, m: at the point that all bodies
    with this vector share (a hinge's axis), else at the body's fixed point if the vector stands still, else amid the body."""
    length, found = 0.3 * typical_length(scene, motion), []
    for vector in dict.fromkeys(vector for body in scene.bodies for vector in body.vectors):
        bodies = [body for body in scene.bodies if vector in body.vectors]
        shared = set(bodies[0].points).intersection(*(body.points for body in bodies[1:]))
        fixed = [point for point in bodies[0].points if scene.points[point][1] == "fixed"]
        still = numpy.ptp(motion.positions[:, vector], axis=0).max() < 1e-9
        at = [min(shared)] if len(bodies) > 1 and shared else fixed[:1] if still and fixed else bodies[0].points
        if at:
            found.append({"vector": vector, "at": at, "length": length})
    return found


def coils(scene, motion):
    """Torsion springs, each a spiral from one direction to the other, which are pairs of points, at the mean of the points `at`: at
    the point that both directions share, else where the second begins; of unit vectors, where one of these is drawn."""
    vectors = {arrow["vector"]: arrow["at"] for arrow in arrows(scene, motion)}
    length, found = 0.2 * typical_length(scene, motion), []
    for first, second in scene.torsion_springs:
        lines = [pair for pair in (second, first) if all(scene.points[point][1] != "vector" for point in pair)]
        shared = sorted(set(first) & set(second)) if len(lines) == 2 else []
        if at := shared[:1] or (lines[0][:1] if lines else []) or vectors.get(second[1]) or vectors.get(first[1]):
            found.append({"first": first, "second": second, "at": at, "length": length})
    return found
