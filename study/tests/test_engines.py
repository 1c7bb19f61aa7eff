# study/run --engines: what is run, lost, left out and compared, on fake programs; every setting on the real ones.
import json
import shutil
import subprocess
import tempfile

import numpy
import pandas
import pytest

from study.accuracy_study import subjects as ours
from study.engines import curves, programs, rounds, settings, subjects
from study.engines.main import engines
from study.pipeline.errors import StudyError
from study.pipeline.layout import Layout, ROOT, read_json
from study.tests.conftest import FAKE, study

STEPS = (1e-2, 5e-3, 2.5e-3)
LIST = """
values: {step: [1e-2, 5e-3, 2.5e-3]}
engines:
  able: [{name: usual, over: step}, {name: loses it, over: step, options: {does: lose}}]
  broken: [{name: crashes, over: step, options: {does: crash}}]
  absent: [{name: usual, over: step}]
"""
CHOICE = ("--loops", "30", "--only", "good_sparse/only")


def stand_in(folder, patch):
    """Programs `able` and `broken` in place of the engines'; `absent` is not installed."""
    (folder / "engines").mkdir()
    for engine in ("able", "broken"):
        shutil.copy(ROOT / "study/tests/fake_engine.py", folder / "engines" / f"engine_{engine}")
    (folder / "engines" / "engines.json").write_text(json.dumps(
        {"able": "", "broken": "", "absent": "libabsent-dev is not installed"}))
    (folder / "settings.yaml").write_text(LIST)
    patch.setattr(programs, "FOLDER", folder / "engines")
    listed = settings.read_list(folder / "settings.yaml")
    patch.setattr(settings, "read_list", lambda: listed)
    patch.setenv("MBS_PROGRAM", str(FAKE))
    patch.setattr(tempfile, "tempdir", str(folder))
    patch.setattr(ours, "STEPS", STEPS)
    patch.setattr(rounds, "ROUNDS", 2)
    chains = subjects.all_of
    patch.setattr(subjects, "all_of", lambda *choice: chains(*choice)[:-1])  # the fake mbs knows chains only


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A whole run on the fake programs, which tests copy."""
    folder = tmp_path_factory.mktemp("engines")
    with pytest.MonkeyPatch.context() as patch:
        stand_in(folder, patch)
        engines([*CHOICE, "--results", str(folder / "results")])
    return folder / "results"


@pytest.fixture
def fakes(tmp_path, monkeypatch):
    stand_in(tmp_path, monkeypatch)


@pytest.fixture
def run(whole, fakes, tmp_path):
    shutil.copytree(whole, tmp_path / "results")
    return lambda *more: engines([*CHOICE, "--results", str(tmp_path / "results"), *more])


def table(folder, name):
    return pandas.read_csv(folder / "results" / f"{name}.csv")


def test_every_outcome_is_a_row_and_both_sides_are_timed_in_the_same_rounds(run, tmp_path):
    rows = table(tmp_path, "engines")
    assert set(rows.subject) == {"four-bar:30", "four-bar:30 regular"}
    rows = rows[rows.subject == "four-bar:30"].set_index(["engine", "setting"]).sort_index()
    assert list(rows.loc[("able", "usual")].status) == ["ok"] * 3
    assert numpy.allclose(rows.loc[("able", "usual")].error, [1e-2, 2.5e-3, 6.25e-4])
    assert list(rows.loc[("able", "loses it")].status) == ["wrong-branch", "wrong-branch", "ok"]
    assert set(rows.loc[("broken", "crashes")].status) == {"crashed"}
    assert rows.loc["absent"].status_reason.tolist() == ["libabsent-dev is not installed"]
    rounds = table(tmp_path, "rounds")
    assert set(rounds.side) == {"engine", "ours"} and set(rounds["round"]) == {1, 2}
    orders = {tuple(one.sort_values("order").raw_file.str.replace(r"-\d+\.json", "", regex=True))
              for _, one in rounds[rounds.subject == "four-bar:30"].groupby("round")}
    assert len(orders) > 1  # shuffled anew
    page = (tmp_path / "results" / "engines.html").read_text()
    for text in ("left out, libabsent-dev is not installed", "the matrix is singular", "2 wrong-branch", "rods differ"):
        assert text in page, text
    for row in table(tmp_path, "engines").dropna(subset="raw_file").itertuples():
        record = read_json(tmp_path / "results" / row.raw_file)
        assert row.command.split()[1:] == record["command"][1:]


def test_what_is_stored_is_never_run_again(run, tmp_path):
    results = tmp_path / "results"
    before = {path: path.stat().st_mtime_ns for path in results.rglob("raw/**/*.json")}
    content = (results / "equal_error.csv").read_bytes()
    gone = [next(path for path in before if kind in path.parts) for kind in ("engines", "rounds")]
    for path in gone:
        path.unlink()
    run()
    changed = {path for path, time in before.items() if path.stat().st_mtime_ns != time}
    assert changed == set(gone) and (results / "equal_error.csv").read_bytes() == content
    with pytest.raises(StudyError, match=r"holds results of something else \(inputs: duration \S+, now 2.0\)"):
        run("--duration", "2")
    shutil.rmtree(results / "raw")
    run("--stored")


def bench(tmp_path, limit=10.0):
    return programs.Bench(Layout(tmp_path / "results"), limit)


def one_curve(tmp_path, limit=10.0, **options):
    setting = settings.Setting("able", "it", "step", STEPS, tuple(options.items()))
    return curves.measure(bench(tmp_path, limit), ours.chain(2, 1.0), {"able": [setting]}, {}, lambda text: None)


def test_a_curve_ends_where_it_would_take_too_long(fakes, tmp_path):
    rows = one_curve(tmp_path, does="slow")
    assert [row["status"] for row in rows] == ["ok", "not-run", "not-run"]
    assert rows[1]["status_reason"].startswith("predicted to take")


def test_a_program_that_hangs_is_ended(fakes, tmp_path):
    rows = one_curve(tmp_path, limit=0.3, does="hang")
    assert [row["status"] for row in rows] == ["timeout", "not-run", "not-run"]


def test_the_motion_of_the_double_pendulum():
    times = numpy.linspace(0, subjects.PENDULUM_S, 401)
    first, second = subjects.positions(times)
    assert numpy.allclose([first[:, 0], second[:, 0]], [[1, 0], [2.5, 0]])
    assert numpy.allclose(numpy.hypot(*first), 1) and numpy.allclose(numpy.hypot(*(second - first)), 1.5)
    velocities = [numpy.gradient(one, times, axis=1, edge_order=2) for one in (first, second)]
    energy = 0.0  # of thin rods: m/6 (va va + va vb + vb vb) between ends a and b, and m g y of the middle
    for mass, (a, va), (b, vb) in ((1.0, (0 * first, 0 * first), (first, velocities[0])),
                                   (1.5, (first, velocities[0]), (second, velocities[1]))):
        energy += mass / 6 * (va * va + va * vb + vb * vb).sum(0) + mass * 9.81 * (a[1] + b[1]) / 2
    assert numpy.ptp(energy[2:-2]) < 5e-3 * 20  # differences of positions give the velocities
    subject = subjects.pendulum()
    assert subject.own_error < 1e-12 and subject.every(2.5e-3) == 4 and subject.judging(1e-3) == []
    record = {"outputs": {"t": times} | {f"{point}.{axis}": places[place] for point, places in (
        ("B", first), ("C", second)) for place, axis in enumerate("xy")}}
    assert subject.error(record) == 0
    record["outputs"]["C.y"] = second[1] + 1e-3
    assert subject.error(record) == pytest.approx(1e-3)
    end, after = subjects.positions(numpy.array([subjects.PENDULUM_S, 75 * 0.0266667])).transpose(2, 0, 1)
    assert numpy.hypot(*(after - end).T).max() < 1e-4  # a rounded step ends 2.5e-6 s later
    points = numpy.moveaxis(numpy.array([first, second]), 2, 0).reshape(401, 4)
    summary = {"outputs": {"t": times.tolist(), "points": (points + [0, 0, 0, 1e-4]).tolist()}}
    assert subjects.error(subject, {"summary": summary}) == pytest.approx(1e-4)


def test_settings_are_read_and_refused(tmp_path):
    listed = settings.read_list()
    assert list(listed) == ["simbody", "mujoco", "ode", "bullet"] and all(len(one) > 5 for one in listed.values())
    assert listed["ode"][1].words(2.5e-3) == ["--setting", "erp=0.8", "step=0.0025"]
    for text, what in (("[{name: a, over: iterations}]", "must have a name and over"),
                       ("[{name: a, over: step, option: {}}]", "no more"),
                       ("[{name: a, over: step}, {name: 'a,', over: step}]", "names must differ")):
        (tmp_path / "s.yaml").write_text(f"values: {{step: [1e-2]}}\nengines: {{able: {text}}}")
        with pytest.raises(StudyError, match=what):
            settings.read_list(tmp_path / "s.yaml")
    (tmp_path / "s.yaml").write_text("values: {step: [1e-3, 1e-2]}\nengines: {}")
    with pytest.raises(StudyError, match="the coarsest must be the first"):
        settings.read_list(tmp_path / "s.yaml")


def test_programs_that_are_not_built_are_said_so(tmp_path, monkeypatch):
    monkeypatch.setattr(programs, "FOLDER", tmp_path)
    with pytest.raises(StudyError, match="study/setup --engines"):
        programs.built()
    (tmp_path / "engines.json").write_text('{"ode": ""}')
    assert programs.built()["ode"].endswith("engine_ode is not built")


@pytest.mark.parametrize("arguments, what", [
    (["--loops", "0"], "0 is not a number of loops"), (["--time-limit", "-1"], "-1 is not a positive number"),
    (["--stored"], "holds no results"), (["--only", "nobody"], "unknown implementation 'nobody'")])
def test_what_is_wrong_is_said_in_a_line(tmp_path, arguments, what):
    done = study("run", "--engines", "--results", tmp_path, *arguments)
    assert done.returncode == 2 and what in done.stderr and "Traceback" not in done.stderr


def test_an_engine_that_does_not_exist(tmp_path):
    done = study("run", "--dry-run", "--results", tmp_path, "--engines", "havok")
    assert done.returncode == 2 and "unknown engine 'havok'; known: simbody, mujoco, ode, bullet" in done.stderr


REAL = [one for found in settings.read_list().values() for one in found if programs.program(one.engine).exists()]


@pytest.mark.parametrize("setting", REAL, ids=[f"{one.engine}-{one.file_name}" for one in REAL])
def test_every_setting_means_something_to_its_program(setting):
    done = subprocess.run([programs.program(setting.engine), "--loops", "1", "--duration", "0.05",
                           *setting.words(setting.values[2]), "--json"], capture_output=True, text=True)
    summary = json.loads(done.stdout)
    assert summary["engine"] == setting.engine and summary["status"] in (
        "ok", "degraded", "diverged"), summary


@pytest.mark.parametrize("setting", {one.engine: one for one in REAL}.values(),
                         ids=list({one.engine: one for one in REAL}))
def test_programs_refuse_bad_input(setting):
    program = programs.program(setting.engine)
    for words, what in ((["--loops", "0"], "--loops"), (["--loops", "1", "--setting", "stp=1"], "stp means nothing"),
                        (["--loops", "1", "--setting", "step=fast"], "must be a number"),
                        (["--loops", "1", "--pendulum"], "excludes"), ([], "--loops or --pendulum")):
        done = subprocess.run([program, *words], capture_output=True, text=True)
        assert done.returncode == 2 and what in done.stderr and done.stderr.count("\n") == 1
