# Rows, times at equal error, figures and page of the engines on synthetic records.
import dataclasses
from functools import partial
from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy
import pytest

from analysis.core.records import Record
from analysis.core.registry import Registry
from analysis.engines import andrews, equal_error, figures, page, tables
from analysis.engines.runs import row
from analysis.engines.subjects import FLOOR, PENDULUM_S, positions, subject_of
from analysis.tests.tables_of import tables_of

LONG, SHORT = "four-bar-2", "four-bar-2-regular"
VIEW = SimpleNamespace(registry=Registry({"implementations": [
    {"folder": "lib", "available": True, "library": "Some", "variants": [{"name": "lib/a"}]},
    {"folder": "compiled_ldl", "available": True, "library": "none", "variants": [{"name": equal_error.CHAINS}, {"name": equal_error.FRONTS}]}]}))


def theirs(engine, step, time, error, status="ok", subject=LONG, role="engine", number=0, options=(), native=False, **more):
    cell = {"program": f"{'../build-engines/' if native else ''}study/engines/engine_{engine}", "role": role, "number": number,
            "settings": ["--loops", "2", "--duration", "5", "--setting", *options, f"step={step:g}", "--json"]}
    output = {"status": status, "status_reason": "" if status == "ok" else "because", "position_error_max": error,
              "time": time, "repeats": 1, "version": "1.0", "complaints": 0, "first_complaint": ""} | more
    return Record(f"{subject}/{role}/{engine}-{step}-{status}-{number}-{native}", cell, "done", "", 0.1, [], {}, output)


def mine(name, step, time, error, status="ok", subject=LONG, role="ours", number=0, words=("--scheme", "rattle")):
    cell = {"program": "mbs", "role": role, "number": number, "contenders": [name],
            "settings": [*words, "--step", f"{step:g}", "--duration", "5", "--judge-every", "1"]}
    output = {"status": status, "status_reason": "because", "position_error_max": error, "steps": 100, "duration": 5.0,
              "step_us": {"mean": 5e4 * time}, "least_us": None, "repeats": 1}
    return Record(f"{subject}/{role}/{name}-{step}-{number}-{words}", cell, "done", "", 0.1, [], {}, output)


def rounds(runs, factor=1.0):
    """Two rounds of runs, at `factor` and 1.1 `factor` times their untimed time."""
    return [make(*arguments[:2], factor * slower * arguments[2], *arguments[3:], role="round", number=number, **more)
            for number, slower in ((1, 1.0), (2, 1.1)) for make, arguments, more in runs]


def dropped(engine, step):
    return dataclasses.replace(theirs(engine, step, 0.1, 0.3), status="dropped", reason="the budget", output={})


PAPER = {"words": ("--scheme", "penalty", "--penalty", "1e8")}
RUNS = [(theirs, ("ode", 1e-2, 1.0, 5e-2), {}), (theirs, ("ode", 5e-3, 2.0, 6e-3), {}), (theirs, ("ode", 1e-3, 9.0, 4e-6), {}),
        (theirs, ("bullet", 1e-2, 3.0, 2e-4), {"first_complaint": "LCP failed", "options": ("model=bodies",)}),
        (theirs, ("ode", 1e-2, 1.0, 5e-3), {"subject": SHORT}), (theirs, ("ode", 1e-2, 0.5, 5e-2), {"native": True}),
        (mine, (equal_error.CHAINS, 1e-2, 0.1, 2e-2), {}), (mine, (equal_error.CHAINS, 5e-3, 0.2, 1e-4), {}),
        (mine, (equal_error.FRONTS, 5e-3, 0.4, 1e-4), {}), (mine, ("lib/a", 1e-2, 2.0, 3e-2), {}),
        (mine, ("lib/a", 5e-3, 3.0, 8e-3), PAPER), (mine, (equal_error.CHAINS, 1e-2, 0.5, 4e-3), {"subject": SHORT})]
LOST = [theirs("ode", 2e-2, 0.1, 0.3, "wrong-branch"), theirs("dart", 1e-2, 0.1, 0.3, "diverged"), dropped("dart", 5e-3),
        mine("lib/a", 1e-2, 0.001, 9.0, "diverged", subject=SHORT)]
