# Cells, sums and figures of the map on made-up times.
import json
import math

import matplotlib.pyplot as plt
import pandas
import pytest

from analysis.core import records, schema
from analysis.core.files import ROOT, write_json
from analysis.core.records import Record
from analysis.core.style import DENSE, SPARSE, Look
from analysis.core.timing import differing
from analysis.core.view import View
from analysis.map import figures, page, summary, tables
from analysis.map.cells import map_cells, table
from analysis.map.figures import bounds, broken, shorter
from analysis.map.timed import AFTER, Scene, timed_rows
from analysis.tests.map_tables import cell, failed, registry, results, scene, view

A, B, C, OWN = "eigen_dense/llt", "csc_klu/refactor", "csc_cholmod/simplicial", "ours/best"


def some(rows, **more):
    return results(rows, dense=[A], sparse=[B, C, OWN], own=[OWN], **more)


def bench(contenders, role="time", number=1, status="done", where="four-bar:4", passes=None, environment="own|openblas"):
    """A record of a timed process."""
    rows = {f"{name}/{where}": {"stretch_us": [100.0, 110.0], "cpu_us": [100.0, 110.0], "steps": 10, "fill_percent": 52.0, "variables": 10,
                                "constraints": 9, "start": 0.1, "passes": (passes or {}).get(name, 20)} for name in contenders}
    return Record(f"n0010/{role}/{'-'.join(contenders).replace('/', '.')}-{number}.json",
                  {"scene": where, "contenders": list(contenders), "environment": environment, "role": role, "number": number,
                   "settings": []}, status, "" if status == "done" else "it died", 1.0, [], {}, {"rows": rows} if status == "done" else {})


def test_the_smallest_group_of_a_scene_counts_and_further_processes_have_numbers_of_their_own():
    rows = timed_rows([bench([A, B, C]), bench([A, B], number=1), bench([A, B], number=2),
                       bench([C], role="time-left-out", status="disagrees"), bench([A, B], role="again"),
                       bench([A], role="pilot")])
    good = rows[rows.status == "ok"]
    assert set(good.implementation) == {A, B} and sorted(good.process.unique()) == [1, 2, AFTER + 1]
    assert list(rows[rows.implementation == C].status) == ["disagrees"]


def test_who_is_far_ahead_wins_though_only_the_others_have_further_processes():
    speed = {OWN: (1.0,) * 3, A: (10.0,) * 3, B: (11.0,) * 3}
    rows = pandas.DataFrame([
        {"implementation": name, "environment": "own", "process": number, "status": "ok", "samples": speed[name]}
        for number, names in ((1, speed), (2, speed), (AFTER + 1, (A, B)), (AFTER + 2, (A, B))) for name in names])
    found = Scene(rows).rank([OWN, A, B])
    assert found.winner == OWN and found.decided and found.equivalent == (OWN,)
    assert Scene(rows).rank([A, B]).winner == A


@pytest.mark.parametrize("passes, wrong", [
    ({A: 20, B: 20, C: 21}, {C}), ({A: 20, B: 21}, {A, B}), ({A: 20, B: 20}, set()),
    ({A: 20, f"{A}+one": 21, f"{A}+two": 21, f"{A}+three": 21}, {f"{A}+one", f"{A}+two", f"{A}+three"}),
    ({A: 20, "null/null": 1}, set())])
def test_passes_of_most_stand_and_alternatives_do_not_vote(passes, wrong):
    rows = pandas.DataFrame([{"implementation": name, "status": "ok", "passes": count} for name, count in passes.items()])
    assert set(differing(rows)) == wrong


def test_a_cell_is_decided_equal_or_open():
    rows = cell(A, 10, 2.0, 2.1, 1.9, 2.0) + cell(B, 10, 1.0, 1.01, 1.0, 0.99)
    rows += cell(A, 22, 1.0, 1.01, 1.0, 1.0) + cell(B, 22, 1.0, 1.0, 1.0, 1.01)
    rows += cell(A, 50, 1.0, 1.4, 0.9, 1.2) + cell(B, 50, 1.1, 1.1, 1.1, 1.1)
    rows += cell(A, 82, 1.0)
    found = map_cells(some(rows), [A, B])
    assert [(one.decided, one.settled) for one in found] == [(True, True), (False, True), (False, False), (True, True)]
    assert found[0].winners == (B,) and set(found[1].winners) == set(found[2].winners) == {A, B}
    assert found[3].winners == (A,) and found[3].ranking.second is None


