# Tables, what must hold, figures and sentences of the limit on synthetic records.
from functools import partial
from itertools import combinations
from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy
import pytest
from matplotlib.colors import to_rgb

from analysis.core.records import Record
from analysis.core.registry import Registry
from analysis.limit import figures, held, page, tables
from analysis.core.timing import PHASES
from analysis.limit.tables import LIMIT
from analysis.tests.tables_of import tables_of

REGISTRY = Registry({"implementations": [
    {"folder": "one", "available": True, "library": "L", "variants": [{"name": "one/a"}, {"name": "one/b"}]},
    {"folder": "two", "available": True, "library": "M", "variants": [{"name": "two/c"}]},
    {"folder": "own", "available": True, "library": "none", "variants": [{"name": "own/x"}, {"name": "own/y"}]}]})
VIEW = SimpleNamespace(registry=REGISTRY, settings={"processes": 2})
A, B, C = (f"harness/scenes/problems/{name}.json" for name in "abc")


def bench(role, scene, number=1, status="done", **times):
    """A process; of each contender ("one_a") µs a step, or why it has none."""
    names = [name.replace("_", "/") for name in times]
    found = {}
    for name, time in zip(names, times.values()):
        known = {"stretch_us": [40 * time] * 3, "cpu_us": [40 * time] * 3, "steps": 40, "passes": 80, "variables": 6, "setup_us": 7.0, "memory_bytes": 9e3,
                 "position_error": 1e-6} if isinstance(time, float) else {"error_occurred": True, "error_message": time}
        shares = {phase: 0.0 for phase in PHASES} | {"other": 1.0} if name in (LIMIT, "own/y") else dict.fromkeys(PHASES, 0.1) | {"solve": 0.5}
        found[f"{name}/{scene}"] = known | ({f"phase_{phase}": share for phase, share in shares.items()} if role == "size" else {})
    cell = {"scene": scene, "contenders": names, "environment": "own|openblas", "number": number, "role": role, "settings": []}
    return Record(f"{role}/{number}-{scene.rpartition('/')[2]}-{len(names)}.json", cell, status, "the budget" if status != "done" else "",
                  1.0, [], {}, {"rows": found} if status == "done" else {})


def gate(role, scene, **verdicts):
    return [Record(f"{role}-gate/{name}.json", {"scene": scene, "contenders": [name.replace("_", "/")], "role": f"{role}-gate"},
                   "done", "", 1.0, [], {}, {"rows": [{"scene": scene, "implementation": name.replace("_", "/"), "verdict": verdict, "reason": "why"}]}) for name, verdict in verdicts.items()]


def about(scene, dimension=2):
    return Record(f"about/{scene}", {"scene": scene, "role": "about", "contenders": []}, "done", "", 0.1, [], {},
                  {"dimension": dimension, "variables": 6})


def batch(scene, sets, number=1, **gains):
    found = {f"{name.replace('_', '/')}/{scene}/batch": {"variables": 22, "lanes": 8, "step_us": 2.0, "alone_us": 2.0 * gain, "gain": gain}
             if isinstance(gain, float) else {"error_occurred": True, "error_message": gain} for name, gain in gains.items()}
    cell = {"scene": scene, "contenders": [name.replace("_", "/") for name in gains], "number": number, "role": "batch",
            "settings": ["--batch", "--sets", sets]}
    return Record(f"batch/{scene}-{sets}-{number}.json", cell, "done", "", 1.0, [], {}, {"rows": found})


made = partial(tables_of, "limit", tables.build, VIEW)


def look(scene, kind="problem", **times):
    """The first look at a scene, and what is known of it."""
    return [about(scene), bench(f"{kind}-look", scene, **times)]


def agree(role, scene, *names):
    return gate(role, scene, **{name: "agrees" for name in names})


def sizes(*loops, power=1.0, setup=10.0):
    """Two processes a size: the limit code's time grows with this power of n; ours is 1.4, a library's 5 times as long."""
    records = []
    for size in loops:
        n = 2.0 * size + 2
        for number in (1, 2):
            record = bench("size", f"four-bar:{size}", number, limit_limit=1e-2 * n**power, own_x=1.4e-2 * n**power, one_a=5e-2 * n**power)
            for row in record.output["rows"].values():
                row |= {"setup_us": setup * size, "memory_bytes": 100 * n}
            records.append(record)
        records += agree("size", f"four-bar:{size}", "limit_limit", "own_x", "one_a")
    return records


