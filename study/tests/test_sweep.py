# study/sweep: tables of mbs sweep as pictures.
import gzip
import subprocess

import numpy
import pytest

from analysis.core.files import StudyError
from study.tests.conftest import PROGRAM, ROOT, study
from study.tools import sweep

HEAD = ("k,m,status,status_reason,failed_at,steps,passes_per_step,position_error_estimate,local_error_sum,"
        "energy_drift_max,constraint_violation_max,B.x.last,B.x.min,B.x.max\n")


def table(path, lanes=12, head=HEAD):
    rows = []
    for lane in range(lanes):
        k, m = lane % 4, lane // 4
        rows.append(f"{k},{m},diverged,\"lost, early\",0.1,80,,,,,,,,\n" if lane == 5 else
                    f"{k},{m},plausible,,,80,2,,1e-3,,1e-9,{k * m},0,{k + m}\n")
    opened = gzip.open if path.suffix == ".gz" else open
    with opened(path, "wt") as file:
        file.write(head + "".join(rows))
    return path


@pytest.mark.parametrize("name", ["t.csv", "t.csv.gz"])
def test_a_table_becomes_a_picture(tmp_path, name):
    path = table(tmp_path / name)
    done = subprocess.run([ROOT / "study" / "sweep", path], cwd=tmp_path, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == "t.png: B.x.last of 12 lanes, 1 of them failed\n"
    assert (tmp_path / "t.png").read_bytes().startswith(b"\x89PNG")


def test_the_surface_has_medians_and_marks_failures(tmp_path):
    from matplotlib import pyplot
    found, parameters, result = sweep.read(table(tmp_path / "t.csv"), None)
    assert (parameters, result) == (["k", "m"], "B.x.last")
    figure, axes = pyplot.subplots()
    sweep.surface(axes, found, ["k", "m"], result)
    values = numpy.ma.filled(axes.collections[0].get_array(), numpy.nan).reshape(3, 4)
    assert values[2, 3] == 6 and numpy.isnan(values[1, 1])
    assert axes.lines[0].get_xydata().tolist() == [[1, 1]]
    pyplot.close(figure)


def test_numbers_are_not_crossed_by_their_axis(tmp_path):
    from matplotlib import pyplot
    found, parameters, result = sweep.read(table(tmp_path / "t.csv"), None)
    figure, axes = pyplot.subplots()
    sweep.lines(axes, found, [*parameters, result])
    above = max(line.get_zorder() for line in axes.lines)
    assert axes.texts and all(one.get_bbox_patch() and one.get_zorder() > above for one in axes.texts)
    pyplot.close(figure)


def test_a_result_of_a_lane_that_failed_does_not_count(tmp_path):
    from matplotlib import pyplot
    found, parameters, result = sweep.read(table(tmp_path / "t.csv"), None)
    found.loc[5, result] = 1e6  # got so far
    figure, (left, right) = pyplot.subplots(1, 2)
    sweep.lines(left, found, [*parameters, result])
    finished, failed = left.collections
    assert [text.get_text() for text in left.texts][-2:] == ["6", "0"] and failed.get_segments()[0][-1, 1] == -0.12
    assert finished.get_clim() == (0, 1) and finished.get_array().max() == 1
    sweep.surface(right, found, ["k", "m"], result)
    assert numpy.ma.filled(right.collections[0].get_array(), numpy.nan).reshape(3, 4)[2, 3] == right.collections[0].get_clim()[1] == 6
    found["finished"] = False  # then there is nothing else
    figure, axes = pyplot.subplots()
    sweep.lines(axes, found, [*parameters, result])
    assert axes.texts[-2].get_text() == "1e+06"
    pyplot.close("all")


def test_the_lanes_that_are_drawn_have_no_relation_that_a_grid_has_not(tmp_path):
    from matplotlib import pyplot
    found, parameters, result = sweep.read(table(tmp_path / "t.csv", 2 * sweep.LINES + 1, HEAD.replace("k,m", "m,k")), None)
    found["m"], found["finished"] = found.index % 2, True
    figure, axes = pyplot.subplots()
    sweep.lines(axes, found, ["k", "m", result])
    ends = numpy.array(axes.collections[0].get_segments())[:, :2, 1]
    assert len(ends) == sweep.LINES and abs(numpy.corrcoef(ends.T)[0, 1]) < 0.1
    pyplot.close(figure)


def test_cells_are_of_values_or_of_one_width():
    assert sweep.edges(numpy.array([1.0, 4, 2])).tolist() == [0.5, 1.5, 3, 5]
    for count, expected in ((10_000, sweep.CELLS), (400, 10), (50, 4)):
        found = sweep.edges(numpy.linspace(0, 1, count))
        assert len(found) == expected + 1 and numpy.ptp(numpy.diff(found)) < 1e-12
    assert sweep.edges(numpy.array([7.0, 7])).tolist() == [6.5, 7.5]


@pytest.mark.parametrize("text, options, words", [
    (None, [], "no table can be read"), ("", [], "no table can be read"), ("a,b\n1,2\n", [], "found no lanes"),
    (HEAD, [], "found no lanes"), (HEAD + "1,2,ok" + "," * 11 + "\n", ["--of", "B"], "--of: found 'B'"),
    (HEAD + "1,2,diverged" + "," * 11 + "\n", [], "--of: found 'constraint_violation_max', allowed are none: no lane has a result"),
    (HEAD + "x,2,ok" + ",0" * 11 + "\n", [], "k has something else"),
    (HEAD + "1,2,ok" + ",0" * 11 + "\n1,", [], "line 3: found a row that is cut short"),
    (HEAD + "1,2,ok" + ",0" * 11 + "\n1,2", [], "line 3: .* cut short"),
    (HEAD + "1,2,ok" + ",0" * 11 + "\n", ["--over", "k", "q"], "--over: found 'q', allowed are k, m"),
    (HEAD + "1,2,ok" + ",0" * 11 + "\n", ["--output", "t.pdf"], "ends with .png"),
    (HEAD + "1,2,ok" + ",0" * 11 + "\n", ["--parts", "4"], "--parts: found 4 without --cluster"),
    (HEAD + "1,2,ok" + ",0" * 11 + "\n", ["--parts", "0", "--cluster", "slurm", "--", "four-bar:1"], "--parts: found 0, allowed")])
def test_what_cannot_be_drawn_is_said(tmp_path, text, options, words):
    path = tmp_path / "t.csv"
    if text is not None:
        path.write_text(text)
    with pytest.raises(StudyError, match=words):
        sweep.sweep([str(path), *options])
    assert [*tmp_path.iterdir()] == [path] * (text is not None)


@pytest.fixture
def profile(tmp_path):
    """A cluster that is this machine: its array runs at once, and what a node writes last is seen late."""
    folder = tmp_path / "profile"
    folder.mkdir()
    array = ('for i in $(seq "$1"); do bash "$2" "$i" > log-"$i" 2>&1; done; ls done-* > .cluster/all; '
             '[ ! -e done-1 ] || { mv done-1 .cluster; (sleep 1; mv .cluster/done-1 .) > /dev/null 2>&1 & }; echo all')
    status = '[ "$(wc -l < .cluster/all)" = 2 ] && echo success || echo failed'
    for name, text in {"array": array, "submit": "", "status": status, "cancel": "", "config.yaml": ""}.items():
        (folder / name).write_text(f"#!/bin/bash\n{text}\n")
        (folder / name).chmod(0o755)
    return folder


def test_a_cluster_gives_the_table_of_these_words_only(tmp_path, profile):
    path = tmp_path / "t.csv"

    def words(gravity):
        return "four-bar:1", "--vary", f"gravity/1={gravity}", "--implementation", "csc_klu/refactor", "--duration", "0.1"

    def made(gravity):
        return study("sweep", path, "--output", tmp_path / "t.png", "--cluster", profile, "--parts", 2, "--", *words(gravity))

    (tmp_path / "t.csv.parts").mkdir()  # as a controller leaves it that is killed before it merges
    for number in (1, 2):
        subprocess.run([PROGRAM, "sweep", *words("-12,-11"), "--shard", f"{number}/2", "--output", tmp_path / f"t.csv.parts/part-{number}"],
                       check=True, capture_output=True)
    other = made("-9,-8")
    assert other.returncode == 2 and "part 1 of 2 is not done: " in other.stderr and "another sweep" in other.stderr, other.stderr
    assert not path.exists()
    for _ in range(2):  # the second one only draws
        assert made("-12,-11").returncode == 0
        assert [line.partition(",")[0] for line in path.read_text().splitlines()[1:]] == ["-12", "-11"]
        assert {one.name for one in (tmp_path / "t.csv.parts").iterdir()} == {"part.sh", "made", ".lock", ".cluster"}
    before, other = path.read_bytes(), made("-9,-8")
    assert (other.returncode, path.read_bytes()) == (2, before) and "did not make" in other.stderr
    path.rename(tmp_path / "mine.csv")
    path.write_text("mine")  # nor what nobody made
    (tmp_path / "t.csv.parts/part.sh").unlink()
    assert made("-12,-11").returncode == 2 and path.read_text() == "mine"


# A part is the scene; FAILS is the part that fails.
FAKE = """#!/bin/bash
for word; do [ "$last" = --output ] && output=$word; last=$word; done
case " $* " in
  *" --check "*) ! grep mbs: s.json >&2 || exit 2 ;;
  *" --shard $FAILS/2 "*) echo mbs: lost; exit 2 ;;
  " merge-sweep "*) cat "$2" "$3" > "$output" ;;
  *) cat s.json > "$output"; exit 1 ;;
esac
"""


@pytest.fixture
def make(tmp_path, profile, monkeypatch):
    """Makes t.csv of s.json by a stand-in for the program."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MBS_PROGRAM", str(tmp_path / "mbs"))
    (tmp_path / "s.json").write_text("scene\n")
    (tmp_path / "mbs").write_text(FAKE)
    (tmp_path / "mbs").chmod(0o755)
    return lambda: sweep.on_cluster(["s.json", "--vary", f"k={'1,' * 200}2"], "t.csv", 2, profile)


@pytest.mark.parametrize("name", ["s.json", "mbs", "t.csv"])
def test_a_table_of_another_scene_or_program_is_none_of_this_command(tmp_path, make, name):
    make()
    assert (tmp_path / "t.csv").read_text() == "scene\n" * 2
    path = tmp_path / name
    before = path.read_text()
    path.write_text(before + "# changed\n")
    with pytest.raises(StudyError, match="t.csv: found a file that this command did not make with this scene and this program"):
        make()
    path.write_text(before)
    make()  # there it is


def test_a_table_that_came_while_a_part_is_missing_is_none_of_this_command(tmp_path, make, monkeypatch):
    monkeypatch.setenv("FAILS", "2")
    with pytest.raises(StudyError, match="is not done"):
        make()
    monkeypatch.delenv("FAILS")
    (tmp_path / "t.csv").write_text("of another sweep")
    with pytest.raises(StudyError, match="did not make"):
        make()
    assert (tmp_path / "t.csv.parts/part-1").exists() and (tmp_path / "t.csv").read_text() == "of another sweep"


def test_what_mbs_refuses_is_not_submitted(tmp_path, make):
    (tmp_path / "s.json").write_text("mbs: no scene")
    with pytest.raises(StudyError, match="mbs: no scene"):
        make()
    assert not (tmp_path / "t.csv.parts").exists()


def test_the_part_that_failed_is_named_and_not_one_that_is_seen_late(make, monkeypatch):
    monkeypatch.setenv("FAILS", "2")
    with pytest.raises(StudyError, match="part 2 of 2 is not done: mbs: lost; the same command goes on"):
        make()
