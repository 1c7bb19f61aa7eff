# Tables, maps and page of the part stability on a record of every outcome.
from types import SimpleNamespace

import matplotlib.pyplot as plt
import pytest

from analysis.core.records import Record
from analysis.core.schema import conform, of_part
from analysis.stability import figures, page, tables

STATUSES = ("diverged", "ok", "ok", "degraded", "wrong-branch", "not-converged", "timeout", "crashed")
VIEW = SimpleNamespace(settings={"duration": 2.0})


def record(role, status, step=1e-3, scheme="penalty", precision="double", penalty="auto", loops=2, error=1e-3, **more):
    words = ["--scheme", scheme, "--precision", precision, "--penalty", penalty, "--step", f"{step:g}"]
    cell = {"kind": "simulate", "scene": f"four-bar:{loops}", "contenders": ["one/a"], "settings": words, "role": role}
    name = f"maps/{role}/{'-'.join(words)}-{loops}.json"
    if status in ("timeout", "crashed", "dropped"):
        return Record(name, cell, status, "because", 1.0, [], {})
    output = {"status": status, "status_reason": "" if status == "ok" else "because", "penalty": 1e7, "passes_per_step": 2.0,
              "position_error_max": error if status in ("ok", "degraded") else None, "steps_at_limit": 0} | more
    return Record(name, cell, "done", "", 1.0, [], {}, output | ({} if penalty == "auto" else {"penalty": float(penalty)}))


def window(step):
    cell = {"scene": "four-bar:2", "settings": ["--step", f"{step:g}", "--precision", "double"], "role": "window"}
    return Record(f"maps/window/{step}.json", cell, "done", "", 0.1, [], {}, {"penalty_window": {
        "step": step, "lower": 1e6, "lower_from": "passes", "upper": 1e9, "upper_from": "rounding"}})


def maps(statuses=STATUSES, automatic="diverged", **more):
    return [record("map", status, step, penalty=f"{4 * 10.0**power / step**2:.8g}", **more)
            for step in (1e-3, 2e-3) for power, status in enumerate(statuses)] + [
        record("map", automatic, **more), window(1e-3), window(2e-3)]


def made(records):
    found, schema = tables.build(records, VIEW), of_part("stability")
    assert set(found) == set(schema)
    return {name: conform(found[name], columns, name) for name, columns in schema.items()}


def test_a_row_says_what_was_asked_and_how_it_ended():
    rows = made(maps())["maps"]
    assert len(rows) == 17 and set(rows.status) == set(STATUSES) and (rows.record != "").all()
    assert sorted(set(rows[rows.penalty_asked != "auto"].alpha_dt2_4)) == [10.0**power for power in range(8)]
    assert (rows[rows.status == "timeout"].reason == "because").all()


def test_a_window_that_could_not_be_estimated_is_a_row_and_a_gap_of_its_lines():
    lost = Record("maps/window/lost.json", window(4e-3).cell, "crashed", "SIGSEGV", 0.1, [], {})
    found = made([*maps(), lost])
    assert list(found["windows"].status) == ["ok", "ok", "crashed"] and found["windows"].reason.iloc[2] == "SIGSEGV"
    assert found["windows"].lower.isna().tolist() == [False, False, True] and found["windows"].step.iloc[2] == 4e-3
    for figure in figures.draw(found, VIEW).values():
        plt.close(figure)


def test_the_map_names_every_outcome_that_occurs():
    figure = figures.draw(made(maps()), VIEW)["penalty-double"]
    named = {text.get_text() for text in figure.legends[0].get_texts()}
    assert {figures.category(status) for status in STATUSES} - {"ok"} <= named
    assert {"estimated lower end", "estimated upper end", "automatic α", "the setting of 2008"} <= named
    plt.close(figure)


def test_what_was_dropped_is_on_no_map_and_counted_on_the_page():
    found = made([*maps(), record("map", "dropped", penalty="1e3")])
    assert page.context(found, VIEW)["dropped"] == 1 and page.context(found, VIEW)["total"] == 17
    plt.close(figures.draw(found, VIEW)["penalty-double"])
    assert figures.draw(made([record("map", "dropped"), window(1e-3)]), VIEW) == {}


def test_valleys_are_the_ends_of_what_is_ok():
    rows = made(maps())["maps"]
    assert page.valleys(rows) == {2: {1e-3: (10, 100, 2, 2), 2e-3: (10, 100, 2, 2)}}
    rows = made(maps(("ok", "diverged", "ok")))["maps"]
    assert page.valleys(rows)[2][2e-3] == (1, 100, 2, 3)
    assert page.valleys(made(maps(("timeout",)))["maps"]) == {2: {1e-3: None, 2e-3: None}}


@pytest.mark.parametrize("error", [0.02, float("nan")])
def test_what_is_ok_but_wrong_is_accused(error):
    assert page.context(made(maps()), VIEW)["inaccurate"] == []
    [accused] = page.context(made([*maps(), record("map", "ok", penalty="5", error=error)]), VIEW)["inaccurate"]
    assert accused["penalty_asked"] == "5"


def test_where_the_automatic_factor_misses_a_valley_is_told_from_where_there_is_none():
    [missed], none = page.automatic(made(maps())["maps"])
    assert missed["valley"] == (10, 100, 2, 2) and none == []
    missed, [alone] = page.automatic(made(maps(("diverged", "degraded")))["maps"])
    assert missed == [] and alone["valley"] is None
    assert page.automatic(made(maps(automatic="ok"))["maps"]) == ([], [])


ROW = {"scheme": "saddle-point", "loops": 2000, "status": "ok", "position_error_max": 1e-3,
       "passes_per_step": 2.0, "steps_at_limit": 0}


@pytest.mark.parametrize("change, verdict", [
    ({}, "yes"), ({"loops": 3000}, ""), ({"scheme": "rattle"}, ""), ({"status": "degraded"}, "no"),
    ({"position_error_max": 3e-3}, "no"), ({"position_error_max": None, "status": "timeout"}, "no"),
    ({"passes_per_step": 2.3}, "no"), ({"steps_at_limit": 1}, "no"), ({"status": "dropped"}, ""),
    ({"scheme": "penalty"}, "yes"), ({"scheme": "penalty", "steps_at_limit": 1}, "no")])
def test_what_whole_runs_must_hold(change, verdict):
    assert tables.holds(ROW | change) == verdict


def test_answers_count_what_is_ok_and_what_holds():
    found = made([*maps(automatic="ok"), record("whole", "ok"), record("whole", "degraded", loops=10)])
    texts = [one["text"] for one in page.answers(found, VIEW)]
    assert texts == ["Penalty form: the automatic factor is ok in 1 of 1 cells of size and step, with steps up to 1 ms, over 2 s.",
                     "Whole runs with everything automatic: 1 of 2 keep what their form must hold, up to N = 2."]
    assert "Not measured" in page.answers(made([]), VIEW)[0]["text"]
