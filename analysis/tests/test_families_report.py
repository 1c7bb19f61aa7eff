# Who is fastest on real mechanisms: tables, figure, page and sentences on synthetic records.
from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy
import pandas
import pytest
import yaml

from analysis.core import controls, site
from analysis.core.files import ROOT
from analysis.families import bounds, by_hand, defaults, figures, page, rule, tables, times
from analysis.tests.test_limit_report import REGISTRY, about, bench, gate
from analysis.tests.tables_of import tables_of

SCENES = ["ladder:2", "grid:3x3"]
VIEW = SimpleNamespace(registry=REGISTRY, settings={"processes": {"penalty": 3, "saddle-point": 2}, "scenes": SCENES}, context={"cpu_model": "P"})


def described(scene):
    found = about(scene)
    order = {"factor_nonzeros": 20, "per_column": 2.0, "flops": 90, "height": 3, "widest": 4}
    return replace(found, output=found.output | {"variables": 10, "constraints": 5, "elimination": {"orderings": {"AMD": order, "natural": None}}})


def asked(scene, **verdicts):
    return [replace(one, cell=one.cell | {"role": "penalty-gate"}) for one in gate("any", scene, **verdicts)]


made = partial(tables_of, "families", tables.build, VIEW)


def measured(scene, number, **times):
    return bench("penalty", scene, number, **times)


def small():
    return made([described(scene) for scene in SCENES],
                [bench("penalty-look", scene, 1, one_a=2.0, one_b=9.0, two_c="unsupported: no", own_x=1.0) for scene in SCENES],
                asked(SCENES[0], one_a="agrees", one_b="agrees", own_x="agrees"), asked(SCENES[1], one_a="agrees", one_b="agrees", own_x="disagrees"),
                [measured(SCENES[0], number, one_a=2.0, own_x=1.0) for number in (1, 2, 3)],
                [measured(SCENES[1], number, one_a=2.0 + 0.001 * number, one_b=2.01, own_x=1.0) for number in (1, 2, 3)])


def test_each_family_of_the_full_profile_has_a_mark_of_its_own():
    scenes = yaml.safe_load((ROOT / "study" / "profiles" / "full.yaml").read_text())["parts"]["families"]["scenes"]
    assert len({tables.family_of(scene) for scene in scenes}) <= len(set(figures.FORMS)) == len(figures.FORMS)


def test_who_is_slow_and_agrees_keeps_the_time_of_the_look_and_who_disagrees_has_none():
    looks = bench("penalty-look", SCENES[0], 1, one_a=2.0, one_b=9.0, two_c=8.0, own_x=1.0)
    times = [measured(SCENES[0], number, one_a=2.0, own_x=1.0) for number in (1, 2, 3)]
    said = asked(SCENES[0], one_a="agrees", own_x="agrees", one_b="agrees", two_c="disagrees")
    rows = made(described(SCENES[0]), looks, said, times)["scenes"].set_index("implementation")
    assert (rows.status["one/b"], rows.verdict["one/b"], rows.look_us["one/b"]) == ("slower", "agrees", 9.0)
    assert (rows.status["two/c"], rows.verdict["two/c"]) == ("disagrees", "disagrees") and rows.isna().to_rival["two/c"]
    unasked = made(described(SCENES[0]), looks, asked(SCENES[0], one_a="dropped"))["scenes"].set_index("implementation")
    assert set(unasked.status[["one/a", "one/b"]]) == {"dropped"} and unasked.reason["one/b"].endswith("before the gate")
    assert unasked.loc[["one/a", "one/b"], ["step_us", "look_us"]].isna().all(axis=None)  # nobody saw their motion there


def test_libraries_and_all_have_their_winners_among_those_that_agree():
    found = small()
    winners = found["winners"].set_index(["scene", "layer"])
    assert list(dict.fromkeys(found["winners"].scene)) == SCENES  # as the profile has them
    first = winners.loc[SCENES[0]]
    assert (first.winner["libraries"], first.winner["all"]) == ("one/a", "own/x") and first.margin["all"] == pytest.approx(2)
    assert bool(first.decided["all"]) and first.step_us["libraries"] == 2.0
    second = winners.loc[SCENES[1]]
    assert second.winner["all"] == "one/a" and set(second.equivalent["libraries"].split()) == {"one/a", "one/b"}
    rows = found["scenes"].set_index(["scene", "implementation"])
    assert rows.to_rival[SCENES[0], "own/x"] == pytest.approx(0.5) and rows.look_us[SCENES[0], "own/x"] == 1.0
    assert (rows.status[SCENES[1], "own/x"], rows.status[SCENES[0], "two/c"]) == ("disagrees", "unsupported")
    assert rows.status[SCENES[0], "one/b"] == "slower"


