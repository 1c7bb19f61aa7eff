# Tables and sentences of the standard problems and of modelling on synthetic records.
from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import numpy
import pytest

from analysis.core.files import StudyError
from analysis.core.records import Record
from analysis.core.registry import Registry
from analysis.scenes import page, tables
from analysis.tests.tables_of import tables_of
from study.scenes import problems, references

NAMES = ("one/a", "two/b", "three/c")
REGISTRY = Registry({"implementations": [{"folder": name.split("/")[0], "available": True, "library": "L", "variants": [
    {"name": name}]} for name in NAMES]})
VIEW = SimpleNamespace(registry=REGISTRY, settings={"rounds": 2})
LISTED = {problem.name: problem for problem in problems.read_list()[1]}


def run(name, who, step, off=0.0, role="compared", status="ok", ended="done"):
    """A run of a standard problem that is `off` its reference, or ends so far from the published values."""
    problem, times = LISTED[name], numpy.linspace(0, LISTED[name].duration, 5)
    if problem.published:
        series = {column: [0.0, value + off] for column, value in references.PUBLISHED[problem.published]().items()}
        times = times[[0, -1]]
    else:
        series = {column: list(values + off) for column, values in references.KNOWN[problem.known](times).items()}
    output = {"status": status, "status_reason": "because", "variables": 2, "energy_drift_max": 1e-7, "passes_per_step": 2.0}
    cell = {"scene": problem.scene, "contenders": [who], "role": role, "settings": ["--step", f"{step:g}"]}
    return Record(f"problems/{role}/{who}-{name}-{step:g}.json", cell, ended, "it died" if ended != "done" else "", 1.0, [], {},
                  output if ended == "done" else {}, {"t": list(times)} | series if ended == "done" else {})


def verdict(name, who, said, ended="done"):
    rows = {"rows": [{"scene": LISTED[name].scene, "implementation": who, "verdict": said, "reason": "why"}]} if ended == "done" else {}
    return Record(f"problems/gate/{who}-{name}.json", {"scene": LISTED[name].scene, "contenders": [who], "role": "gate"}, ended,
                  "it died", 1.0, [], {}, rows)


def modelled(case, number, *times, motion="plausible", off=1e-3):
    """The whole runs and the timed process of a round; a time in µs a step for each of the first implementations."""
    from study.scenes.modelling import slug
    scene, names = f"raw/scenes/scenes/10-{slug(case)}.json", NAMES[:len(times)]
    at = numpy.linspace(0, 1, 4)
    exact = references.four_bar(at, 10)
    whole = [Record(f"modelling/motion.{slug(case)}/{name}.json",
                    {"scene": scene, "contenders": [name], "role": f"motion.{slug(case)}", "settings": []}, "done", "", 1.0, [], {},
                    {"status": motion, "status_reason": "lost", "variables": 22},
                    {"t": list(at)} | {key: list(values + off) for key, values in exact.items()}) for name in names]
    rows = {f"{name}/{scene}": {"stretch_us": [100 * time] * 3, "cpu_us": [100 * time] * 3, "steps": 100} for name, time in zip(names, times)}
    cell = {"scene": scene, "contenders": list(names), "environment": "own|system", "number": number,
            "role": f"time.{slug(case)}", "settings": []}
    return [*(whole if number == 1 else []), Record(f"modelling/time.{slug(case)}/{number}.json", cell, "done", "", 1.0, [], {},
                                                    {"rows": rows})]


made = partial(tables_of, "scenes", tables.build, VIEW)


def test_a_run_is_judged_by_the_closed_form_and_a_failed_one_keeps_its_reason():
    found = made(run("A01", "two/b", 1e-3, off=1e-4), run("A01", "one/a", 1e-3), run("A01", "three/c", 1e-3, ended="timeout"))
    rows = found["problems"].set_index("implementation")
    assert list(rows.index) == list(NAMES)  # as the registry has them
    assert rows.error_rms["one/a"] < 1e-12 and rows.precision["one/a"] == "high"
    assert rows.error_max["two/b"] >= rows.error_rms["two/b"] > 1e-4
    assert (rows.status["three/c"], rows.reason["three/c"], rows.precision["three/c"]) == ("timeout", "it died", "not judged")
    assert numpy.isnan(rows.error_rms["three/c"]) and rows.reference["one/a"] == "closed form"


def test_self_convergence_judges_by_the_other_one_and_is_named_so():
    records = [run("A03", who, step, off=1e-4 * step**2 / 1e-12) for who in NAMES[:2] for step in LISTED["A03"].steps]
    rows = made(*records)["problems"]
    assert set(rows.reference) == {"self-convergence of two implementations"}
    assert rows.error_rms.notna().all() and (rows.groupby("implementation").error_rms.apply(list).iloc[0][0]
                                             > rows.groupby("implementation").error_rms.apply(list).iloc[0][2])
    alone = made(*records[:3])["problems"]
    assert set(alone.precision) == {"not judged"} and alone.error_rms.isna().all()
    lost = made(*records[:5], run("A03", "two/b", LISTED["A03"].steps[2], ended="crashed"))["problems"]
    assert set(lost[lost.implementation == "one/a"].precision) == {"not judged"}


