# The figures and the page of study/extremes on small tables of every outcome.
import json

import matplotlib.pyplot as plt
import numpy
import pandas
import pytest

from analysis.extremes import battery_figure, numbers, pivots_figure, roundoff_figure, sentences, ways_figure
from analysis.extremes.report import write
from analysis.loader import TableError

STATUSES = ("ok", "degraded", "diverged", "wrong-branch", "not-converged", "timeout", "crashed", "refused", "not run")
REGISTRY = [{"folder": name, "variants": [{"name": f"{name}/v", "dense": name == "a"}]} for name in "ab"]


def battery():
    return pandas.DataFrame([
        {"axis": axis, "value": status, "implementation": name, "setting": form, "status": status, "reason": "why",
         "true_error": 1e-5 if status in ("ok", "degraded") else float("nan"), "truth": "exact", "silent": False,
         "truth_error": 2e-16, "steps": 24.0 if status == "ok" else 2000.0, "step": 1e-3,
         "command": f"run {axis} {status} {name} {form}"}
        for axis in ("loops", "step") for status in STATUSES for name in ("a/v", "b/v")
        for form in ("penalty", "saddle-point")])


def ways():
    rows = [{"way": way, "implementation": "csc_klu/v", "axis": "step", "value": step, "loops": 2, "status": "ok",
             "reason": "", "true_error": 1e-4, "safe": safe, "silent": not safe, "command": "run w"}
            for way, safe in (("α auto", True), ("saddle-point", False)) for step in (1e-3, 2e-3)]
    return pandas.DataFrame([*rows, {"way": "mixed precision", "implementation": "csc_klu", "status": "unsupported",
                                     "reason": "no variant serves mixed", "silent": float("nan")}])


def cost():
    times = {"α auto": (1.0, 2.0, 9.0), "saddle-point": (2.0, 5.0, 18.0)}
    return pandas.DataFrame([
        {"way": way, "folder": "csc_klu", "loops": 10, "round": number, "status": "ok", "step_us": time,
         "passes_per_step": 2.0} for way, found in times.items() for number, time in enumerate(found, start=1)])


def pivots():
    return pandas.DataFrame([
        {"sequence": "upright", "form": "penalty", "strategy": strategy, "matrices": 91, "pivoting": pivoting,
         "error_median": 1e-16, "error_worst": worst, "repivotings": 0, "time_us_median": time}
        for strategy, worst, time in (("refactor", 1e-7, 2.0), ("guarded", 1e-15, 2.4), ("factor", 1e-16, 6.0))
        for pivoting in ("diagonal", "default", "largest")])


def lines(jump):
    """A difference that grows tenfold in a second, or by four decades at 2 s."""
    t = numpy.linspace(0, 4, 401)
    found = 1e-12 * (10.0**(4 * (t > 2)) if jump else 10**t)
    return pandas.DataFrame({"loops": 1, "scheme": "penalty", "implementation": "a/v", "t": t, "difference": found,
                             "speed": 2 + numpy.cos(t)})


TURNS = pandas.DataFrame({"loops": 1, "t": [0.2, 0.6, 1.2, 2.0]})  # singular positions; a turn takes 1 s


def roundoff():
    return pandas.DataFrame([{"loops": 1, "scheme": "penalty", "implementation": "a/v", "status": "ok", "reason": "",
                              "at_1_s": 1e-12, "at_5_s": 1e-10, "at_20_s": 1.6e-9}])


def results(folder, **tables):
    (folder / "run.json").write_text(json.dumps({"contexts": {"own": {"compiler": "c", "commit": "0"}},
                                                 "inputs": {"time_limit": 60.0}}))
    (folder / "implementations.json").write_text(json.dumps({"implementations": REGISTRY}))
    for name, table in tables.items():
        table.to_csv(folder / f"{name}.csv", index=False)
    return folder


def test_the_matrix_names_every_outcome_and_counts_what_is_silently_wrong():
    table = battery()
    figure = battery_figure.draw(table)
    named = {text.get_text() for text in figure.axes[0].get_legend().get_texts()}
    assert {"ok or plausible", *STATUSES[1:]} <= named and battery_figure.title(table) == "0 silent wrongs in 56 runs"
    table.loc[0, "silent"], table.loc[4, "status"], table.loc[1, "true_error"] = True, "strange", 0.0
    figure = battery_figure.draw(table)
    named = {text.get_text() for text in figure.axes[0].get_legend().get_texts()}
    assert {"silently wrong: ok or plausible beyond its class", "other failure"} <= named
    assert battery_figure.title(table) == "1 silent wrong in 56 runs"
    plt.close("all")


def test_no_error_is_shown_below_that_of_the_truth():
    table = battery()
    table.loc[[0, 1, 2], "true_error"] = [0.0, 2e-16, 2.1e-16]
    shown = [text.get_text() for text in battery_figure.draw(table).axes[0].texts]
    assert (shown.count("≤−16"), shown.count("−16"), shown.count("−5")) == (2, 1, 13)
    plt.close("all")


def test_what_was_left_out_and_what_is_short_is_told():
    table = battery()
    table["reason"] = table.reason.mask(table.status == "not run", "dense implementations run up to 200 loops")
    table = table[(table.status != "not run") | (table.axis == "loops") & (table.implementation == "a/v")]
    assert sentences.left_out(table) == [
        "Not run in loops not run: a/v (dense implementations run up to 200 loops).",
        "Motions last 2 s in most cells. Those of extreme size and step that are shorter than 1 s may miss what happens "
        "later: ok: 24 steps of 0.001 s, 0.024 s; ok: 24 steps of 0.001 s, 0.024 s."]
    assert sentences.left_out(table[table.status == "degraded"]) == []


