# study/accuracy: which cells are asked for, on a lab whose answers are known; the order of the real program.
import pytest

from analysis.accuracy import subjects, tables
from analysis.accuracy.points import runs as rows_of
from analysis.core.files import StudyError
from analysis.core.records import Record
from study.accuracy import plan
from study.accuracy.runs import Runs
from study.core import executor
from study.core.cell import Cell, Contender
from study.core.profile import load, names
from study.core.setting import Setting, read_settings
from study.tests.accuracy_fakes import SETTINGS, SPEED, Lab, options, view


def measured(column="four-bar-10", **more):
    lab = Lab(column, **more)
    plan.run(lab, column)
    return lab, tables.build(list(lab.records.values()), view(lab))


def winner(found, scene, layer, required):
    rows = found["winners"]
    [row] = rows[(rows.scene == scene) & (rows.layer == layer) & (rows.required == required)].to_dict("records")
    return row


@pytest.fixture(scope="module")
def whole():
    """(lab, tables) of N = 10, which no test changes."""
    return measured()


def test_the_winners_are_those_of_the_model(whole):
    _, found = whole
    for scene in ("four-bar:10", "four-bar:10,fill=1"):
        best = winner(found, scene, "libraries", 1e-3)
        # RATTLE needs the fewest steps, and of the libraries one serves it.
        assert (best["implementation"], best["setting"], best["settled"]) == ("lib_a/fast", "rattle", True)
        assert best["error"] <= 1e-3 < 4 * best["error"]
        assert best["time"] == pytest.approx(1e-6 * 2 * SPEED["lib_a/fast"] / best["step"], rel=0.01)
        # Own code is five times as fast, and does not hide the library.
        over_all = winner(found, scene, "all", 1e-3)
        assert (over_all["implementation"], over_all["second"]) == ("own/code", "lib_a/fast")
        assert over_all["decided"] and over_all["margin"] == pytest.approx(5.0, rel=0.01)


def test_what_is_far_behind_is_not_tried_in_other_settings(whole):
    lab, found = whole
    slow = [cell for cell in lab.asked if "lib_a/slow" in [one.variant for one in cell.contenders]]
    assert {(cell.kind, cell.role) for cell in slow} == {("bench", "look/default")}
    assert {options(cell)["--step"] for cell in slow} == {"0.00125"}
    rows = found["points"]
    assert set(rows[rows.implementation == "lib_a/slow"].status) == {"not-judged"}


def test_who_is_ranked_has_met_the_error_in_a_run_of_its_own():
    _, found = measured(wrong=("lib_b/even",), settings=SETTINGS | {"settings": ["default"]})
    points = found["points"]
    own = points[(points.implementation == "lib_b/even") & (points.error_of == "lib_b/even")]
    assert len(own) and (own.error > 9 * 10 * own.step**2).all()
    assert winner(found, "four-bar:10", "libraries", 1e-3)["implementation"] == "lib_a/fast"
    assert winner(found, "four-bar:10", "libraries", 1e-3)["equivalent"] == ""
    _, found = measured(settings=SETTINGS | {"settings": ["default"]})
    assert winner(found, "four-bar:10", "libraries", 1e-3)["equivalent"] == "lib_b/even"
    _, found = measured(lost={"lib_a/fast": "diverged"}, settings=SETTINGS | {"settings": ["default"]})
    best = winner(found, "four-bar:10", "libraries", 1e-3)
    assert (best["implementation"], best["step"]) == ("lib_b/even", 1.25e-3)  # the point of the first look


def test_the_first_point_is_timed_twice_in_turn_with_the_others(whole):
    lab, found = whole
    point = lambda cell: (cell.role.partition("/")[2], cell.scene, options(cell)["--step"], cell.contenders)
    timed = [cell for cell in lab.asked if cell.role.partition("/")[0] in ("time", "control")]
    again = [cell for cell in timed if cell.role.startswith("control/")]
    assert [cell.number for cell in again] == [1, 2, 3] and {*map(point, again)} == {point(timed[0])}
    assert [cell.number for cell in timed[:timed.index(again[-1])]] == sorted(cell.number for cell in timed[:timed.index(again[-1])])
    [row] = found["controls"].to_dict("records")
    assert (row["implementation"], row["ratio"], row["decided"]) == (again[0].contenders[0].name, 1.0, False)


