# The command line of study/view: from a scene to an HTML page and a PNG sheet, some instants of the motion beside each other for documents, which
# the page's own scripts draw in Chromium.
import base64
import os
import re
import subprocess
import tempfile
from pathlib import Path

import numpy

from analysis.core.files import StudyError, write
from study.core.cell import scene_name
from study.core.options import Parser, positive
from study.core.studyset import describe
from study.tools.viewer import page, program, trajectory

FRAMES = 600  # in a page, at most
VALUES_AT_MOST = 2_000_000  # coordinates in a page: 11 MB of it
IMPLEMENTATION = "csc_klu/refactor"
CHROMIUM = ("/usr/bin/chromium", "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
            "--disable-background-networking", "--disable-component-update")
SECONDS = 120  # that it may take
PICTURE = re.compile(r'id="sheet" src="data:image/png;base64,([^"]+)"')  # what sheet.js leaves in the page


def view(arguments):
    options = _options(arguments)
    place = scene_name(options.scene)
    scene = program.from_description(describe(place), Path(options.scene).name)
    if not scene.points:
        raise StudyError(f"{options.scene} has no points to show")
    frames = max(2, min(FRAMES, VALUES_AT_MOST // (len(scene.points) * scene.dimension)))
    if options.trajectory:
        motion = trajectory.read(options.trajectory, scene, frames)
        note = Path(options.trajectory).name
    else:
        with tempfile.TemporaryDirectory() as folder:
            csv, outputs = Path(folder) / "trajectory.csv", Path(folder) / "outputs.csv" if scene.outputs else None
            note = program.simulate(place, scene, options, frames, csv, outputs, print)
            motion = trajectory.read(csv, scene, frames, outputs)
    if not motion.curves:
        print("the trajectory has no energy and constraint columns: the page leaves the curves out")
    up = [int(axis == options.up) for axis in "xyz"] if options.up else program.upward(options.scene)
    html = page.render(scene, motion, note, up).encode()
    png = sheet(scene, motion, up, options.window) if options.png else None
    for name, content in ((options.output, html), *([(options.png, png)] if png else [])):
        write(name, lambda partial, content=content: partial.write_bytes(content))
        print(f"{name}: {len(motion.times)} frames" if name == options.output else name)


def _options(arguments):
    parser = Parser(prog="study/view", description="Shows the motion of a scene: an HTML page that needs nothing else to play it, and a PNG "
                    "sheet for documents.")
    parser.add_argument("scene", help="four-bar:N, one of mbs list --scenes, or a JSON file")
    parser.add_argument("trajectory", nargs="?", help="CSV of `mbs simulate --trajectory`; without it, the scene is simulated now")
    parser.add_argument("--output", metavar="FILE.html", help="the page (SCENE.html, here)")
    parser.add_argument("--png", metavar="FILE.png", help="write a contact sheet of the motion too")
    parser.add_argument("--window", nargs=2, type=float, metavar="S", help="first and last time of the sheet (all of the motion)")
    parser.add_argument("--up", choices="xyz", help="axis that points up in 3D (against gravity; y without gravity)")
    own = parser.add_argument_group("without TRAJECTORY")
    own.add_argument("--duration", type=positive, metavar="S", help="simulated time (10 or, with small steps or large scenes, what a minute "
                     "is enough for)")
    own.add_argument("--step", type=positive, metavar="S", help="time step (1.25e-3, or the first tenth, hundredth, … of it that does)")
    own.add_argument("--implementation", help=f"folder/variant ({IMPLEMENTATION})")
    options = parser.parse_args(arguments)
    if options.trajectory and (options.duration or options.step or options.implementation):
        raise StudyError("--duration, --step and --implementation are for a simulation, but a TRAJECTORY is given")
    if options.window and not options.window[0] < options.window[1]:
        raise StudyError("--window must be two times, the first before the last")
    if options.window and options.png is None:
        raise StudyError("--window: found without --png, whose sheet it is of: allowed are both or none")
    if options.output is None:
        options.output = re.sub(r"[^\w.=-]+", "-", Path(options.scene).name.removesuffix(".json")) + ".html"
    inputs = [Path(name).resolve() for name in (options.scene, options.trajectory) if name]
    for flag, name, ending in (("--output", options.output, ".html"), ("--png", options.png, ".png")):
        if name is None:
            continue
        path = Path(name)
        if path.suffix.lower() != ending:
            raise StudyError(f"{flag} is {name!r}: it must end with {ending}")
        if why := ("it is an input" if path.resolve() in inputs else "it is a directory" if os.path.isdir(path) else
                   "" if os.path.isdir(path.parent) else f"there is no directory {path.parent}"):
            raise StudyError(f"{flag}: cannot write {name}: {why}")
    options.implementation = options.implementation or IMPLEMENTATION
    return options


def sheet(scene, motion, up, window=None):
    """The PNG file as bytes. `up`: the unit vector that points up in space; `window`: first and last time, s, or None for all of the motion."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "sheet.html"
        path.write_text(page.render(scene, within(motion, window) if window else motion, "", up, sheet=True), encoding="utf-8")
        try:
            done = subprocess.run([*CHROMIUM, f"--user-data-dir={folder}/profile", "--dump-dom", path.as_uri()], stdin=subprocess.DEVNULL,
                                  capture_output=True, text=True, errors="replace", timeout=SECONDS, env=os.environ | {"HOME": folder})
        except FileNotFoundError as error:
            raise StudyError(f"--png: {CHROMIUM[0]}, which draws the sheet, is missing: run study/setup") from error
        except subprocess.TimeoutExpired as error:
            raise StudyError(f"--png: {CHROMIUM[0]} has not drawn the sheet in {SECONDS} s") from error
    if not (found := PICTURE.search(done.stdout)):
        raise StudyError(f"--png: {CHROMIUM[0]} did not draw the sheet: {(done.stderr.strip().splitlines() or ['it said nothing'])[-1][:300]}")
    return base64.b64decode(found[1])


def within(motion, window):
    """The part of a motion between two times."""
    if len(inside := numpy.flatnonzero((motion.times >= window[0]) & (motion.times <= window[1]))) < 2:
        raise StudyError(f"--window {window[0]:g} {window[1]:g}: the motion has fewer than two frames there; it lasts from "
                         f"{motion.times[0]:g} to {motion.times[-1]:g} s")
    return trajectory.Motion(motion.times[inside], motion.positions[inside], {}, {})
