# study/merge: what holds on several machines.
import math
import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy
import pandas
import pytest
from scipy import special

from analysis.core import records, schema
from analysis.core.files import ROOT, StudyError, read_json, write_json
from analysis.core.registry import ANCHOR
from analysis.core.text import layout
from analysis.core.timing import Ranking, Ratio
from analysis.map.ledger import beside
from study.tools import fragments
from study.tools.merge import agreement, machine, main
from study.tools.merge.agreement import Agreement, Question
from study.tools.merge.main import HERE, ORDER, labels, merge, need_alike
from study.tools.paper import numbers, tables

ONE = Ratio(1.0, 1.0, 1.0)
SETS = sorted(path.parent for path in (ROOT / "results").glob("*/set.json"))


FREEDOM = 7
QUANTILE = special.stdtrit(FREEDOM, 0.975)


def agreed(*machines, untimed=(), scene="four-bar:4"):
    """`untimed`: on the last machine."""
    rankings = [Ranking(next(iter(one)), {name: ratio._replace(freedom=FREEDOM) for name, ratio in one.items()}) for one in machines]
    return Agreement(Question("map", scene, "penalty", "libraries", 10.0), (*rankings[:-1], rankings[-1]._replace(untimed=untimed)))


def measured(random, log, error):
    """A Ratio as FREEDOM + 1 layouts give it."""
    logs = log + error * random.standard_normal(FREEDOM + 1)
    half = QUANTILE * logs.std(ddof=1) / len(logs) ** 0.5
    return Ratio(*numpy.exp(logs.mean() + numpy.array([0.0, -half, half])))


def test_who_is_best_on_one_machine_and_near_it_on_the_other_holds_on_both():
    found = agreed({"a": ONE, "b": Ratio(1.03, 1.01, 1.05), "c": Ratio(1.4, 1.3, 1.5)},
                   {"b": ONE, "a": Ratio(1.2, 1.1, 1.3), "c": Ratio(1.5, 1.4, 1.6)})
    assert found.common == ["b"] and found.verdict == "decided" and found.robust == "b"
    assert found.winners == ["a", "b"] and found.worst["a"] == 1.2 and not found.alike
    assert agreed({"a": ONE, "b": Ratio(1.02, 0.99, 1.05)}, {"b": ONE, "a": Ratio(1.01, 1.0, 1.03)}).alike


def test_contradicting_machines_leave_nobody_and_name_the_robust_one():
    found = agreed({"a": ONE, "b": Ratio(1.3, 1.2, 1.4), "c": Ratio(1.15, 1.1, 1.2)},
                   {"b": ONE, "a": Ratio(1.4, 1.3, 1.5), "c": Ratio(1.12, 1.1, 1.2)})
    assert found.common == [] and found.verdict == "differs" and found.robust == "c"


def test_what_an_interval_does_not_exclude_stays_inside():
    found = agreed({"a": ONE, "b": Ratio(1.2, 1.04, 1.4)}, {"a": ONE, "b": Ratio(1.1, 1.0, 1.2)})
    assert found.common == ["a", "b"] and found.verdict == "several"


def test_who_lacks_a_time_is_not_shown_to_be_behind():
    sure, near, far = {"a": ONE}, {"a": ONE, "b": Ratio(1.02, 0.99, 1.05)}, {"a": ONE, "b": Ratio(1.5, 1.4, 1.6)}
    assert agreed(near, sure).verdict == "decided"  # it does not serve the scene there, or was far slower
    found = agreed(near, sure, untimed=("b",))
    assert (found.verdict, found.common, found.chance("decided")) == ("open", ["a"], 1.0)
    assert agreed(far, sure, untimed=("b",)).verdict == "decided" and agreed(near, near, sure, untimed=("c",)).verdict == "decided"
    alone = agreed({"b": ONE, "a": Ratio(1.5, 1.4, 1.6)}, sure, untimed=("b",))
    assert alone.verdict == "open" and agreement.shares([alone, found]) == {"all": 2, "same": 1, "common": 0, "differ": 0}


