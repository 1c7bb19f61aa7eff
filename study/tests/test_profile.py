# Profiles: the shipped ones are valid, wrong ones are named in one line.
import pytest
import yaml

from study.pipeline import estimate, profile as profiles
from study.pipeline.errors import StudyError
from study.pipeline.verify import best_cost, stretch_steps


@pytest.mark.parametrize("name", profiles.names())
def test_shipped_profiles(name):
    profile = profiles.load(name)
    assert all(scenes[0].fill is None for scenes in profile.columns.values())
    assert profile.rounds * profile.repetitions >= 9 or name == "smoke"


def test_profiles_cover_what_the_study_promises():
    assert {10, 22, 50, 82, 160} <= set(profiles.load("quick").columns)
    paper = profiles.load("paper")
    assert max(paper.columns) == 4000 and len(paper.columns[1000]) > 9


def test_scene_names():
    natural, filled = profiles.Scene(82, None), profiles.Scene(10, 0.3)
    assert (natural.name, natural.label) == ("four-bar:40", "natural")
    assert (filled.name, filled.label) == ("four-bar:4,fill=0.30", "fill030")


@pytest.mark.parametrize("change, message", [
    ({"rounds": 0}, "rounds must be positive"), ({"rounds": "three"}, "rounds must be of type int"),
    ({"colour": 1}, "missing or unknown settings: colour"),
    ({"step": float("nan")}, "step must be"),
    ({"limits": {}}, "limits must be exactly"), ({"columns": [{"variables": 10}]}, "a column has"),
    ({"columns": [{"variables": 11, "fills": ["natural"]}]}, "even number"),
    ({"columns": [{"variables": 10, "fills": [0.5]}]}, "must start with natural"),
    ({"columns": [{"variables": 10, "fills": ["natural", 30]}]}, "a fill is a share"),
])
def test_wrong_settings(tmp_path, change, message):
    data = yaml.safe_load((profiles.FOLDER / "smoke.yaml").read_text()) | change
    path = tmp_path / "wrong.yaml"
    path.write_text(yaml.safe_dump(data))
    with pytest.raises(StudyError, match=message):
        profiles.read(path, "wrong")


def test_stretch_is_the_longest_within_the_budget():
    quick = profiles.load("quick")
    budget = 1e6 * quick.stretch_budget["filled"]
    filled = profiles.Scene(10, 0.5)
    assert stretch_steps(quick, filled, budget / 800) == 800
    assert stretch_steps(quick, filled, budget / 799) == 400
    assert stretch_steps(quick, filled, budget) == 16


def test_a_rejected_implementation_excludes_nobody():
    pilots = {"fast": {"step_us": 1.0}, "slow": {"step_us": 500.0}, "dead": {"status": "crashed"}}
    assert best_cost(pilots, {}) == 1.0
    assert best_cost(pilots, {"fast": {"verdict": "disagrees"}}) == 500.0
    assert best_cost({"dead": pilots["dead"]}, {}) == float("inf")


def test_estimates():
    quick = profiles.load("quick")
    plan = estimate.work(quick, 3)
    assert 30 < sum(work.left() for work in plan.values()) < 300
    for work in plan.values():
        work.done = work.cells
    assert estimate.seconds_left(plan, 10, 5) == 0
    assert [estimate.duration(s) for s in (5, 65, 3660)] == ["5 s", "1 min 5 s", "1 h 1 min"]
