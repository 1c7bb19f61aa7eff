# Points, winners, pairs, figures and page of accuracy on records of a model, and on small tables of every outcome.
import re
from pathlib import Path

import jinja2
import matplotlib.pyplot as plt
import numpy
import pandas
import pytest

from analysis.accuracy import figures, page, pairs, points, tables, winners
from analysis.core import schema
from analysis.core.records import Record
from analysis.core.style import Look
from analysis.core.text import between, ends, number
from study.accuracy import plan
from study.core.setting import read_settings
from study.tests.accuracy_fakes import SETTINGS, Lab, view

HERE = Path(tables.__file__).parent


@pytest.fixture(scope="module")
def found():
    """(tables as their schema has them, view): a size with a fill, two sizes of pairs."""
    settings = SETTINGS | {"columns": [{"loops": 10, "fills": [1.0], "seconds": 60}, {"pairs": 10, "seconds": 20},
                                       {"pairs": 40, "seconds": 20}], "processes": [2, 3]}
    records = []
    for column in ("four-bar-10", "pairs-10", "pairs-40"):
        lab = Lab(column, settings, lost={"lib_b/even": "diverged"} if column == "pairs-40" else ())
        plan.run(lab, column)
        records += lab.records.values()
    made = tables.build(records, view(lab))
    columns = schema.of_part("accuracy")
    assert set(made) == set(columns)
    return {name: schema.conform(frame, columns[name], name) for name, frame in made.items()}, view(lab)


def run(implementation="a/x", setting="default", step=1e-3, error=1e-3, passes=2.0, status="ok", duration=5.0):
    return {"scene": "s", "implementation": implementation, "setting": setting, "step": step, "duration": duration,
            "status": status, "reason": "", "seconds": 0.1, "record": f"run-{implementation}", "variables": 6.0, "fill": 0.5,
            "passes": passes, "factorizations": passes, "steps": 1000, "time": 1.0, "error": error}


def process(implementation="a/x", microseconds=10.0, number=1, role="time", setting="default", step=1e-3, status="ok", **more):
    return {"scene": "s", "implementation": implementation, "setting": setting, "step": step, "role": role, "process": number,
            "environment": "e", "status": status, "reason": "" if status == "ok" else "because", "passes": 200.0, "steps": 100.0,
            "step_us": microseconds, "samples": (microseconds,) * 3, "variables": 6.0, "record": f"{role}-{number}"} | more


def of(runs, processes):
    """(points, measured)"""
    columns = ["scene", "implementation", "setting", "step", "role", "process", "status"]
    measured = pandas.DataFrame(processes, columns=None if processes else columns)
    return points.points(pandas.DataFrame(runs), measured), measured


def rounds(implementation, levels, **more):
    return [process(implementation, level, place + 1, **more) for place, level in enumerate(levels)]


def winner(runs, processes, required=1e-2, libraries=("a/x", "b/y", "c/z")):
    table, measured = of(runs, processes)
    rows = winners.winners(table, measured, [required], libraries).set_index("layer")
    return rows.loc["libraries"], rows.loc["all"]


def test_a_stretch_counts_with_the_passes_of_the_whole_run():
    table, _ = of([run(passes=3.0)], [process(microseconds=10.0)])
    [row] = table.to_dict("records")
    assert row["time"] == pytest.approx(10e-6 / 1e-3 * 3.0 / 2.0) and row["time_from"] == "rounds"
    table, _ = of([run()], [process(number=1, microseconds=10.0), process(number=2, microseconds=30.0)])
    row = table.iloc[0]
    assert (row.time, row.time_low, row.time_high, row.processes) == pytest.approx((0.02, 0.01, 0.03, 2))


def test_an_error_is_that_of_an_own_run_or_says_whose_it_is():
    table, _ = of([run(), run("b/y", step=2e-3)], [process(), process("c/z", role="look"), process("c/z", 1.0, step=9.0)])
    rows = table.set_index(["implementation", "step"])
    assert rows.loc[("a/x", 1e-3)].error_of == "a/x" and rows.loc[("b/y", 2e-3)].time_from == "run"
    borrowed = rows.loc[("c/z", 1e-3)]
    assert (borrowed.status, borrowed.error, borrowed.error_of) == ("not-judged", 1e-3, "a/x")
    assert rows.loc[("c/z", 9.0)].reason == "nobody's run tells its error"
    assert list(winners.meeting(table, 1e-2).implementation) == ["a/x"]


def test_the_longest_run_judges_and_a_lost_process_is_a_row():
    table, _ = of([run(duration=5.0, status="diverged", error=numpy.nan), run(duration=1.0)], [process()])
    assert table.status.iloc[0] == "diverged"
    table, _ = of([run()], [process(number=1), process(number=2, status="crashed")])
    assert table.status.iloc[0] == "crashed" and table.reason.iloc[0] == "because" and numpy.isnan(table.time.iloc[0])
    table, _ = of([run()], [process(number=1), process(number=2, status="dropped")])
    assert table.status.iloc[0] == "ok" and table.processes.iloc[0] == 1