def test_a_ranking_knows_who_lacks_a_time_and_how_many_layouts_tell_a_ratio(tmp_path, monkeypatch):
    rows = pandas.DataFrame([("a", "ok", 8, 1.0, math.nan), ("b", "ok", 3, 1.1, 1.0), ("c", "dropped"), ("d", "slower"), ("e", "ok", 2),
                             ("f", "crashed"), ("own", "dropped")], columns=["implementation", "status", "processes", "to_rival", "to_rival_low"])
    rows = rows.assign(to_rival_high=1.2 * rows.to_rival_low, scene="chain:3", scheme="penalty", variables=6.0)
    (tmp_path / "families").mkdir()
    (tmp_path / "families" / "scenes.csv").touch()
    monkeypatch.setattr(schema, "read_table", lambda *_: rows)
    [ranking] = agreement.questions(SimpleNamespace(folder=tmp_path, registry=SimpleNamespace(libraries=[*"abcdef"]))).values()
    assert ranking.untimed == ("c", "e", "f") and [*ranking.ratios] == ["a", "b"] and ranking.ratios["b"].freedom == 2
    both = agreement._of_all(ranking, pandas.DataFrame({"implementation": ["g", "g"], "status": ["dropped", "slower"]}))
    assert both.untimed == ()


def test_a_cell_is_decided_falsely_in_less_than_one_of_twenty():
    """Two are among the best on all of five machines, the second just so."""
    random = numpy.random.default_rng(5)
    cells = [agreed(*({"a": ONE, "b": measured(random, numpy.log(1.05), 0.02)} for _ in range(5))) for _ in range(1000)]
    assert sum(any(one.ratios["b"].low > 1.05 for one in cell.machines) for cell in cells) > 100
    assert 0 < sum(cell.verdict == "decided" for cell in cells) < 50


def test_who_is_far_behind_takes_nothing_from_what_is_shown_of_others():
    far, near = {f"far/{number}": Ratio(3.0, 2.9, 3.1) for number in range(12)}, Ratio(1.2, 1.12, 1.28)
    found = agreed({"a": ONE, "b": near} | far, {"b": ONE, "a": near} | far)
    assert found.verdict == "differs" and found.chance("differs") == pytest.approx(0.0042, rel=0.1)


def test_of_many_cells_those_stay_that_are_decided_by_far():
    far, near = {"a": ONE, "b": Ratio(2.0, 1.9, 2.1)}, {"a": ONE, "b": Ratio(1.11, 1.07, 1.15)}
    cells = [agreed(far, far, scene="far"), *(agreed(near, near, scene=f"near:{number}") for number in range(5)),
             agreed(far, {"b": ONE, "a": far["b"]}, scene="differs")]
    assert [one.verdict for one in cells] == ["decided"] * 6 + ["differs"]
    assert {one.scene for one in agreement.sure(cells)} == {"far", "differs"}


def test_what_days_add_is_in_a_verdict():
    found = agreed(*2 * [{"a": ONE, "b": Ratio(1.15, 1.13, 1.17)}])
    assert found.verdict == "decided" and found._replace(day=0.05**2).verdict == "several"


def test_gains_are_compared_on_the_same_scenes(monkeypatch):
    rows = pandas.DataFrame([(ANCHOR, "chain:3", 0.5), (ANCHOR, "chain:9", 0.9), (numbers.SCALAR, "chain:3", 0.6), (numbers.BLOCKS, "chain:3", 0.4),
                             (numbers.BLOCKS, "chain:8", 0.1)], columns=["implementation", "scene", "step_us"]).assign(scheme="penalty", status="ok")
    monkeypatch.setattr(machine, "table", lambda folder, *_: rows if folder.name == "second" else rows.assign(step_us=1.0))
    sets = [SimpleNamespace(folder=Path(name)) for name in ("first", "second")]
    found = machine.beside(sets)
    assert [*found] == [numbers.BLOCKS, ANCHOR, numbers.SCALAR]
    assert found[numbers.SCALAR][0] == 1 and found[numbers.SCALAR][1:] == ([1.0, pytest.approx(0.6)], [1.0, pytest.approx(0.5)])
    assert found[ANCHOR] == (2, [1.0, pytest.approx(0.45**0.5)], [1.0, pytest.approx(0.45**0.5)])
    monkeypatch.setattr(tables, "_machine", lambda one: {})
    monkeypatch.setattr(tables, "GAINED", (numbers.SCALAR, ANCHOR, numbers.BLOCKS))
    said = tables.machines(SimpleNamespace(compared=sets))
    assert [line.split("&")[-1].split()[0] for line in said.splitlines() if "a step with" in line] == ["0.6", "0.5", "0.4"]


