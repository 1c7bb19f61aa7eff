# study/scenes: references against their own equations, the metric, and the whole on two problems.
import json
import os
import subprocess
import tempfile

import numpy
import pandas
import pytest

from study.pipeline import runs
from study.pipeline.errors import StudyError
from study.scene_study import mechanics, metric, modelling, problems, references
from study.scene_study.extrapolate import extrapolate, observed_order
from study.scene_study.main import _choose, scenes
from study.tests.conftest import FAKE, ROOT

GRAVITY = references.GRAVITY


def second_derivative(function, column, times, step=1e-4):
    left, middle, right = (function(times + shift)[column] for shift in (-step, 0, step))
    return (right - 2 * middle + left) / step**2


def test_pendulum_fulfils_its_equation():
    times = numpy.linspace(0.1, 9.9, 41)
    at = references.pendulum(times)
    assert numpy.allclose(at["B.x"]**2 + at["B.y"]**2, 1, atol=1e-12)
    assert numpy.allclose((at["vB.vx"]**2 + at["vB.vy"]**2) / 2 + GRAVITY * at["B.y"], 0, atol=1e-9)
    # The tension cannot change the angular momentum: d/dt (x vy - y vx) = -g x.
    turning = (at["B.x"] * second_derivative(references.pendulum, "B.y", times)
               - at["B.y"] * second_derivative(references.pendulum, "B.x", times))
    assert numpy.allclose(turning, -GRAVITY * at["B.x"], atol=1e-5)


@pytest.mark.parametrize("loops", [1, 2, 40])
def test_four_bar_conserves_its_energy(loops):
    at = references.four_bar(numpy.linspace(0, 20, 101), loops)
    inertia, weight = (loops + 1) / 3 + loops, (loops + 1) / 2 + loops
    energy = inertia / 2 * (at["vB0.vx"]**2 + at["vB0.vy"]**2) + weight * GRAVITY * at["B0.y"]
    assert numpy.allclose(energy, inertia / 2 + weight * GRAVITY, rtol=1e-10)


def test_grid_of_one_row_is_a_four_bar():
    """One row of the grid hangs from the ground as the N-four-bar stands on it."""
    times = numpy.linspace(0, 1, 11)
    at = mechanics.grid(times, 1, lean=0.3)
    angle = numpy.arctan2(at["corner.x"] - 1, -at["corner.y"])
    step = 1e-4
    nearby = mechanics.grid(numpy.array([0.0, 0.5 - step, 0.5, 0.5 + step]), 1, lean=0.3)
    turned = numpy.arctan2(nearby["corner.x"] - 1, -nearby["corner.y"])[1:]
    k = 3 * GRAVITY * (3 * 1 + 1) / (2 * (4 * 1 + 1))
    found = (turned[2] - 2 * turned[1] + turned[0]) / step**2
    assert abs(angle[0] - 0.3) < 1e-12
    assert abs(found + k * numpy.sin(turned[1])) < 1e-4


def test_metric_divides_by_the_reference_or_the_threshold():
    known = {"x": numpy.array([2.0, 0.0])}
    square, largest = metric.errors({"x": numpy.array([2.002, 1e-5])}, known)
    assert largest == pytest.approx(1e-2)
    assert square == pytest.approx(((1e-3**2 + 1e-2**2) / 2) ** 0.5)
    assert [metric.precision(e) for e in (1e-3, 1.1e-3, 0.1, 0.2, float("nan"))] == [
        "high", "low", "low", "none", "none"]


def test_extrapolation_removes_the_leading_error():
    values = [1 + 0.3 * step**2 + 0.01 * step**4 for step in (0.4, 0.2, 0.1)]
    assert observed_order(*map(numpy.float64, values)) == pytest.approx(2, abs=0.01)
    assert abs(extrapolate(*values[1:]) - 1) < 1e-5


def test_every_problem_is_complete():
    compared, listed = problems.read_list()
    assert len(compared) == 2 and compared[0].split("/")[0] != compared[1].split("/")[0]
    for problem in listed:
        if not problem.scene.startswith("four-bar:"):
            assert (ROOT / problem.scene).exists(), problem.scene
        for step in problem.steps:
            steps = problem.duration / step
            assert abs(steps - round(steps)) < 1e-6 and round(steps) % metric.SAMPLES == 0


def test_modelling_scenes_differ_where_they_should():
    scenes = modelling.scenes(3)
    assert {case.scene for case in modelling.CASES} == set(scenes)
    assert len(scenes["redundant"]["rods"]) == len(scenes["plain"]["rods"]) + 2
    assert all(not point.get("fixed") for point in scenes["unknown grounds"]["points"])