def said(found):
    return found["held"].set_index("what")


def test_multiples_are_of_the_limit_code_within_the_same_process():
    found = made(bench("size", "four-bar:10", 1, limit_limit=0.25, one_a=3.0), bench("size", "four-bar:10", 2, limit_limit=0.5, one_a=6.0))
    row = found["steps"].set_index("implementation").loc["one/a"]
    assert row.multiple == pytest.approx(12) == row.multiple_low and row.step_us == 4.5 and (row.low_us, row.high_us) == (3.0, 6.0)
    assert row.solve_us == pytest.approx(2.25) and sum(row[f"{phase}_us"] for phase in PHASES) == pytest.approx(row.step_us)
    assert row.passes == 2 and row.pass_us == pytest.approx(2.25) and row.processes == 2


def test_who_failed_in_one_process_has_failed_and_who_was_slow_in_one_has_not():
    found = made(bench("size", "four-bar:10", 1, limit_limit=1.0, one_a=3.0, one_b=2.0),
                 bench("size", "four-bar:10", 2, limit_limit=1.0, one_a="diverged: at step 3", one_b="slower: than a second"),
                 bench("size-left-out", "four-bar:10", 1, "crashed", two_c=1.0))
    rows = found["steps"].set_index("implementation")
    assert (rows.status["one/a"], rows.reason["one/a"]) == ("diverged", "at step 3") and numpy.isnan(rows.step_us["one/a"])
    assert rows.status["one/b"] == "ok" and rows.processes["one/b"] == 1 and rows.status["two/c"] == "crashed"
    assert [(status, names) for status, _, names in page.lost(found)] == [
        ("diverged", [("one/a", ["four-bar:10"])]), ("crashed", [("two/c", ["four-bar:10"])])]


def test_who_ended_a_process_of_all_is_lost_alone():
    alone = bench("size-alone", "four-bar:10", 0, "crashed", one_b=2.0)
    found = made(bench("size", "four-bar:10", 1, limit_limit=1.0, one_a=3.0, one_b=2.0),
                 bench("size", "four-bar:10", 2, "crashed", limit_limit=1.0, one_a=3.0, one_b=2.0), alone,
                 bench("size-left-out", "four-bar:10", 0, "crashed", one_b=2.0),
                 *(bench("size", "four-bar:10", number, limit_limit=1.0, one_a=4.0) for number in (1, 2)))
    rows = found["steps"].set_index("implementation")
    assert list(rows.status) == ["ok", "ok", "crashed"] and rows.processes["one/a"] == 2 and rows.step_us["one/a"] == 4.0


def test_a_lead_is_over_the_fastest_library_that_the_gate_agrees_with():
    found = made(look(A, own_x=1.0, own_y=0.5, one_a=3.0, one_b=1.1, two_c=9.0),
                 *(bench("problem", A, number, own_x=1.0 * number, own_y=0.5 * number, one_a=3.0 * number) for number in (1, 2)),
                 agree("problem", A, "own_x", "own_y", "one_a"), gate("problem", A, one_b="disagrees"))
    rows = found["leads"].set_index("implementation")
    assert rows.lead["own/x"] == pytest.approx(3) and rows.lead["own/y"] == pytest.approx(6) and set(rows.rival) == {"one/a"}
    scenes = found["scenes"].set_index("implementation")
    assert (scenes.status["one/b"], scenes.reason["one/b"]) == ("disagrees", "why")
    assert scenes.status["two/c"] == "dropped" and numpy.isnan(scenes.step_us["two/c"])  # the gate was not asked
    assert scenes.to_rival["own/x"] == pytest.approx(1 / 3) and numpy.isnan(scenes.to_rival["two/c"])
    assert scenes.variables["own/x"] == 6 and scenes.dimension["own/x"] == 2


