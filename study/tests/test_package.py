"""The installed package: examples and Python against a fresh prefix, from an empty folder; without GPL parts."""
import csv
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build"
EXAMPLES = ROOT / "harness/examples"
pytestmark = [pytest.mark.skipif(not (BUILD / "harness/library/libmbs.so").exists(), reason="the library is not built"),
              pytest.mark.xdist_group("package")]


def run(*command, **options):
    """Its output; a failure shows all of it."""
    found = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=600,
                           env={"PATH": "/usr/bin:/bin", "HOME": "/nonexistent"} | options.pop("env", {}), **options)
    assert found.returncode == 0, found.stdout + found.stderr
    return found.stdout


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    """A prefix that nobody has built in."""
    folder = tmp_path_factory.mktemp("package") / "prefix"
    run("cmake", "--install", BUILD, "--prefix", folder)
    return folder


@pytest.fixture(scope="module")
def examples(prefix, tmp_path_factory):
    """The examples alone, built against the prefix."""
    folder = tmp_path_factory.mktemp("examples")
    shutil.copytree(EXAMPLES, folder, dirs_exist_ok=True)
    run("cmake", "-S", folder, "-B", folder, f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
    run("cmake", "--build", folder, "-j", "2")
    return folder


def driven(examples, inputs, *more):
    """Rows (t, height of the body) of the car."""
    text = run(examples / "car", "car.json", inputs, *more, cwd=examples)
    return [[float(cell) for cell in row] for row in csv.reader(text.splitlines())]


def test_the_car_feels_the_bump(examples):
    (examples / "road.csv").write_text(run(examples / "road.py", 1))
    rows = driven(examples, "road.csv")
    assert len(rows) == 800 and rows[-1][0] == pytest.approx(1.0)
    flat = re.sub(r"(?m)^[\d.,e-]+$", "0,0,0,0", (examples / "road.csv").read_text())
    (examples / "flat.csv").write_text(flat)
    lifted = [bumpy[1] - still[1] for bumpy, still in zip(rows, driven(examples, "flat.csv"))]
    assert max(map(abs, lifted[:150])) < 1e-12, "before the bump, at 2 m and 10 m/s"
    assert 0.005 < max(lifted) < 0.05


@pytest.mark.parametrize("implementation", ["auto", "csc_ldl/uplooking"])
def test_thirty_lines_agree_with_mbs_simulate(examples, prefix, implementation):
    """On a flat road the inputs are what `mbs simulate` leaves them at."""
    (examples / "level.csv").write_text("road FL,road FR,road RL,road RR\n" + "0,0,0,0\n" * 402)
    last = driven(examples, "level.csv", implementation)[-1]
    run(prefix / "bin/mbs", "simulate", "car.json", "--implementation", "csc_ldl/uplooking", "--duration", "0.5",
        "--output", "out.csv", cwd=examples)
    with open(examples / "out.csv", encoding="utf-8") as file:
        *_, expected = csv.DictReader(file)
    assert last[1] == pytest.approx(float(expected["body.z"]), abs=1e-8)


def test_errors_are_one_line(examples):
    (examples / "bad.csv").write_text("road FL,road FR\n0,0\n0,x\n")
    (examples / "unknown.csv").write_text("road XY\n0\n0\n0\n")
    for scene, inputs in (("nowhere.json", "level.csv"), ("car.json", "nowhere.csv"), ("car.json", "bad.csv"),
                          ("car.json", "unknown.csv")):
        found = subprocess.run([examples / "car", scene, inputs], cwd=examples, capture_output=True, text=True, check=False)
        assert found.returncode == 1
        assert found.stderr.startswith("car: ") and found.stderr.count("\n") == 1


@pytest.mark.parametrize("words, name", [
    (("realtime", "car.json", "x"), "SECONDS"), (("speed", "four-bar:3", "1e-3x", "5"), "STEP"),
    (("speed", "four-bar:3", "1e-3", "x"), "STEPS"), (("monte_carlo", "car.json", "-1"), "RUNS"),
    (("monte_carlo", "car.json", "1", "2.5"), "THREADS")])
def test_examples_say_which_number_is_none(examples, words, name):
    program, *rest = words
    found = subprocess.run([examples / program, *rest], cwd=examples, capture_output=True, text=True, check=False)
    assert found.returncode == 1
    assert found.stderr.startswith(f"{program}: {name}: found '") and "allowed is" in found.stderr and found.stderr.count("\n") == 1


def test_the_loop_in_real_time_counts(examples):
    text = run(examples / "realtime", "car.json", "0.2", cwd=examples)
    assert "200 steps of 1000 us" in text and "deadlines missed: " in text


def test_monte_carlo_does_not_depend_on_threads(examples):
    one, two = (run(examples / "monte_carlo", "car.json", "8", threads, cwd=examples) for threads in ("1", "2"))
    assert one.split(":")[1] == two.split(":")[1]
    assert float(re.search(r"deviation ([\d.]+)", one)[1]) > 0


def python_of(prefix):
    found = list(prefix.glob("lib/python3*/dist-packages/mbs/_mbs*.so"))
    if not found:
        pytest.skip("Python's module is not built: pybind11-dev, python3-dev")
    return {"PYTHONPATH": str(found[0].parents[1])}


def test_the_notebook_runs(prefix, tmp_path):
    text = run("/usr/bin/python3", EXAMPLES / "notebook.py", cwd=tmp_path, env=python_of(prefix))
    assert "54 variables; 7 degrees of freedom" in text and "steps_at_limit" in text


def test_steps_are_compared_with_those_of_the_program(examples, prefix):
    """Whether the bounds hold is no test's business: others may be at work on this machine."""
    found = subprocess.run([EXAMPLES / "speed.py", prefix, examples, "1"], env={"PATH": "/usr/bin:/bin"} | python_of(prefix),
                           capture_output=True, text=True, timeout=600, check=False)
    held, missed = found.stdout.count(": held"), found.stdout.count(": NOT HELD")
    assert held + missed == 3 and found.returncode == (1 if missed else 0), found.stdout + found.stderr


def test_arrays_are_views_that_outlive_their_stepper(prefix, tmp_path):
    run("/usr/bin/python3", "-c", """
import numpy, mbs
stepper = mbs.Stepper(mbs.Scene("four-bar:3"), "csc_ldl/uplooking")
q = stepper.q
before = q.copy()
assert not q.flags.owndata and not q.flags.writeable
stepper.step(10)
assert (q == before).all()          # until it is asked for again
assert stepper.q is not q and (q != before).any() and (q == stepper.q).all()
rows, at_limit = stepper.run(20, every=5)
assert rows.shape == (4, 1 + len(stepper.outputs)) and rows[0, 0] == 15 * 1.25e-3
del stepper
assert numpy.isfinite(q).all()
for wrong in (lambda: mbs.Scene("nowhere.json"), lambda: mbs.Scene("four-bar:3")["nothing"]):
    try:
        wrong()
    except mbs.Refused as error:
        assert "\\n" not in str(error)
    else:
        raise AssertionError("not refused")
""", cwd=tmp_path, env=python_of(prefix))


def test_python_refuses_bad_input_in_one_line(prefix, tmp_path):
    run("/usr/bin/python3", "-c", """
import sys
import numpy, mbs
car = mbs.Scene(sys.argv[1])
stepper = mbs.Stepper(car, "csc_ldl/uplooking", step=1e-3)
four_bar = mbs.Stepper("four-bar:3", "csc_ldl/uplooking", step=1e-3)
moment, nan, two = stepper.save(), float("nan"), [car, car]
rows = numpy.zeros((10, len(stepper.inputs)))
rows[5, stepper.inputs.index("wind")] = nan
wrong = {
    "duration: found nan": lambda: mbs.simulate(car, nan), "duration: found inf": lambda: mbs.simulate(car, float("inf")),
    "duration: found '2'": lambda: mbs.simulate(car, "2"), "duration: found -1": lambda: mbs.simulate(car, -1),
    "duration: found None": lambda: mbs.simulate_all(two, None),
    "inputs: found list": lambda: mbs.simulate(car, 1, inputs=[1.0]),
    "input 'wind': found no numbers": lambda: mbs.simulate(car, 1, inputs=dict.fromkeys(stepper.inputs, [0.0] * 800) | {"wind": ["x"]}),
    "scenes: found none": lambda: mbs.simulate_all([], 1.0), "scenes: found str": lambda: mbs.simulate_all("car.json", 1.0),
    "scenes: found Scene": lambda: mbs.BatchStepper(car),
    "threads: found 0": lambda: mbs.simulate_all(two, 1.0, threads=0), "lanes: found 0": lambda: mbs.simulate_all(two, 1.0, lanes=0),
    "scene: found set": lambda: mbs.Scene({"points": {1}}), "scene: expected str": lambda: mbs.Scene(3),
    "scene: found str, allowed is a text": lambda: mbs.Scene("\\ud800"), "name: found int": lambda: mbs.Scene({}, name=3),
    "settings: found stepp, allowed are step, ": lambda: mbs.Stepper(car, stepp=1e-3),
    "scheme: found str, allowed is an mbs.Scheme": lambda: mbs.Stepper(car, scheme="rattle"),
    "max_passes: found float": lambda: mbs.Stepper(car, max_passes=1.5), "step: found str": lambda: mbs.Stepper(car, step="1e-3"),
    "max_passes: found int, allowed is a whole number of up to 2147483647": lambda: mbs.Stepper(car, max_passes=2**40),
    "implementation: found int": lambda: mbs.Stepper(car, 1),
    "csc_ldl/uplooking: it does not offer scheme multistep6":
        lambda: mbs.Stepper("four-bar:3", "csc_ldl/uplooking", scheme=mbs.Scheme.multistep6),
    "input 'wind': found the value nan": lambda: stepper.set("wind", nan),
    "input 'front stiffness': found the value -1": lambda: stepper.set("front stiffness", -1),
    "value: found str": lambda: stepper.set("wind", "much"), "input: found int": lambda: stepper.set(0, 1.0),
    "found 0 steps": lambda: stepper.step(0), "steps: found float": lambda: stepper.step(1.5),
    "steps: found -1": lambda: stepper.run(-1), "every: found 0": lambda: stepper.run(1, every=0),
    "inputs: found list": lambda: stepper.run(1, inputs=[["x"] * 6]), "input 'wind'": lambda: stepper.run(10, inputs=rows),
    "steps: their table does not fit memory": lambda: stepper.run(2**62), "duration: found 1e+308": lambda: mbs.simulate(car, 1e308),
    "moment: found NoneType": lambda: stepper.restore(None),
    "moment: found str": lambda: stepper.restore("x"), "what was saved is of another scene": lambda: four_bar.restore(moment),
    "bodies/body/mass: found nan": lambda: car.__setitem__("bodies/body/mass", nan),
    "found lane 2": lambda: mbs.BatchStepper(two).set(2, "wind", 0.0),
    "the scene has no input 'wimd'": lambda: mbs.BatchStepper(two).set(0, "wimd", 0.0)}
for said, work in wrong.items():
    try:
        work()
    except (mbs.Refused, mbs.Unsupported) as error:
        assert str(error).startswith(said) and "\\n" not in str(error), str(error)
    else:
        raise AssertionError("not refused: " + said)
""", EXAMPLES / "car.json", cwd=tmp_path, env=python_of(prefix))


def test_python_says_what_it_has(prefix, tmp_path):
    run("/usr/bin/python3", "-c", """
import copy, pickle
import numpy, mbs
for name in mbs.__all__:
    thing = getattr(mbs, name)
    if isinstance(thing, type) and not hasattr(thing, "__members__") and not issubclass(thing, Exception):
        assert thing.__doc__, name
        public = {part: getattr(thing, part) for part in dir(thing) if not part.startswith("_")}
        assert all(part.__doc__ for part in public.values()), (name, public)
stepper = mbs.Stepper("four-bar:3", "eigen_dense/llt", step=1e-3, tangent=mbs.TangentReuse.kept, projections_every=2,
                      multipliers=mbs.MultiplierUpdate.converged, precision=mbs.Precision.mixed, geometric_stiffness=False)
assert "status='converged'" in repr(stepper.step(3))
rows, _ = stepper.run(10, every=3)
assert numpy.allclose(rows[:, 0], [6e-3, 9e-3, 12e-3])
moment = copy.deepcopy(stepper.save())
stepper.step()
stepper.restore(moment)
assert numpy.isclose(stepper.t, 13e-3)
scene = pickle.loads(pickle.dumps(mbs.Scene("four-bar:3")))
assert scene.name == "four-bar:3" and copy.copy(scene).document() == scene.document()
plain = {"points": [{"name": "O", "position": [0, 0], "fixed": True}, {"name": "A", "position": numpy.array([1.0, 0.0])}],
         "rods": [{"between": ["O", "A"], "mass": numpy.float64(2)}]}
assert mbs.simulate(plain, 0.01, step=1e-3).attrs["steps_at_limit"] == 0
assert any(one["allocates"] for one in mbs.implementations()) and not all(one["allocates"] for one in mbs.implementations())
""", cwd=tmp_path, env=python_of(prefix))


def test_without_gpl_parts_nothing_links_them(tmp_path):
    """Configured only: the sources are those of every build."""
    run("cmake", "-S", ROOT, "-B", tmp_path, "-G", "Ninja", "-DMBS_GPL=OFF", cwd=tmp_path)
    commands = (tmp_path / "build.ninja").read_text()
    assert "libklu" in commands
    assert not re.search(r"lib(umfpack|cholmod)", commands)
    registry = (tmp_path / "implementations/registry.cpp").read_text()
    assert registry.count("without GPL parts") == 2


def test_the_library_shows_its_own_names_only(prefix):
    names = run("nm", "-DC", "--defined-only", prefix / "lib/libmbs.so").splitlines()
    assert names and all(re.search(r" mbs::|guard variable|typeinfo", name) for name in names), names[:5]
