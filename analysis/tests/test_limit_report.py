# The limit's page and figures from made-up tables.
import json

import matplotlib.pyplot as plt
import pandas
import pytest

from analysis.limit.figure import LIMIT, by_phase, leaders, over_size, timed
from analysis.limit.must_hold import leads, must_hold
from analysis.limit.report import by_size, write
from analysis.loader import PHASES, TableError

REGISTRY = [{"folder": folder, "variants": [{"name": f"{folder}/{name}"} for name in names]}
            for folder, names in (("one", ("a", "b")), ("two", ("c",)))]


def row(name, loops, step_us, status="ok", reason=""):
    shares = dict.fromkeys(PHASES, 0.1) | {"factorization": 0.5}
    return {"implementation": name, "loops": loops, "variables": 2 * loops + 2, "status": status,
            "reason": reason, "step_us": step_us, "low_us": step_us, "high_us": step_us,
            "rounds": 1, "passes": 2.0} | {
        f"{phase}_us": share * step_us for phase, share in shares.items()}


def steps():
    nothing = float("nan")
    return pandas.DataFrame([
        row(LIMIT, 10, 0.25), row("one/a", 10, 3.0), row("one/b", 10, 2.0), row("two/c", 10, 5.0),
        row(LIMIT, 40, 1.0), row("one/a", 40, 8.0), row("one/b", 40, nothing, "failed", "too slow"),
        row("two/c", 40, 12.0), row("two/c", 499, 99.0)])


def bounds():
    return pandas.DataFrame([
        {"loops": n, "variables": 2 * n + 2, "passes": 2.0, "flops": 4e3, "divisions": 30,
         "bytes_loaded": 7e3, "bytes_stored": 4e3, "level": "L1", "arithmetic_ns": 70.0,
         "latency_ns": 189.0, "memory_ns": 57.0, "bound_ns": 189.0, "measured_ns": 250.0,
         "ratio": 1.32} for n in (40, 10)])


def test_multiples_are_of_the_limit_code_of_the_same_size():
    found = timed(steps()).set_index(["implementation", "loops"]).multiple
    assert found["one/a", 10] == 12 and found["one/a", 40] == 8 and found[LIMIT, 40] == 1
    assert ("two/c", 499) not in found.index  # the limit code has no time there
    assert ("one/b", 40) not in found.index


def test_a_folder_is_led_by_the_fastest_of_those_timed_everywhere():
    assert leaders(steps()) == ["one/a", "two/c"]
    assert set(leaders(steps(), ["one"])) == {"one/a", "one/b", "two/c"}


def test_phases_are_times_and_multiples():
    sizes = dict(by_size(steps()))
    assert [r["implementation"] for r in sizes[22]] == [LIMIT, "one/b", "one/a", "two/c"]
    factorization = sizes[22][1]["phases"][PHASES.index("factorization")]
    assert factorization == pytest.approx((1000.0, 4.0))
    assert sizes[22][0]["phases"] == []


def test_figures_show_bounds_limit_and_leaders():
    figure = over_size(bounds(), steps(), REGISTRY)
    labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert "two/c" in labels and "one/b" not in labels
    assert sum(label.startswith("bound") for label in labels) == 3
    split = by_phase(steps())
    assert [axes.get_title(loc="left")[:6] for axes in split.axes] == ["n = 22", "n = 82"]
    plt.close("all")


def test_the_page_has_every_variant_and_what_was_lost(tmp_path):
    steps().to_csv(tmp_path / "steps.csv", index=False)
    bounds().to_csv(tmp_path / "bounds.csv", index=False)
    (tmp_path / "implementations.json").write_text(json.dumps({"implementations": REGISTRY}))
    (tmp_path / "run.json").write_text(json.dumps({"contexts": {"own": {"compiler": "c", "commit": "0"}}}))
    write(tmp_path)
    text = (tmp_path / "limit.html").read_text()
    assert "one/b, four-bar:40: too slow" in text and "<td>two/c</td>" in text
    assert (tmp_path / "figures" / "over_size.png").exists()


def test_instructions_are_a_column_where_they_were_counted(tmp_path):
    table = steps()
    (tmp_path / "implementations.json").write_text(json.dumps({"implementations": REGISTRY}))
    (tmp_path / "run.json").write_text(json.dumps({"contexts": {"own": {"compiler": "c", "commit": "0"}}}))
    bounds().to_csv(tmp_path / "bounds.csv", index=False)
    for counted in (False, True):
        if counted:
            table["instructions"] = [2769.0] + [float("nan")] * (len(table) - 1)
        table.to_csv(tmp_path / "steps.csv", index=False)
        write(tmp_path)
        text = (tmp_path / "limit.html").read_text()
        assert ("instructions</th>" in text) == counted
        assert ('<td class="n">2769</td>' in text) == counted


def test_tables_without_the_limit_code_are_refused(tmp_path):
    table = steps()
    table[table.implementation != LIMIT].to_csv(tmp_path / "steps.csv", index=False)
    bounds().to_csv(tmp_path / "bounds.csv", index=False)
    with pytest.raises(TableError, match="no size has a time of limit/limit"):
        write(tmp_path)


OWN = [*REGISTRY, {"folder": "own", "library": "none", "variants": [{"name": "own/x"}]}]


A, B, C = (f"harness/scenes/problems/{name}.json" for name in "abc")


