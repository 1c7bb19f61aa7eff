# The map's plan on a fake program that misbehaves on demand: who is timed, who is left out and why.
import shutil
import tempfile
from types import SimpleNamespace

import pytest
import yaml

from analysis.core import records, schema
from analysis.core.files import StudyError, misfit
from analysis.core.registry import Registry
from analysis.core.view import View
from analysis.map import tables
from study.core import profile as profiles, studyset
from study.core.cell import Contender
from study.core.lab import Lab
from study.map import plan
from study.map.timed import Pilot, Rule, Scene
from study.tests.conftest import FAKE, TEMPORARY

SETTINGS = {"seconds": 100, "processes": 3, "process": 0.1, "again": 2, "slower": {"natural": 1000, "filled": 50},
            "limits": {"pilot": 2, "check": 10, "time": 10}, "alternatives": [{"implementations": ["good_dense"],
                                                                              "blas": ["reference", "atlas"], "columns": [10]}],
            "phases": {"columns": [10], "processes": 1}, "operations": {"columns": [10], "processes": 1},
            "seeds": {"columns": [10], "seeds": 2, "processes": 2},
            "columns": [{"variables": 10, "seconds": 90, "fills": ["natural", 0.3, 1.0]}]}


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Runs the column of ten variables; its Lab."""
    monkeypatch.setenv("MBS_PROGRAM", str(FAKE))
    monkeypatch.setattr(tempfile, "tempdir", TEMPORARY.name)
    monkeypatch.setattr(profiles, "FOLDER", tmp_path / "profiles")
    monkeypatch.setattr(profiles, "parts", lambda: {"map": ""})
    (tmp_path / "profiles").mkdir()

    def column(seconds=90.0, **more):
        (tmp_path / "profiles" / "small.yaml").write_text(yaml.safe_dump(
            {"title": "t", "blas": {"all": "openblas", "good_sparse": "reference"}, "dropped": "d",
             "parts": {"map": SETTINGS | more}}))
        found = studyset.start(tmp_path / "set", profiles.load("small", ["map"]), [], ["map"])
        lab = Lab(found, "map", "n0010", seconds)
        plan.run(lab, "n0010")
        return lab
    return column


def made(lab):
    folder = lab.set.folder
    view, known = View(folder, "map"), schema.of_part("map")
    found = tables.build(records.read_part(folder, "map"), view)
    return {name: schema.conform(rows, known[name], name) for name, rows in found.items()}


def statuses(tidy, scene):
    rows = tidy[(tidy.scene == scene) & (tidy.kind == "timing")]
    return {name: set(mine.status) for name, mine in rows.groupby("implementation")}


@pytest.mark.slow
def test_bad_ones_are_left_out_with_their_reason_and_the_others_are_ranked(run, monkeypatch):
    monkeypatch.setenv("FAKE_BAD", "1")
    lab = run(limits={"pilot": 1, "check": 10, "time": 10})
    tidy = made(lab)["tidy"]
    found = statuses(tidy, "four-bar:4")
    assert {name: found[name] for name in found if name.startswith("bad/")} == {
        "bad/crash": {"crashed"}, "bad/hang": {"excluded"}, "bad/memory": {"out-of-memory"}, "bad/large": {"out-of-memory"},
        "bad/wrong": {"disagrees"}, "bad/slow": {"excluded"}, "bad/crawl": {"excluded"}, "bad/passes": {"disagrees"},
        "bad/nan": {"diverged"}}
    assert found["good_sparse/only"] == found["good_dense/first"] == {"ok"}
    assert found["good_dense/first+atlas"] == found["absent"] == {"unavailable"}
    reasons = tidy.groupby("implementation").reason.max()
    assert "passes over the stretch" in reasons["bad/passes"] and "0.4 m" in reasons["bad/wrong"]
    assert "libatlas3" in reasons["good_dense/first+atlas"] and "Foo is not installed" in reasons["absent"]


def test_pairs_have_processes_of_their_own_with_one_in_common(run):
    lab = run()
    found = made(lab)
    natural = found["tidy"][(found["tidy"].scene == "four-bar:4") & (found["tidy"].kind == "timing") & (found["tidy"].status == "ok")]
    by_pair = natural.groupby("environment").implementation.agg(set)
    assert {"good_dense/first", "good_dense/second", "null/null"} <= by_pair["own|openblas"]
    assert {"good_sparse/only", "good_dense/first+reference"} <= by_pair["own|reference"]
    rows = found["cells"].set_index(["scene", "layer"])
    assert rows.winner["four-bar:4", "libraries"] in ("good_dense/first", "good_sparse/only")
    assert found["scenes"].set_index("scene").reason["four-bar:4,fill=0.30"].startswith("the mechanism's own fill is 52")
    assert {"phases", "operations"} <= set(found["tidy"].kind)


def test_a_fill_is_put_between_where_another_leads(run):
    found = made(run())
    winners = found["cells"][found["cells"].layer == "libraries"].set_index("scene").winner
    if winners["four-bar:4"] != winners["four-bar:4,fill=1.00"]:
        assert "four-bar:4,fill=0.76" in winners.index


def test_other_seeds_are_timed_before_the_leaders_take_what_is_left(run):
    lab = run(columns=[{"variables": 10, "seconds": 90, "fills": ["natural", 0.8, 1.0]}])
    roles = [name.split("/")[1] for name in lab.names]
    assert max(place for place, role in enumerate(roles) if role == "seeds") < roles.index("again")
    rows = made(lab)["tidy"]
    rows = rows[rows.kind == "seeds"]
    assert set(rows.status) == {"ok"} and set(rows.scene) == {f"four-bar:4,fill=0.80,seed={one}" for one in (1, 2)}


@pytest.mark.slow
def test_what_has_a_record_is_not_run_again_and_gives_the_same_plan(run):
    first = run()
    files = {path: path.stat().st_mtime_ns for path in first.base.rglob("*.json")}
    second = run()
    assert sorted(first.names) == sorted(second.names)
    assert files == {path: path.stat().st_mtime_ns for path in first.base.rglob("*.json")}
    shutil.rmtree(first.base / "n0010" / "gate")
    assert sorted(run().names) == sorted(first.names)


def test_what_the_budget_does_not_allow_is_dropped_and_says_so(run):
    tidy = made(run(seconds=0.0))["tidy"]
    assert "dropped" in set(tidy.status) and (tidy[tidy.status == "dropped"].reason.str.contains("budget")).all()


@pytest.mark.parametrize("columns, words", [
    ([{"variables": 9, "seconds": 1, "fills": ["natural"]}], "even number"),
    ([{"variables": 10, "seconds": 1, "fills": [0.5]}], "start with natural"),
    ([{"variables": 10, "seconds": 101, "fills": ["natural"]}], "its columns take 101 s")])
def test_a_wrong_column_is_one_clear_line(columns, words):
    with pytest.raises(StudyError, match=words):
        plan.columns(SETTINGS | {"columns": columns})


def test_a_column_has_all_its_settings_and_no_others():
    column = {"variables": 10, "seconds": 1, "fills": ["natural"], "slower": 3}
    assert misfit([column], plan.SETTINGS["columns"]) == ""
    assert misfit([column, {"variables": 10, "fills": [], "fill": 1}], plan.SETTINGS["columns"]) == "entry 2: seconds is missing, fill is unknown"


@pytest.mark.parametrize("name", ["smoke", "quick", "full"])
def test_the_profiles_fit_their_budgets(name):
    settings = profiles.load(name, ["map"]).parts["map"]
    assert sum(plan.columns(settings).values()) <= settings["seconds"]


KNOWN = Registry({"implementations": [{"folder": name.split("/")[0], "available": True, "library": library, "variants": [
    {"name": name, "dense": dense, "unsymmetric": False}]} for name, library, dense in (
        ("own/x", "none", False), ("a/x", "L", False), ("b/x", "L", True), ("c/x", "L", True), ("d/x", "L", True))]})


def rule(fill, **pilots):
    """The rule of exclusion for contenders by folder; `pilots`: µs a step."""
    lab = SimpleNamespace(settings=SETTINGS, registry=KNOWN)
    found = {Contender(f"{name}/x", f"{name}/x"): Pilot(None, time) for name, time in pilots.items()}
    return Rule(lab, Scene(10, fill), found)


def chosen(found, verdicts=None):
    return "".join(one.name[0] for one in found.chosen({one: False for one in found.pilots if one.name[0] in (verdicts or "")}))


def test_neither_own_code_nor_who_is_rejected_excludes_anybody():
    natural = rule(None, own=1.0, a=500.0, b=2000.0)
    assert natural.best({}) == 500.0 and chosen(natural) == "oab"
    assert chosen(rule(None, a=1.0, b=2000.0)) == "a" and chosen(rule(None, a=1.0, b=2000.0), verdicts="a") == "ab"
    assert rule(None, own=1.0).best({}) == 1.0 and chosen(rule(None, a=float("inf"))) == ""


def test_the_two_fastest_of_a_family_stay_in_filled_scenes():
    assert chosen(rule(0.5, a=1.0, b=120.0, c=100.0, d=110.0)) == "acd"  # slower than 50 times, within 250
    assert chosen(rule(None, a=1.0, b=120.0, c=100.0, d=110.0)) == "abcd"
    assert chosen(rule(0.5, a=1.0, b=300.0)) == "a"