def test_a_resumed_plan_asks_for_nothing_new(whole):
    lab, _ = whole
    again = Lab("four-bar-10")
    again.records = dict(lab.records)
    plan.run(again, "four-bar-10")
    assert not again.asked and len(again.records) == len(lab.records)


def test_a_spent_budget_leaves_rows_and_no_ranking():
    lab, found = measured(budget=20)
    assert len(lab.asked) <= 40 and len(found["left_out"]) > 10 and set(found["left_out"].status) == {"dropped"}
    assert set(found["winners"].implementation) == {"not timed"}  # by the looks, own code would not have been ahead
    lab, found = measured(budget=1)
    assert len(lab.asked) == 1 and set(found["winners"].implementation) == {"not timed"}


def test_curves_leave_half_of_the_budget_to_times():
    lab, found = measured(budget=60)
    assert any(cell.role.startswith("time/") for cell in lab.asked)
    assert "share" in " ".join(found["left_out"].reason)


def test_steps_between_are_tried_where_a_halving_just_misses(whole):
    lab, found = whole
    between = {float(options(cell)["--step"]) for cell in lab.asked if cell.kind == "simulate"} - set(subjects.STEPS)
    assert between and all(min(abs(step / other - 2 / 3) for other in subjects.STEPS) < 1e-5 for step in between)
    # 10 h^2 <= 1e-3: 10 ms, the halving itself.  2 h^2 <= 1e-3: 20 ms; between 20 and 40 it misses.
    steps = found["winners"][found["winners"].layer == "libraries"].set_index(["scene", "required"]).step
    assert steps["four-bar:10", 1e-3] == 0.02


def test_a_stretch_is_a_matter_of_the_scene():
    runs = Runs(Lab("four-bar-10"), "loops", {"loops": 10})
    assert runs.stretch("four-bar:10", 1e-2) == 500  # all of it
    assert runs.stretch("four-bar:10", 1e-4) == 2272
    large = Runs(Lab("four-bar-200"), "loops", {"loops": 200})
    assert large.stretch("four-bar:200", 1e-3) == 124 and large.stretch("four-bar:200,fill=1", 1e-3) == 10
    assert runs.duration(0.5) == 5.0 and runs.duration(3.0) == 1.0 and runs.duration(5.0) is None


def test_pairs_share_processes_with_their_kind_only():
    lab, found = measured("pairs-10")
    saddle = [cell for cell in lab.asked if cell.role == "pair/saddle" and cell.number == 1]
    assert [[one.name for one in cell.contenders] for cell in saddle] == [["lib_b/even"], ["own/code"]]
    rows = found["pairs"]
    assert set(rows.kind) == {"form", "reuse"}
    assert set(rows[rows.kind == "form"].implementation) == {"lib_b/even", "own/code"}
    form = rows[rows.kind == "form"].iloc[0]
    assert form.ratio == pytest.approx(1.0) and form.processes == 5 and form.first_class == 1e-4
    reuse = rows[rows.kind == "reuse"].iloc[0]
    assert (reuse.implementation, reuse.first_factorizations, reuse.second_factorizations) == ("lib_a/fast", 2, 1)


@pytest.mark.parametrize("columns, what", [
    ([{"loops": 2}], "needs seconds and one of"), ([{"pairs": 2, "fills": [], "seconds": 1}], "needs seconds"),
    (["loops"], "needs seconds"), ([{"problem": "A01", "seconds": 101}], "add up to 101 s, more than 100 s")])
def test_wrong_columns_are_said_in_a_line(columns, what):
    with pytest.raises(StudyError, match=what):
        plan.columns(SETTINGS | {"columns": columns})


def test_wrong_names_are_said_in_a_line():
    with pytest.raises(StudyError, match="'A99' is no standard problem"):
        subjects.problem("A99")
    with pytest.raises(StudyError, match="'A02' is no standard problem of its own scene"):
        subjects.problem("A02")  # an N-four-bar: by its loops
    with pytest.raises(StudyError, match="unknown, or without default: nothing"):
        Runs(Lab("four-bar-2", SETTINGS | {"settings": ["default", "nothing"]}), "loops", {"loops": 2})