def scenes():
    def one(scene, name, step_us, status="ok", dimension=2, filled=False):
        return {"scene": scene, "implementation": name, "step_us": step_us, "status": status,
                "reason": "", "variables": 6, "dimension": dimension, "filled": filled}
    return pandas.DataFrame([
        one(A, "own/x", 1.0), one(A, "one/a", 3.0), one(A, "two/c", 2.5),
        one(B, "own/x", 1.0), one(B, "one/a", 1.9), one(B, "two/c", 9.0, "slower"),
        one(C, "own/x", 1.0, dimension=3), one(C, "one/a", 0.5, "failed", dimension=3),
        one(C, "two/c", 1.6, dimension=3),
        one("harness/scenes/examples/e.json", "own/x", 1.0), one("harness/scenes/examples/e.json", "one/a", 1.2),
        one("f", "own/x", 1.0, filled=True), one("f", "one/a", 0.95, filled=True)])


def held(**tables):
    return {one.what: one for one in must_hold("own", OWN, **tables)}


def test_a_lead_is_over_the_fastest_with_a_library_that_agreed():
    found = leads(scenes(), "own", ["own/x"], "scene")
    assert found[A] == 2.5 and found[B] == 1.9 and found[C] == 1.6


def test_the_worst_scene_of_a_kind_counts():
    found = held(scenes=scenes())
    planar = found["times faster than the fastest with a library, planar standard problems"]
    assert not planar.holds and planar.worst == "1.9 (problems/b, x)"
    assert found["times faster than the fastest with a library, spatial standard problems"].holds
    filled = found["times the step of the fastest with a library, n = 100, filled"]
    assert filled.holds and filled.worst == "1.05 (f, x)"


def sized(power, last=9999):
    rows = [row(name, loops, factor * (2 * loops + 2) ** power) | {
        "setup_us": 10.0 * loops, "memory_bytes": 100.0 * loops + 100}
        for loops in (10, 24, 40, 49, 79, 499, 1999, last)
        for name, factor in ((LIMIT, 1.0), ("own/x", 1.4), ("one/a", 5.0))]
    return pandas.DataFrame(rows)


def test_sizes_and_growth():
    found = held(steps=sized(1.0))
    assert found["times faster than the fastest with a library, N-four-bar"].holds
    assert found["times the limit code's step"].holds
    assert all(found[f"exponent of {what} over n, penalty form"].worst == "1"
               for what in ("a step's time", "a pass's time", "memory"))
    assert found["set-up, s"].worst == "0.1 (n = 20000, x)" and found["set-up, s"].holds
    assert not held(steps=sized(1.1))["exponent of a step's time over n, penalty form"].holds


def test_growth_in_the_saddle_point_form():
    what = "exponent of a step's time over n, saddle-point form"
    rows = sized(1.0)
    assert held(growth=rows)[what].holds and not held(growth=sized(1.1))[what].holds
    assert held(growth=rows[rows.variables < 10000])[what].worst == ""
    assert held(growth=rows[:0])[what].worst == ""


def test_what_was_not_measured_does_not_hold():
    found = held(steps=sized(1.0, last=499).drop_duplicates())
    for what in ("exponent of memory over n, penalty form", "set-up, s"):
        assert found[what].worst == "" and not found[what].holds
    few = sized(1.0)
    few = few[few.loops != 24]
    lead = held(steps=few)["times faster than the fastest with a library, N-four-bar"]
    assert lead.worst == "" and not lead.holds


def test_batches_gain():
    def gains(*values):
        return pandas.DataFrame([{"scene": f"s{k}", "sets": 64, "implementation": "own/x", "status": "ok", "step_us": 2.0, "alone_us": 2.0 * gain, "gain": gain}
                                 for k, gain in enumerate(values)])
    what = "throughput of batches ÷ that of their lanes alone, {} sets of parameters"
    assert held(batches=gains(5.0, 4.0))[what.format(64)].holds
    assert held(batches=gains(5.0, 3.9))[what.format(64)].worst == "3.9 (s1, x)"
    found = held(batches=pandas.concat([gains(5.0, 4.0), gains(5.0, 3.9).assign(sets=8)]))
    assert found[what.format(64)].holds and not found[what.format(8)].holds
    for lost in ({"status": "failed"}, {"gain": float("nan")}):
        part = gains(5.0, 4.0)
        part.loc[1, list(lost)] = list(lost.values())
        found = held(batches=part)[what.format(64)]
        assert found.worst == "" and not found.holds


def test_the_fastest_variant_of_a_folder_counts_scene_by_scene():
    table = pandas.concat([scenes(), pandas.DataFrame([
        {"scene": scene, "implementation": "own/y", "step_us": 0.5, "status": status, "reason": "", "variables": 6,
         "dimension": 2, "filled": False} for scene, status in ((A, "ok"), (B, "failed"))])])
    found = leads(table, "own", ["own/x", "own/y"], "scene")
    assert found[A] == 5.0 and found[B] == 1.9


def test_scenes_and_batches_need_no_sizes(tmp_path):
    scenes().to_csv(tmp_path / "scenes.csv", index=False)
    (tmp_path / "implementations.json").write_text(json.dumps({"implementations": OWN}))
    (tmp_path / "run.json").write_text(json.dumps({"contexts": {"own": {"compiler": "c", "commit": "0"}}}))
    write(tmp_path)
    text = (tmp_path / "limit.html").read_text()
    assert "What own is held to" in text and "1.9 (problems/b, x)" in text and "not measured" not in text
    assert (tmp_path / "figures" / "ahead.png").exists()