def test_a_cell_keeps_the_interval_within_its_build_beside_that_of_a_new_one():
    rows = [row | {"layout": f"layouts/mbs-{row['process'] % 2}"} for row in cell(A, 10, 2.0, 2.2, 2.01, 2.21) + cell(B, 10, 1.0, 1.0, 1.0, 1.0)]
    found = pandas.DataFrame(table(some(rows))).iloc[0]
    assert found.low < found.within_low < found.margin < found.within_high < found.high


def test_left_alone_one_wins_over_the_excluded_but_not_over_the_failed():
    decided = {status: map_cells(some(cell(A, 10, 1.0, 1.0) + failed(B, 10, status)), [A, B])[0].decided
               for status in ("excluded", "crashed", "disagrees")}
    assert decided == {"excluded": True, "crashed": False, "disagrees": False}


def test_libraries_and_all_are_two_layers():
    rows = pandas.DataFrame(table(some(cell(A, 10, 2.0, 2.0) + cell(OWN, 10, 1.0, 1.0) + failed(B, 10, "excluded"))))
    assert dict(zip(rows.layer, rows.winner)) == {"libraries": A, "all": OWN}
    assert set(rows.excluded) == {B} and set(rows.second.fillna("")) == {"", A}


def test_edges_lie_between_fills_and_nothing_is_claimed_beyond():
    assert bounds([], 5.0) == []
    assert bounds([20.0, 40.0], 10.0) == [15.0, 30.0, 50.0]
    assert bounds([100.0], 50.0) == [75.0, 100.0]
    assert bounds([20.0, 40.0], None) == [20.0, 30.0, 50.0]


def test_dense_overtakes_where_the_ratio_passes_one():
    rows = []
    for fill, dense in ((None, 4.0), (0.25, 2.0), (0.75, 0.5)):
        rows += cell(A, 10, dense, dense, fill=fill) + cell(B, 10, 1.0, 1.0, fill=fill)
    found = some(rows)
    [row] = summary.dense_from(found)
    assert row["from"] == 75 and row["last_sparse"] == 25 and row["between"] is None


def test_a_size_at_which_nobody_was_timed_says_nothing_of_dense_and_sparse():
    assert summary.dense_from(some(failed(A, 10, "dropped", fill=0.5) + cell(A, 22, 1.0))) == []


def test_the_price_counts_pilots_and_puts_those_that_fail_last():
    rows = cell(A, 10, 1.0, 1.0, pilot_us=1.0) + cell(B, 10, 2.0, 2.0, pilot_us=2.0) + failed(C, 10, "crashed")
    rows += cell(A, 22, 1.0, 1.0, pilot_us=1.0) + failed(B, 22, "excluded", pilot=8.0) + cell(C, 22, 1.5, 1.5)
    ordered = summary.prices(some(rows), [A, B, C])
    assert [one["implementation"] for one in ordered] == [A, B, C]
    assert [(one["cells"], one["of"], one["rough"], one["failed"]) for one in ordered] == [(2, 2, 0, 0), (2, 2, 1, 0), (1, 2, 0, 1)]
    assert (ordered[1]["mean"], ordered[1]["worst"], ordered[1]["where"]) == (pytest.approx(4), pytest.approx(8), scene(22))


def test_neighbouring_sizes_with_one_outcome_are_one_line():
    rows = []
    for size, first in ((10, 2.0), (22, 3.0), (50, 0.5)):
        rows += cell(A, size, first, first, first) + cell(B, size, 1.0, 1.0, 1.0)
    groups = summary.by_size(some(rows), [A, B])
    assert list(page.by_outcome(groups)) == [
        f"{B} is the fastest library at n = 10 to 22, 2.00 to 3.00 times ahead of the second.",
        f"{A} is the fastest library at n = 50, 2.00 times ahead of the second."]


def test_sizes_that_tell_nothing_are_named():
    groups = summary.by_size(some(cell(A, 10, 2.0) + cell(B, 10, 1.0) + failed(A, 22, "dropped") + failed(B, 22, "dropped")), [A, B])
    assert list(page.by_outcome(groups)) == ["At n = 10 too few processes were timed to tell.", "At n = 22 nobody was timed."]


def test_exclusions_of_one_are_one_line_of_what_was_not_timed():
    rows = page.losses(some(cell(A, 10, 1.0) + failed(B, 10, "excluded", "7 times") + failed(B, 22, "excluded", "9 times")
                              + failed(C, 10, "crashed", "SIGSEGV")))
    assert [(row["implementation"], row["status"], len(row["scenes"])) for row in rows] == [(C, "crashed", 1), (B, "excluded", 2)]