def test_without_a_verdict_or_a_rival_there_is_no_lead_and_the_reason_is_said():
    first = look(A, own_x=1.0, one_a=3.0, own_y="unsupported: no chain")
    rows = made(first, agree("problem", A, "one_a"), bench("problem", A, one_a=3.0))["leads"].set_index("implementation")
    assert (rows.status["own/x"], rows.status["own/y"]) == ("dropped", "unsupported") and rows.lead.isna().all()
    alone = made(first, agree("problem", A, "own_x"), bench("problem", A, own_x=1.0))["leads"]
    assert alone.status[0] == "dropped" and "no library" in alone.reason[0]
    spent = made(first, agree("problem", A, "own_x", "one_a"), bench("problem", A, status="dropped", own_x=1.0, one_a=3.0))["leads"]
    assert (spent.status[0], spent.reason[0]) == ("dropped", "the budget")


def test_the_worst_scene_of_a_kind_counts_by_its_whole_interval():
    def scene(name, *times, dimension=2, kind="problem"):
        return [about(name, dimension), bench(f"{kind}-look", name, own_x=1.0, one_a=times[0]), *agree(kind, name, "own_x", "one_a"),
                *(bench(kind, name, number, own_x=1.0, one_a=time) for number, time in enumerate(times, start=1))]
    found = said(made(scene(A, 2.5, 2.6), scene(B, 1.9, 1.91), scene(C, 1.3, 1.9, dimension=3),
                      scene("four-bar:49,fill=0.5", 0.95, 0.95, kind="fill")))
    planar = found.loc["times faster than the fastest library, planar standard problems"]
    assert (planar.verdict, planar["where"], planar.measured, planar.cases) == ("not held", "problems/b", 2, 2)
    spatial = found.loc["times faster than the fastest library, spatial standard problems"]
    assert spatial.verdict == "open" and spatial.low < 1.5 < spatial.high
    assert found.verdict["times faster than the fastest library, n = 100, filled"] == "held"
    wide = said(made(scene(A, 2.5, 2.5), scene(B, 2.0, 5.0))).loc["times faster than the fastest library, planar standard problems"]
    assert (wide.verdict, wide["where"]) == ("open", "problems/a") and wide.worst == 2.5 and wide.low < 2 < wide.high
    assert found.verdict["times the limit code's step"] == "not measured"


def test_of_all_own_code_the_fastest_counts_scene_by_scene():
    what = "times faster than the fastest library, planar standard problems"
    records = [look(A, own_x=1.0, own_y=0.5, one_a=1.5), *(bench("problem", A, number, own_x=1.0, own_y=0.5, one_a=1.5)
                                                           for number in (1, 2)), *agree("problem", A, "own_x", "one_a", "own_y")]
    row = said(made(*records)).loc[what]
    assert row.worst == pytest.approx(3) and row.variant == "own/y" and row.verdict == "held"
    records[-1].output["rows"][0]["verdict"] = "disagrees"
    row = said(made(*records)).loc[what]
    assert row.worst == pytest.approx(1.5) and row.variant == "own/x" and row.verdict == "not held"


def test_sizes_and_growth():
    found = said(made(sizes(10, 40, 499, 9999, 99)))
    ahead = found.loc["times faster than the fastest library, N-four-bar"]
    assert ahead.verdict == "held where measured"
    assert (ahead.measured, ahead.cases) == (3, 6) and found.verdict["times the limit code's step"] == "held"
    for what in ("a step's time", "a pass's time", "memory"):
        assert found.worst[f"exponent of {what} over n, penalty form"] == pytest.approx(1)
        assert found.loc[f"exponent of {what} over n, penalty form", "where"].startswith("fit of 3 sizes")
    assert len(found.record["exponent of memory over n, penalty form"].split()) == 3  # one a size of the fit
    assert found.worst["set-up, s"] == pytest.approx(0.09999) and found.verdict["set-up, s"] == "held"
    steep = said(made(sizes(49, 499, 9999, power=1.1, setup=100.0)))
    assert steep.verdict["exponent of a step's time over n, penalty form"] == "not held" == steep.verdict["set-up, s"]
    bent = said(made(sizes(49, 9999), *sizes(499, power=1.1))).loc["exponent of a step's time over n, penalty form"]
    assert bent.verdict == "open" and bent.low < bent.worst < 1.05 < bent.high  # three sizes off a line say little
    short = said(made(sizes(49, 499)))
    assert short.verdict["exponent of memory over n, penalty form"] == "not measured" == short.verdict["set-up, s"]


