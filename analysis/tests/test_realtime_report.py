# Verdicts, tables, figures and sentences of real time on synthetic records.
from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import matplotlib.pyplot as plt
import pytest

from analysis.core.records import Record
from analysis.core.registry import Registry
from analysis.realtime import figures, page, tables
from analysis.realtime.tables import judge, needs_null
from analysis.tests.tables_of import tables_of

REGISTRY = Registry({"implementations": [
    {"folder": "lib", "available": True, "library": "Some", "variants": [{"name": f"lib/{name}"} for name in "abc"]},
    {"folder": "own", "available": True, "library": "none", "variants": [{"name": "own/a"}]}]})
VIEW = SimpleNamespace(registry=REGISTRY, context={"cpu_model": "A machine"}, settings={
    "duration": 5.0, "pilot": 1.3, "steps": [1e-3]})


def run(loops, missed, number=1, who="lib/a", status="ok", role="search", ended="done", step="0.001"):
    times = {"mean": 20.0, "median": 10.0, "p99": 50.0, "p999": 80.0, "max": 90.0, "deadline_misses": missed}
    cell = {"scene": f"four-bar:{loops}", "contenders": [who], "role": role, "number": number,
            "settings": ["--scheme", "penalty", "--step", step, "--duration", "1.3", "--deadline-us", "1000"]}
    output = {"status": status, "status_reason": "because", "steps": 1300, "step_us": times, "judge_us": 0.1}
    return Record(f"largest/search/{who}-{loops}-{number}-{role}.json", cell, ended, "the budget" if ended != "done" else "",
                  0.1, [], {}, output if ended == "done" else {})


def null(after, lost, status="done"):
    cell = {"role": "null", "settings": ["--deadline-us", "1000", "--seconds", "1.3", "--after", after]}
    output = {"lost": lost, "readings": 10, "largest_us": 7.0} if status == "done" else {}
    return Record(f"largest/null/{after}", cell, status, "", 1.3, [], {}, output)


made = partial(tables_of, "realtime", tables.build, VIEW)


@pytest.mark.parametrize("missed, lost, kept, hopeless", [
    (0, None, True, False), (3, 3, True, False), (3, 2, False, False), (13, 0, False, False), (14, 0, False, True),
    (1, None, False, False)])
def test_a_run_may_miss_what_the_null_process_lost(missed, lost, kept, hopeless):
    record = run(8, missed)
    verdict = judge(record, None if lost is None else null(record.name, lost))
    assert (verdict.kept, verdict.hopeless) == (kept, hopeless) and bool(verdict.reason) != kept
    assert needs_null(record) == (missed > 0)


def test_a_run_that_is_not_whole_is_not_kept_and_a_broken_null_process_excuses_nothing():
    lost = run(8, 0, status="diverged")
    assert judge(lost, None).hopeless and judge(lost, None).reason == "diverged: because" and not needs_null(lost)
    assert not judge(run(8, 0, ended="timeout"), None).kept
    assert not judge(run(8, 1), null("x", 5, status="crashed")).kept


def test_the_largest_is_a_size_all_of_whose_runs_were_kept():
    runs = [run(8, 0), run(16, 5), run(16, 0, number=2), run(32, 0), run(64, 400), run(45, 2)]
    found = made(*runs, null(runs[1].name, 1), null(runs[3].name, 0), null(runs[5].name, 1))
    [row] = found["largest"].to_dict("records")
    assert (row["largest"], row["next"], row["missed"], row["null_missed"]) == (32, 45, "0", "0") and row["complete"]
    assert (row["next_missed"], row["next_null_missed"]) == ("2", "1")
    assert row["next_reason"] == "2 of 1300 steps missed, 1 by the null process"
    assert row["record"] == runs[3].name
    assert figures.answer(SimpleNamespace(**row)) == "32: 0 (0); 45: 2 (1)"
    assert list(found["tried"].kept) == [True, False, True, True, False, False]
    assert found["machine"].lost.sum() == 2


def test_what_the_budget_ends_or_nothing_ends_is_said():
    dropped = run(32, 0, ended="dropped")
    [row] = made(run(8, 0), dropped)["largest"].to_dict("records")
    assert row["largest"] == 8 and not row["complete"] and row["next_reason"] == "the budget"
    assert figures.answer(SimpleNamespace(**row)) == "8: 0 (–); or more, as the budget was spent"
    [row] = made(run(8, 0))["largest"].to_dict("records")
    assert row["complete"] and row["next_reason"] == tables.END and figures.answer(SimpleNamespace(**row)) == "8: 0 (–); or more"
    [row] = made(run(8, 0, ended="dropped"))["largest"].to_dict("records")
    assert row["largest"] != row["largest"] and not row["complete"]
    [row] = made(run(1, 900, status="not-converged"))["largest"].to_dict("records")
    assert row["largest"] == 0 and row["next_reason"] == "not-converged: because"
    assert figures.answer(SimpleNamespace(**row)) == "0; 1: not-converged"


def test_two_runs_of_a_size_are_not_added_up():
    runs = [run(8, 0), run(16, 5), run(16, 0, number=2)]
    [row] = made(*runs, null(runs[1].name, 1))["largest"].to_dict("records")
    assert (row["next_steps"], row["next_missed"], row["next_null_missed"]) == ("1300 and 1300", "5 and 0", "1 and –")
    assert row["next_reason"] == "5 of 1300 steps missed, 1 by the null process"