def test_who_was_timed_in_fewer_processes_is_not_among_what_was_not_timed():
    rows = page.losses(some(cell(A, 10, 1.0) + failed(A, 10, "dropped", "the budget") + failed(B, 10, "dropped", "the budget")))
    assert [(row["implementation"], row["status"]) for row in rows] == [(A, "fewer processes"), (B, "dropped")]


@pytest.mark.parametrize("rows", [[], cell(A, 10, 1.0), failed(A, 10, "crashed"),
                                  cell(A, 10, 1.0, 1.1) + cell(B, 10, 2.0, 2.1) + cell(A, 10, 3.0, fill=0.5)
                                  + failed(C, 10, "excluded", pilot=9.0)])
def test_every_figure_can_be_drawn(rows):
    found = some(rows)
    drawn = figures.draw({"tidy": found.tidy}, found.view)
    assert set(drawn) >= {"f4_sparse_solvers", "f7_map", "map_all"}
    for figure in drawn.values():
        assert figure.get_size_inches()[1] < 16  # two screens
        plt.close(figure)


def test_no_winner_is_drawn_in_grey():
    names = [f"f{place}/x" for place in range(10)]
    look = Look(registry(sparse=names))
    assert all(max(rgb) - min(rgb) > 25 for rgb in ([int(look.colour(name)[at:at + 2], 16) for at in (1, 3, 5)] for name in names))


def test_each_folder_has_a_colour_of_its_own():
    dense = [".dense = true" in path.read_text(encoding="utf-8") for path in (ROOT / "implementations").glob("*/implementation.cpp")]
    assert sum(dense) <= len(set(DENSE)) and len(dense) - sum(dense) <= len(set(SPARSE)), "analysis/core/style.py needs another colour"


@pytest.mark.parametrize("letters, lines", [(30, ["csc_cholmod/supernodal"]), (13, ["csc_cholmod/", "supernodal"]), (9, ["csc_", "cholmod/", "supernodal"])])
def test_a_name_is_broken_where_it_has_a_joint(letters, lines):
    assert broken("csc_cholmod/supernodal", letters) == lines


@pytest.mark.parametrize("name, end", [("csc_cholmod/supernodal", "cholmod/supernodal"), ("hybrid_dense/llt", "hybrid_dense/llt"),
                                       ("csc_ldl/up", "csc_ldl/up"), ("ldl/up", "ldl/up")])
def test_a_shorter_name_is_that_of_no_other(name, end):
    assert shorter(name, ["csc_cholmod/supernodal", "csc_cholmod/simplicial", "eigen_dense/llt", "hybrid_dense/llt", "csc_ldl/up", "ldl/up"]) == end


def test_a_line_over_fill_breaks_where_a_fill_was_not_timed():
    found = some([one for fill in (None, 0.25, 0.5, 1.0) for one in
                  cell(A, 100, 2.0, 2.1, fill=fill) + (cell(B, 100, 3.0, 3.2, fill=fill) if fill != 0.25 else [])])
    for axes in figures.over_fill(found, Look(found.registry)).axes:
        assert [math.isnan(value) for line in axes.lines[:1] for value in line.get_ydata()] == [False, True, False, False]
    assert axes.lines[0].get_ydata()[2] == pytest.approx(1.51, abs=0.01)
    plt.close("all")


def test_records_become_tables_and_a_page(tmp_path):
    from analysis.core import site
    gate = Record("n0010/gate/all.json", {"scene": "four-bar:4", "contenders": [A, B, C], "environment": "own|openblas", "role": "gate",
                                          "number": 0}, "done", "", 1.0, [], {}, {"rows": [
        {"scene": "four-bar:4", "implementation": name, "verdict": verdict, "reason": reason,
         "checks": [{"name": "lock-step", "value": 0.1, "tolerance": 1.0, "passed": verdict == "agrees", "detail": ""}]}
        for name, verdict, reason in ((A, "agrees", ""), (B, "agrees", ""), (C, "disagrees", "off by 1"))]})
    found = [gate, *(bench([A, B], number=number) for number in (1, 2, 3)), *(bench([name], "pilot") for name in (A, B, C, OWN)),
             bench([OWN], "excluded", status="excluded")]
    for one in found:
        data = {key: getattr(one, key) for key in ("cell", "status", "reason", "seconds", "command", "context", "output")}
        records.write(tmp_path / "raw" / "map" / one.name, data)
    known = registry([A], [B, C, OWN], [OWN])
    write_json(tmp_path / "registry.json", known.listed)
    (tmp_path / "profile.yaml").write_text(json.dumps({"parts": {"map": {"seconds": 1, "columns": [{"variables": 10, "fills": ["natural"]}]}}}))
    context = dict.fromkeys(("machine", "commit", "compiler", "flags", "cpu_model", "kernel"), "x") | {"num_cpus": 2, "libraries": "L 1", "dirty": "false"}
    write_json(tmp_path / "set.json", {"profile": "smoke", "only": [], "parts": ["map"], "context": context, "date": "today",
                                       "programs": {}})
    site.write_part(tmp_path, "map")
    assert not (tmp_path / "index.html").exists()  # else two parts at once overwrite each other's page
    rows = schema.read_table(tmp_path, "map", "tidy")
    assert dict(rows[rows.process.isna()].groupby("implementation").status.first()) == {C: "disagrees", OWN: "excluded"}
    assert (rows[rows.status == "ok"].step_us == 10.5).all() and set(rows.fill_percent) == {52.0}
    cells = schema.read_table(tmp_path, "map", "cells")
    assert set(cells.failed) == {C} and set(cells.excluded) == {"", OWN}
    assert cells.settled.all() and set(cells.equivalent) == {f"{A} {B}"}
    page = (tmp_path / "map.html").read_text()
    assert "off by 1" in page and "several are as fast as each other" in page and "NaN" not in page and ">nan" not in page