def test_growth_in_the_saddle_point_form_is_apart():
    records = [bench("growth", f"four-bar:{size}", number, own_x=1e-2 * (2 * size + 2)) for size in (49, 499, 9999) for number in (1, 2)]
    found = made(records)
    assert set(found["steps"].form) == {"saddle-point"} and found["leads"].empty
    held_ = said(found)
    assert held_.verdict["exponent of a step's time over n, saddle-point form"] == "held"
    assert held_.verdict["exponent of a step's time over n, penalty form"] == "not measured"


def test_batches_have_gains_with_intervals_for_each_number_of_sets():
    found = made(batch("four-bar:10", 8, 1, own_x=4.0, one_a="unsupported: alone"), batch("four-bar:10", 8, 2, own_x=4.41),
                 batch("four-bar:10", 64, 1, own_x=5.0), batch("four-bar:10", 64, 2, own_x=5.0), batch("four-bar:40", 64, 1, own_x="failed: x"))
    rows = found["batches"].set_index(["implementation", "sets", "scene"])
    row = rows.loc["own/x", 8, "four-bar:10"]
    assert row.gain == pytest.approx(4.2) and row.low < 4 < 4.41 < row.high and (row.least, row.most) == (4.0, 4.41)
    held_ = said(found)
    what = "throughput of batches ÷ that of their lanes alone, {} sets of parameters"
    assert held_.verdict[what.format(8)] == "open" and held_.verdict[what.format(64)] == "held where measured"
    assert (held_.measured[what.format(64)], held_.cases[what.format(64)]) == (1, 2)
    assert page.context(found, VIEW)["alone"] == ["one/a"]


def swept(number, one, two, status="done"):
    rows = [{"jobs": jobs, "wall_s": wall, "cpu_s": 2.0 * jobs, "memory_mb": 9.0, "merge_s": 0.1} for jobs, wall in ((1, one), (2, two))]
    return Record(f"sweep/{number}", {"scene": "four-bar:10", "contenders": ["own/x"], "number": number, "role": "sweep", "settings": []}, status,
                  "why", 1.0, [], {}, {"lanes": 1000, "bytes": 5, "rows": rows} if status == "done" else {})


def test_sweeps_are_projected_from_the_lanes_that_were_run():
    found = made(swept(1, 2.0, 1.0), swept(2, 4.0, 2.0), swept(3, 2.0, 1.0))
    rows = found["sweeps"].set_index("jobs")
    assert list(rows.lanes_per_s) == [500, 1000] and list(rows.gain) == pytest.approx([1, 2]) and list(rows.work) == [1, 2]
    assert rows.million_s[2] == pytest.approx(1000 + 100) and rows.nodes_s[2] == pytest.approx(10 + 100)
    assert (rows.least[1], rows.most[1], rows.lane_us[1]) == (250, 500, 2000)
    assert any("2 times as many lanes a second as by one job" in one["text"] for one in page.answers(found, VIEW))
    assert made(swept(1, 1.0, 1.0, "dropped"))["sweeps"].reason.tolist() == ["why"]


@pytest.mark.parametrize("two, status, gain, verdict", [((1.0, 1.0), "done", 2.0, "held"), ((1.2, 1.2), "done", 2 / 1.2, "not held"),
                                                        ((1.0, 1.2), "done", 2 / 1.2**0.5, "open"), ((1.0, 1.0), "dropped", numpy.nan, "not measured")])
def test_two_jobs_are_held_to_a_gain(two, status, gain, verdict):
    row = said(made(*(swept(number, 2.0, one, status) for number, one in enumerate(two, 1)))).loc["lanes a second of a sweep by two jobs ÷ by one"]
    assert (row.verdict, row.cases, row.measured) == (verdict, 1, status == "done") and row.worst == pytest.approx(gain, nan_ok=True)