def test_sentences_of_the_battery_find_where_nobody_is_ok():
    said, nobody = sentences.battery(battery())
    assert said[0].startswith("8 of 56 runs are ok or plausible, and right; 0 are") and len(nobody) == 14
    table = battery()
    table.loc[(table.value == "diverged") & (table.implementation == "a/v"), "status"] = "ok"
    assert len(sentences.battery(table)[1]) == 12
    assert [one["outcomes"] for one in sentences.unlike(table)][0] == {"ok": ["a/v"], "diverged": ["b/v"]}


def test_costs_are_medians_of_ratios_within_a_round():
    assert numbers.costs(cost(), "csc_klu", "saddle-point") == [(10, 2.0, 2.0, 2.5)]
    assert numbers.costs(cost(), "csc_klu", "mixed precision") == []
    lost = cost()
    lost.loc[lost.way == "α auto", "status"] = "diverged"
    assert numbers.costs(lost, "csc_klu", "saddle-point") == []
    assert numbers.share(ways()[ways().way == "α auto"]) == (2, 2)


def test_growth_tells_jumps_from_what_grows_between():
    singular = numpy.array([2.0])
    near, far, time = numbers.growth(lines(jump=True), singular)
    assert near == pytest.approx(4) and far == pytest.approx(0) and time == pytest.approx(0.05, abs=0.01)
    near, far, _ = numbers.growth(lines(jump=False), singular)
    assert near == pytest.approx(0.2, abs=0.02) and far == pytest.approx(3.8, abs=0.02)

    def said(found):
        return sentences.jumps(sentences.roundoff(roundoff(), found, TURNS))
    assert "in jumps" in said(lines(jump=True))[0]
    assert "no jumps" in said(lines(jump=False))[0] and "between 2.0 and 2.0" in said(lines(jump=False))[1]
    both = lines(jump=False)
    both["difference"] *= numpy.where(both.t > 2, 10.0, 1.0)
    assert "it grows 3.5 times as fast there" in said(both)[0]


def test_growth_begins_after_the_first_turn():
    found = lines(jump=False)
    told = sentences.jumps(sentences.roundoff(roundoff(), found, TURNS))
    assert told[0].startswith("After the first turn 13 % of the growth") and "13 % of the time" in told[0]
    found.loc[found.t < 0.3, "difference"] = 0.0  # nothing of how far it was below
    assert sentences.jumps(sentences.roundoff(roundoff(), found, TURNS)) == told
    assert sentences.jumps(sentences.roundoff(roundoff(), found[found.t < 0.9], TURNS)) == ["No growth was seen."]


def test_a_lag_is_told_from_other_differences():
    late = lines(jump=False)
    late["t"] += 1e-3
    late["difference"] = 1e-12 * late.t**2 * late.speed
    assert numbers.with_speed(late) == pytest.approx(1, abs=1e-6)
    late["difference"] = 1e-12 * late.t**2 / late.speed
    assert numbers.with_speed(late) == pytest.approx(-1, abs=1e-6)
    assert numpy.isnan(numbers.with_speed(late[:2]))


def test_the_guard_is_compared_with_kept_pivots():
    said = "\n".join(sentences.pivots(pivots()))
    assert "guarded takes 1.20 times" in said and "factor takes 3.00 times" in said and "10⁻⁷" in said


def test_the_page_has_the_parts_that_were_run(tmp_path):
    with pytest.raises(TableError, match="holds no table"):
        write(results(tmp_path))
    results(tmp_path, pivots=pivots(), pivots_claims=pandas.DataFrame([{"claim": "it is safe", "holds": False}]))
    write(tmp_path)
    page = (tmp_path / "extremes.html").read_text()
    assert "does not hold" in page and "The battery" not in page
    table = battery()
    table.loc[0, "silent"] = True
    table.loc[table.axis == "step", "setting"] = "rattle4"
    results(tmp_path, battery=table, ways=ways(), ways_cost=cost(), roundoff=roundoff(),
            scaling=pandas.DataFrame([{"solver": "Cholesky", "components_that_differ": 0, "largest_difference": 0.0}]),
            roundoff_growth=lines(jump=True), singular=TURNS)
    write(tmp_path)
    page = (tmp_path / "extremes.html").read_text()
    assert "<code>run loops ok a/v penalty</code>" in page and "run w" in page
    assert "N = 10: 2.00 (2.00 to 2.50)" in page
    assert "no variant serves mixed" in page and "Cholesky: the same bit for bit" in page
    assert {path.name for path in (tmp_path / "figures").glob("*.png")} == {
        "battery.png", "battery-settings.png", "ways.png", "pivots.png", "roundoff-penalty.png"}
    (tmp_path / "singular.csv").unlink()
    with pytest.raises(TableError, match="singular.csv: cannot be read"):
        write(tmp_path)


def test_figures_of_one_row_can_be_drawn():
    for figure in (battery_figure.draw(battery()[:1]), pivots_figure.draw(pivots()[:1]),
                   ways_figure.draw(ways()[:1], cost()), roundoff_figure.draw(
                       lines(True)[:1], pandas.DataFrame({"loops": [], "t": []}), REGISTRY, "penalty")):
        plt.close(figure)
