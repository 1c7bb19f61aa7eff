# study/view on a stand-in program: what is read, what is prepared, what is refused and how.
import base64
import io
import json
import os
import re
import struct
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy
import pytest
from matplotlib.image import imread

from analysis.core.files import StudyError
from study.tests import moving_mbs
from study.tests.conftest import ROOT
from study.tools.viewer import main, page, program, trajectory
from study.tools.viewer.program import from_description, upward

STAND_IN = Path(moving_mbs.__file__)


def view(folder, *arguments, program=STAND_IN):
    return subprocess.run([ROOT / "study" / "view", *map(str, arguments)], cwd=folder, text=True,
                          capture_output=True, env=os.environ | {"MBS_PROGRAM": str(program)},
                          timeout=300)


def scene_of(name):
    return from_description({"dimension": moving_mbs.PLACES.get(name, 2), "drivers_end": None,
                             "elements": moving_mbs.elements(name)}, name)


def csv_of(folder, name, times=(0.0, 0.5, 1.0), change=lambda row, values: values, curves=True):
    """A trajectory; `change` may alter the values of a row (the header is row 0)."""
    axes = "xyz"[:scene_of(name).dimension]
    rows = [["t", *(f"{point}.{v}{axis}" for point in moving_mbs.place(name, 0) for v in ("", "v")
                    for axis in axes), *(trajectory.CURVES if curves else ())]]
    for t in times:
        places = (x for _, at in moving_mbs.place(name, t).values() for x in (*at, *[0] * len(at)))
        rows.append([t, *places, *((1 + t, 2 - t, 1e-9) if curves else ())])
    path = folder / f"{name}.csv"
    path.write_text("".join(",".join(map(str, change(k, row))) + "\n"
                            for k, row in enumerate(rows)))
    return path


def data_of(page):
    """The data and the packed positions of a page."""
    text = page.read_text()
    data = json.loads(re.search(r'<script id="scene"[^>]*>(.*?)</script>', text)[1])
    packed = base64.b64decode(re.search(r'<script id="packed"[^>]*>(.*?)</script>', text)[1])
    return data, struct.unpack(f"<{len(packed) // 4}f", packed)


def test_positions_and_curves_are_read(tmp_path):
    scene = scene_of("top")
    motion = trajectory.read(csv_of(tmp_path, "top"), scene, 100)
    assert motion.times.tolist() == [0, 0.5, 1]
    for frame, t in enumerate(motion.times):
        expected = [at for _, at in moving_mbs.top(t).values()]
        numpy.testing.assert_allclose(motion.positions[frame], expected, atol=1e-15)
    assert motion.curves["kinetic_energy"].tolist() == [1, 1.5, 2]


def test_rows_between_frames_count_for_the_violation_only(tmp_path):
    def change(row, values):
        return [*values[:-1], 5e-3] if row == 4 else values
    path = csv_of(tmp_path, "crank", times=[0.1 * k for k in range(12)], change=change)
    motion = trajectory.read(path, scene_of("crank"), 4)
    numpy.testing.assert_allclose(motion.times, [0, 0.3, 0.6, 0.9, 1.1])
    assert motion.curves["constraint_violation"].tolist() == [1e-9, 5e-3, 1e-9, 1e-9, 1e-9]


def test_a_trajectory_without_curves_is_shown_and_said(tmp_path):
    done = view(tmp_path, "crank", csv_of(tmp_path, "crank", curves=False))
    assert done.returncode == 0, done.stderr
    assert "no energy and constraint columns" in done.stdout
    page = tmp_path / "crank.html"
    assert data_of(page)[0]["curves"] is None
    assert 'id="energy"' not in page.read_text() and "without curves" in page.read_text()


@pytest.mark.parametrize("change, words", [
    (lambda row, values: values[1:], "its first column is 'O.x', not t"),
    (lambda row, values: values[:-8], "it lacks the column R.x and 1 more"),
    (lambda row, values: values[:-1], "but not all of"),
    (lambda row, values: [v.replace("E.", "Z.") for v in values] if row == 0 else values,
     "another scene than crank: it lacks the column E.x"),
    (lambda row, values: [*values, "Q.x" if row == 0 else 1], "it has the column Q.x"),
    (lambda row, values: [*values, "E.x" if row == 0 else 1], "the column E.x more than once"),
    (lambda row, values: [*values[:5], "nan", *values[6:]] if row == 2 else values,
     "line 3: not 28 finite numbers"),
    (lambda row, values: [*values[:5], "1e999", *values[6:]] if row == 2 else values,
     "line 3: not"),
    (lambda row, values: [*values[:5], "", *values[6:]] if row == 2 else values, "line 3: not"),
    (lambda row, values: values[:7] if row == 3 else values, "line 4: not 28 finite numbers"),
    (lambda row, values: [0.0, *values[1:]] if row == 2 else values, "line 3: the time 0 s"),
    (lambda row, values: [values[0], *(v + 0.1 for v in values[1:])] if row == 1 else values,
     "starts 0.1 m away"),
])
def test_wrong_trajectories_are_refused_by_name_and_line(tmp_path, change, words):
    path = csv_of(tmp_path, "crank", change=change)
    with pytest.raises(StudyError, match=re.escape(words)) as error:
        trajectory.read(path, scene_of("crank"), 100)
    assert str(path) in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize("text, words", [("", "is empty"), ("t,O.x\n", "another scene"),
                                         ("\x00\x01\xff", "is no trajectory")])