def test_a_folder_is_led_by_the_fastest_of_those_timed_everywhere():
    rows = figures.everyone(made(*(bench("size", f"four-bar:{size}", number, limit_limit=1.0, one_a=3.0,
                                         one_b=2.0 if size == 10 else "slower: much", two_c=5.0, own_x=1.5, own_y=1.2)
                                   for size in (10, 40) for number in (1, 2)))["steps"])
    assert figures.leaders(rows) == ["own/y", "one/a", "two/c"]
    assert figures.leaders(rows, {"own"}) == ["own/y", "own/x", "one/a", "two/c"]


def test_phases_that_do_not_exist_are_said_in_words():
    rows = figures.everyone(made(*(bench("size", "four-bar:10", number, limit_limit=1.0, one_a=3.0, own_y=1.2) for number in (1, 2)))["steps"])
    figure = figures.by_phase({"n = 22": rows}, figures.leaders(rows, {"own"}))
    assert [text.get_text() for text in figure.axes[0].texts].count("all in the same sweeps") == 1
    assert len(figure.axes[0].patches) == len(PHASES)  # of one/a
    plt.close(figure)


def test_phases_stay_apart_in_grey():
    grey = {phase: (numpy.dot(to_rgb(colour), (0.299, 0.587, 0.114)), hatch) for phase, (colour, hatch, _) in figures.PHASES.items()}
    assert all(abs(one - other) > 0.12 or hatch != its for (one, hatch), (other, its) in combinations(grey.values(), 2))


def test_libraries_stand_beside_the_fastest_of_them_and_a_line_breaks_where_a_size_is_missing():
    found = made(*(bench("size", f"four-bar:{size}", number, limit_limit=1.0, own_x=1.4, one_a=3.0, **{"two_c": 4.5} if size != 40 else {})
                   for size in (10, 40, 99) for number in (1, 2)),
                 *(one for size in (10, 40, 99) for one in agree("size", f"four-bar:{size}", "limit_limit", "own_x", "one_a", "two_c")))
    *_, behind = figures.draw(found, VIEW)["over_size"].axes
    first, second = [list(line.get_ydata()) for line in behind.lines]
    assert first == [1, 1, 1] and second[::2] == pytest.approx([1.5, 1.5]) and numpy.isnan(second[1])
    plt.close("all")


def test_variants_are_series_of_their_own():
    found = made(look(A, own_x=1.0, own_y=0.5, one_a=3.0), *(bench("problem", A, number, own_x=1.0, own_y=0.5, one_a=3.0) for number in (1, 2)),
                 agree("problem", A, "own_x", "own_y", "one_a"))
    figure = figures.draw(found, VIEW)["ahead"]
    labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert labels == ["own/x", "own/y", "at least"]
    plt.close("all")


def test_figures_sentences_and_page_of_a_small_set_and_of_none():
    bounds = Record("sizes/bounds/all.json", {"role": "bounds", "scene": ""}, "done", "", 1.0, [], {}, {"rows": [
        {"loops": 10, "variables": 22, "arithmetic_ns": 70.0, "latency_ns": 189.0, "memory_ns": 57.0, "bound_ns": 189.0,
         "measured_ns": 250.0, "ratio": 1.32}]})
    small = made(bounds, sizes(10, 40, 9999), look(A, own_x=1.0, one_a=3.0), *(bench("problem", A, number, own_x=1.0, one_a=3.0) for number in (1, 2)),
                 agree("problem", A, "own_x", "one_a"), batch("four-bar:10", 8, 1, own_x=4.0), batch("four-bar:10", 8, 2, own_x=4.2))
    for found in (small, made()):
        for figure in figures.draw(found, VIEW).values():
            assert figure.get_size_inches()[1] < 12
            plt.close(figure)
        page.context(found, VIEW)
        assert all(one["text"].endswith(".") for one in page.answers(found, VIEW))
    texts = [one["text"] for one in page.answers(small, VIEW)]
    assert "the fastest library takes 5 times as long (n = 22 to 20000)" in texts[0] and "own/x is shown to be faster" in texts[1]
    assert page.answers(made(), VIEW)[0]["text"].startswith("Not measured")
    assert [key for key, _ in page.context(small, VIEW)["sizes"]] == [22, 82, 20000]


def test_examples_are_held_to_nothing():
    assert numpy.isnan(held.wanted("example", 2)) and held.wanted("problem", 3) < held.wanted("problem", 2)