def test_what_each_set_says_and_what_they_say_alike_is_counted():
    sure, open_, equal = {"a": ONE, "b": Ratio(1.3, 1.2, 1.4)}, {"a": ONE, "b": Ratio(1.04, 0.9, 1.2)}, {"a": ONE, "b": Ratio(1.02, 1.0, 1.04)}
    other, as_fast = {"b": ONE, "a": Ratio(1.3, 1.2, 1.4)}, {"b": ONE, "a": Ratio(1.01, 1.0, 1.03)}
    _, *told, _ = layout(HERE / "said.txt.j2").render(
        labels=["first", "second"], counts={"all": dict.fromkeys(ORDER, (0, 0))}, layers=agreement.LAYERS, spread={}, held={}, page="",
        agreed={"all": [agreed(sure, sure), agreed(equal, as_fast), agreed(sure, other), agreed(open_, sure)]}).splitlines()
    assert told == ["  first: 3 decided or with all that are as fast", "  second: 4 decided or with all that are as fast",
                    "  3 so in all, 2 of them alike (67 %)", "  four-bar:4, penalty: a | b"]


def test_a_fresh_run_is_held_to_the_decided_cells(monkeypatch):
    cells = [agreed({"a": ONE, "b": Ratio(1.3, 1.2, 1.4)}, {"a": ONE, "b": Ratio(1.3, 1.2, 1.4)})]
    behind, near = Ratio(1.2, 1.1, 1.3), Ratio(1.2, 1.0, 1.4)
    for ratios, *told in (({"a": ONE}, 1, 0), ({"b": ONE}, 0, 0), ({"b": ONE, "a": near}, 0, 0), ({"b": ONE, "a": behind}, 0, 1)):
        monkeypatch.setattr(agreement, "questions", lambda _: {cells[0].question: Ranking(next(iter(ratios)), ratios)})
        assert agreement.held(cells, None) == {"libraries": (1, *told)}


def test_a_kept_fresh_run_says_whether_it_is_held():
    run = {"processor": "P", "commit": "c" * 40, "date": "2026-01-02T03:04", "profile": "quick", "records": ["0"]}
    record = {"sets": ["one", "two"], "run": run, "held": {"libraries": [20, 19, 0], "all": [20, 18, 1]}}
    text = fragments._made("fresh", [record], agreement.LAYERS)
    assert text == "- P, 2026-01-02, commit cccccccccc, profile quick, held to one and two: libraries, 19 of 20 (95 %, asked 95 %: held), " \
                   "contradicted in 0; all, own code included, 18 of 20 (90 %, asked 95 %: not held), contradicted in 1.\n"
    assert fragments._made("fresh", [], agreement.LAYERS) == "No run is stored.\n"


@pytest.mark.parametrize("record", [read_json(path) for path in sorted(fragments.FRESH.glob("*.json"))])
def test_a_kept_fresh_run_was_held_to_the_stored_pair(record):
    kept = [read_json(ROOT / "results" / name / "set.json")["context"] for name in record["sets"]]
    assert {one["commit"] for one in kept} == {record["run"]["commit"]} and fragments.main_set().name in record["sets"]


def test_who_is_robust_is_among_those_that_hold_on_all():
    found = agreed({"a": ONE, "b": Ratio(1.06, 1.055, 1.07)}, {"b": ONE, "a": Ratio(1.2, 1.0, 1.4)})
    assert found.common == ["a"] and found.worst["b"] < found.worst["a"] and found.robust == "a"


def test_what_days_and_machines_add_to_a_ratio_is_told():
    random = numpy.random.default_rng(3)
    cells = [agreed(*({"a": ONE, "b": Ratio(*numpy.exp([log, log - 0.001, log + 0.001]))} for shift in 0.1 * random.standard_normal(3)
                      for log in 1.0 + shift + 0.03 * random.standard_normal(2))) for _ in range(300)]
    found = agreement.components(cells, ["m1", "m1", "m2", "m2", "m3", "m3"])
    assert found["day"] == (pytest.approx(3, rel=0.1), 300) and found["processor"] == (pytest.approx(10, rel=0.1), 300)
    alone = agreement.components(cells[:1], ["m1", "m2", "m3", "m4", "m5", "m6"])
    assert [*alone] == ["processor"] and agreement.components([agreed({"a": ONE}, {"a": ONE})], ["m1", "m2"]) == {}


def test_where_neither_days_nor_machines_add_anything_next_to_nothing_is_told():
    random, error = numpy.random.default_rng(4), 0.03
    half = QUANTILE * error
    cells = [agreed(*({"a": ONE, "b": Ratio(*numpy.exp([log, log - half, log + half]))}
                      for log in 1.0 + error * random.standard_normal(4))) for _ in range(300)]
    found = agreement.components(cells, ["m1", "m1", "m2", "m2"])
    assert all(percent < 1 and count == 300 for percent, count in found.values()), found