def test_figure_page_and_sentences_of_a_small_set_and_of_none():
    for found in (small(), made()):
        for figure in figures.draw(found, VIEW).values():
            plt.close(figure)
        page.context(found, VIEW)
        assert all(one["text"].endswith(".") for one in page.answers(found, VIEW))
    texts = [one["text"] for one in page.answers(small(), VIEW)]
    assert "one/a on 2, one/b on 1" in texts[0] and "faster than the fastest library on 1 of 1" in texts[1]
    [case] = page.cases(small(), VIEW)  # too few mechanisms for a rule
    assert case["take"] == "fastest: own/x on 1 of 1 scenes; 2 to 2 times as fast as the fastest library, median 2"
    assert page.cases(made(), VIEW) == []


def test_a_scene_where_nobody_agrees_has_its_reason():
    found = made(described(SCENES[0]), bench("penalty-look", SCENES[0], 1, one_a="failed: it died"))
    row = found["winners"].iloc[0]
    assert row.winner == "" and row.reason == "failed: it died"


def test_controls_have_rows_and_their_twins_no_place():
    found = made(described(SCENES[0]), bench("penalty-look", SCENES[0], 1, one_a=2.0), [measured(SCENES[0], number, **{"one_a": 2.0, "one_a+twin": 2.0 + 0.001 * number}) for number in (1, 2, 3)])
    [row] = found["controls"].to_dict("records")
    assert (row["scene"], row["scheme"], row["implementation"], row["decided"]) == (SCENES[0], "penalty", "one/a", False) and row["ratio"] > 1
    assert list(found["scenes"].implementation) == ["one/a"] and controls.said(found["controls"]).startswith("Controls, where nothing differs: 0 of 1")


@pytest.mark.parametrize("path, said", [
    ("analysis/map", "by Holm"), ("analysis/families", "(Holm's procedure)"), ("analysis/accuracy", "uncorrected for their number"), ("study/tools/merge", "by Holm")])
def test_pages_say_whether_their_intervals_are_corrected_for_their_number(path, said):
    assert said in (ROOT / path / "page.html.j2").read_text(encoding="utf-8")


def test_orders_of_elimination_have_rows_where_they_were_computed():
    rows = small()["orderings"]
    assert list(rows.scene) == SCENES and set(rows.ordering) == {"AMD"} and set(rows.per_column) == {2.0}


def mechanisms(disturb=lambda family, name: 1.0):
    """Six families: one/a is the fastest where the factor has few operations, one/b where it has many."""
    features = dict.fromkeys((*times.FEATURES, *rule.ALONE), 1.0) | {"passes": 2.0, "saddle": 0.0}
    known, rows = [], []
    for family, column in (("chain", 3), ("tree", 2), ("grid", 6), ("beam", 30), ("block", 40), ("shell", 50)):
        for size in (10, 100, 1000):
            scene, flops = f"{family}:{size}", column**2 * size
            known.append({"family": family, "scene": scene, "record": f"r/{scene}"} | features | {
                "n": float(size), "per_column": float(column), "factor": column * size, "flops": flops, "tangent": 3 * size, "jacobian": 2 * size})
            us = {"one/a": 0.5 * size + 0.002 * flops, "one/b": 1.2 * size + 0.0001 * flops}
            us = {name: time * disturb(family, name) for name, time in us.items()}
            us["own/x"] = 0.5 * min(us.values())
            rows += [{"family": family, "scene": scene, "scheme": "penalty", "variables": size, "implementation": name, "status": "ok",
                      "verdict": "agrees", "passes": 2.0, "step_us": time, "look_us": time, "to_rival": time / min(us["one/a"], us["one/b"]), "record": f"r/{scene}"}
                     for name, time in us.items()]
    found = {"mechanisms": pandas.DataFrame(known), "scenes": pandas.DataFrame(rows)}
    fastest = found["scenes"][found["scenes"].to_rival == 1]
    found["winners"] = fastest.assign(layer="libraries", winner=fastest.implementation)
    return found | rule.judged(found, REGISTRY)