def test_who_ended_a_look_is_lost_at_that_setting_and_the_others_are_not():
    def look(names, number, status="done", more=""):
        timed = {"steps": 10, "passes": 20, "cpu_us": [100.0], "stretch_us": [100.0]}
        cell = {"scene": "s", "contenders": names, "environment": "own", "role": f"look/default{more}", "number": number,
                "settings": ["--step", "1e-3"]}
        return Record(f"look{more}/{len(names)}-{number}", cell, status, "", 1.0, [], {},
                      {"rows": {f"{name}/s": timed for name in names}} if status == "done" else {})
    lost = [look(["a/x", "b/y"], 1, "crashed"), look(["b/y"], 0, "crashed", "-left-out"), look(["a/x"], 0, more="-alone")]
    for records in ([look(["a/x"], 1), *lost], [*lost, look(["a/x"], 1)]):
        rows = points.timed(records)
        assert set(rows.setting) == {"default"}
        assert list(rows.sort_values("implementation").status) == ["ok", "crashed"]


def test_a_winner_is_decided_as_fast_or_open():
    both = [run(), run("b/y")]
    clear, _ = winner(both, rounds("a/x", (10, 10.1, 9.9)) + rounds("b/y", (15, 15.1, 14.9)))
    assert (clear.implementation, clear.second, clear.decided, clear.settled) == ("a/x", "b/y", True, True)
    assert clear.margin == pytest.approx(1.5, rel=0.01)
    same, _ = winner(both, rounds("a/x", (10, 10, 10)) + rounds("b/y", (10.2, 10.1, 10.3)))
    assert same.settled and same.equivalent == "b/y"
    loose, _ = winner(both, rounds("a/x", (10, 12, 9)) + rounds("b/y", (11, 10, 12)))
    assert not loose.decided and not loose.settled
    one, _ = winner(both, rounds("a/x", (10,)) + rounds("b/y", (15,)))
    assert not one.decided and not one.settled  # of one process there is no interval


def test_other_settings_are_compared_round_by_round():
    runs = [run(), run("b/y", "rattle", 2e-3)]
    drift = (1.0, 2.0, 1.5)  # of the machine, from round to round
    rows = rounds("a/x", [10 * one for one in drift])
    rows += rounds("b/y", [15 * one for one in drift], setting="rattle", step=2e-3)
    best, _ = winner(runs, rows)
    assert (best.implementation, best.setting, best.step) == ("b/y", "rattle", 2e-3)
    assert best.margin == pytest.approx(10 / 7.5) and best.decided


def test_who_was_slower_in_a_look_has_lost_and_who_was_not_reached_leaves_it_open():
    runs = [run(), run("b/y"), run("c/z", error=0.5)]
    ahead = rounds("a/x", (10, 10, 10))
    best, _ = winner(runs, ahead + [process("b/y", 20.0, role="look"), process("c/z", 1.0, role="look")])
    assert best.implementation == "a/x" and best.decided and best.candidates == 2 and best.timed == 1
    best, _ = winner(runs, ahead + [process("b/y", 11.0, role="look")])
    assert not best.decided and not best.settled
    best, _ = winner(runs, [process("b/y", 11.0, role="look")])
    assert best.implementation == "b/y" and not best.settled
    nobody, _ = winner(runs, ahead, required=1e-6)
    assert nobody.implementation == "nobody" and nobody.candidates == 0
    unknown, _ = winner(runs, [])
    assert unknown.implementation == "not timed"


@pytest.mark.parametrize("coarse, error, required, settled", [(1e-3, 1e-3, 1e-4, False), (1e-3, 1e-3, 1e-2, True), (1e-5, 1e-3, 1e-4, True)])
def test_a_curve_that_the_budget_cut_above_the_error_leaves_it_open(coarse, error, required, settled):
    """At `error`; with a time at its last value that the fastest takes at a step of `coarse`."""
    runs = [run(error=1e-5, step=coarse), run("b/y", step=2e-4, error=error) | {"time": 0.05},
            run("b/y", step=1e-4, error=numpy.nan, status="dropped") | {"time": numpy.nan}]
    runs = runs if coarse > 1e-4 else [runs[0], runs[1] | {"time": 2.0}, runs[2]]
    best, _ = winner(runs, rounds("a/x", (100, 100, 100) if coarse > 1e-4 else (10, 10, 10), step=coarse), required)
    assert best.implementation == "a/x" and (best.decided, best.settled) == (settled, settled)


