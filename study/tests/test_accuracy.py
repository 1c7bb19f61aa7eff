# study/accuracy: what is run, left out and refused, on the fake program; a curve on the real one.
import os
import re
import shutil
import tempfile

import numpy
import pandas
import pytest

from study.accuracy_study import gate, pairs, settings, subjects, work
from study.accuracy_study.main import accuracy
from study.pipeline import runs
from study.pipeline.contenders import Contender
from study.pipeline.errors import StudyError
from study.pipeline.layout import read_json
from study.scenes import mechanics, problems
from study.tests.accuracy_fakes import BOTH, STEPS, fake  # noqa: F401 (a fixture)
from study.tests.conftest import FAKE, ROOT, study

PROGRAM = os.environ.get("MBS_PROGRAM", str(ROOT / "build" / "mbs"))
CHOICE = ("--loops", "30", "--problems", "none", "--only", *BOTH, "--parts", "work")


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Results of study/accuracy on the fake program, N = 30, three steps, which `run` copies."""
    folder = tmp_path_factory.mktemp("accuracy")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MBS_PROGRAM", str(FAKE))
        patch.setattr(tempfile, "tempdir", str(folder))
        patch.setattr(subjects, "STEPS", STEPS)
        accuracy([*CHOICE, "--results", str(folder / "results")])
    return folder / "results"


@pytest.fixture
def run(whole, fake, tmp_path):
    shutil.copytree(whole, tmp_path / "results")
    return lambda *more: accuracy([*CHOICE, "--results", str(tmp_path / "results"), *more])


def table(folder, name):
    return pandas.read_csv(folder / "results" / f"{name}.csv")


def test_every_setting_that_is_served_has_its_rows(run, tmp_path):
    rows, listed = table(tmp_path, "work"), [one.name for one in settings.read_list()]
    universal = ["default", "paper", "loose", "velocity", "unprojected"]
    assert set(rows[rows.implementation == BOTH[0]].setting) == {*universal, "single", "saddle"} <= {*listed}
    assert set(rows[rows.implementation == BOTH[1]].setting) == {*universal}
    done = rows[rows.status == "ok"]
    assert numpy.allclose(done.time, 1e-6 * done.step_us / done.step, rtol=1e-2) and rows.front.any()
    assert numpy.allclose(done.error, 1e-3 * (done.step / 1.25e-3)**2)
    lost = rows[rows.setting == "paper"]
    assert set(lost.status) == {"diverged"} and (lost.status_reason == "NaN in q").all()
    page = (tmp_path / "results" / "accuracy.html").read_text()
    assert "6 diverged" in page and "2 agree, but are less accurate" in page
    for row in rows[rows.raw_file.notna()].itertuples():
        assert row.command == runs.typed(read_json(tmp_path / "results" / row.raw_file))


def test_what_is_stored_is_never_run_again_and_can_be_drawn_again(run, tmp_path):
    results = tmp_path / "results"
    before = {path: path.stat().st_mtime_ns for path in results.rglob("raw/**/*.json")}
    content = (results / "work.csv").read_bytes()
    next(path for path in before if "work" in path.parts).unlink()
    run()
    assert sum(path.stat().st_mtime_ns != time for path, time in before.items()) == 1
    assert (results / "work.csv").read_bytes() == content
    drawn = [*results.glob("figures/*"), results / "accuracy.html"]
    before = [path.read_bytes() for path in drawn]
    shutil.rmtree(results / "raw")
    run("--stored")
    assert len(drawn) == 3 and before == [path.read_bytes() for path in drawn]
    assert not list(results.rglob("*.partial"))
    with pytest.raises(StudyError, match=r"holds results of something else \(inputs: duration \S+, now 2.0\)"):
        run("--duration", "2")


def test_references_of_problems(fake):
    listed = {one.name: one for one in problems.read_list()[1]}
    default = settings.Setting("default")
    pendulum = subjects.problem(listed["A01"], fake, default, None)
    assert 0 < pendulum.own_error < 1e-11 and set(pendulum.known) == {"B.x", "B.y", "vB.vx", "vB.vy"}
    exact = {"t": [0.025, 0.05]} | {name: values[1:3].tolist() for name, values in pendulum.known.items()}
    assert pendulum.error({"outputs": exact}) == 0
    assert pendulum.error({"outputs": exact | {"t": [0.05, 0.075]}}) > 1e-3
    crank = subjects.problem(listed["slider-crank"], fake, default, None)
    assert 1e-13 < crank.own_error < 1e-6 and mechanics.TOLERANCE == 1e-12
    assert subjects._samples(10, 4e-3) == (25, 4) and subjects._samples(10, 3.1e-3) == ()


def test_the_gate_tells_who_disagrees_from_who_is_inaccurate(fake, monkeypatch):
    monkeypatch.setenv("FAKE_BAD", "1")
    group = [Contender(name, name) for name in ("good_sparse/only", "bad/wrong")]
    rows = gate.check(fake, settings.Setting("default"), group)
    assert gate.refused(rows) == {("bad/wrong", "default"):
                                  "gate, four-bar:10: lock-step: q differs by 0.4 m"}
    loose = gate.check(fake, settings.Setting("loose", (("tolerance", "1e-6"),)), group)
    assert set(gate.refused(loose)) == {("bad/wrong", "loose")} and loose[0]["only_inaccurate"]
    assert "--tolerance 1e-6" in loose[0]["command"]


def test_pairs_alone(run, tmp_path, monkeypatch):
    monkeypatch.setattr(pairs, "ROUNDS", 2)
    run("--parts", "pairs")
    assert len(table(tmp_path, "forms")) == 1 and len(table(tmp_path, "precision")) == 1
    assert "A step of the saddle-point form takes" in (tmp_path / "results" / "accuracy.html").read_text()


def test_a_check_that_dies_is_repeated_one_by_one(fake, monkeypatch):
    def killed(path, setting, group, context, final=False):
        names = [one.variant for one in group]
        if not final:
            return None
        return {"command": ["mbs"], "rows": [{"scene": "four-bar:2", "implementation": names[0],
                "verdict": "crashed", "reason": "SIGSEGV", "checks": []}]}
    monkeypatch.setattr(gate, "_run", killed)
    rows = gate.check(fake, settings.Setting("default"), [Contender(name, name) for name in BOTH])
    assert [row["implementation"] for row in rows] == [*BOTH] and not any(row["takes_part"] for row in rows)


def test_settings_are_read_and_refused(tmp_path):
    [default, *others] = settings.read_list()
    assert default.words() == [] and {"saddle kept", "rattle6", "mixed"} <= {one.name for one in others}
    loose = next(one for one in others if one.name == "loose")
    assert loose.words((("tolerance", "1e-13"), ("penalty", "auto"))) == [
        "--tolerance", "1e-6", "--penalty", "auto"]
    assert settings.Setting("g", (("geometric-stiffness", True),)).words() == ["--geometric-stiffness"]
    for text, what in (("[{name: a, option: {}}]", "no more"), ("[{name: a}, {name: a}]", "must differ"),
                       ("[{name: a, needs: [mixed]}]", "first setting must be the default")):
        (tmp_path / "settings.yaml").write_text(f"settings: {text}")
        with pytest.raises(StudyError, match=what):
            settings.read_list(tmp_path / "settings.yaml")


@pytest.mark.parametrize("arguments, what", [
    (["--loops", "0"], "0 is not a number of loops"), (["--duration", "-1"], "-1 is not a positive number"),
    (["--parts", "all"], "invalid choice: 'all'"), (["--problems", "A99"], "unknown problem 'A99'; known: A01"),
    (["--problems", "A02"], "A02 is an N-four-bar"), (["--stored"], "holds no results"),
    (["--only", "nobody"], "unknown implementation 'nobody'")])
def test_what_is_wrong_is_said_in_a_line(tmp_path, arguments, what):
    done = study("accuracy", "--results", tmp_path, *arguments)
    assert done.returncode == 2 and what in done.stderr and "Traceback" not in done.stderr
    assert not list(tmp_path.glob("*.json")) and not list(tmp_path.glob("*.csv"))


def test_the_start_says_how_long_it_may_take(tmp_path):
    done = study("accuracy", "--dry-run", "--loops", "2", "--results", tmp_path)
    assert done.returncode == 0 and "minutes on a quiet machine" in done.stdout
    assert not list(tmp_path.iterdir())


def test_a_curve_of_the_real_program(fake, monkeypatch):
    monkeypatch.setenv("MBS_PROGRAM", PROGRAM)
    entries = settings.Entries({"csc_klu/refactor": Contender("csc_klu/refactor", "csc_klu/refactor")},
                               {"csc_klu/refactor": False},
                               {"csc_klu/refactor": settings.read_list()[:1]}, {})
    rows = work.measure(fake, subjects.chain(2, 0.2), entries, print)
    assert list(rows.status) == ["ok"] * 3 and rows.front.sum() >= 1
    ratios = rows.error.to_numpy()[:-1] / rows.error.to_numpy()[1:]
    assert ((3.5 < ratios) & (ratios < 4.5)).all()  # second order


def test_the_page_explains_every_setting():
    page = (ROOT / "analysis/accuracy/accuracy.html.j2").read_text(encoding="utf-8")
    terms = " ".join(re.findall("<dt>(.*?)</dt>", page)).replace(",", "").split()
    for setting in settings.read_list():
        assert set(setting.name.split()) <= set(terms), setting.name