def test_the_rule_compares_times_and_holds_on_families_left_out():
    tables = mechanisms()
    found = rule.document(tables)
    assert set(found["candidates"]["penalty"]) == {"one/a", "one/b"}
    assert found["held"]["families"] == 6 and found["held"]["scenes"] == found["held"]["timed"] == 18
    assert found["held"]["mean_loss"] == 0 and found["held"]["within"] == found["held"]["inside"] == 1
    assert found["times"]["own/x"]["layer"] == "own" and found["times"]["one/a"]["penalty"]["low"] <= 1
    assert {row["scene"]: row["fastest"] for row in found["scenes"]}["beam:10"] == "one/b"
    assert rule.missed(tables["held"]).empty
    assert [(form, name) for form, name, text in page._formulas(tables["steps"]) if text.startswith("passes × (")] == [("penalty", "one/a"), ("penalty", "one/b")]


def test_a_rule_is_carried_to_what_was_measured_elsewhere():
    here, there = mechanisms(), mechanisms(lambda family, name: 5.0 if (family, name) == ("shell", "one/b") else 1.0)
    assert set(rule.carried((here, REGISTRY), (here, REGISTRY)).values()) == {0.0}
    found = rule.carried((here, REGISTRY), (there, REGISTRY))
    assert len(found) == 18 and {scene for (_, scene), loss in found.items() if loss > 0} <= {"shell:10", "shell:100", "shell:1000"} and max(found.values()) > 0


def test_dense_and_sparse_ones_are_compared_though_known_families_hardly_ask_for_one(monkeypatch):
    monkeypatch.setitem(REGISTRY.variants["one/b"], "dense", True)
    held = mechanisms(lambda family, name: {"block": 2.7, "shell": 1.0}.get(family, 3.0) if name == "one/b" else 1.0)["held"]
    assert set(held[held.family == "shell"].chosen) == {"one/b"}


@pytest.mark.parametrize("per_flop, compared", [(1e-3, ["one/a", "one/b"]), (5e-3, ["one/a"])])
def test_the_sparse_one_that_is_predicted_the_fastest_where_most_is_to_do_is_compared(per_flop, compared):
    scenes = ["chain:10", "chain:20", "grid:10", "grid:20"]
    data, found = object.__new__(rule._Data), object.__new__(rule._Rule)
    data.registry, data.family = REGISTRY, {scene: scene.partition(":")[0] for scene in scenes}
    data.features = pandas.DataFrame({"n": [10.0, 20.0, 10.0, 20.0], "flops": [10.0, 20.0, 1e3, 2e4]}, index=scenes)
    data.losses = {"penalty": pandas.DataFrame({"one/a": [0.0, 0.0, 0.0, 0.001], "one/b": [1.0, 1.0, 1.0, 0.0]}, index=scenes)}
    found.models = {("penalty", "one/a"): {"n": 1.0, "flops": 2e-3}, ("penalty", "one/b"): {"n": 1.2, "flops": per_flop}}
    assert found._compared(data) == {"penalty": compared}


def test_a_time_is_the_sum_of_its_terms():
    features = mechanisms()["mechanisms"]
    us = 3.0 * features.n + 0.02 * features.passes * features.flops
    for known in ({}, {"flops": 0.01}):  # given, and taken off what is fitted
        found = times.model(("n", "passes*flops", "passes*n", "1"), features, us, numpy.ones(len(us)), known)
        assert times.predicted(found, features) == pytest.approx(us.to_numpy(), rel=1e-6) and min(found.values()) > 0
        assert found.items() >= known.items()


