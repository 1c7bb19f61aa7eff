# study/view on the real program and its scenes.
import json
import os
import subprocess
from pathlib import Path

import pytest

from study.tests.browser import Browser
from study.tests.conftest import ROOT
from study.tests.test_view import data_of, view

pytestmark = pytest.mark.slow
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
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert "bad.json: points[0]" in done.stderr


def test_a_scene_of_a_short_driver_table_is_shown_as_long_as_it_is_known(tmp_path):
    times = [0.05 * k for k in range(11)]
    (tmp_path / "short.json").write_text(json.dumps({
        "points": [{"name": "R", "position": [0, 0], "driven": {"y": {"table": {
            "times": times, "values": [0.1 * t * t for t in times]}}}},
            {"name": "B", "position": [0.6, -0.8]}],
        "rods": [{"name": "rod", "between": ["R", "B"], "mass": 1}]}))
    described = json.loads(subprocess.run([PROGRAM, "describe", tmp_path / "short.json", "--json"],
                                          check=True, capture_output=True).stdout)
    assert described["drivers_end"] == pytest.approx(0.5)
    done = view(tmp_path, "short.json", program=PROGRAM)
    assert done.returncode == 0, done.stderr
    assert data_of(tmp_path / "short.html")[0]["times"][-1] == pytest.approx(0.5)
    done = view(tmp_path, "short.json", "--duration", "2", program=PROGRAM)
    assert done.returncode == 2 and "a driver's table ends at 0.5 s" in done.stderr


def test_a_scene_is_shown_in_the_form_of_the_step_that_it_needs(tmp_path):
    points = [("A", 0, 0), ("B", 1, 1e-8), ("C", 2, 0), ("D", 3, 1e-8)]  # nearly in line: singular
    (tmp_path / "level.json").write_text(json.dumps({
        "points": [{"name": name, "position": [x, y], "fixed": name in "AD"} for name, x, y in points],
        "rods": [{"between": list(ends), "mass": 1} for ends in ("AB", "BC", "CD")]}))
    done = view(tmp_path, "level.json", "--duration", "0.025", program=PROGRAM)
    assert done.returncode == 0 and "saddle-point form" in done.stdout, done.stderr


@pytest.mark.parametrize("duration", ["1e12", "1e300"])
def test_a_duration_that_takes_too_many_steps_is_refused(tmp_path, duration):
    done = view(tmp_path, "four-bar:1", "--duration", duration, program=PROGRAM)
    assert done.returncode == 2 and "steps" in done.stderr and "at most 1e+08" in done.stderr


@pytest.mark.parametrize("asked, up", [([], [0, 0, 1]), (["--up", "x"], [1, 0, 0])])
def test_a_scene_in_space_stands_upright(tmp_path, asked, up):
    (tmp_path / "pendulum.json").write_text(json.dumps({
        "dimension": 3, "gravity": [0, 0, -9.81],
        "points": [{"name": "A", "position": [0, 0, 0], "fixed": True},
                   {"name": "B", "position": [0.6, 0, -0.8]}],
        "rods": [{"name": "rod", "between": ["A", "B"], "mass": 1}]}))
    done = view(tmp_path, "pendulum.json", "--duration", "0.5", *asked, program=PROGRAM)
    assert done.returncode == 0, done.stderr
    assert data_of(tmp_path / "pendulum.html")[0]["up"] == up


def test_outputs_and_torsion_springs_of_a_scene_are_shown(tmp_path):
    done = view(tmp_path, ROOT / "harness/scenes/examples/spatial_joints.json", "--duration", "0.5",
                "--output", "page.html", "--png", "sheet.png", program=PROGRAM)
    assert done.returncode == 0, done.stderr
    data, _ = data_of(tmp_path / "page.html")
    assert set(data["outputs"]) == {"bend", "M", "axis", "reach", "slide"} and len(data["coils"]) == 1
    with Browser(tmp_path / "profile") as browser:
        browser.open(tmp_path / "page.html")
        browser.wait("document.getElementById('output-values').textContent !== ''")
        assert browser.complaints == []
