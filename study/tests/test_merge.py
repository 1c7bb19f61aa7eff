# study/merge: what holds on several machines.
import json
import shutil
from types import SimpleNamespace

import pandas
import pytest

from analysis.core.errors import StudyError
from analysis.core.files import ROOT
from analysis.core.timing import Ranking, Ratio
from study.tests.conftest import study
from study.tools.merge import agreement, machine
from study.tools.merge.agreement import Agreement, Question
from study.tools.merge.main import _said, labels, need_alike

ONE = Ratio(1.0, 1.0, 1.0)
SETS = sorted(path.parent for path in (ROOT / "results").glob("*/set.json"))


def agreed(*machines):
    return Agreement(Question("map", "four-bar:4", "penalty", "libraries", 10.0), tuple(Ranking(next(iter(one)), one) for one in machines))


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


def test_what_each_set_says_and_what_they_say_alike_is_counted():
    sure, open_, equal = {"a": ONE, "b": Ratio(1.3, 1.2, 1.4)}, {"a": ONE, "b": Ratio(1.04, 0.9, 1.2)}, {"a": ONE, "b": Ratio(1.02, 1.0, 1.04)}
    other, as_fast = {"b": ONE, "a": Ratio(1.3, 1.2, 1.4)}, {"b": ONE, "a": Ratio(1.01, 1.0, 1.03)}
    told = list(_said([agreed(sure, sure), agreed(equal, as_fast), agreed(sure, other), agreed(open_, sure)], ["first", "second"]))
    assert told == ["  first: 3 decided or with all that are as fast", "  second: 4 decided or with all that are as fast",
                    "  3 so in all, 2 of them alike (67 %)", "  four-bar:4, penalty: a | b"]


def test_a_fresh_run_is_held_to_the_decided_cells(monkeypatch):
    cells = [agreed({"a": ONE, "b": Ratio(1.3, 1.2, 1.4)}, {"a": ONE, "b": Ratio(1.3, 1.2, 1.4)})]
    for winner, inner in (("a", 1), ("b", 0)):
        monkeypatch.setattr(agreement, "questions", lambda _: {cells[0].question: Ranking(winner, {winner: ONE})})
        assert agreement.held(cells, None) == {"libraries": (1, inner)}


@pytest.mark.parametrize("key, value, words", [("commit", "other", "commit"), ("libraries", "Eigen 9", "libraries"),
                                               ("dirty", "true", "tree with changes")])
def test_other_builds_and_dirty_trees_are_refused(key, value, words):
    context = {"commit": "c", "compiler": "g", "flags": "f", "build_type": "Release", "libraries": "l", "dirty": "false", "cpu_model": "p"}
    sets = [SimpleNamespace(folder=name, facts={"context": one, "date": name}) for name, one in
            (("first", context), ("second", context | {key: value}))]
    need_alike(sets[0], sets[0])
    with pytest.raises(StudyError, match=words):
        need_alike(*sets)
    assert labels(sets) == ["p, first", "p, second"]


def test_a_claim_has_a_row_with_the_verdict_of_each_machine(monkeypatch):
    ledgers = {"first": [{"id": "T1", "claim": "c", "paper": "2×", "verdict": "confirmed"}],
               "second": [{"id": "T1", "claim": "c", "paper": "2×", "verdict": "refuted"}, {"id": "F7", "claim": "d", "paper": "", "verdict": "mixed"}]}
    monkeypatch.setattr(machine, "table", lambda folder, *_: pandas.DataFrame(ledgers[folder]))
    found = machine.claims([SimpleNamespace(folder=name) for name in ledgers])
    assert [(id, [row and row["verdict"] for row in rows]) for id, _, _, rows in found] == [("T1", ["confirmed", "refuted"]), ("F7", [None, "mixed"])]


@pytest.mark.skipif(not SETS, reason="no stored set")
def test_two_sets_become_a_page_and_a_table(tmp_path):
    for day in (1, 2):
        shutil.copytree(SETS[0], tmp_path / str(day))
        facts = json.loads((tmp_path / str(day) / "set.json").read_text())
        (tmp_path / str(day) / "set.json").write_text(json.dumps(facts | {"date": f"2026-01-0{day} 00:00"}))
    done = study("merge", tmp_path / "1", tmp_path / "2", "--fresh", tmp_path / "2", "--to", tmp_path / "merged")
    assert done.returncode == 0, done.stderr
    assert "0 differ by machine" in done.stdout and "alike (100 %)" in done.stdout and "fresh set's winner lies in" in done.stdout
    assert "2026-01-02" in (tmp_path / "merged" / "index.html").read_text()
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "mine.txt").touch()
    refused = study("merge", tmp_path / "1", tmp_path / "2", "--to", tmp_path / "full")
    assert refused.returncode == 2 and "is not empty" in refused.stderr
    assert study("merge", tmp_path / "1").returncode == 2
    facts["context"]["commit"] = "0" * 40
    (tmp_path / "2" / "set.json").write_text(json.dumps(facts))
    assert "of another build" in study("merge", tmp_path / "1", tmp_path / "2", "--to", tmp_path / "merged").stderr
    done = study("merge", tmp_path / "1", tmp_path / "2", "--other-builds", "--to", tmp_path / "merged")
    assert done.returncode == 0 and "0 differ by machine" in done.stdout