ABSENT = Record(f"{LONG}/engine/x", {"program": "study/engines/engine_simbody", "role": "engine", "number": 0, "settings": []},
                "unavailable", "libsimbody-dev is not installed (study/setup --engines)", 0.0, [], {})


made = partial(tables_of, "engines", tables.build, VIEW)


@pytest.fixture(scope="module")
def found():
    return made(*(make(*arguments, **more) for make, arguments, more in RUNS), *LOST, ABSENT, *rounds(RUNS, 2.0))


def one(found, engine, limit, side, subject=LONG):
    table = found["equal_error"]
    [row] = table[(table.subject == subject) & (table.engine == engine) & (table.limit == limit) & (table.side == side)].to_dict("records")
    return row


def test_rows_say_who_ran_what():
    ode = row(theirs("ode", 5e-3, 2.0, 6e-3, options=("erp=0.8", "method=quickstep")))
    assert (ode["name"], ode["setting"], ode["over"], ode["value"]) == ("ode", "erp 0.8, method quickstep", "step", 5e-3)
    assert row(theirs("ode", 5e-3, 2.0, 1e-20))["error"] == FLOOR
    assert row(theirs("ode", 5e-3, 2.0, 1.0, native=True))["name"] == "ode+native"
    ours = row(mine("lib/a", 5e-3, 3.0, 8e-3, words=("--penalty", "1e8", "--scheme", "penalty", "--geometric-stiffness")))
    assert ours["setting"] == "penalty, penalty 1e8, geometric-stiffness" and ours["time"] == pytest.approx(3.0)
    assert (ours["side"], ours["subject"], ours["value"]) == ("ours", LONG, 5e-3)
    assert numpy.isnan(row(LOST[0])["error"]) and row(LOST[0])["status"] == "wrong-branch"
    assert row(mine("lib/a", 1, 1, float("nan")))["status"] == "diverged"  # whatever the run says of itself


def test_ours_is_the_fastest_of_a_side_at_the_engine_s_own_error_or_a_smaller_one(found):
    row = one(found, "ode", 1e-1, "chains")
    assert (row["engine_value"], row["implementation"], row["step"]) == (1e-2, equal_error.CHAINS, 1e-2)
    assert row["ratio"] == pytest.approx(10) and row["low"] == pytest.approx(10)  # the same rounds: no spread
    assert row["engine_time"] == pytest.approx(2.1)  # times of the rounds, not of the curves
    assert one(found, "ode", 1e-1, "library")["ratio"] == pytest.approx(0.5)
    assert one(found, "ode", 1e-1, "paper")["setting"] == "penalty, penalty 1e8"
    assert one(found, "bullet", 1e-3, "fronts")["ratio"] == pytest.approx(7.5)


def test_what_ours_does_not_reach_keeps_its_row_and_its_reason(found):
    assert one(found, "ode", 1e-5, "chains")["reason"] == "not reached: its smallest error is 0.0001 m"
    assert numpy.isnan(one(found, "ode", 1e-5, "chains")["ratio"])
    assert one(found, "ode", 1e-2, "library", SHORT)["reason"] == "not reached: it lost the motion"
    assert one(found, "ode", 1e-2, "paper", SHORT)["reason"] == "none of it takes part"
    ours = tables.frame([row(make(*arguments, **more)) for make, arguments, more in RUNS[6:8]])
    assert equal_error.unreached(ours.assign(status=["ok", "dropped"]), 1e-3).startswith("not measured: the budget cut 1 of its curves")
    assert equal_error.unreached(ours.assign(status=["unsupported", "dropped"]), 1e-3).startswith("not served")
    assert one(found, "ode", 1e-2, "library")["reason"] == "not reached: its smallest error is 0.008 m"


def test_the_build_with_our_flags_is_an_engine_of_its_own_and_compared_with_the_package(found):
    [row] = found["native"].to_dict("records")
    assert row["ratio"] == pytest.approx(2.0) and row["engine"] == "ode" and row["native_time"] == pytest.approx(1.05)
    assert one(found, "ode+native", 1e-1, "chains")["ratio"] == pytest.approx(5.0)
    assert "2 times as long" in page.of_native(found["native"])