PROGRAM = os.environ.get("MBS_PROGRAM", str(ROOT / "build" / "mbs"))


def outputs(folder, scene, step, problem):
    """Samples of a run of `problem` with csc_klu/refactor, of `scene` instead of its own."""
    file = folder / "outputs.csv"
    every = round(problem.duration / step) // metric.SAMPLES
    subprocess.run([PROGRAM, "simulate", scene, "--implementation", "csc_klu/refactor", "--step",
                    f"{step:g}", "--duration", f"{problem.duration:g}", *problem.settings,
                    "--output", file, "--every", f"{every}"], check=True, stdout=subprocess.DEVNULL,
                   cwd=ROOT)
    return {name: values.to_numpy() for name, values in pandas.read_csv(file).items()}


@pytest.mark.parametrize("problem", [one for one in problems.read_list()[1]
                                     if one.known in references.INTEGRATED],
                         ids=lambda one: one.file_name)
def test_the_program_agrees_with_equations_of_motion_of_their_own(tmp_path, problem):
    found = outputs(tmp_path, problem.scene, problem.steps[-1], problem)
    known = references.KNOWN[problem.known](found["t"])
    assert metric.precision(metric.errors(found, known)[0]) == "high"
    assert set(known) == set(problems.columns_of(problem, found))


def test_published_angles_of_andrews_mechanism_close_its_loop():
    """P from B and gamma, and from O by beta and Theta."""
    at, beta, theta = references.andrews_end(), 0.1581077119629904e2, -0.1575637105984298e2
    for axis, direction in (("x", numpy.cos), ("y", numpy.sin)):
        assert abs(at[f"E.{axis}"] - 28e-3 * direction(beta + theta) - at[f"P.{axis}"]) < 1e-14


def test_published_values_and_the_difference_are_in_the_table():
    problem = next(one for one in problems.read_list()[1] if one.published)
    published = references.andrews_end()
    found = {"runs": {("a/b", step): {
        "summary": {"status": "ok", "status_reason": ""},
        "outputs": {"t": [0, 0.03]} | {column: [0, value + 1e-6 + step**2]
                                       for column, value in published.items()}}
        for step in problem.steps}}
    rows = problems.convergence_rows(problem, found, ["a/b"])
    assert {row["component"]: row["published"] for row in rows} == published
    assert [row["difference"] for row in rows] == pytest.approx([1e-6] * 8, rel=1e-6)


@pytest.mark.parametrize("body", [None, "K1", "K2", "K3", "K4", "K5", "K6", "K7"])
def test_andrews_mechanism_ends_where_it_was_published_to_end(tmp_path, body):
    """1e-9 m with the right inertias; with one of them 1 % off, far more than that."""
    problem = next(one for one in problems.read_list()[1] if one.published)
    lines = (ROOT / problem.scene).read_text().splitlines()
    scene = json.loads("\n".join(line for line in lines if not line.startswith("//")))
    for entry in scene["bodies"]:
        entry["inertia"] *= 1.01 if entry["name"] == body else 1
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(scene))
    finer, finest = (outputs(tmp_path, path, step, problem) for step in problem.steps[:2])
    away = max(abs(extrapolate(finer[column][-1], finest[column][-1]) - value)
               for column, value in references.andrews_end().items())
    assert away < 1e-9 if body is None else away > 1e-7


def run(*arguments, **more):
    environment = os.environ | {"MBS_PROGRAM": PROGRAM} | more
    return subprocess.run([ROOT / "study" / "scenes", *map(str, arguments)], text=True,
                          capture_output=True, env=environment, timeout=600)


def test_two_problems_through_the_real_program(tmp_path):
    results = tmp_path / "scenes"
    choice = ["--results", results, "--only", "csc_klu/refactor", "csc_cholmod/simplicial",
              "--problems", "A01", "slider-crank", "--rounds", "1"]
    done = run(*choice, TMPDIR=str(tmp_path))
    assert done.returncode == 0, done.stderr
    found = pandas.read_csv(results / "problems.csv")
    assert set(found.status) == {"plausible"}, found[["implementation", "status", "reason"]]
    finest = found[found.groupby("problem").step.transform("min") == found.step]
    assert set(finest.precision) == {"high"}, finest[["problem", "error_rms"]]
    assert set(pandas.read_csv(results / "gate.csv").verdict) == {"agrees"}
    assert dict(zip(found.problem, found.reference)) == {
        "A01": "closed form", "slider-crank": "own equations, integrated"}
    orders = pandas.read_csv(results / "convergence.csv")
    meaningful = orders[orders.order_meaningful]
    assert len(meaningful) and meaningful.order.between(1.9, 2.1).all(), meaningful
    pieces = pandas.read_csv(results / "modelling.csv")
    lost = pieces[~pieces.status.isin(runs.GOOD)]  # no projections: lost at a singular position
    assert set(lost.piece) <= {"projections"} and lost.reason.notna().all(), lost.reason
    assert (pieces.position_error.dropna() < 0.05).all()
    for raw in [*found.raw_file, *pieces.raw_file]:
        assert (results / raw).exists(), raw
    before = (results / "problems.csv").read_bytes(), (results / "scenes.html").read_bytes()
    again = run("--results", results, "--problems", "A01", "slider-crank", "--stored",
                TMPDIR=str(tmp_path))
    assert again.returncode == 0, again.stderr
    assert before == ((results / "problems.csv").read_bytes(),
                      (results / "scenes.html").read_bytes())


