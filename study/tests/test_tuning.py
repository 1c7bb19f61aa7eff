# Tuning: who is asked, of whom only those that the gate agrees with are timed, and what the table says of each.
from functools import partial
from types import SimpleNamespace

import pytest

from analysis.core.records import Record
from analysis.core.registry import Registry
from analysis.tests.tables_of import tables_of
from analysis.tuning import page, tables
from study.core.cell import Contender
from study.tuning import plan

REGISTRY = Registry({"implementations": [{"folder": "one", "available": True, "library": "L", "variants": [
    {"name": "one/a", "settings": ["saddle-point"]}, {"name": "one/b"},
    {"name": "one/a_metis", "tried_for": "one/a", "description": "METIS", "settings": ["saddle-point"]},
    {"name": "one/a_wrong", "tried_for": "one/a", "description": "wrong"}]}]})
SCENE = "four-bar:10"
SETTINGS = {"scenes": [SCENE], "saddle_point": [SCENE], "steps": 20, "processes": 3, "samples": 2}
VIEW = SimpleNamespace(registry=REGISTRY, settings=SETTINGS)
VERDICTS = {"one/a": "agrees", "one/a_metis": "agrees", "one/a_wrong": "disagrees"}


def gate(status="done", role="gate", **changes):
    rows = [{"scene": SCENE, "implementation": name, "verdict": verdict, "reason": "why"} for name, verdict in (VERDICTS | changes).items()]
    return Record(role, {"scene": SCENE, "contenders": list(VERDICTS), "role": role}, status, "slow", 1.0, [], {},
                  {"rows": rows} if status == "done" else {})


def bench(number, role="time", **times):
    found = {f"one/{name}/{SCENE}": {"stretch_us": [20 * time] * 2, "cpu_us": [20 * time] * 2, "steps": 20, "passes": 40, "setup_us": 1.0,
                                     "memory_bytes": 9.0, "variables": 22} for name, time in times.items()}
    cell = {"scene": SCENE, "contenders": [f"one/{name}" for name in times], "environment": "own|x", "number": number, "role": role, "settings": []}
    return Record(f"{role}/{number}", cell, "done", "", 1.0, [], {}, {"rows": found})


made = partial(tables_of, "tuning", tables.build, VIEW)


def test_what_was_tried_stands_apart_from_what_takes_part():
    assert list(REGISTRY.variants) == ["one/a", "one/b"] and list(REGISTRY.tried) == ["one/a_metis", "one/a_wrong"]


@pytest.mark.parametrize("names, expected", [(("one/a", "one/b"), list(VERDICTS)), (("one/b",), [])])
def test_only_those_that_the_gate_agrees_with_are_timed(monkeypatch, names, expected):
    cells, timed = [], []

    def run(asked, drop):
        cells.extend(asked)
        return [gate(role=cell.role) for cell in asked]
    monkeypatch.setattr(plan, "measure", lambda lab, scene, good, **more: timed.extend(one.name for one in good))
    lab = SimpleNamespace(contenders=[Contender(name, name, "x") for name in names], registry=REGISTRY, settings=SETTINGS, run=run)
    plan.run(lab, "alternatives")
    penalty, saddle = ([one.name for cell in cells if cell.role == role for one in cell.contenders] for role in ("gate", "saddle-point-gate"))
    good = [name for name in expected if VERDICTS[name] == "agrees"]
    assert (penalty, saddle) == (expected, good)  # one/a_wrong serves the penalty form alone
    assert timed == [*good, *(["one/a+twin"] if good else []), *good]


def test_ratios_and_reasons():
    rows = made(gate(), *(bench(number, a=10.0, a_metis=12.0 + 0.01 * number) for number in (1, 2, 3)))["alternatives"].set_index("alternative")
    assert rows.ratio["one/a_metis"] == pytest.approx(1.202) and rows.low["one/a_metis"] > 1 and rows.base["one/a_metis"] == "one/a"
    assert (rows.status["one/a_wrong"], rows.reason["one/a_wrong"]) == ("disagrees", "why")
    late = made(gate("dropped"))["alternatives"]
    assert set(late.status) == {"dropped"} and all(reason.endswith("slow") for reason in late.reason)


def test_forms_are_apart():
    records = [bench(number, role=role, a=10.0, a_metis=time + 0.01 * number) for role, time in (("time", 12.0), ("saddle-point-time", 8.0)) for number in (1, 2, 3)]
    found = made(gate(), gate(role="saddle-point-gate"), *records)
    ratio = found["alternatives"].set_index(["scheme", "alternative"]).ratio
    assert (ratio["penalty", "one/a_metis"], ratio["saddle-point", "one/a_metis"]) == (pytest.approx(1.202), pytest.approx(0.802))
    assert page.context(found, VIEW)["scenes"] == {"one/a": [SCENE, f"{SCENE}, saddle-point form"]}
    assert "the shortest is one/a_metis on four-bar:10, saddle-point form" in page.answers(found, VIEW)[0]["text"]


def test_controls_are_apart():
    records = [bench(number, **{"a": 10.0, "a_metis": 12.0, "a+twin": 10.0 + 0.01 * number}) for number in (1, 2, 3)]
    found = made(gate(), *records)
    assert list(found["controls"].implementation) == ["one/a"] and list(found["alternatives"].alternative) == ["one/a_metis", "one/a_wrong"]


def test_page_and_sentences():
    full = made(gate(), *(bench(number, a=10.0, a_metis=12.0 + 0.01 * number) for number in (1, 2, 3)))
    known = page.context(full, VIEW)
    assert known["scenes"] == {"one/a": [SCENE]} and len(known["groups"]["one/a"]) == 2 and len(known["lost"]) == 1
    assert "1 are shown to be longer than with the variant's own, 0 shorter" in page.answers(full, VIEW)[0]["text"]
    assert "Not measured" in page.answers(made(gate("dropped")), VIEW)[0]["text"] and page.context(made(), VIEW)["groups"] == {}