@pytest.mark.parametrize("slower, decided", [(1.0, False), (1.1, True)])
def test_a_run_that_is_there_twice_is_a_control_and_in_no_round(found, slower, decided):
    again = [dataclasses.replace(one, name=f"{one.name}-again", cell=one.cell | {"role": "control"}) for one in rounds(RUNS[:1], 2.0 * slower)]
    assert numpy.isnan(row(again[0])["error"])  # as in rounds, which keep no motion
    with_twins = made(*(make(*arguments, **more) for make, arguments, more in RUNS), *LOST, ABSENT, *rounds(RUNS, 2.0), *again)
    [control] = with_twins["controls"].to_dict("records")
    assert (control["scene"], control["ratio"], control["decided"]) == (LONG, pytest.approx(slower), decided) and "ode" in control["implementation"]
    assert all(with_twins[name].equals(found[name]) for name in ("rounds", "equal_error", "engines", "ours")) and found["controls"].empty


def test_candidates_are_the_fastest_of_each_side():
    engines = tables.frame([row(make(*arguments, **more)) for make, arguments, more in RUNS[:4]])
    ours = tables.frame([row(make(*arguments, **more)) for make, arguments, more in RUNS[6:11]])
    theirs_found, ours_found = equal_error.candidates(engines, ours, VIEW.registry.own)
    assert len(theirs_found) == 4 and list(ours_found.index) == [0, 1, 2, 3, 4]
    assert equal_error.least_error(engines) == 4e-6 and equal_error.least_error(engines[:0]) == 0.0
    again, _ = equal_error.candidates(engines[engines.name == "ode"], tables.frame([]), ())
    assert set(again.name) == {"ode"}


def test_figures_page_and_answers(found):
    drawn = figures.draw(found, VIEW)
    assert set(drawn) == {"singular", "regular"}
    plt.close("all")
    known = page.context(found, VIEW)
    assert known["measured"] and known["subjects"] == {LONG: "N = 2", SHORT: "N = 2, first 0.6 s"}
    assert known["summaries"]["library"][LONG]["ode"] == {
        "low": 0.5, "high": 0.5, "timed": 1, "lacking": ["2 of 3 errors not reached"]}
    assert (known["summaries"]["library"][SHORT]["bullet"], known["summaries"]["library"][LONG]["dart"]) == ("takes no part", "cut after 1 value")
    assert [(row["side"], row["engine"], round(row["ratio"], 3)) for row in known["behind"]][:2] == [
        ("paper", "ode+native", 0.167), ("library", "ode+native", 0.25)]
    assert ("chains", LONG, "not reached: its smallest error is 0.0001 m", [4e-6]) in known["unreached"]
    assert any("Simbody: left out, libsimbody-dev is not installed" in text for text in known["says"])
    texts = [one["text"] for one in page.answers(found, VIEW)]
    assert texts[0].startswith("Our code for chains: timed at 4 of 5 errors that engines reach, shown to be faster in 4 of these; ")
    assert texts[0].endswith("; 1 of 5 errors not reached.") and "Open Dynamics Engine alone" in texts[-1]
    assert "1 of its 1 curves were cut" in next(text for text in known["says"] if text.startswith("DART"))
    single = found["equal_error"].assign(low=0.0, high=numpy.inf)
    assert "shown to be faster in 0 of these (4 have a single round" in page.of_side(single, "chains")


def test_a_sentence_on_andrews_mechanism():
    runs = [(theirs, ("ida", 1e-4, 4.0, 5e-4), {"subject": "andrews"}), (theirs, ("ida", 1e-3, 0.1, 1e-3), {"subject": "andrews"}),
            (theirs, ("ida", 1e-5, 9.0, 1e-6), {"subject": "andrews"}),
            (mine, ("lib/a", 1e-4, 2.0, 1e-4), {"subject": "andrews"}), (mine, (equal_error.FRONTS, 1e-4, 1.0, 1e-7), {"subject": "andrews"})]
    motion = numpy.moveaxis(andrews.positions(numpy.array([0.0, 0.03])), 2, 0)  # time, point, axis
    table = made(*(record for make, arguments, more in runs for record in [known(make(*arguments, **more), motion)]), *rounds(runs))
    [text] = page.of_andrews(table["equal_error"])
    assert text == ("SUNDIALS IDA on Andrews' mechanism, at its errors from 0.0005 to 10⁻⁶ m, takes 4 to 9 times as long as our "
                    "general code; 2 times as long as the fastest library (1 of 2 errors not reached).")


