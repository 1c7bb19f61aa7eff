# Extremes: judging, tables, figures, page and answers on synthetic records and small tables of every outcome.
from functools import partial
from types import SimpleNamespace

import numpy
import pandas
import pytest

from analysis.core import site
from analysis.core.files import ROOT, StudyError
from analysis.core.records import Record
from analysis.core.registry import Registry
from analysis.extremes import battery, cells, judge, page, tables, trials
from analysis.extremes.motions import Chain, Flat
from analysis.tests.tables_of import tables_of

STATUSES = ("ok", "degraded", "diverged", "wrong-branch", "not-converged", "timeout", "crashed", "refused", "excluded", "dropped")
NAMES = ("a/v", "b/v", "csc_klu/v")
REGISTRY = Registry({"implementations": [{"folder": name.split("/")[0], "available": True, "variants": [
    {"name": name, "dense": name == "a/v"}]} for name in NAMES]})
VIEW = SimpleNamespace(registry=REGISTRY, settings={})
TIMES = numpy.linspace(0, 3, 31)
CELL = next(cell for cell in cells.extremes() if cell.label == "N = 1")
TRIALS = {(cell.axis, cell.label): cell for cell in reversed(trials.all_trials())}  # of some steps: the first
KITE, PASSING, FAR, STANDARD = (TRIALS[key] for key in (
    ("driven four-bar", "kite at 0.001, 1 per s"), ("passage, driven", "Cardan, 1 per s"), ("far, driven", "quick return, 1 per s"), ("standard problem", "A01")))
SPRUNG = next(cell for cell in cells.extremes() if cell.motion is None)


def record(name, cell, output=None, series=None, ended="done", reason="", **more):
    cell = {"contenders": ["a/v"], "role": "penalty", "number": 0, "program": "mbs", "settings": ["--step", f"{cells.STEP:g}"]} | cell
    return Record(name, cell, ended, reason, 0.1, ["build/mbs", "simulate", "a scene.json", "--json", "--trajectory", "MOTION", "--every", "5"], {},
                  {"status": "ok", "status_reason": ""} | (output or {}), series or {}, **more)


def run(status="ok", error=0.0, who="a/v", role="penalty", of=CELL, **more):
    """A run of the battery that is off by `error` along both axes."""
    series = {column: list(values + error) for column, values in of.motion.solutions(TIMES)[0].items()} if of.motion else {}
    return record(f"battery/{role}/{who}@{of.name}", {"scene": f"raw/scenes/{of.name}.json", "contenders": [who], "role": role},
                  {"status": status} | more, {"t": list(TIMES)} | series)


made = partial(tables_of, "extremes", tables.build, VIEW)


def test_what_is_ok_beyond_its_class_is_silently_wrong():
    table = made(run("ok"), run("ok", 0.02, who="b/v"), run("degraded", 0.02, role="rattle"), run("diverged", 0.5, role="rattle4"),
                 run("ok", float("nan"), role="saddle-point"), run("plausible", 1e-3, "b/v", "saddle-point", position_error_max=0.02),
                 record("battery/dropped", {"scene": CELL.name, "role": "rattle6"}, ended="dropped", reason="budget"))["battery"]
    found = {(row.implementation, row.setting): row for row in table.itertuples()}
    assert [key for key, row in found.items() if row.verdict == battery.SILENT] == [("b/v", "penalty"), ("a/v", "saddle-point"), ("b/v", "saddle-point")]
    assert found["b/v", "penalty"].true_error == pytest.approx(0.02 * 2**0.5)
    assert found["b/v", "penalty"].command == "build/mbs simulate 'a scene.json'" and found["a/v", "penalty"].command == ""
    assert found["b/v", "saddle-point"].true_error == 0.02  # what it reports itself, between two instants
    assert numpy.isnan(found["a/v", "rattle4"].true_error) and found["a/v", "rattle6"].status == "dropped"


def trial(status, error=0.0, of=KITE, until=None, **more):
    motion = of.motion.solutions(TIMES)[0] if of.motion else {}
    series = {"t": list(TIMES[:until])} | {column: list(values[:until] + error) for column, values in motion.items()}
    return record(f"battery/{status}-{of.name}-{error}-{until}", {"scene": f"{of.scene or of.name}", "settings": ["--step", f"{of.step:g}"]},
                  {"status": status, "status_reason": "why"} | more, series)


