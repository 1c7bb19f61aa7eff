# The contact sheet: some instants of the motion beside each other, for documents. The page's own scripts draw it, in Chromium.
import base64
import os
import re
import subprocess
import tempfile
from pathlib import Path

import numpy

from analysis.core.errors import StudyError
from study.tools.viewer import page
from study.tools.viewer.trajectory import Motion

CHROMIUM = ("/usr/bin/chromium", "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
            "--disable-background-networking", "--disable-component-update")
SECONDS = 120
PICTURE = re.compile(r'id="sheet" src="data:image/png;base64,([^"]+)"')  # what sheet.js leaves in the page


def draw(scene, motion, up, window=None):
    """The PNG file as bytes. `up`: the unit vector that points up in space; `window`: first and last time, s, or None for all of the motion."""
    text = page.render(scene, within(motion, window) if window else motion, "", up, sheet=True)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "sheet.html"
        path.write_text(text, encoding="utf-8")
        try:
            done = subprocess.run([*CHROMIUM, f"--user-data-dir={folder}/profile", "--dump-dom", path.as_uri()], stdin=subprocess.DEVNULL,
                                  capture_output=True, text=True, errors="replace", timeout=SECONDS, env=os.environ | {"HOME": folder})
        except FileNotFoundError as error:
            raise StudyError(f"--png: {CHROMIUM[0]}, which draws the sheet, is missing: run study/setup") from error
        except subprocess.TimeoutExpired as error:
            raise StudyError(f"--png: {CHROMIUM[0]} has not drawn the sheet in {SECONDS} s") from error
    found = PICTURE.search(done.stdout)
    if not found:
        raise StudyError(f"--png: {CHROMIUM[0]} did not draw the sheet: {(done.stderr.strip().splitlines() or ['it said nothing'])[-1][:300]}")
    return base64.b64decode(found[1])


def within(motion, window):
    """The part of a motion between two times."""
    inside = numpy.flatnonzero((motion.times >= window[0]) & (motion.times <= window[1]))
    if len(inside) < 2:
        raise StudyError(f"--window {window[0]:g} {window[1]:g}: the motion has fewer than two frames there; it lasts from "
                         f"{motion.times[0]:g} to {motion.times[-1]:g} s")
    return Motion(motion.times[inside], motion.positions[inside], {})