@pytest.mark.parametrize("name", ["smoke", "quick", "full"])
def test_profiles_keep_to_their_budget(name):
    assert name in names()
    settings = load(name, ["accuracy"]).parts["accuracy"]
    assert set(plan.columns(settings)) and set(settings["settings"]) <= {one.name for one in read_settings()}


def test_settings_are_read_and_refused(tmp_path):
    [default, *others] = read_settings()
    assert default == Setting() and not default.needs and default.words() == ["--scheme", "penalty"]
    by_name = {one.name: one for one in others}
    assert by_name["saddle kept"].needs == {"saddle-point", "tangent"} and by_name["rattle6"].needs == {"rattle"}
    assert by_name["multistep6 loose"].needs == {"multistep"} and by_name["single"].needs == {"single"}
    assert by_name["paper"].needs == by_name["velocity"].needs == set()
    assert by_name["loose"].words((("tolerance", "1e-13"), ("penalty", "auto"))) == [
        "--tolerance", "1e-6", "--penalty", "auto", "--scheme", "penalty"]
    assert by_name["geometric"].words()[-1] == "--geometric-stiffness"
    loose = Setting("rattle4", (("tolerance", "loose"),))
    assert (loose.name, loose.file_name, loose.order, loose.parent) == ("rattle4, tolerance loose", "rattle4-tolerance.loose", 4, Setting("rattle4"))
    assert loose.words(tolerance=1e-8)[-1] == "1e-08" and (loose.loosened, default.loosened) == (1e3, None)
    for text, what in (("[{name: a, option: {}}]", "option is unknown"), ("[{name: a}, {name: a}]", "must differ"),
                       ("[{name: a, options: {scheme: rattle}}]", "first setting must be the default")):
        (tmp_path / "settings.yaml").write_text(f"settings: {text}")
        with pytest.raises(StudyError, match=what):
            read_settings(tmp_path / "settings.yaml")


def test_references_know_their_own_error():
    chain = subjects.reference(subjects.chain(10, 5.0))
    assert 1e-16 < chain.own_error < 1e-13
    pendulum = subjects.problem("A01")
    known = subjects.reference(pendulum)
    assert 0 < known.own_error < 1e-11 and set(known.known) == {"B.x", "B.y", "vB.vx", "vB.vy"}
    half = {column: list(values[2:4]) for column, values in known.known.items()}
    spacing = pendulum.duration / subjects.SAMPLES

    def motion(first):
        return Record("A01/x.json", {}, "done", "", 0, [], {}, {}, {"t": [first * spacing, (first + 1) * spacing]} | half)
    assert subjects.error(pendulum, known, motion(2)) == 0 and subjects.error(pendulum, known, motion(4)) > 1e-3
    andrews = subjects.problem("A03")
    with pytest.raises(StudyError, match="its runs were not made"):
        subjects.reference(andrews)
    assert andrews.base[0] == ("penalty", "1e+17")
    for entry in ("A01", "A03", "A04", "chain", "grid", "half car"):
        one = subjects.problem(entry)
        assert all(abs(one.every(step) * step * subjects.SAMPLES / one.duration - 1) < 1e-9 for step in one.steps)


def test_the_real_program_is_of_second_order():
    subject, one, found = subjects.chain(2, 0.2), Contender("csc_klu/refactor", "csc_klu/refactor"), []
    for step in (1e-2, 5e-3, 2.5e-3):
        cell = Cell("simulate", subject.scene, (one,), (*Setting().words(), *subject.words(step)), "run/default").settled()
        found.append(Record(f"four-bar-2/{cell.file_name()}", **executor.run(cell, None)))
    rows = rows_of(found, subject, subjects.reference(subject))
    assert list(rows.status) == ["ok"] * 3 and list(rows.step) == [1e-2, 5e-3, 2.5e-3]
    ratios = rows.error.to_numpy()[:-1] / rows.error.to_numpy()[1:]
    assert ((3.5 < ratios) & (ratios < 4.5)).all()