@pytest.mark.parametrize(("run", "verdict"), [
    (trial("ok"), "right"), (trial("plausible", 0.002), "right"), (trial("plausible", 0.02), "silently wrong"), (trial("ok", 0.02), "silently wrong"),
    (trial("degraded"), "false alarm"), (trial("degraded", 0.002), "told"), (trial("degraded", 0.1), "told"), (trial("not-converged"), "told"),
    (trial("wrong-branch", 0.1, until=9), "told"), (trial("wrong-branch", until=9), "stopped"), (trial("diverged", until=9), "stopped"),
    (trial("wrong-branch", until=9, failed_at=5.28), "stopped"), (trial("wrong-branch", until=9, failed_at=1.5), "false alarm"),
    (trial("wrong-branch", of=PASSING, until=9), "false alarm"), (trial("diverged", of=PASSING, until=9), "stopped"),
    (trial("wrong-branch", of=FAR, until=9), "false alarm"), (trial("diverged", of=FAR, until=9), "false alarm"), (trial("diverged", 0.1, of=FAR, until=9), "told"),
    (trial("ok", of=FAR), "right"), (trial("not-converged", of=FAR), "false alarm")])
def test_a_trial_is_worth_what_it_said_beside_its_error(run, verdict):
    [row] = made(run)["battery"].itertuples()
    assert row.verdict == verdict 
    assert bool(row.command) == (verdict in ("silently wrong", "false alarm"))
    assert (row.wrong_from == row.wrong_from) == (verdict == "silently wrong" or verdict == "told" and "0.1" in row.record)


def test_trials_that_did_not_run_or_cannot_be_judged_have_no_verdict():
    unknown = next(cell for cell in trials.all_trials() if cell.motion is None)
    lost = record("battery/x", {"scene": KITE.name, "settings": ["--step", f"{KITE.step:g}"]}, ended="timeout", reason="20 s")
    assert list(made(lost, trial("degraded", of=unknown), trial("unsupported", until=0))["battery"].verdict.fillna("")) == 3 * [""]
    assert page._battery(made(lost)["battery"]) ["runs"] == 0


def test_trials_are_counted_by_kind_and_bounds_that_fail_are_said_to():
    tables = made(trial("plausible"), trial("plausible", 0.5), trial("ok", 0.6), trial("degraded"), trial("ok", of=STANDARD))
    found = tables["battery"]
    counts = battery.kinds(found)
    assert [(row["kind"], row["mechanisms"], row["runs"]) for row in counts] == [(STANDARD.axis, 1, 1), ("driven four-bar", 1, 4)]
    [wrong] = battery.listed(found, battery.SILENT)
    assert (wrong["runs"], wrong["wrong_from"], wrong["settings"]) == (2, 0.0, ["penalty"]) and wrong["true_error"] == pytest.approx(0.6 * 2**0.5 / KITE.length)
    [text] = [one["text"] for one in page.answers(tables, VIEW)]
    assert "In 5 runs of 2 mechanisms of 2 kinds: 2 silent wrongs and 1 false alarm." in text
    assert text.endswith("driven four-bar, kite at 0.001, 1 per s: build/mbs simulate 'a scene.json'.")
    assert "silently wrong”: not held, 2 runs (driven four-bar: 2)." in text and "own steps”: held, in 1 runs." in text
    text = render(made(trial("plausible", 0.5)))
    assert "Silently wrong: 1 run<" in text and "build/mbs simulate" in text and "False alarm: no run." in text


def test_records_of_another_battery_are_named():
    other = record("battery/penalty/x", {"scene": "raw/scenes/no-such-cell.json"})
    with pytest.raises(StudyError, match="battery/penalty/x: its cell is none of the battery"):
        made(other)


def test_a_run_is_held_to_the_nearest_of_its_motions_and_to_no_bad_reference():
    flat, ulp = Flat(1, angle=numpy.pi / 2, rate=0.0), 2.0**-52
    for chain, least in ((flat, ulp), (Chain(1, rate=0.0), ulp), (Chain(1), 8 * ulp), (Chain(1, offset=1e6), 1e6 * ulp)):
        own = judge.true_motion(cells.Extreme("x", "x", "", chain), {}, TIMES)[1]  # of closed forms, as they are evaluated
        assert least <= own < 100 * least  # libraries of elliptic functions differ by processor
    assert judge.true_motion(cells.Extreme("x", "x", "", flat), {}, [])[1] == 0
    second = {"t": list(TIMES)} | {key: list(values) for key, values in flat.solutions(TIMES)[1].items()}
    other = record("x", {}, series=second)
    assert judge.off(other, flat.solutions(TIMES), 1.0, 0.1) == (0, None)
    error, since = judge.off(other, flat.solutions(TIMES)[:1], 1.0, 0.1)
    assert error > 0.1 and 0 < since < TIMES[-1]

    def sprung(shift, status="ok"):
        return record("r", {}, {"status": status}, {"t": [0.0], "B.x": [shift], "B.y": [0.0], "C.x": [0.0], "C.y": [0.0]})
    solutions, own, _ = judge.true_motion(SPRUNG, {4: sprung(3e-4), 8: sprung(0.0)}, [0.0])
    assert own == pytest.approx(1e-4) and len(solutions) == 1
    for references, why in (({4: sprung(0.3), 8: sprung(0.0)}, "own error is 1.0e-01"), ({4: sprung(0)}, "missing"),
                            ({4: sprung(0), 8: sprung(0, "diverged")}, "diverged")):
        found, _, text = judge.true_motion(SPRUNG, references, [0.0])
        assert found == [] and why in text


