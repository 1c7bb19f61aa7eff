# Profiles: the shipped ones are valid, wrong ones are named in one line.
from types import SimpleNamespace

import pytest
import yaml

from study.pipeline import estimate, profile as profiles
from study.pipeline.contenders import Contender, contenders
from study.pipeline.errors import StudyError
from study.pipeline.progress import duration
from study.pipeline.verify import best_cost, fastest_of_families, stretch_steps


@pytest.mark.parametrize("name", profiles.names())
def test_shipped_profiles(name):
    profile = profiles.load(name)
    assert all(scenes[0].fill is None for scenes in profile.columns.values())
    assert profile.rounds * profile.repetitions >= 7 or name == "smoke"


def test_profiles_cover_what_the_study_promises():
    assert {10, 22, 50, 82, 160} <= set(profiles.load("quick").columns)
    paper = profiles.load("paper")
    assert max(paper.columns) == 4000 and len(paper.columns[1000]) > 4
    assert {100} | set(paper.operations["columns"]) <= set(paper.columns)
    assert profiles.load("map").columns == paper.columns


def test_scene_names():
    natural, filled = profiles.Scene(82, None), profiles.Scene(10, 0.3)
    assert (natural.name, natural.label) == ("four-bar:40", "natural")
    assert (filled.name, filled.label) == ("four-bar:4,fill=0.30", "fill030")


@pytest.mark.parametrize("change, message", [
    ({"rounds": 0}, "rounds must be positive"), ({"rounds": "three"}, "rounds must be of type int"),
    ({"colour": 1}, "missing or unknown settings: colour"),
    ({"step": float("nan")}, "step must be"),
    ({"limits": {}}, "limits must be exactly"), ({"blas": {}}, "blas must name a pair for all"),
    ({"refine": {"seconds": -1, "rounds": 2}}, "refine needs numbers"),
    ({"operations": {"columns": [6], "rounds": 2}}, "operations name 6, which is no column"),
    ({"alternatives": [{"implementations": ["a"], "columns": [10]}]}, "an alternative has exactly"),
    ({"alternatives": [{"implementations": ["a"], "columns": [12], "blas": ["atlas"]}]},
     "alternatives name 12, which is no column"),
    ({"columns": [{"variables": 10, "fills": ["natural"], "exclusion": 1}]}, "exclusion must be"),
    ({"columns": [{"variables": 10}]}, "a column has"),
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


def test_neither_a_rejected_implementation_nor_an_alternative_excludes_anybody():
    names = ("a/fast", "a/slow", "a/dead", "a/slow+atlas")
    contenders = {name: Contender(name, name.split("+")[0]) for name in names}
    study = SimpleNamespace(contenders=contenders, own=set())
    pilots = {"a/fast": {"step_us": 1.0}, "a/slow": {"step_us": 500.0},
              "a/dead": {"status": "crashed"}, "a/slow+atlas": {"step_us": 0.1}}
    assert best_cost(study, pilots, {}) == 1.0
    assert best_cost(study, pilots, {"a/fast": {"verdict": "disagrees"}}) == 500.0
    assert best_cost(study, {"a/dead": pilots["a/dead"]}, {}) == float("inf")


def test_code_without_a_library_excludes_nobody_who_has_one():
    contenders = {name: Contender(name, name) for name in ("own/x", "a/slow")}
    study = SimpleNamespace(contenders=contenders, own={"own/x"})
    pilots = {"own/x": {"step_us": 1.0}, "a/slow": {"step_us": 500.0}}
    assert best_cost(study, pilots, {}) == 500.0
    assert best_cost(study, {"own/x": pilots["own/x"]}, {}) == 1.0


def test_the_fastest_of_a_family_stay_in_the_map():
    pilots = {"a/x": {"step_us": 1.0}, "b/x": {"step_us": 40.0}, "b/y": {"step_us": 20.0},
              "b/z": {"step_us": 30.0}, "c/x": {"status": "crashed"}, "d/x": {"step_us": 99.0}}
    members = {"one": ["a/x", "c/x"], "two": ["b/x", "b/y", "b/z"], "three": ["d/x"]}
    assert fastest_of_families(members, pilots, {}, 50) == ["a/x", "b/y", "b/z"]
    wrong = {"b/y": {"verdict": "disagrees"}}
    assert fastest_of_families(members, pilots, wrong, 50) == ["a/x", "b/z", "b/x"]


def test_estimates():
    quick = profiles.load("quick")
    plan = estimate.work(quick, [Contender(f"a/{name}", f"a/{name}") for name in "xyz"])
    assert 30 < sum(work.left() for work in plan.values()) < 300
    for work in plan.values():
        work.done = work.cells
    assert estimate.seconds_left(plan, 10, 5) == 0
    assert [duration(s) for s in (5, 65, 3660)] == ["5 s", "1 min 5 s", "1 h 1 min"]


KNOWN = {"implementations": [{"variants": [{"name": "a/x", "operations": True}]}],
         "blas": [{"name": "openblas", "available": True, "reason": ""},
                  {"name": "reference", "available": True, "reason": ""},
                  {"name": "atlas", "available": False, "reason": "not installed"}]}


def with_alternatives(**settings):
    quick = profiles.load("quick")
    return profiles.Profile("p", quick.settings | {"blas": {"all": "openblas"}} | settings,
                            quick.columns)


def test_alternatives_stand_beside_the_ranked_ones():
    profile = with_alternatives(alternatives=[
        {"implementations": ["a"], "columns": [22], "blas": ["openblas", "reference", "atlas"]},
        {"implementations": ["a/x"], "columns": [22], "builds": ["gcc-O2", "clang-O3"]},
        {"implementations": ["b"], "columns": [22], "blas": ["reference"]}])
    found = {one.name: one for one in contenders(profile, KNOWN, ["a/x"], {"clang-O3": "no clang"})}
    assert list(found) == ["a/x", "a/x+reference", "a/x+atlas", "a/x+gcc-O2", "a/x+clang-O3"]
    assert [one.missing for one in found.values()] == ["", "", "not installed", "", "no clang"]
    assert found["a/x"].call("bench")[-2:] == ["--blas", "openblas"]
    natural, filled = profiles.Scene(22, None), profiles.Scene(22, 0.5)
    assert [name for name, one in found.items() if one.at(natural)] == [
        "a/x", "a/x+reference", "a/x+gcc-O2"]
    assert [name for name, one in found.items() if one.at(filled)] == ["a/x"]


def test_a_usual_pair_that_is_missing_is_told():
    found = contenders(with_alternatives(blas={"all": "atlas"}, alternatives=[]), KNOWN, ["a/x"],
                       {})
    assert [(one.name, one.blas, one.missing) for one in found] == [
        ("a/x", "system", ""), ("a/x+atlas", "atlas", "not installed")]


@pytest.mark.parametrize("settings, message", [
    ({"blas": {"all": "mkl"}}, "unknown BLAS pair 'mkl'; known: openblas, reference, atlas"),
    ({"alternatives": [{"implementations": ["a"], "columns": [22], "builds": ["icc-O9"]}]},
     "unknown build 'icc-O9'; known: gcc-O2"),
])
def test_unknown_pairs_and_builds(settings, message):
    with pytest.raises(StudyError, match=message):
        contenders(with_alternatives(**{"alternatives": []} | settings), KNOWN, ["a/x"], {})