def test_dense_ones_factorize_in_the_saddle_point_form_as_in_the_penalty_form():
    penalty = {"passes*n": 1.0, "passes*springs": 2.0, "passes*n*n*n": 3.0}
    assert times.as_penalty(penalty, True) == {"saddle_passes*springs": 2.0, "saddle_passes*stiff*n*n*n": 3.0}
    assert times.as_penalty(penalty, False) == {"saddle_passes*springs": 2.0}
    tables = mechanisms()
    stiff = tables["mechanisms"].family.isin(["chain", "beam"])
    tables["mechanisms"] = tables["mechanisms"].assign(stiff=stiff.astype(float), saddle_passes=2.0)
    penalty = tables["scenes"].merge(tables["mechanisms"][["scene", "stiff", "n"]], on="scene")
    twice = penalty.assign(scheme="saddle-point", step_us=penalty.step_us + penalty.stiff * 0.001 * penalty.n**3)
    scenes = pandas.concat([penalty.assign(step_us=penalty.step_us + 0.001 * penalty.n**3), twice], ignore_index=True)
    scenes["to_rival"] = scenes.step_us / scenes[scenes.implementation != "own/x"].groupby(["scheme", "scene"]).step_us.min().reindex(
        pandas.MultiIndex.from_frame(scenes[["scheme", "scene"]])).to_numpy()
    dense = SimpleNamespace(**vars(REGISTRY) | {"variants": {name: one | {"dense": True} for name, one in REGISTRY.variants.items()}})
    models = rule._Rule(rule._Data(tables | {"scenes": scenes}, dense)).models
    assert all(models["saddle-point", name]["saddle_passes*stiff*n*n*n"] == models["penalty", name]["passes*n*n*n"] > 0 for name in ("one/a", "one/b"))


def test_the_front_page_has_the_rule_by_hand_and_that_of_describe():
    tables = mechanisms()
    described, parted, own = page.cases(tables, VIEW)
    assert parted["case"] == "By hand, penalty form" and parted["take"].startswith(
        "one/b if c ≥ 10; else one/a (c: non-zeros of L per column); on families left out")
    assert all("0.0 % slower than the fastest library on average, 0 % at worst" in row["take"] for row in (parted, described))
    assert described["take"].endswith("(18 cases)") and own["take"].startswith("fastest: own/x on 18")


def test_cases_by_hand_are_told_by_letters():
    case = {"scheme": "penalty", "scenes": 1} | {f"{end}_{name}": None for name in by_hand.SHOWN for end in ("least", "below")}
    rows = [case | {"library": "one/a", "below_dense": 26.0, "below_per_column": 20.0}, case | {"library": "one/b", "below_dense": 26.0, "least_per_column": 20.0},
            case | {"library": "one/c", "least_dense": 26.0, "least_per_column": 8.0}, case | {"library": "one/a", "least_dense": 26.0, "below_per_column": 8.0}]
    below = "one/b if p < 26 and c ≥ 20; one/c if p ≥ 26"
    meant = " (p: operations to factorize the tangent, in % of those of a full one; c: non-zeros of L per column)"
    assert page._taken(pandas.DataFrame(rows)) == below + " and c ≥ 8; else one/a" + meant
    assert page._taken(pandas.DataFrame([*rows[:2], case | {"library": "one/c", "least_dense": 26.0}])) == below + "; else one/a" + meant
    assert page._taken(pandas.DataFrame([case | {"library": "one/c"}])) == "one/c"


def test_cases_by_hand_part_where_the_fastest_changes():
    cost, at, below, above = by_hand.limit(numpy.array([30.0, 1.0, 2.0, 20.0]), numpy.array([[1.0, 0.0], [0.0, 1.0], [0.0, 1.0], [1.0, 0.0]]))
    assert (cost, at, below, above) == (0.0, 6.0, 0, 1)
    assert by_hand.limit(numpy.array([2.0, 2.0]), numpy.array([[1.0, 0.0], [0.0, 0.5]]))[:3] == (0.5, numpy.inf, 1)


def test_a_rule_is_judged_on_what_it_was_not_fitted_on():
    """A machine of its own kind, on which all others are no guide, shows as a loss and as a time that is missed."""
    held = mechanisms(lambda family, name: 10.0 if (family, name) == ("tree", "one/a") else 1.0)["held"]
    odd = held[held.family == "tree"]
    assert set(odd.chosen) == {"one/a"} and (odd.loss > 2).all() and (odd.step_us > odd.high_us).all()
    assert {"tree"} <= set(rule.missed(held).family)


def test_times_are_predicted_by_the_passes_of_the_timed_steps_where_mbs_describe_would_count_them():
    tables = mechanisms()
    rows = tables["scenes"].scene.isin(["grid:10", "grid:1000"])
    tables["scenes"].loc[rows, ["passes", "step_us", "look_us"]] *= 3.5  # both are 2 by `mechanisms`
    tables["mechanisms"].loc[tables["mechanisms"].scene == "grid:1000", "flops"] = 10 * rule.COUNTABLE
    held = rule.judged(tables, REGISTRY)["held"].set_index("scene")
    ratio = held.predicted_us / held.step_us
    assert ratio["grid:10"] == pytest.approx(1.0, abs=0.05) and ratio["grid:1000"] != pytest.approx(1.0, abs=0.2)