def test_files_that_are_no_trajectories_are_refused(tmp_path, text, words):
    path = tmp_path / "some.csv"
    path.write_text(text)
    with pytest.raises(StudyError, match=words):
        trajectory.read(path, scene_of("crank"), 100)


def test_what_has_no_end_is_not_read(tmp_path):
    with pytest.raises(StudyError, match="/dev/null is no regular file"):
        trajectory.read("/dev/null", scene_of("crank"), 100)
    header = csv_of(tmp_path, "crank").read_text().partition("\n")[0] + "\n"
    for text, words in (("", "is no trajectory"), (header, "line 2: not")):  # and zeros without a line's end
        path = tmp_path / "some.csv"
        path.write_text(text)
        os.truncate(path, len(text) + 2 * trajectory.LONGEST)
        with pytest.raises(StudyError, match=words):
            trajectory.read(path, scene_of("crank"), 100)


def test_one_row_is_no_motion(tmp_path):
    with pytest.raises(StudyError, match="1 row"):
        trajectory.read(csv_of(tmp_path, "crank", times=[0.0]), scene_of("crank"), 100)


@pytest.mark.parametrize("arguments, words", [
    (["crank", "none.csv"], "cannot read none.csv: No such file or directory"),
    (["missing.json"], "cannot open missing.json: No such file or directory"),
    (["old"], "lacks something to draw"),
    (["crank", "--output", "page.txt"], "it must end with .html"),
    (["crank", "--output", "nowhere/page.html"], "there is no directory nowhere"),
    (["crank", "--output", "/proc/page.html"], "cannot write /proc/page.html"),
    (["crank", "--png", "sheet.pdf"], "it must end with .png"),
    (["crank", "--duration", "-1"], "--duration"),
    (["crank", "--window", "3", "2"], "the first before the last"),
    (["crank", "--duration", "1", "--png", "a.png", "--window", "5", "6"], "from 0 to 1 s"),
    (["crank", "any.csv", "--duration", "1"], "but a TRAJECTORY is given"),
    (["crank", "any.csv", "--implementation", "csc_klu"], "but a TRAJECTORY is given"),
    (["crank", "--window", "2", "3"], "--window: found without --png"),
    (["stiff", "--step", "1e-3"], "diverged at t = 0.1 s"),
    ([], "the following arguments are required: scene"),
])
def test_bad_requests_get_one_line_and_write_nothing(tmp_path, arguments, words):
    done = view(tmp_path, *arguments)
    assert done.returncode == 2
    assert words in done.stderr and done.stderr.count("\n") == 1, done.stderr
    assert not list(tmp_path.iterdir())


def test_a_program_that_is_not_there_is_named(tmp_path):
    done = view(tmp_path, "crank", program="/nowhere/mbs")
    assert done.returncode == 2 and "/nowhere/mbs is missing: build it with study/setup" in done.stderr


def test_outputs_that_cannot_be_replaced_leave_no_parts(tmp_path):
    path = csv_of(tmp_path, "crank")
    done = view(tmp_path, "crank", path, "--output", path.rename(tmp_path / "crank.html"))
    assert done.returncode == 2 and "cannot read" in done.stderr
    done = view(tmp_path, "crank", tmp_path / "crank.html")
    assert done.returncode == 2 and "it is an input" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["crank.html"]


