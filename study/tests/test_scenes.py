# Standard problems: what they are judged by, and what is asked for; the program against equations of their own.
import json
import subprocess
from types import SimpleNamespace

import numpy
import pandas
import pytest

from analysis.core.files import StudyError
from analysis.core.registry import Registry
from study.core.cell import Contender
from study.scenes import mechanics, metric, modelling, plan, problems, references
from study.scenes.metric import extrapolate, observed_order
from study.tests.conftest import PROGRAM, ROOT

GRAVITY = mechanics.GRAVITY


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


def outputs(folder, scene, step, problem):
    """Samples of a run of `problem` with csc_klu/refactor, of `scene` instead of its own."""
    file = folder / "outputs.csv"
    every = round(problem.duration / step) // metric.SAMPLES
    subprocess.run([PROGRAM, "simulate", scene, "--implementation", "csc_klu/refactor", "--step", f"{step:g}", "--duration",
                    f"{problem.duration:g}", *problem.settings, "--output", file, "--every", f"{every}"], check=True,
                   stdout=subprocess.DEVNULL, cwd=ROOT)
    return {name: values.to_numpy() for name, values in pandas.read_csv(file).items()}


@pytest.mark.slow
@pytest.mark.parametrize("problem", [one for one in problems.read_list()[1] if one.known in references.INTEGRATED],
                         ids=lambda one: one.name)
def test_the_program_agrees_with_equations_of_motion_of_their_own(tmp_path, problem):
    found = outputs(tmp_path, problem.scene, problem.steps[-1], problem)
    known = references.KNOWN[problem.known](found["t"])
    assert metric.precision(metric.errors(found, known)[0]) == "high"
    assert set(known) == set(problem.columns(found))


def test_published_angles_of_andrews_mechanism_close_its_loop():
    """P from B and gamma, and from O by beta and Theta."""
    at, beta, theta = references.andrews_end(), 0.1581077119629904e2, -0.1575637105984298e2
    for axis, direction in (("x", numpy.cos), ("y", numpy.sin)):
        assert abs(at[f"E.{axis}"] - 28e-3 * direction(beta + theta) - at[f"P.{axis}"]) < 1e-14


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


@pytest.mark.parametrize("names, compared", [
    (["d/one", "k/a", "c/b"], ["k/a", "c/b"]), (["d/one", "k/x", "c/b"], ["c/b", "d/one"]),
    (["d/one", "d/two"], ["d/one"]), (["k/x", "k/a"], ["k/a"])])
def test_two_of_those_that_take_part_are_compared(names, compared):
    assert problems.compared_of(["k/a", "c/b"], names) == compared


@pytest.mark.parametrize("change, message", [
    ({"known": "nothing"}, "P: unknown reference 'nothing'"), ({"published": "never"}, "unknown published values 'never'"),
    ({"known": "extrapolated"}, "extrapolation needs three steps")])
def test_what_the_list_names_must_exist(tmp_path, change, message):
    path = tmp_path / "problems.yaml"
    entry = {"name": "P", "title": "P", "scene": "s", "duration": 1, "steps": [0.1], "known": "pendulum", "judged": ["B"]}
    path.write_text(json.dumps({"compared": [], "problems": [entry | change]}))
    with pytest.raises(StudyError, match=message):
        problems.read_list(path)


class Asked:
    """A lab that runs nothing and keeps what it is asked for."""

    def __init__(self, names, **settings):
        self.contenders, self.settings, self.cells = [Contender(name, name) for name in names], settings, []
        self.registry = Registry({"implementations": [{"folder": "eigen_dense", "available": True, "variants": [
            {"name": "eigen_dense/llt", "dense": True}]}]})

    def contender(self, name):
        return next((one for one in self.contenders if one.name == name), None)

    def run(self, cells, drop=False):
        self.cells += cells
        return [SimpleNamespace(cell={"scene": cell.scene}, output={"variables": 4}) for cell in cells]

    def scene(self, name, document):
        return f"{name}.json"

    def tell(self, text):
        pass


def test_two_run_every_step_everyone_the_first_and_all_go_through_the_gate():
    lab = Asked(["eigen_dense/llt", "csc_klu/refactor", "csc_cholmod/simplicial"], problems=["A01", "slider-crank"])
    plan.run(lab, "problems")
    counts = pandas.Series([(cell.role, cell.contenders[0].name, cell.scene.rpartition("/")[2]) for cell in lab.cells]).value_counts()
    assert counts["compared", "csc_klu/refactor", "slider_crank.json"] == 3
    assert counts["everyone", "eigen_dense/llt", "a01_pendulum.json"] == 1
    assert ("everyone", "eigen_dense/llt", "slider_crank.json") not in counts
    gates = [cell for cell in lab.cells if cell.role == "gate"]
    assert [len(cell.contenders) for cell in gates] == [3, 3]  # one process a problem
    for cell in lab.cells:
        assert cell.role == "gate" or cell.every * float(cell.settings[1]) * metric.SAMPLES == pytest.approx(float(cell.settings[3]))


def test_a_round_has_every_case_once_in_an_order_of_its_own():
    lab = Asked(["csc_klu/refactor", "eigen_dense/llt"], loops=[10], rounds=2, samples=3)
    plan.run(lab, "modelling")
    timed = [cell for cell in lab.cells if cell.timed]
    rounds = [[cell.role for cell in timed if cell.number == number] for number in (1, 2)]
    assert sorted(rounds[0]) == sorted(rounds[1]) and rounds[0] != rounds[1]
    assert len(rounds[0]) == len(modelling.CASES) + 1 and {"time.plain", "time.plain+twin"} < {*rounds[0]}
    bench = [cell for cell in timed if cell.kind == "bench"]
    assert all(len(cell.contenders) == 2 for cell in bench)  # they take turns
    assert len({cell.settled().file_name() for cell in lab.cells}) == len(lab.cells)
    untimed = [cell for cell in lab.cells if not cell.timed]
    assert len(untimed) == 2 * len(modelling.CASES) and {cell.every for cell in untimed} == {1, 20}
    lab = Asked([], loops=[10], rounds=1, samples=3)
    plan.run(lab, "modelling")
    assert lab.cells == []