def without(tables, rows, **changed):
    """The tables, where rows of contenders have no times."""
    scenes = tables["scenes"].copy()
    where = [(row.scene, row.implementation) in rows for row in scenes.itertuples()]
    scenes.loc[where, ["step_us", "look_us", "to_rival"]] = numpy.nan
    for name, value in changed.items():
        scenes.loc[where, name] = value
    return tables | {"scenes": scenes}


def test_a_loss_is_of_the_look_where_there_are_no_other_times():
    tables = mechanisms(lambda family, name: 3.0 if (family, name) == ("tree", "one/a") else 1.0)
    odd = (tables["scenes"].family == "tree") & (tables["scenes"].implementation == "one/a")
    tables["scenes"].loc[odd, "status"] = "slower"
    looked = rule.judged(tables, REGISTRY)["held"].set_index("scene")
    assert set(looked.known_by[looked.family == "tree"]) == {"look"} and set(looked.known_by[looked.family != "tree"]) == {"turns"}
    assert looked.loss["tree:10"] > 0.2 and looked.chosen["tree:10"] == "one/a"
    left = rule.judged(without(tables, [("tree:1000", "one/a")], status="excluded", verdict=""), REGISTRY)["held"].set_index("scene")
    assert left.known_by["tree:1000"] == "smaller" and left.loss["tree:1000"] == left.loss["tree:100"]


def test_a_loss_of_what_was_never_tried_is_not_known_and_that_of_a_failure_is_large():
    tables = mechanisms()
    everywhere = [(f"tree:{size}", "one/a") for size in (10, 100, 1000)]
    found = rule.judged(without(tables, everywhere, status="excluded", verdict=""), REGISTRY)
    held = found["held"].set_index("scene")
    assert held.loc["tree:10", ["chosen", "known_by"]].to_list() == ["one/a", ""] and numpy.isnan(held.loss["tree:10"])
    assert rule.summary(found["held"])["unknown"] == 3 and set(rule.missed(found["held"]).scene) == {scene for scene, _ in everywhere}
    mean, worst, *_ = bounds._rule(found["held"])
    assert mean[3] is None and worst[3] is None and "of 15 of 18 choices" in mean[2]  # neither held nor broken
    wrong = rule.judged(without(tables, everywhere, status="disagrees", verdict="disagrees"), REGISTRY)["held"].set_index("scene")
    assert wrong.known_by["tree:10"] == "failed" and wrong.loss["tree:10"] == rule.FAILED


def test_numbers_alone_are_compared():
    rows = mechanisms()["alone"].set_index("feature")
    assert rows.worst_loss["per_column"] == 0 < rows.worst_loss["n"]


def test_bounds_say_what_does_not_hold_and_where():
    found = mechanisms()
    scenes = found["scenes"].replace({"implementation": {"own/x": "compiled_own/x"}})
    scenes.loc[scenes.scene == "grid:10", "verdict"] = "disagrees"
    scenes.loc[(scenes.scene == "beam:100") & (scenes.implementation == "compiled_own/x"), "to_rival"] = 0.8
    rows = {what: (text, holds) for what, _, text, holds in reversed(bounds.bounds(found | {"scenes": scenes}))}  # the first of those of one name
    assert rows["worst loss of the rule by hand, on families left out"] == ("0.0 %", True)
    assert rows["they are inside the range that is given"] == ("100 % of 18", True)
    assert rows["who has a time agrees with the reference, in both forms"][1] is False
    text, holds = rows["compiled code, up to n = 2000"]
    assert holds is False and "not on: beam:100 1.25" in text and "17 of 18" in text
    assert rows["compiled code, above n = 2000"] == ("none was timed", None)


