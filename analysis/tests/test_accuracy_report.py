# The Pareto front, the winners, the figures and the page of study/accuracy on small tables of every outcome.
import matplotlib.pyplot as plt
import pandas
import pytest

from analysis.accuracy import names, pairs_figure, regions_figure, report, sentences, work_figure
from analysis.accuracy.front import fastest, near, pareto
from analysis.accuracy.tangents import tangents
from analysis.accuracy.winners import winners

REGISTRY = [{"folder": name, "variants": [{"name": f"{name}/a", "dense": name == "one"}]}
            for name in ("one", "two")]
SHUFFLED = " ".join(f"{1.02 + 0.1 * place / 3:g}" for place in (3, -1, 2, -3, 0, -2, 1))
DENSE = {"one/a": True, "two/a": False}


def run(implementation, setting, step, time, error, status="ok", **more):
    done = status in ("ok", "degraded")
    return {"subject": "four-bar:2", "loops": 2, "implementation": implementation, "setting": setting,
            "step": step, "status": status, "status_reason": "" if done else "because", "rounds": 1,
            "variables": 6, "time": time if done else float("nan"), "error": error if done else float("nan"),
            "step_us": 1e6 * time * step, "at_most": False, "factorizations_per_step": 2.0,
            "passes_per_step": 2.0, "raw_file": "raw", "command": "build/mbs", "front": False} | more


def work():
    return pandas.DataFrame([
        run("one/a", "default", 1e-2, 1.0, 1e-2), run("one/a", "default", 5e-3, 2.0, 1e-3),
        run("two/a", "default", 1e-2, 1.4, 1e-2), run("two/a", "default", 5e-3, 1.5, 2e-3),
        run("two/a", "kept", 5e-3, 0.5, 5e-1, "diverged"), run("two/a", "rattle", 5e-3, 9.0, 1e-3),
        run("two/a", "saddle", 1.25e-3, 4.0, 1e-4, factorizations_per_step=2.0),
        run("two/a", "saddle kept", 1.25e-3, 3.0, 5e-4, "degraded", factorizations_per_step=0.5),
        run("two/a", "rattle4", 1e-3, 20.0, 1e-9, at_most=True),
        run("two/a", "rattle6", 1e-2, 1e-9, 1.0, "unsupported"),
        run("one/a", "mixed", 1e-2, float("nan"), float("nan"), "not-run", step_us=float("nan"))])


def cell(implementation, time, required=1e-2, spread=0.1, **more):
    return {"loops": 2, "fill_asked": None, "natural_fill": 0.8, "fill": 0.8, "required": required,
            "implementation": implementation, "setting": "default", "step": 1e-2, "error": 5e-3,
            "measured_error": required, "error_of": implementation, "status": "ok", "time": time, "time_low": time - spread,
            "time_high": time + spread, "duration": 1.0, "rounds": 7, "raw_file": "raw", "command": "c",
            "times": " ".join(f"{time + spread * place / 3:g}" for place in (-3, -2, -1, 0, 1, 2, 3)),
            "reason": None} | more


def pair(implementation, ratio, classes=(1e-3, 1e-3), **more):
    return {"loops": 10, "variables": 22, "implementation": implementation, "first": "default",
            "second": "mixed", "ratio": ratio, "low": 0.95 * ratio, "high": 1.05 * ratio, "reason": None,
            "duration": 1.0, "first_class": classes[0], "second_class": classes[1], "first_step_us": 2.0,
            "second_step_us": 2.0 / ratio, "first_passes_per_step": 2.0, "second_passes_per_step": 2.5,
            "first_error": 5e-4, "second_error": 6e-4, "first_status": "ok", "second_status": "ok"} | more