def known(record, motion):
    """The record of a run on Andrews' mechanism, whose error its points say."""
    error = record.output["position_error_max"]
    moved = motion + [[error, 0]] + numpy.zeros((1, 4, 1))
    record.output["outputs"] = {"t": [0.0, 0.03], "points": moved.reshape(2, 8).tolist()}
    record.series.update({"t": [0.0, 0.03]} | {f"{point}.{axis}": moved[:, place, at].tolist() for place, point in enumerate("EPSU")
                                               for at, axis in enumerate("xy")})
    return record


def test_without_engines_the_page_says_what_is_missing():
    found = made(ABSENT)
    assert [one["text"] for one in page.answers(found, VIEW)] == ["Not measured: libsimbody-dev is not installed (study/setup --engines)."]
    known = page.context(found, VIEW)
    assert not known["measured"] and known["setting_up"] == "study/setup --engines"
    assert set(figures.draw(found, VIEW)) == {"singular", "regular"}
    plt.close("all")


def test_the_motion_of_the_double_pendulum():
    times = numpy.linspace(0, PENDULUM_S, 401)
    first, second = positions(times)
    assert numpy.allclose([first[:, 0], second[:, 0]], [[1, 0], [2.5, 0]])
    assert numpy.allclose(numpy.hypot(*first), 1) and numpy.allclose(numpy.hypot(*(second - first)), 1.5)
    velocities = [numpy.gradient(one, times, axis=1, edge_order=2) for one in (first, second)]
    energy = 0.0  # of thin rods: m/6 (va va + va vb + vb vb) between ends a and b, and m g y of the middle
    for mass, (a, va), (b, vb) in ((1.0, (0 * first, 0 * first), (first, velocities[0])), (1.5, (first, velocities[0]), (second, velocities[1]))):
        energy += mass / 6 * (va * va + va * vb + vb * vb).sum(0) + mass * 9.81 * (a[1] + b[1]) / 2
    assert numpy.ptp(energy[2:-2]) < 5e-3 * 20  # differences of positions give the velocities
    assert numpy.hypot(*(positions(times) - positions(times, 2e-3)).swapaxes(0, 1)).max() < FLOOR
    subject = subject_of("double-pendulum")
    series = {"t": list(times)} | {f"{point}.{axis}": list(places[place]) for point, places in (
        ("B", first), ("C", second)) for place, axis in enumerate("xy")}
    record = SimpleNamespace(output={}, series=series)
    assert subject.error(record, False) == 0
    series["C.y"] = list(second[1] + 1e-3)
    assert subject.error(record, False) == pytest.approx(1e-3)
    series["C.y"][3] = None
    assert numpy.isnan(subject.error(record, False))  # never smaller for what is missing
    points = numpy.moveaxis(numpy.array([first, second]), 2, 0).reshape(401, 4)
    record.output = {"outputs": {"t": times.tolist(), "points": (points + [0, 0, 0, 1e-4]).tolist()}}
    assert subject.error(record, True) == pytest.approx(1e-4)
    end, after = positions(numpy.array([PENDULUM_S, 75 * 0.0266667])).transpose(2, 0, 1)
    assert numpy.hypot(*(after - end).T).max() < 1e-4  # a rounded step ends 2.5e-6 s later


@pytest.mark.parametrize("name, loops, regular, duration, title", [
    ("four-bar-10", 10, False, 5.0, "N = 10"), ("four-bar-40-regular", 40, True, 0.6, "N = 40, first 0.6 s"),
    ("double-pendulum", 0, True, 2.0, "double pendulum"), ("andrews", 0, True, 0.03, "Andrews' mechanism")])
def test_subjects_are_known_by_their_column(name, loops, regular, duration, title):
    subject = subject_of(name)
    assert (subject.loops, subject.regular, subject.duration, subject.title) == (loops, regular, duration, title)