def test_the_answer_counts_dense_solvers_with_sparse_assembly_and_names_the_least_worst_case():
    hybrid, rows = "hybrid_dense/llt", []
    for fill, times in ((None, (8.0, 3.5, 1.0)), (0.5, (8.0, 1.0, 2.0)), (1.0, (8.0, 1.0, 2.0))):
        rows += [row for name, time in zip((A, hybrid, B), times) for row in cell(name, 10, time, time, time, fill=fill)]
    found = results(rows, dense=[A, hybrid], sparse=[B])
    known = {"tidy": found.tidy, "cells": pandas.DataFrame(table(found)), "claims": pandas.DataFrame(columns=["id", "verdict"]), "controls": pandas.DataFrame()}
    said = {one["anchor"]: one["text"] for one in page.answers(known, found.view)}
    assert said["maps"] == "As the tangent fills, sparse assembly with a dense solver (hybrid_dense) leads, or is as fast, in 2 of 2 filled cells."
    assert said["regret"] == (f"The single library that costs least is {hybrid}: 1.52 times the best on average, 3.5 times at worst, over 3 cells. "
                              f"The one with the least worst case is {B}: 1.59 times the best on average, 2 times at worst.")


def test_without_times_the_answer_says_so():
    found = some([])
    empty = {"tidy": found.tidy, "claims": pandas.DataFrame({"verdict": []})}
    [answer] = page.answers(empty, found.view)
    assert "Nothing was timed" in answer["text"]


def test_a_scene_is_read_off_its_name():
    asked = tables._asked(pandas.Series(["four-bar:24,fill=0.35,seed=2", "four-bar:4"]))
    assert list(asked["variables"]) == [50, 10] and asked["fill_asked"][0] == 0.35 and math.isnan(asked["fill_asked"][1])
    assert set(tables.build([], view(registry()))) == set(schema.of_part("map"))


def test_the_ledger_has_a_column_for_each_other_processor_of_its_commit(tmp_path, monkeypatch):
    rows = {"mine": [("T1", "c"), ("T2", "d")], "other": [("T1", "c")], "old": [("T2", "d")]}
    for name, cpu, commit in (("mine", "x", "new"), ("other", "y", "new"), ("old", "z", "before")):
        context = {"cpu_model": cpu, "commit": commit, "machine": "", "kernel": "", "compiler": "", "flags": "", "dirty": False, "num_cpus": 1}
        write_json(tmp_path / name / "set.json", {"profile": "", "only": [], "parts": ["map"], "programs": {}, "context": context, "date": ""})
        write_json(tmp_path / name / "map" / schema.DIGESTS, {})
        (tmp_path / name / "raw").mkdir()
        (tmp_path / name / "raw" / "map.tar.xz").touch()
    ledger_of = lambda name: pandas.DataFrame([{"id": one, "claim": claim, "paper": "", "ours": name} for one, claim in rows[name]])
    monkeypatch.setattr(schema, "read_table", lambda folder, *_: ledger_of(folder.name))
    processors, found = page.ledgers(ledger_of("mine"), View(tmp_path / "mine", "map"))
    assert processors == ["y"] and [(id, [one and one["ours"] for one in both]) for id, _, _, both in found] == [
        ("T1", ["mine", "other"]), ("T2", ["mine", None])]