def test_figures_page_and_answers():
    found = made(run(10, 2, role="steps"), run(10, 0, role="steps", who="own/a"), run(40, 0, role="steps", ended="timeout"),
                 null("distributions", 1), run(8, 0), run(16, 90), run(64, 0, who="own/a"))
    drawn = figures.draw(found, VIEW)
    assert set(drawn) == {"steps", "largest"} and "Largest N" in drawn["largest"]._suptitle.get_text()
    for figure in drawn.values():
        plt.close(figure)
    known = page.context(found, VIEW)
    assert known["machine"] == [(1e-3, 1, 1.3, 1, 7.0)] and known["judging"] == []
    texts = [one["text"] for one in page.answers(found, VIEW)]
    assert texts[0] == ("Steps of 1 ms: Of the libraries lib/a keeps up with N = 8, n = 18 (0 of 1300 steps missed, – lost by the null process), "
                        "and not with N = 16 (90 of 1300 steps missed, 0 by the null process). "
                        "Of our own code own/a keeps up with N = 64, n = 130 (0 of 1300 steps missed, – lost by the null process).")
    [case] = page.cases(found, VIEW)
    assert case["take"].endswith("itself loses: of the libraries up to 18 variables (lib/a); of our own code up to 130 variables (own/a)")
    assert texts[1:] == ["1 of 2 runs of 5 s missed no deadline at all. The machine itself lost 1 of the deadlines of 1 ms in 1.3 s."]


def test_what_the_budget_dropped_is_counted_and_not_drawn():
    found = made(run(10, 2, role="steps"), run(10, 0, role="steps", who="own/a", ended="dropped"), run(8, 0), run(8, 0, who="own/a", ended="dropped"))
    for figure in figures.draw(found, VIEW).values():
        assert [label.get_text() for label in figure.axes[0].get_yticklabels()] == ["lib/a"]
        assert "not drawn: 1 that the budget dropped" in [text.get_text() for text in figure.legends[0].get_texts()]
        plt.close(figure)


def test_all_who_keep_up_with_as_many_are_named_and_who_was_not_searched_is_counted():
    found = made(run(8, 0), run(8, 0, who="lib/b"), run(8, 0, who="lib/c", ended="dropped"))
    [text] = [one["text"] for one in page.answers(found, VIEW)]
    assert "lib/a keeps up with N = 8" in text and text.endswith("; so does lib/b; 1 not searched, as the budget was spent.")
    assert page.cases(found, VIEW)[0]["take"].endswith("of the libraries up to 18 variables (lib/a, lib/b)")
    assert page.cases(made(run(8, 0, ended="dropped")), VIEW) == []


def judged(scene, variables, judge_us, who="own/a", mean=10.0, status="ok", number=1):
    output = {"status": status, "status_reason": "because", "variables": variables, "judge_us": judge_us, "step_us": {"mean": mean}}
    return Record(f"judging/judging/{who}-{scene}-{number}.json", {"scene": scene, "contenders": [who], "role": "judging", "number": number, "settings": []},
                  "done", "", 0.1, [], {}, output)


def test_judging_is_held_to_its_bound_beside_the_fastest():
    runs = [*(judged("small", 6, cost, number=place) for place, cost in enumerate((0.9, 0.3, 0.1))), judged("small", 6, 0.1, "lib/a", 90.0),
            judged("large", 22, 0.3), judged("lost", 30, 0.1, status="diverged")]
    found = made(*runs)
    small, large, lost = found["judging"].to_dict("records")
    assert (small["implementation"], small["share"], small["bound"], small["held"]) == ("own/a", pytest.approx(0.03), 0.04, True)
    assert (large["share"], large["bound"], large["held"]) == (pytest.approx(0.03), 0.02, False)
    assert lost["share"] != lost["share"] and lost["status"] == "diverged"
    [answer] = page.answers(found, VIEW)
    assert "not held on large (3 %)." in answer["text"] and answer["anchor"] == "judging"
    assert ": held; nearest to it: small, 3 %." in page.answers(made(*runs[:4]), VIEW)[0]["text"]


@pytest.mark.parametrize("slower", [1.0, 1.2])
def test_runs_that_are_there_once_more_are_controls(slower):
    runs = [judged("small", 6, 0.1, mean=mean, number=place) for place, mean in enumerate((9.0, 10.0, 11.0))]
    again = [replace(one, name=f"again-{one.name}", cell=one.cell | {"role": "control"}, output=one.output | {
        "step_us": {"mean": slower * one.output["step_us"]["mean"]}}) for one in runs]
    found = made(*runs, *again)
    [row] = found["controls"].to_dict("records")
    assert (row["scene"], row["ratio"], row["decided"]) == ("small", pytest.approx(slower), slower > 1) and len(found["judging"]) == 1


def test_without_records_all_says_so():
    found = made()
    assert page.answers(found, VIEW)[0]["text"].startswith("Not measured")
    assert all(len(figures.draw(found, VIEW)[name].axes) == 1 for name in ("steps", "largest"))
    plt.close("all")
    assert page.context(found, VIEW)["judging"] == []