def test_the_front_is_what_nobody_beats():
    rows = work()
    assert list(rows.loc[pareto(rows)].time) == [1.0, 1.5, 2.0, 3.0, 4.0, 20.0]
    assert set(near(rows, 1.4)) == set(pareto(rows)) | {2} and set(near(rows, 1.3)) == set(pareto(rows))
    rows.loc[1, "error"] = 1.99e-3  # as good as that of the faster one
    assert 1 not in pareto(rows) and 1 in near(rows, 1.4)
    rows = work()
    assert fastest(rows, 1e-3).implementation == "one/a" and fastest(rows, 1e-10) is None


def test_a_winner_needs_to_be_clear_of_the_spread_of_other_implementations():
    def of(*cells):
        [row] = winners(pandas.DataFrame(cells)).to_dict("records")
        return row
    assert of(cell("one/a", 1.0), cell("two/a", 1.5))["decided"] is True
    near_one = of(cell("one/a", 1.0), cell("two/a", 1.02, times=SHUFFLED))
    assert near_one["decided"] is False and near_one["second"] == "two/a" and near_one["margin_low"] < 1
    paired = of(cell("one/a", 1.0), cell("two/a", 1.02))  # slower in every round: the interval says so
    assert paired["margin"] == pytest.approx(1.02)
    few = cell("three/a", 0.9, rounds=3, times="0.9 0.9 0.9")  # once slower than both that had more rounds
    assert of(few, cell("one/a", 1.0), cell("two/a", 1.5))["implementation"] == "one/a"
    same = of(cell("one/a", 1.0), cell("one/a", 1.1, setting="loose"), cell("two/a", 1.5))
    assert same["decided"] is True and same["as_fast"] == "loose" and same["margin"] == 1.5
    assert of(cell("one/a", 1.0, measured_error=2e-2), cell("two/a", 1.5))["implementation"] == "two/a"
    lost = of(cell("one/a", 1.0, status="diverged"), cell("two/a", 2.0, reason="pruned", status=None))
    assert lost["implementation"] == "nobody" and lost["candidates"] == 2


def test_cells_that_nobody_reaches_are_winners_rows_too():
    found = winners(pandas.DataFrame([cell("one/a", 1.0), cell("one/a", 1.0, fill_asked=1.0, required=1e-4)]))
    assert list(zip(found.fill_asked.fillna(-1), found.required, found.implementation)) == [
        (-1, 1e-2, "one/a"), (-1, 1e-4, "nobody"), (1.0, 1e-2, "nobody"), (1.0, 1e-4, "one/a")]


def test_the_figure_names_the_front_and_what_did_not_finish():
    figure = work_figure.draw(work(), names.look(REGISTRY), DENSE, "m", "title")
    named = [text.get_text() for text in figure.legends[0].get_texts()]
    assert any("two/a, rattle4: 1 ms" in text for text in named)
    assert any("one/a, default: 10 ms … 5 ms" in text for text in named)
    settings = [text.get_text() for text in figure.axes[1].get_legend().get_texts()]
    assert "kept: no run finished" in settings and "saddle" in settings
    assert figure.axes[1].get_title(loc="left") == "settings of two/a (sparse)"
    crosses = [line for line in figure.axes[1].get_lines() if line.get_marker() == "x" and len(line.get_xdata())]
    assert [list(line.get_xdata()) for line in crosses] == [[pytest.approx(0.5)]]
    assert "rattle6: unsupported" in settings
    plt.close(figure)


def test_a_subject_that_nobody_finishes_can_be_drawn():
    rows = pandas.DataFrame([run("one/a", "default", 1e-2, 1.0, 1.0, "diverged")])
    figure = work_figure.draw(rows, names.look(REGISTRY), DENSE, "m", "title")
    assert sentences.of_subject(rows) == ["No run finished."]
    plt.close(figure)


def test_the_region_map_shows_setting_step_and_nobody():
    found = winners(pandas.DataFrame([cell("one/a", 1.0), cell("two/a", 1.02, times=SHUFFLED),
                                      cell("one/a", 1.0, fill_asked=1.0, required=1e-4)]))
    figure = regions_figure.draw(found, names.look(REGISTRY))
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert texts.count("nobody") == 2 and texts.count("default\n10 ms") == 2
    assert [axes.get_title(loc="left") for axes in figure.axes[:2]] == ["error at most 0.01 m",
                                                                        "error at most 0.0001 m"]
    assert sum(patch.get_hatch() == "////" for patch in figure.axes[0].patches) == 1
    plt.close(figure)