def test_a_simulation_of_its_own_reaches_the_end(tmp_path):
    done = view(tmp_path, "crank", "--duration", "2", "--png", "crank.png")
    assert done.returncode == 0, done.stderr
    data, packed = data_of(tmp_path / "crank.html")
    assert data["times"][0] == 0 and data["times"][-1] == pytest.approx(2)
    assert 300 <= len(data["times"]) <= 601
    assert [data["points"][i]["name"] for i in data["moving"]] == ["E", "P", "D", "R"]
    assert len(packed) == len(data["times"]) * 4 * 2
    assert packed[-8:-6] == pytest.approx(moving_mbs.crank(2.0)["E"][1], abs=1e-6)
    assert (tmp_path / "crank.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


def test_the_step_is_made_smaller_until_the_run_is_right(tmp_path):
    done = view(tmp_path, "stiff")
    assert done.returncode == 0, done.stderr
    assert "diverged" in done.stdout and "degraded: local errors" in done.stdout and "step 1.25e-05 s" in (tmp_path / "stiff.html").read_text()
    assert data_of(tmp_path / "stiff.html")[0]["times"][-1] == pytest.approx(0.1)


def test_a_slow_scene_is_shortened_unless_a_duration_is_asked_for(tmp_path):
    done = view(tmp_path, "slow")
    assert "only 0.07 s of it" in done.stdout, done.stdout + done.stderr
    assert "only" not in view(tmp_path, "slow", "--duration", "3").stdout


def test_driven_motion_is_shown_as_long_as_it_is_known(tmp_path):
    assert view(tmp_path, "short").returncode == 0
    assert data_of(tmp_path / "short.html")[0]["times"][-1] == pytest.approx(0.5)
    done = view(tmp_path, "short", "--duration", "2")
    assert done.returncode == 2 and "a driver's table ends at 0.5 s" in done.stderr


def test_no_name_in_a_scene_can_leave_its_element(tmp_path):
    description = {"dimension": 2, "drivers_end": None, "elements": moving_mbs.elements("crank")}
    scene = from_description(description, "</title><script>alert(1)</script>")
    scene = replace(scene, points=[(name.replace("O", "</script><b>"), kind) for name, kind in scene.points])
    motion = trajectory.read(csv_of(tmp_path, "crank"), scene_of("crank"), 100)
    from study.tools.viewer.page import render
    text = render(scene, motion, "<i>", [0, 1, 0])
    assert "<b>" not in text and "alert(1)</script>" not in text and "<i>" not in text


def test_traces_are_of_points_that_move_differently(tmp_path):
    scene = scene_of("crank")
    path = csv_of(tmp_path, "crank", times=[0.05 * k for k in range(60)])
    motion = trajectory.read(path, scene, 99)
    names = [scene.points[index][0] for index in page.traces(scene, motion)]
    assert names[0] == "E" and len(names) == 2 and names[1] in "PD"


def test_vectors_sit_on_shared_points_or_amid_their_body(tmp_path):
    scene = scene_of("top")
    motion = trajectory.read(csv_of(tmp_path, "top"), scene, 100)
    index = {name: place for place, (name, _) in enumerate(scene.points)}
    assert page.arrows(scene, motion)[0]["at"] == [index[name] for name in "OTUV"]
    scene.bodies.append(type(scene.bodies[0])("L", [index["W"], index["T"]], [index["a"]]))
    assert page.arrows(scene, motion)[0]["at"] == [index["T"]]


def test_a_window_is_cut_out_of_the_motion(tmp_path):
    motion = trajectory.read(csv_of(tmp_path, "crank", times=[0.05 * k for k in range(201)]), scene_of("crank"), 999)
    part = main.within(motion, (1, 3))
    assert part.times[0] == pytest.approx(1) and part.times[-1] == pytest.approx(3) and len(part.positions) == len(part.times)


def test_the_sheet_shows_eight_different_instants(tmp_path):
    path = csv_of(tmp_path, "top", times=[0.05 * k for k in range(60)])
    motion = trajectory.read(path, scene_of("top"), 99)
    pixels = imread(io.BytesIO(main.sheet(scene_of("top"), motion, [0, 1, 0])))
    panels = [panel for row in numpy.split(pixels, 2) for panel in numpy.split(row, 4, axis=1)]
    for place, panel in enumerate(panels):
        assert len(numpy.unique(panel.reshape(-1, panel.shape[2]), axis=0)) > 50  # it is no empty paper
        assert all((panel != other).any(axis=2).sum() > 500 for other in panels[place + 1:])


def test_a_sheet_without_chromium_is_refused_with_the_cure(tmp_path, monkeypatch):
    monkeypatch.setattr(main, "CHROMIUM", ("/nowhere/chromium",))
    motion = trajectory.read(csv_of(tmp_path, "top"), scene_of("top"), 99)
    with pytest.raises(StudyError, match="/nowhere/chromium, which draws the sheet, is missing: run study/setup"):
        main.sheet(scene_of("top"), motion, [0, 1, 0])


@pytest.mark.parametrize("text, up", [
    ('{"gravity": [0, 0, -9.81]}', [0, 0, 1]), ('{"gravity": [0, 0, 9.81]}', [0, 0, -1]),
    ('{"gravity": [-9, 0.1, 4]}', [1, 0, 0]), ('{"gravity": [0, 0, 0]}', [0, 1, 0]),
    ('// "gravity": /*\n{"points": [{"name": "a//b/*"}], /* here:\n*/ "gravity": [0, 0, -1.6]}',
     [0, 0, 1]), ("{}", [0, 1, 0]), ('{"gravity": [0, 0, "=-g"]}', [0, 1, 0]), ("no JSON", [0, 1, 0])])
def test_up_is_against_gravity(tmp_path, text, up):
    path = tmp_path / "scene.json"
    path.write_text(text)
    assert upward(path) == up
    assert upward("four-bar:3") == [0, 1, 0]


def test_faces_are_those_of_a_solid_and_look_outward(tmp_path):
    scene, motion = scene_of("top"), trajectory.read(csv_of(tmp_path, "top"), scene_of("top"), 100)
    corners = numpy.array([[x, y, z] for x in (0, 1) for y in (0, 2) for z in (0, 3)], float)
    count = len(scene.points)
    motion = motion._replace(positions=numpy.concatenate([motion.positions, numpy.tile(corners, (len(motion.times), 1, 1))], axis=1))
    scene = replace(scene, bodies=[program.Body(name, [count + k for k in corners_of], [])
                                   for name, corners_of in (("box", range(8)), ("plate", (0, 1, 2, 3)), ("bar", (0, 7)))])
    at = motion.positions[0]
    box, plate, bar = (page.faces(at, body.points) for body in scene.bodies)
    assert len(box) == 12 and plate == bar == []
    volume = sum(numpy.dot(at[a], numpy.cross(at[b], at[c])) for a, b, c in box) / 6
    assert volume == pytest.approx(6)  # positive: all look outward


def test_a_bodys_own_helper_points_are_not_drawn(tmp_path):
    listed = moving_mbs.elements("top")
    listed["bodies"][0]["points"] = list("OT")
    names = {"U": "K.x", "V": "V", "W": "K.w"}
    for point in listed["points"]:
        point["name"] = names.get(point["name"], point["name"])
        point["helper"] = point["name"].startswith("K.")
    listed["rods"][0]["between"], listed["springs"] = ["T", "K.w"], []
    scene = from_description({"dimension": 3, "drivers_end": None, "elements": listed}, "top")
    kinds = dict(scene.points)
    # The author's own V stays; K.w is the end of a rod: what is drawn needs it.
    assert kinds["K.x"] == "hidden" and kinds["V"] == kinds["K.w"] == "free"
    motion = trajectory.read(csv_of(tmp_path, "top"), scene_of("top"), 100)
    hidden = [name for name, _ in scene.points].index("K.x")
    assert hidden not in {*page.places(scene), *page.traces(scene, motion)}


def test_distances_are_drawn_where_no_rod_is():
    listed = moving_mbs.elements("crank")
    listed["distances"] = [{"name": "same", "between": ["E", "O"]},
                           {"name": "tie", "between": ["C", "P"]}]
    scene = from_description({"dimension": 2, "drivers_end": None, "elements": listed}, "crank")
    assert [[scene.points[at][0] for at in rod] for rod in scene.rods] == [["O", "E"], ["C", "P"]]


def test_the_scenes_own_outputs_are_in_the_page(tmp_path):
    done = view(tmp_path, "crank", "--duration", "2")
    assert done.returncode == 0, done.stderr
    data, _ = data_of(tmp_path / "crank.html")
    assert {name: list(columns) for name, columns in data["outputs"].items()} == {
        "slider": ["slider.x", "slider.y"], "turned": ["turned"]}
    assert data["outputs"]["turned"]["turned"] == pytest.approx([4 * t for t in data["times"]])
    view(tmp_path, "top", "--duration", "2")
    assert data_of(tmp_path / "top.html")[0]["outputs"] == {}
    assert 'id="output"' not in (tmp_path / "top.html").read_text()


@pytest.mark.parametrize("steps, frames, every", [
    (8000, 600, 16), (8000, 8000, 1), (7, 600, 1), (8001, 600, 21), (7919, 600, 14), (0.2, 600, 1),
    (1e300, 600, 200_000), (float("inf"), 600, 200_000)])
def test_rows_are_written_every_so_many_steps(steps, frames, every):
    assert program._every(steps, frames) == every