def test_libraries_are_ranked_as_if_own_code_were_not_there():
    libraries, everyone = winner([run(), run("own/code")], rounds("a/x", (10, 10, 10)) + rounds("own/code", (2, 2, 2)))
    assert (libraries.implementation, everyone.implementation, everyone.second) == ("a/x", "own/code", "a/x")


def test_pairs_compare_settings_round_by_round_in_the_same_class():
    def table(levels, errors=(1e-4, 1e-4), status="ok"):
        rows = rounds("a/x", [10 * one for one in (1.0, 2.0, 1.5)], role="pair", step=pairs.STEP)
        rows += rounds("a/x", levels, role="pair", step=pairs.STEP, setting="mixed")
        made = pandas.DataFrame([run(step=pairs.STEP, error=errors[0]), run(setting="mixed", step=pairs.STEP, error=errors[1], status=status)])
        return pairs.table("s", made, pandas.DataFrame(rows))
    [row] = table((5, 10, 7.5)).to_dict("records")
    assert row["ratio"] == pytest.approx(0.5) and row["low"] == pytest.approx(row["high"]) and row["processes"] == 3
    assert len(pairs.gains(table((5, 10, 7.5)))) == 1
    assert pairs.gains(table((5, 10, 7.5), errors=(1e-4, 2e-4))).empty    # another class
    assert pairs.gains(table((9, 17, 13.5))).empty                        # less than is asked
    lost = table((5, 10, 7.5), errors=(1e-4, numpy.nan), status="diverged")
    assert lost.reason.iloc[0].startswith("mixed: diverged") and pairs.gains(lost).empty


def test_mixed_precision_says_whether_it_gains(found):
    def row(name, ratio, classes=(1e-3, 1e-3), second="mixed"):
        return {"kind": pairs.PRECISION, "first": "default", "second": second, "implementation": name, "ratio": ratio,
                "low": 0.95 * ratio, "high": 1.05 * ratio, "variables": 22, "first_class": classes[0], "second_class": classes[1],
                "first_status": "ok", "second_status": "ok" if classes[1] else "dropped"}
    table = pandas.DataFrame([row("one/a", 0.5), row("two/a", 0.5, (1e-3, 1e-2)), row("three/a", 0.82), row("one/a", 0.5, (None, None), "single")])
    mixed, single = page.of_precision(table)
    assert "of 3 pairs with double 2 are in the same error class, 1 in another; of 0 it is not known" in mixed
    assert "At least 1.2 times faster in 1 of 2 of the same class" in mixed and "one/a, mixed, n = 22" in mixed
    assert single.startswith("Single precision: of 1 pairs with double 0 are in the same error class, 0 in another; of 1 it is not known. None of")
    [nowhere] = page.of_precision(table.iloc[1:3])
    assert "At least 1.2 times faster in 0 of 1" in nowhere and "three/a" in nowhere
    [alone] = page.of_precision(table.iloc[[2, 0]].assign(low=0.0, high=numpy.inf))  # the faster one is not the first
    assert "All were timed in one process only, so nothing is shown; the best speed-up is about 2 (not bounded) of one/a" in alone


def test_the_fronts_are_those_of_their_layer(found):
    rows = found[0]["points"]
    front = rows[rows.front_libraries]
    assert set(front.implementation) == {"lib_a/fast"} and set(rows[rows.front_all].implementation) == {"own/code"}
    for scene, mine in front.groupby("scene"):
        assert mine.sort_values("time").error.is_monotonic_decreasing


def test_the_figures_show_what_won_and_name_few(found):
    made, seen = found
    drawn = figures.draw(made, seen)
    assert set(drawn) == {"work-four-bar-10", "regions"}
    libraries, _, below, everyone = drawn["work-four-bar-10"].axes
    named = [text.get_text() for text in below.get_legend().get_texts()]
    assert named[-3:] == ["front", "others", figures.RINGED] and len(named) <= figures.MOST + 3
    rings = [line for line in libraries.get_lines() if line.get_markeredgewidth() == figures.RING["markeredgewidth"]]
    won = made["winners"][(made["winners"].layer == "libraries") & made["winners"].fill_asked.isna()]
    assert sorted(rings[0].get_ydata()) == sorted(won.error)
    assert all(name.startswith("lib_") for name in named[:-3]) and named[0] == "lib_a/fast, rattle"
    assert everyone.get_legend().get_texts()[0].get_text().startswith("own/code")
    panels = drawn["regions"].axes
    assert [axes.get_title(loc="left") for axes in panels] == [
        f"N-four-bar, fastest of {who}" for who in ("libraries", "libraries and code without one")]
    assert [tick.get_text() for tick in panels[0].get_xticklabels()] == ["n = 22\nown fill", "n = 22\nfill 100%"]
    assert [text.get_text() for text in panels[0].texts].count("rattle\n20 ms") == 2
    for figure in drawn.values():
        assert figure.get_figheight() < 10
        plt.close(figure)