@pytest.mark.parametrize("key, value, words", [("blas_loaded", "/usr/lib/x86_64-linux-gnu/atlas/libblas.so", "blas_loaded"),
                                               ("commit", "other", "commit"), ("libraries", "Eigen 9", "libraries"), ("dirty", "true", "tree with changes")])
def test_other_builds_and_dirty_trees_are_refused(tmp_path, key, value, words):
    context = {"commit": "c", "compiler": "g", "flags": "f", "build_type": "Release", "libraries": "l", "dirty": "false", "cpu_model": "p",
               "machine": "m", "kernel": "k", "num_cpus": 1,
               "blas": "openblas", "blas_loaded": "/usr/lib/aarch64-linux-gnu/libblas.so"}
    arm, intel = context, context | {"blas_loaded": "/usr/lib/x86_64-linux-gnu/libblas.so"}
    first, alike, *others = [SimpleNamespace(folder=tmp_path / name, facts={"context": one, "date": "today", "parts": []}) for name, one in
                             (("first", arm), ("alike", intel), ("second", arm | {key: value}), ("third", arm))]
    write_json(tmp_path / "first" / "contexts" / "own-atlas.json", context)
    write_json(tmp_path / "third" / "contexts" / "own-atlas.json", context | {key: value})
    need_alike(first, alike)
    for other in others:
        with pytest.raises(StudyError, match=words):
            need_alike(first, other)
    assert labels([first, alike]) == [f"p, today, {tmp_path}/first", f"p, today, {tmp_path}/alike"]


def test_a_set_whose_controls_failed_is_refused(tmp_path, monkeypatch):
    sets = [SimpleNamespace(folder=tmp_path / name, facts={"context": {"dirty": "false"}, "parts": []} | more) for name, more in
            (("sound", {}), ("alone", {"no_evidence": "its A/A control failed"}))]
    for builds in (True, False):
        need_alike(sets[0], sets[0], builds)
        with pytest.raises(StudyError, match="alone is no evidence: its A/A control failed"):
            need_alike(*sets, builds)
    twins = pandas.DataFrame({"ratio": 1.1, "decided": [True] * 6 + [False] * 20})
    monkeypatch.setattr(machine, "table", lambda folder, part, name: twins if part == "families" else twins[:0])
    with pytest.raises(StudyError, match="6 of 26 A/A controls were decided, more than chance allows"):
        need_alike(sets[0], sets[0])
    sound = pandas.DataFrame({"ratio": 1.0, "decided": [False] * 100})  # which hide in all what fails alone
    for failed in ("map", "engines"):
        monkeypatch.setattr(machine, "table", lambda folder, part, name: twins if part == failed else sound)
        assert machine.controls(sets[0])["sound"]
        with pytest.raises(StudyError, match=f"6 of 26 A/A controls were decided, more than chance allows .{failed}"):
            need_alike(sets[0], sets[0])


def test_a_set_without_controls_is_refused(tmp_path):
    none = SimpleNamespace(folder=tmp_path, facts={"context": {"dirty": "false"}, "parts": ["limit", "map"]})
    with pytest.raises(StudyError, match="is no evidence: it has no A/A controls"):
        need_alike(none, none)


def fake(name, commit, cpu, **context):
    known = {"commit": commit, "cpu_model": cpu, "compiler": "g", "flags": "f", "build_type": "Release", "libraries": "l", "dirty": "false"}
    return SimpleNamespace(folder=Path(name), facts={"context": known | context, "parts": []})


@pytest.mark.parametrize("others, chosen", [
    ([], []), ([("b", "new", "y")], ["a", "b"]), ([("b", "old", "y")], []), ([("b", "new", "x")], []),
    ([("b", "old", "x"), ("c", "old", "y")], []), ([("b", "old", "x"), ("c", "new", "y")], ["a", "c"]),
    ([("b", "old", "x"), ("c", "old", "y"), ("d", "new", "y")], ["a", "d"]),
    ([("b", "new", "y"), ("c", "new", "y"), ("d", "new", "z")], ["a", "b", "d"])])  # one of each processor
def test_processors_are_compared_by_sets_of_one_build(others, chosen):
    assert [one.folder.name for one in agreement.compared(fake("a", "new", "x"), [fake(*one) for one in others])] == chosen