def test_references_are_found_by_their_step():
    motion = {"t": [0.0], **{column: [0.0] for column in SPRUNG.columns}}
    finer = [record(f"battery/reference/{factor}", {"scene": f"{SPRUNG.name}.json", "role": "reference", "contenders": ["reference/reference"],
                    "settings": ["--step", f"{SPRUNG.step / factor:g}"]}, series=motion) for factor in judge.FINER]
    mine = record("battery/penalty/1", {"scene": f"{SPRUNG.name}.json"}, series=motion)
    [row] = made(*finer, mine)["battery"].itertuples()
    assert row.truth == "reference at 1/8 of the step" and row.true_error == 0
    [row] = made(mine)["battery"].itertuples()
    assert row.truth.startswith("none") and row.verdict == "" and battery.kind(row) == "unjudged"


def small():
    """battery.csv with every outcome, of two implementations that end alike."""
    return pandas.DataFrame([
        {"axis": axis, "value": status, "implementation": name, "setting": setting, "status": status, "reason": "why",
         "true_error": 1e-5 if status in ("ok", "degraded") else float("nan"), "truth": "exact",
         "verdict": {"ok": battery.RIGHT, "degraded": battery.FALSE}.get(status, ""), "near": float("nan"), "wrong_from": float("nan"), "truth_error": 2e-16, "steps": 24.0 if status == "ok" else 2000.0, "step": 1e-3, "command": "",
         "record": f"{axis} {status} {name} {setting}"}
        for axis in ("loops", "step") for status in STATUSES for setting in ("penalty", "saddle-point") for name in ("a/v", "b/v")])


def test_the_matrix_shows_the_worst_and_who_is_unlike():
    table = small()
    found = page.matrix(table)
    assert len(found) == 16 and ("loops", "dropped") not in found and found["loops", "ok"]["penalty"] == ("ok", -5, False)
    assert {cells["penalty"][0] for cells in found.values()} == {"ok", *STATUSES[1:8]}
    table.loc[table.index[0], ["verdict", "true_error"]] = battery.SILENT, 0.3
    table.loc[table.index[9], "status"] = "strange"
    found = page.matrix(table)
    assert found["loops", "ok"]["penalty"] == ("silent", -1, True) and "other" in {kind for cells in found.values() for kind, _, _ in cells.values()}
    table["truth_error"] = 1e-3
    assert page.matrix(table)["step", "ok"]["penalty"][1] == -3  # none is shown below that of the truth


def test_settings_that_are_equal_in_all_cells_share_a_column():
    table = small()
    more = table[(table.setting == "penalty") & (table.axis == "loops")].assign(setting="rattle")  # not tried elsewhere
    assert page._battery(pandas.concat([table, more]))["columns"] == [["penalty", "saddle-point"], ["rattle"]]
    table.loc[table.index[0], ["verdict", "true_error"]] = battery.SILENT, 0.3
    assert page._battery(table)["columns"] == [["penalty"], ["saddle-point"]]
    found = made(run("ok"), run("ok", role="saddle-point"), run("ok", 0.02, role="rattle4"))
    assert "<span>penalty<br>saddle-point</span></th><th><span>rattle4</span>" in render(found)


def test_what_was_left_out_is_told():
    table = small()
    table["reason"] = table.reason.mask(table.status == "excluded", "dense implementations run up to 200 loops")
    table = table[(table.status != "excluded") | (table.axis == "loops") & (table.implementation == "a/v")]
    assert page.left_out(table) == [
        "Left out: a/v in loops excluded (dense implementations run up to 200 loops).",
        "8 runs were left out, as the budget was spent: the more telling ones came first."]
    assert page.left_out(table[table.status == "degraded"]) == []