def test_a_subject_that_nobody_finishes_and_cells_of_nobody_can_be_drawn():
    lab = Lab("four-bar-10", lost={name: "diverged" for name in ("lib_a/fast", "lib_b/even", "lib_a/slow", "own/code", "lib_dense/llt")})
    plan.run(lab, "four-bar-10")
    made = tables.build(list(lab.records.values()), view(lab))
    columns = schema.of_part("accuracy")
    made = {name: schema.conform(made[name], known, name) for name, known in columns.items()}
    for figure in figures.draw(made, view(lab)).values():
        plt.close(figure)
    assert page.answers(made, view(lab)) == [{"text": "Not measured: nobody reached a required error with a time.", "anchor": ""}]
    [case] = page.cases(made, view(lab))
    assert case["take"] == "what `study/advise` names for your scene" and "nobody" in render(made, view(lab))


def test_nothing_measured_is_a_page_too():
    columns = schema.of_part("accuracy")
    lab = Lab("four-bar-10")
    made = {name: schema.conform(pandas.DataFrame(columns=list(columns[name])), columns[name], name) for name in columns}
    assert tables.build([], view(lab)).keys() == columns.keys()
    assert figures.draw(made, view(lab)) == {} and len(page.answers(made, view(lab))) == 1
    render(made, view(lab))


def test_the_answers_name_both_layers_and_what_reuse_saves(found):
    made, seen = found
    said = [one["text"] for one in page.answers(made, seen)]
    assert said[0].startswith("Of the libraries lib_a/fast is fastest for 2 of 2 required errors")
    assert said[1].startswith("Of all, code without a library included, own/code is fastest")
    assert any("in steps of 1.25 ms: where factorizations are known, “every-step” (--tangent every-step) saves the most of them, 50 %" in one for one in said)
    lost = made["pairs"].assign(second_factorizations=numpy.where(made["pairs"].variables > 50, numpy.nan, made["pairs"].second_factorizations),
                                ratio=numpy.where(made["pairs"].variables > 50, 0.5, 1.1))
    [text] = page.of_reuse(lost)
    assert re.search(r"n = 82 is the quickest: in the median over \d implementations its step takes 0.5 times that of default", text)
    assert "<td class=\"n\">–</td>" in render(made | {"pairs": lost}, seen)
    [case] = page.cases(made, seen)
    assert "an error of 0.001 m: lib_a/fast, `--scheme rattle`, step 20 ms; " in case["take"]
    assert {one["anchor"] for one in page.answers(made, seen)} <= set(re.findall('id="([^"]+)"', render(made, seen)))


def test_the_page_shows_what_was_left_out_and_explains_every_setting(found):
    text = render(*found)
    for part in ("lib_a/fast, rattle (22)", "closed form", "default: diverged: because", "50 %"):
        assert part in text, part
    source = (HERE / "page.html.j2").read_text(encoding="utf-8")
    rows = source[source.index("<summary>Settings"):source.index("{% if chains %}")]
    terms = " ".join(re.findall("<tr><td>(.*?)</td>", rows)).replace(",", "").split()
    for setting in read_settings():
        assert set(setting.name.split()) <= set(terms), setting.name


def test_a_reference_that_is_missing_is_said():
    settings = SETTINGS | {"columns": [{"problem": "A03", "seconds": 10}]}
    lab = Lab("A03", settings)
    record = Record("A03/reference/x.json", {"scene": "s", "contenders": ["lib_a/fast"], "settings": ["--step", "1"],
                                             "role": "reference"}, "timeout", "did not end", 1.0, [], {})
    made = tables.build([record], view(lab))
    assert made["references"].reference.iloc[0] == "none: timeout: did not end" and made["winners"].empty


def render(made, seen):
    """The page, without its frame."""
    loader = jinja2.ChoiceLoader([jinja2.DictLoader({"base.html.j2": "{% block content %}{% endblock %}"}),
                                  jinja2.FileSystemLoader([HERE, HERE.parent / "core"])])
    environment = jinja2.Environment(loader=loader, autoescape=True, undefined=jinja2.StrictUndefined)
    environment.filters |= {"number": number}
    environment.globals |= {"between": between, "ends": ends}
    drawn = figures.draw(made, seen)
    plt.close("all")
    return environment.get_template("page.html.j2").render(**page.context(made, seen), figures=dict.fromkeys(drawn, "AAAA"))


def test_every_series_of_a_figure_is_in_the_look(found):
    look = Look(found[1].registry)
    assert len({look.colour(name) for name in found[1].registry.variants}) == len(found[1].registry.variants)