def test_a_gain_needs_the_same_class_and_the_whole_interval():
    table = pandas.DataFrame([pair("one/a", 1.5), pair("two/a", 1.5, (1e-3, 1e-2)), pair("three/a", 1.22),
                              pair("four/a", 2.0, (None, None))])
    assert list(pairs_figure.gains(table).implementation) == ["one/a"]
    assert "one/a, mixed, n = 22" in sentences.of_precision(table)[0]
    nowhere = sentences.of_precision(table.iloc[1:3])
    assert nowhere[0].startswith("Mixed precision is nowhere") and "1 of 2 pairs" in nowhere[1]
    assert "three/a" in nowhere[0]  # two/a is faster, but of another class
    assert sentences.of_precision(table.iloc[[1, 3]]) == [
        "Mixed precision: none of 2 pairs with double is in the same error class."]
    single = sentences.of_precision(pandas.concat([table, table.iloc[:1].assign(second="single")]))
    assert single[0].startswith("Mixed precision is at least") and single[2].startswith("Single precision is at least")
    figure = pairs_figure.draw(table, names.look(REGISTRY + [
        {"folder": name, "variants": [{"name": f"{name}/a"}]} for name in ("three", "four")]), "t", 1.2)
    assert {text.get_text() for text in figure.axes[0].get_legend().get_texts()} == set(table.implementation)
    plt.close(figure)


def test_reuse_is_compared_with_the_form_that_it_reuses():
    [row] = tangents(work()).to_dict("records")
    assert (row["setting"], row["beside"], row["saved"], row["time_ratio"]) == ("saddle kept", "saddle", .75, .75)
    assert sentences.of_tangents(tangents(work()))[0].startswith("saddle kept saves the most factorizations, 75 %")


def test_the_page_says_what_was_refused_and_what_the_reference_is_worth():
    gate = [{"setting": "single", "scene": "four-bar:2", "implementation": "one/a", "verdict": "disagrees",
             "reason": "free-running", "takes_part": False, "only_inaccurate": False}]
    references = [{"subject": "four-bar:2", "title": "N = 2", "reference": "closed form", "own_error": 3e-15,
                   "unit": "m", "own_error_from": "rounding"},
                  {"subject": "A03", "title": "Andrews", "reference": "none: it diverged", "own_error": None,
                   "unit": None, "own_error_from": None}]
    regions = pandas.DataFrame([cell("one/a", 1.0), cell("two/a", 9.0, reason="pruned: too slow"),
                                cell("two/a", 9.0, reason="over 1 s: diverged: energy")])
    tables = {"work": work(), "gate": pandas.DataFrame(gate), "references": pandas.DataFrame(references),
              "regions": regions, "winners": winners(regions), "fills": pandas.DataFrame(),
              "forms": pandas.DataFrame([pair("one/a", 0.5), pair("two/a", float("nan"))]),
              "precision": pandas.DataFrame([pair("one/a", 1.5)]), "tangents": tangents(work())}
    context = {"compiler": "c", "commit": "0", "cpu_model": "a machine"}
    page = report.render(tables, {"contexts": {"own": context}, "inputs": {"duration": 5.0, "time_limit": 4.0}},
                         {"work-four-bar-2": "AAAA"}, [{"library": "none", "variants": [{"name": "one/a"}]},
                                                       {"library": "L", "variants": [{"name": "two/a"}]}])
    for text in ("one/a, single, four-bar:2: disagrees, free-running", "none: it diverged", "3·10⁻¹⁵",
                 "1 were pruned by their pilots, 1 by a run of their own", "1 not-run", "1 diverged", "one/a, default (6)", "two/a, default (6)", "AAAA"):
        assert text in page, text