@pytest.fixture
def runs_nothing(tmp_path, monkeypatch):
    """study/scenes on the fake program, which runs no problem, and a list of its own to be edited."""
    (tmp_path / "scene.json").write_text("{}")
    listed = tmp_path / "problems.yaml"
    listed.write_text("""{compared: [good_sparse/only, good_dense/first], problems: [
        {name: A01, title: One, scene: %s, duration: 1, steps: [0.1], known: pendulum, judged: [B]}]}
        """ % (tmp_path / "scene.json"))
    monkeypatch.setenv("MBS_PROGRAM", str(FAKE))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(problems, "LIST", listed)
    return lambda *more: scenes(["--results", str(tmp_path / "results"), "--problems", "none",
                                 "--rounds", "0", *more])


@pytest.mark.parametrize("edited, what", [
    ("scene.json", r"inputs: \S*scene.json \w+, now \w+"), ("problems.yaml", r"inputs: problems.yaml \w+, now \w+"),
    ("", "variants")])
def test_a_results_directory_is_of_one_selection_and_one_state_of_the_scenes(
        runs_nothing, tmp_path, edited, what):
    runs_nothing()
    runs_nothing()
    more = () if edited else ("--only", "good_dense")
    if edited:
        (tmp_path / edited).write_text((tmp_path / edited).read_text() + "\n")
    with pytest.raises(StudyError, match=rf"holds results of something else \({what}\)"):
        runs_nothing(*more)


@pytest.mark.parametrize("names, chosen", [
    (["A01"], ["A01"]), (["a01_pendulum"], ["A01"]), (["SIMPLE pendulum", "a01"], ["A01"]),
    (["four-bar:40", "grid_10"], ["A02", "grid"]), (["none"], []), (None, None)])
def test_a_problem_is_known_by_name_title_and_scene_file(names, chosen):
    listed = problems.read_list()[1]
    assert [problem.name for problem in _choose(listed, names)] == (
        chosen if names else [problem.name for problem in listed])


def test_no_two_problems_share_a_name():
    names = [name.lower() for problem in problems.read_list()[1] for name in problem.names]
    assert len(names) == len(set(names))


def test_help_lists_the_problems():
    done = run("--help")
    assert done.returncode == 0
    for name in ("A01", "Simple pendulum", "a01_pendulum", "half_car"):
        assert name in done.stdout


@pytest.mark.parametrize("names, compared", [
    (["d/one", "k/a", "c/b"], ["k/a", "c/b"]), (["d/one", "k/x", "c/b"], ["c/b", "d/one"]),
    (["d/one", "d/two"], ["d/one"]), (["k/x", "k/a"], ["k/a"])])
def test_two_of_those_that_take_part_are_compared(names, compared):
    assert problems.compared_of(["k/a", "c/b"], names) == compared


def test_the_report_names_who_ran_the_problems(tmp_path):
    results = tmp_path / "scenes"
    done = run("--results", results, "--only", "eigen_dense", "--problems", "a03_andrews",
               "Slider-Crank", "--rounds", "0", TMPDIR=str(tmp_path))
    assert done.returncode == 0, done.stderr
    page = (results / "scenes.html").read_text()
    table = page.split("<h2>Standard problems</h2>")[1].split("</tbody>")[0]
    assert "run by eigen_dense/llt, at its finest step" in table and "csc_" not in table
    assert table.count('<td class="s">eigen_dense/llt</td>') == 2
    # Self-convergence needs another one: alone, it is not judged.
    assert ">not judged</span>" in table and ">high</span>" in table


def test_unknown_problem_is_named(tmp_path):
    done = run("--results", tmp_path, "--problems", "A99", TMPDIR=str(tmp_path))
    assert done.returncode == 2 and "A99" in done.stderr and "A01" in done.stderr