def test_own_code_on_a_dense_matrix_is_a_rival_of_its_own_and_what_decides_is_said():
    tables = mechanisms()
    scenes = tables["scenes"].replace({"implementation": {"own/x": "compiled_own/x"}})
    wide = scenes.scene.isin(["block:10", "block:100", "shell:10"]) & (scenes.implementation == "compiled_own/x")
    found = tables | {"scenes": pandas.concat([scenes, scenes[wide].assign(implementation=bounds.PANELS, to_rival=0.6)])}
    asked = [(holds, text) for _, what, text, holds in bounds._compiled(found) if what.startswith("at least")]
    assert [holds for holds, _ in asked] == [True, False] and "15 of 18" in asked[1][1]
    rows = bounds.compiled(found).set_index("scene")
    assert (rows.rival["shell:10"], rows.rival["beam:10"]) == (bounds.PANELS, "one/b") and rows.over_all["shell:10"] == pytest.approx(1.2)
    assert bounds.decides(bounds.compiled(found), "behind") is None
    meaning, relation, limit, there, every, count, every_one = bounds.decides(bounds.compiled(found), "behind_all")
    assert (meaning, relation, limit, there, every, count, every_one) == ("non-zeros of L per column", "at least", 40.0, 3, 6, 3, 18)


def test_limits_by_hand_are_found_without_the_counts_of_who_is_left_out(monkeypatch):
    seen, cases = [], by_hand._cases
    monkeypatch.setattr(by_hand, "_cases", lambda rule, scheme, features, *more: (
        seen.append({scene.partition(":")[0] for scene in features.index}), cases(rule, scheme, features, *more))[1])
    *rests, whole = mechanisms() and seen
    assert [whole - rest for rest in rests] == [{family} for family in ("chain", "tree", "grid", "beam", "block", "shell")]


def test_the_rule_by_hand_is_held_to_the_same_bounds():
    losing = mechanisms(lambda family, name: 10.0 if (family, name) == ("tree", "one/a") else 1.0)
    assert [row[3] for row in bounds._by_hand(losing["by_hand"])] == [False, False]
    cases = losing["by_hand"].assign(mean_loss=0.01, worst_loss=0.02)
    assert [row[3] for row in bounds._by_hand(cases)] == [True, True]
    assert [row[3] for row in bounds._by_hand(cases.assign(unknown=1))] == [None, None]


def test_who_was_not_asked_is_in_no_check():
    tables = mechanisms()
    scenes, known = tables["scenes"], tables["mechanisms"]
    assert bounds._agreement(scenes, known)[0][3] is True
    scenes.loc[scenes.scene == "grid:10", ["verdict", "status"]] = "", "dropped"
    assert bounds._agreement(scenes, known)[0][2:] == ("51 of 51 checks", True)
    assert bounds._agreement(scenes.assign(verdict=""), known)[0][3] is None
    scenes.loc[scenes.scene == "beam:10", "verdict"] = "disagrees"
    _, _, text, holds = bounds._agreement(scenes, known)[0]
    assert holds is False and "other form" not in text
    _, _, text, holds = bounds._agreement(scenes, known.assign(saddle=(known.scene == "beam:10").astype(int)))[0]
    assert holds is False and "; in 3 of these `mbs describe` takes the other form" in text


def test_hybrid_is_held_against_those_it_replaces_on_the_look_where_one_was_not_timed():
    rows = [("hybrid_dense/llt", 1.0, 2.0), ("hybrid_dense/panels", None, 1.5), ("eigen_dense/llt", 1.5, 9.0), ("csc_cholmod/supernodal", None, 6.0)]
    scenes = pandas.DataFrame([{"scene": scene, "scheme": "penalty", "variables": size, "implementation": name, "to_rival": ratio, "look_us": look}
                               for scene, size in ((bounds.FILLED, 100), ("chain:3", 6)) for name, ratio, look in rows])
    found = {what: (text, holds) for what, _, text, holds in bounds._hybrid(scenes)}
    assert found[f"hybrid_dense on {bounds.FILLED}, beside eigen_dense/llt"] == ("1.50 times (hybrid_dense/llt)", False)
    assert found[f"hybrid_dense on {bounds.FILLED}, beside csc_cholmod/supernodal"] == ("4.00 times (hybrid_dense/panels)", True)
    library = f"hybrid_dense with a library's factorization on {bounds.FILLED}, beside csc_cholmod/supernodal"
    assert found[library] == ("3.00 times (hybrid_dense/llt)", True)
    assert found["hybrid_dense, up to n = 22, beside eigen_dense/llt"][1] is True