def test_cells_in_which_nobody_is_right_are_found():
    table = small()
    found = page._battery(table)
    assert (found["runs"], len(found["nobody"])) == (16, 14)
    table.loc[(table.value == "diverged") & (table.implementation == "a/v"), ["status", "verdict"]] = "ok", battery.RIGHT
    found = page._battery(table)
    assert len(found["nobody"]) == 12
    assert found["settings"][0] == ("penalty", 10, battery.counts(table[table.setting == "penalty"]))


def test_settings_are_compared_where_all_were_tried():
    tables = made(run("ok", 0.02, of=KITE), run("ok"), run("ok", 0.02, who="b/v"), run("ok", role="rattle4"), run("ok", 0.02, role="saddle-point"))
    found = tables["battery"]
    said = lambda battery: [one["text"] for one in page.answers(tables | {"battery": battery}, VIEW) if one["anchor"] == "settings"]
    assert battery.by_setting(found) == {"penalty": (1, 1), "rattle4": (1, 1), "saddle-point": (0, 1)}  # of a/v, in the cell of rattle4
    [text] = said(found)
    assert "right most often with “penalty” in 1 of 1, “rattle4” in 1 of 1; with “penalty” in 1 of 1 and “saddle-point” in 0 of 1" in text
    assert said(found[found.setting != "rattle4"]) == []


def stale(number, times):
    rows = [{"sequence": "upright", "form": "penalty", "strategy": strategy, "matrices": 91, "pivoting": pivoting, "error_median": 1e-16,
             "error_worst": worst, "repivotings": 0, "time_us_median": time} for strategy, worst, time in zip(
                 ("refactor", "guarded", "factor"), (1e-7, 1e-15, 1e-16), times) for pivoting in ("diagonal", "default", "largest")]
    return record(f"pivots/{number}", {"number": number, "role": "pivots", "program": "stale_pivots", "contenders": []},
                  {"rows": rows, "claims": [{"claim": "it is safe", "holds": number == 1}]})


def test_the_guard_is_compared_with_kept_pivots_over_processes():
    found = made(stale(1, (2.0, 2.4, 6.0)), stale(2, (4.0, 4.8, 12.0)))
    table = found["pivots"].set_index(["strategy", "pivoting"])
    assert table.time_ratio["guarded", "default"] == pytest.approx(1.2) and table.processes["factor", "largest"] == 2
    assert list(found["claims"].holds) == [False] and found["pivots"].record[0] == "pivots/1 pivots/2"
    said = "\n".join(page._pivots(found["pivots"], found["claims"])["said"])
    assert "guarded takes 1.20 times" in said and "factor takes 3.00 times" in said and "10⁻⁷" in said
    missing = record("pivots/x", {"role": "pivots"}, ended="unavailable", reason="it is missing")
    both, alone = made(stale(1, (2.0, 2.4, 6.0)), missing)["pivots"], made(missing)
    assert len(both) == 10 and list(both.status[9:]) == ["unavailable"] and (both.status == "ok").sum() == 9
    assert "A process gave nothing: unavailable: it is missing" in render(alone)


def render(found):
    template = site.template(ROOT / "analysis" / "extremes" / "page.html.j2")
    return template.render(**page.context(found, VIEW), figures={}, schema={}, part="extremes", parts={}, pages={},
                                       question="?", facts=FACTS, libraries=["c"], context=dict.fromkeys(("cpu_model", "num_cpus", "commit", "compiler",
                                                                                        "flags", "kernel", "machine", "dirty"), "c"))


FACTS = {"date": "today", "profile": "smoke", "only": [], "parts": ["extremes"]}


def test_page_and_answers_of_all_columns():
    found = made(trial("plausible"), run("ok"), run("ok", 0.02, who="b/v"), run("ok", role="rattle4"), run("ok", role="saddle-point"), stale(1, (2.0, 2.4, 6.0)))
    text = render(found)
    assert 'class="matrix"' in text
    assert "Silently wrong: 1 run<" in text and "build/mbs simulate &#39;a scene.json&#39;" in text
    assert "holds" in text and "Not measured" not in text
    said = [one["text"] for one in page.answers(found, VIEW)]
    assert said[0].startswith("In 5 runs of 2 mechanisms of 2 kinds: 1 silent wrong and no false alarms.")
    assert any("right most often" in text for text in said) and any("takes 1.2 times as long" in text for text in said)
    assert {one["anchor"] for one in page.answers(found, VIEW)} <= {"battery", "nobody", "settings", "pivots"}
    assert all(f'id="{one["anchor"]}"' in text for one in page.answers(found, VIEW))


def test_a_page_of_nothing_says_so():
    found = made()
    text = render(found)
    assert text.count("Not measured") == 2
    assert [one["anchor"] for one in page.answers(found, VIEW)] == [""]
