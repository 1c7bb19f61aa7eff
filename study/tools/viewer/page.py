# Writes the HTML page: template, style and scripts of page/, and the motion packed as text.
import base64
import json
from pathlib import Path

import jinja2
import numpy

from study.tools.viewer import picture

FOLDER = Path(__file__).parent / "page"
SCRIPTS = ("data.js", "camera.js", "grid.js", "elements.js", "symbols.js", "stage.js", "charts.js", "playback.js", "pointer.js", "controls.js",
           "sheet.js")


def render(scene, motion, note, up, sheet=False):
    """The whole page as text; nothing in it refers to anything outside. `sheet`: it draws a contact sheet when it is loaded."""
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(FOLDER), trim_blocks=True, undefined=jinja2.StrictUndefined, autoescape=True)
    moving = [index for index in range(len(scene.points)) if numpy.ptp(motion.positions[:, index], axis=0).max() > 0]
    return environment.get_template("page.html.j2").render(
        scene=scene, note=note, has_curves=bool(motion.curves), outputs=motion.outputs, style=_text("page.css"),
        scripts="\n".join(map(_text, SCRIPTS)),
        data=json.dumps(_data(scene, motion, moving, up) | {"sheet": sheet}, separators=(",", ":"), allow_nan=False)
        .replace("<", "\\u003c"),  # no text in it can end the script element
        packed=base64.b64encode(motion.positions[:, moving].astype("<f4").tobytes()).decode())


def _text(name):
    return (FOLDER / name).read_text(encoding="utf-8")


def _data(scene, motion, moving, up):
    low, high = picture.bounds(scene, motion)
    return {
        "dimension": scene.dimension, "up": up, "times": _rounded(motion.times, 9),
        "points": [{"name": name, "kind": kind, "start": _rounded(motion.positions[0, index], 9)}
                   for index, (name, kind) in enumerate(scene.points)],
        "moving": moving, "low": _rounded(low), "high": _rounded(high), "typical": picture.typical_length(scene, motion),
        "rods": scene.rods, "springs": scene.springs,
        "bodies": [{"name": body.name, "points": body.points, "faces": faces} for body, faces in zip(scene.bodies, picture.faces(scene, motion))],
        "arrows": picture.arrows(scene, motion), "coils": picture.coils(scene, motion), "traces": picture.traces(scene, motion),
        "curves": {name: _rounded(values) for name, values in motion.curves.items()} or None,
        "outputs": {name: {column: _rounded(values) for column, values in columns.items()} for name, columns in motion.outputs.items()}}


def _rounded(values, digits=7):
    return [float(f"{value:.{digits}g}") for value in values]