def test_order_extrapolation_and_the_distance_from_what_was_published():
    records = [run("A03", "one/a", step, off=1e-9 + 0.5 * step**2 / 1e-6) for step in LISTED["A03"].steps]
    rows = made(*records)["convergence"]
    assert rows.order.between(1.99, 2.01).all() and rows.order_meaningful.all()
    assert (rows.difference - 1e-9).abs().max() < 1e-12 and len(rows) == 8
    assert made(*records[:2])["convergence"].empty


def test_verdicts_stay_with_the_reason_and_the_sentence_counts_who_serves():
    found = made(verdict("A01", "one/a", "agrees"), verdict("A01", "two/b", "disagrees"), verdict("A01", "three/c", "unsupported"),
                 verdict("A03", "one/a", "", ended="crashed"))
    assert list(found["gate"].verdict) == ["agrees", "disagrees", "unsupported", "crashed"]
    assert found["gate"].reason.iloc[3] == "the check: it died"
    [said] = page.answers(found, VIEW)
    assert said["text"].startswith("The gate: 1 of 3 pairs")
    [(_, good, of, others), _] = page.gate(found["gate"])
    assert (good, of) == (1, 3) and others[0] == ("disagrees", "why", ["two/b"])


def test_a_scene_that_is_no_problem_is_named():
    record = verdict("A01", "one/a", "agrees")
    record.cell["scene"] = "other.json"
    with pytest.raises(StudyError, match="other.json is no standard problem"):
        tables.build([record], VIEW)


def test_cases_are_compared_round_by_round():
    found = made(*(record for number in (1, 2) for case, factor in (("plain", 1), ("springs", 3))
                   for record in modelled(case, number, factor * number, 5.0 * number)))["modelling"]
    rows = found.set_index(["implementation", "case"])
    assert rows.ratio["one/a", "springs"] == pytest.approx(3) == rows.ratio_high["one/a", "springs"]  # though rounds differ twofold
    assert rows.ratio["two/b", "springs"] == pytest.approx(1) and rows.rounds["two/b", "springs"] == 2
    assert rows.position_error["one/a", "plain"] == pytest.approx(1e-3)


def test_a_case_that_was_timed_twice_is_a_control_and_no_case():
    plain = [modelled("plain", number, factor, 5.0)[-1] for number, factor in enumerate((2.0, 3.0, 4.0))]
    for slower in (1.0, 1.1):
        twins = [modelled("plain", number, slower * factor, 5.0)[-1] for number, factor in enumerate((2.0, 3.0, 4.0))]
        again = [replace(one, name=f"again-{one.name}", cell=one.cell | {"role": "time.plain+twin"}) for one in twins]
        found = made(*modelled("plain", 9, 2.0), *plain, *again)
        [row] = found["controls"].to_dict("records")  # of a process the first
        assert (row["implementation"], row["ratio"], row["decided"]) == ("one/a", pytest.approx(slower), slower > 1)
        assert "plain+twin" not in {*found["modelling"].case}


def test_a_motion_that_is_lost_has_a_time_and_no_error():
    records = [*modelled("plain", 1, 2.0), *modelled("no projections", 1, 1.0, motion="diverged")]
    row = made(*records)["modelling"].iloc[1]
    assert row.status == "diverged" and numpy.isnan(row.position_error) and row.ratio == pytest.approx(0.5)
    assert row.ratio_high == numpy.inf  # one process has no interval
    plain, _ = made(*records[:1], *records[2:])["modelling"].itertuples()
    assert plain.rounds == 0 and numpy.isnan(plain.ratio) and numpy.isnan(plain.step_us)


def test_sentences_and_page_of_a_small_set_and_of_none():
    records = [run(name, who, step, role="compared" if who != "three/c" else "everyone", status=status)
               for name in ("A01", "double four-bar") for who in NAMES for step, status in ((1e-3, "degraded"), (5e-4, "ok"))]
    records += [record for number in (1, 2) for case in ("plain", "springs", "no projections, before singular")
                for record in modelled(case, number, 1.0, 2.0)]
    for found in (made(*records), made()):
        known = page.context(found, VIEW)
        said = page.answers(found, VIEW)
        assert all(one["text"].endswith(".") for one in said)
        assert bool(known["finest"]) == ("Not measured" not in said[0]["text"])
    assert [title for title, _, _ in page.everyone(made(*records)["problems"])] == ["Simple pendulum", "Double four-bar"]


@pytest.mark.parametrize("value, text", [(0.5, "0.50000000"), (-1234.5, "-1234.5000"), (0.0, "0"), (numpy.nan, "–"),
                                         (1.2e-3, "0.0012000000")])
def test_positions_have_eight_digits(value, text):
    assert page.digits(value) == text