def test_a_set_of_a_tree_with_changes_is_not_compared():
    assert agreement.compared(fake("a", "new", "x", dirty="true"), [fake("b", "new", "y")]) == []
    assert agreement.compared(fake("a", "new", "x"), [fake("b", "new", "y", dirty="true")]) == []


def test_a_claim_has_a_row_with_the_verdict_of_each_machine():
    ledgers = ([{"id": "T1", "claim": "c", "paper": "2×", "verdict": "confirmed"}],
               [{"id": "T1", "claim": "c", "paper": "2×", "verdict": "refuted"}, {"id": "F7", "claim": "d", "paper": "", "verdict": "mixed"}])
    found = beside(map(pandas.DataFrame, ledgers))
    assert [(id, [row and row["verdict"] for row in rows]) for id, _, _, rows in found] == [("T1", ["confirmed", "refuted"]), ("F7", [None, "mixed"])]


def day(number, folder):
    """A copy of a stored set, as if of another day: its tables are those of a record a part that took another time."""
    shutil.copytree(SETS[0], folder, ignore=shutil.ignore_patterns("raw"))
    for part in machine.PARTS:
        records.write(folder / "raw" / part / "c" / "x.json", {"cell": {"part": part, "role": ""}, "status": "done", "reason": "", "seconds": number,
                                                               "command": [], "context": {}})
        edit(folder / part / schema.DIGESTS, records=schema.digest_of(records.read_part(folder, part)))
    edit(folder / "set.json", date=f"2026-01-0{number} 00:00")


def edit(path, **values):
    write_json(path, read_json(path) | values)


@pytest.fixture
def days(tmp_path, monkeypatch):
    """Arguments of study/merge: two sets, and where to. Pages of parts that are quickly drawn."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(main, "parts", lambda: dict.fromkeys(("families", "scenes"), "Question?"))
    day(1, tmp_path / "1")
    day(2, tmp_path / "2")
    return ["1", "2", "--to", "merged"]


@pytest.mark.skipif(not SETS, reason="no stored set")
def test_two_sets_become_a_page_and_a_table(days, tmp_path, capsys):
    day(3, tmp_path / "3")
    merge([*days, "--fresh", "3"])
    said = capsys.readouterr().out
    assert "0 differ by machine" in said and "alike (100 %)" in said and "fresh set's winner lies in" in said
    kept = read_json(tmp_path / "merged" / "fresh.json")
    assert kept["sets"] == ["1", "2"] and kept["run"]["date"].startswith("2026-01-03") and kept["run"]["records"]
    cells, inside, against = kept["held"]["libraries"]
    assert 0 < cells == inside and against == 0  # the third day's times are those of the others
    page = (tmp_path / "merged" / "index.html").read_text()
    assert "2026-01-02" in page and "What sets of one kind of machine" in page and "days on one machine" not in said + page
    assert "with csc_ldl/uplooking, " in page and " (1)" in page
    assert "2026-01-02" in (tmp_path / "merged" / "families" / "2" / "map.svg").read_text()
    for part in ("families", "scenes"):
        assert all(f"2026-01-0{number}" in (tmp_path / "merged" / f"{part}.html").read_text() for number in (1, 2)) and f'href="{part}.html"' in page
    edit(tmp_path / "2" / "set.json", context=read_json(tmp_path / "2" / "set.json")["context"] | {"commit": "0" * 40})
    with pytest.raises(StudyError, match="of another build"):
        merge(days)
    merge([*days, "--other-builds"])
    assert "0 differ by machine" in capsys.readouterr().out


@pytest.mark.skipif(not SETS, reason="no stored set")
def test_what_is_not_merged_is_said(days, tmp_path):
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "mine.txt").touch()
    shutil.copytree(tmp_path / "2", tmp_path / "copy")
    edit(tmp_path / "copy" / "set.json", date="2026-01-09 00:00")
    for words, said in ((["1", "2", "--to", "full"], "is not empty"), (["1"], "needs two sets or more"),
                        (["1", "1"], "1 holds records of .*1: it is that set"), (["1", "2", "copy"], "copy holds records of .*2: .* or a copy"),
                        ([*days, "--fresh", "copy"], "copy holds records of .*2: .* or a copy")):
        with pytest.raises(StudyError, match=said):
            merge(words)
    edit(tmp_path / "2" / "map" / schema.DIGESTS, records="0" * 64)
    with pytest.raises(StudyError, match="2/map: its tables are not those of its records"):
        merge(days)
    assert not (tmp_path / "merged").exists()
