# study/view on the real program and its scenes.
import json
import os
import subprocess
from pathlib import Path

import pytest

from study.tests.browser import Browser
from study.tests.conftest import ROOT
from study.tests.test_view import data_of, view

PROGRAM = Path(os.environ.get("MBS_PROGRAM", ROOT / "build" / "mbs"))


@pytest.mark.parametrize("scene", ["four-bar:3", "harness/scenes/double_pendulum.json"])
def test_a_scene_is_simulated_and_shown(tmp_path, scene):
    assert os.access(PROGRAM, os.X_OK), f"{PROGRAM} is missing: run study/setup"
    path = scene if scene.startswith("four-bar") else ROOT / scene
    done = view(tmp_path, path, "--duration", "1", "--output", "page.html", "--png", "sheet.png",
                program=PROGRAM)
    assert done.returncode == 0, done.stderr
    data, _ = data_of(tmp_path / "page.html")
    assert data["times"][-1] == pytest.approx(1) and data["moving"] and data["rods"]
    total = [sum(pair) for pair in zip(data["curves"]["kinetic_energy"],
                                       data["curves"]["potential_energy"])]
    assert max(total) - min(total) < 1e-3 * max(data["curves"]["kinetic_energy"])
    with Browser(tmp_path / "profile") as browser:
        browser.prefer(prefers_reduced_motion="no-preference")
        browser.open(tmp_path / "page.html")
        browser.wait("+document.getElementById('scrub').value > 0.1")
        assert browser.complaints == []


def test_a_stored_trajectory_is_shown_with_the_scene_it_is_of(tmp_path):
    csv = tmp_path / "motion.csv"
    subprocess.run([PROGRAM, "simulate", "four-bar:2", "--implementation", "csc_klu/refactor",
                    "--duration", "1", "--every", "5", "--trajectory", csv], check=True,
                   stdout=subprocess.DEVNULL)
    assert view(tmp_path, "four-bar:2", csv, program=PROGRAM).returncode == 0
    assert len(data_of(tmp_path / "four-bar-2.html")[0]["times"]) == 161
    done = view(tmp_path, "four-bar:3", csv, program=PROGRAM)
    assert done.returncode == 2 and "of another scene than four-bar:3" in done.stderr


def test_the_programs_own_complaint_about_a_scene_is_passed_on(tmp_path):
    (tmp_path / "bad.json").write_text(json.dumps({"points": [{"name": "A"}]}))
    done = view(tmp_path, "bad.json", program=PROGRAM)
    assert done.returncode == 2 and done.stderr.startswith("study/view: mbs: ")
    assert "bad.json: points[0]" in done.stderr