def followed(rows, *choices):
    """Rows of rules with these choices. rows: {(mechanism, library): (loss, what it is known by)}; n is 20, 40, ..., fill 19 %."""
    found = pandas.DataFrame(rows.values(), pandas.MultiIndex.from_tuples(rows), ["loss", "by"])
    losses, known_by = found.loss.unstack(), found.by.unstack(fill_value="")
    features = pandas.DataFrame({"n": 20.0 * numpy.arange(1, len(losses) + 1), "fill": 19.0}, losses.index)
    data = SimpleNamespace(losses={"penalty": losses}, known_by={"penalty": known_by}, features=features)
    return [*defaults.table(data, {("penalty", *at): "/".join(at) for at in rows}, [defaults.Rule("R", "S", "", choose) for choose in choices])]


def test_a_default_is_held_against_the_fastest_library_where_both_have_times():
    rows = {(scene, "fast"): (0.0, "turns") for scene in "abcd"}
    rows |= {("a", "slow"): (1.0, "turns"), ("b", "slow"): (7.0, "look"), ("c", "slow"): (3.0, "failed")}
    always, never = followed(rows, lambda n, fill: "slow", lambda n, fill: "fast" if fill == 0.19 else "slow")
    assert (always["scenes"], always["timed"], always["rough"], always["smaller"], always["chosen"]) == (4, 2, 1, 0, "slow on 4")
    assert (always["mean"], always["worst"], always["where"], always["record"]) == (pytest.approx(4), 8.0, "b", "b/slow")
    assert (never["mean"], never["worst"], never["timed"], never["rough"]) == (1.0, 1.0, 4, 0)


def test_what_a_smaller_machine_tells_of_a_default_is_said_to_be_at_least_so_much():
    rows = {("a", "fast"): (0.0, "turns"), ("b", "fast"): (0.0, "turns"), ("a", "slow"): (3.0, "look"), ("b", "slow"): (8.0, "smaller")}
    row, by_size = followed(rows, lambda n, fill: "slow", lambda n, fill: "fast" if n == 40 else "slow")
    assert (row["timed"], row["rough"], row["smaller"], row["mean"], row["record"]) == (2, 2, 1, pytest.approx(6), "b/slow")
    assert (by_size["rough"], by_size["smaller"], by_size["worst"], by_size["mean"]) == (1, 0, 4.0, pytest.approx(2))
    found = small()
    for one, how in ((row, "at least"), (by_size, "about")):
        [said] = [answer["text"] for answer in page.answers(found | {"defaults": pandas.DataFrame([one])}, VIEW) if answer["anchor"] == "defaults"]
        assert f"“R” ({how} " in said


def test_a_default_without_any_time_has_no_loss():
    [row] = followed({("a", "fast"): (0.0, "turns")}, lambda n, fill: "nobody")
    assert (row["timed"], row["mean"], row["worst"], row["where"], row["record"]) == (0, None, None, "", "")


@pytest.mark.parametrize("rule, variables, fill, expected", [
    ("OpenModelica, 2016", 4000, 0.1, defaults.DENSE), ("OpenModelica, 2016", 4001, 0.1, defaults.UMFPACK),
    ("OpenModelica, linear systems", 40, 0.19, defaults.KLU), ("OpenModelica, linear systems", 40, 0.2, defaults.DENSE),
    ("OpenModelica, linear systems", 1001, 0.5, defaults.KLU), ("OpenModelica, nonlinear systems", 40, 0.19, defaults.DENSE),
    ("LinearSolve.jl, 2022", 10_000, 0.1, defaults.KLU), ("LinearSolve.jl, 2023", 10_000, 0.1, defaults.UMFPACK),
    ("LinearSolve.jl, 2026", 1000, 0.1, defaults.KLU), ("LinearSolve.jl, 2026", 1001, 0.1, defaults.UMFPACK),
    ("Dense below 50", 49, 0.1, defaults.DENSE), ("Dense below 50", 50, 0.1, defaults.KLU), ("The map of 2008", 901, 0.01, defaults.CHOLMOD),
    ("The map of 2008", 40, 0.5, defaults.SUPERNODAL)])
def test_rules_choose_as_their_sources_say(rule, variables, fill, expected):
    assert next(one for one in defaults.RULES if one.name == rule).choose(variables, fill) == expected


def test_a_name_is_broken_at_its_joints_and_stays_text():
    name = site.template(site.HERE / "index.html.j2").environment.filters["name"]
    assert str(name("csc_klu/refactor")) == "csc_klu/<wbr>refactor" and str(name("a,<b>")) == "a,<wbr>&lt;b&gt;"
