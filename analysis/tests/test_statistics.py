# The statistics on samples whose right answer is known.
import math

import numpy
import pandas
import pytest

from analysis.core.records import Record
from analysis.core.registry import ANCHOR, TWIN
from analysis.core.timing import counted, median, power_law, rank, ratio
from analysis.core import controls, timing
from analysis.core.controls import disturbance, told
from analysis.map import carry
from analysis.map.timed import AFTER


def rows(name, processes, environment="own", status="ok"):
    """Rows of a contender; `processes`: {number: its samples}."""
    return [{"implementation": name, "environment": environment, "process": number, "status": status, "samples": tuple(samples)}
            for number, samples in processes.items()]


def noisy(random, level, processes=5, between=0.03, inside=0.01, samples=4):
    """Each process has an effect of its own, far above the noise inside it."""
    return {number: level * (1 + between * random.standard_normal()) * (1 + inside * random.standard_normal(samples))
            for number in range(processes)}


def test_median_never_hides_a_nan():
    assert median([3.0, 1.0, 2.0]) == 2.0
    assert all(numpy.isnan(median(values)) for values in ([1.0, numpy.nan, 2.0], [1.0, numpy.inf], []))


def test_what_disturbs_both_in_a_process_cancels():
    slow = {1: (1.1, 3.3), 2: (2.2, 1.1)}
    found = ratio(pandas.DataFrame(rows("a", slow) + rows("b", {1: (1.0, 3.0), 2: (2.0, 1.0)})), "a", "b")
    assert (found.value, found.low, found.high) == pytest.approx((1.1, 1.1, 1.1)) and found.freedom == 1


def test_one_process_gives_no_interval_and_none_gives_no_ratio():
    table = pandas.DataFrame(rows("a", {1: (2.0,)}) + rows("b", {1: (1.0,)}) + rows("c", {2: (1.0,)}))
    assert (ratio(table, "a", "b").low, ratio(table, "a", "b").high) == (0.0, math.inf)
    assert math.isnan(ratio(table, "a", "c").value)


def test_other_environments_are_compared_through_what_they_have_in_common():
    table = pandas.DataFrame(rows("a", {1: (2.0,), 2: (2.0,)}, "one") + rows("k", {1: (1.0,), 2: (1.0,)}, "one")
                             + rows("b", {1: (9.0,), 2: (9.0,)}, "two") + rows("k+two", {1: (3.0,), 2: (3.0,)}, "two"))
    assert ratio(table, "b", "a").value == pytest.approx(1.5)


def test_who_depends_on_the_environment_is_not_what_two_are_compared_through():
    """Another library gains in the other environment; the anchor does not."""
    table = pandas.DataFrame([row for name, here, there in (("a", 2.0, 1.0), (ANCHOR, 1.0, 1.0), ("b", 4.0, 1.0))
                              for row in (*rows(name, {1: (here,), 2: (here,)}, "one"), *rows(f"{name}+two", {1: (there,), 2: (there,)}, "two"))])
    assert ratio(table, "a", "a+two").value == pytest.approx(2.0)
    assert ratio(table, "b", "a+two").value == pytest.approx(4.0)
    assert math.isnan(ratio(table[~table.implementation.str.startswith((ANCHOR, "b"))], "a", "a+two").value)
    twin = pandas.DataFrame(rows(ANCHOR + TWIN, {101: (1.0,)}, "one"))  # a control: in processes of its own
    assert ratio(pandas.concat([table, twin]), "a", "a+two").value == pytest.approx(2.0)


@pytest.mark.parametrize("processes", [5, 9])  # quick, full
def test_the_interval_covers_the_truth_as_often_as_it_says(processes):
    random, covered = numpy.random.default_rng(5), 0
    for _ in range(300):
        table = pandas.DataFrame(rows("a", noisy(random, 1.2, processes)) + rows("b", noisy(random, 1.0, processes)))
        found = ratio(table, "a", "b")
        covered += found.low <= 1.2 <= found.high
    assert 0.91 <= covered / 300 <= 0.99


def test_of_two_that_are_equal_one_in_twenty_is_a_false_winner_at_most():
    """The winner is chosen from the same samples: by a one-sided chance it would be one in ten."""
    random, found = numpy.random.default_rng(7), []
    for _ in range(400):
        table = pandas.DataFrame([row for name in "ab" for row in rows(name, noisy(random, 1.0))])
        margin = rank(table).ratios
        found += timing.holm([{"chance": max(one.chance for name, one in margin.items() if one.value > 1), "decided": True, "holm": False}])
    assert 0.025 <= sum(row["holm"] for row in found) / len(found) <= 0.08


def in_layouts(random, level, layouts, each, between, inside):
    """Rows of two contenders in `each` processes of each layout, which shifts their ratio."""
    found = []
    for number in range(layouts * each):
        if number < layouts:
            in_layouts.shift[number] = between * random.standard_normal()
        ratio_here = level * math.exp(in_layouts.shift[number % layouts] + inside * random.standard_normal())
        found += [row | {"layout": f"layouts/mbs-{number % layouts + 1}", "record": "r", "scene": "s"} for row in
                  rows("a", {AFTER + 1 + number: (ratio_here,) * 4}) + rows("b", {AFTER + 1 + number: (1.0,) * 4})]
    return pandas.DataFrame(found)


in_layouts.shift = {}


def test_the_interval_is_that_for_a_new_layout_however_many_processes_each_has():
    random, covered = numpy.random.default_rng(8), 0
    for _ in range(200):
        found = ratio(in_layouts(random, 1.2, 8, 3, 0.04, 0.005), "a", "b")
        covered += found.low <= 1.2 <= found.high
    assert 0.90 <= covered / 200 <= 0.99


def test_the_spread_is_told_by_its_sources():
    random = numpy.random.default_rng(9)
    found = [carry.components(in_layouts(random, 1.2, 8, 3, 0.04, 0.01), pandas.DataFrame(columns=["status", "variables", "fill_asked"])) for _ in range(60)]
    mean = {source: numpy.sqrt(numpy.mean([one.set_index("source").percent[source] ** 2 for one in found]))
            for source in ("process", "layout")}
    assert mean["process"] == pytest.approx(1.0, rel=0.1) and mean["layout"] == pytest.approx(4.0, rel=0.15)


def seeded(random, seeds, between, inside):
    """Rows of two contenders on scenes that differ in the seed of their fill, in the same four layouts."""
    layouts, found = 0.1 * random.standard_normal(4), []
    for seed in range(seeds):
        shift = between * random.standard_normal()
        for number, layout in enumerate(layouts, start=1):
            time = math.exp(0.5 + shift + layout + inside * random.standard_normal())
            found += [row | {"scene": f"s{seed}"} for row in rows("b", {number: (time,)}) + rows("a", {number: (1.0,)})]
    return pandas.DataFrame(found).assign(record="r", fill_asked=0.2)


def test_the_interval_at_artificial_fill_is_that_for_other_seeds_where_these_were_timed():
    random, covered, variances = numpy.random.default_rng(11), 0, []
    for _ in range(100):
        groups = pandas.concat(seeded(random, 3, 0.05, 0.01).assign(variables=n) for n in (22, 50, 100, 160))
        beyond = carry.of_seeds(groups)
        variances.append(beyond[0])
        logs = 0.05 * random.standard_normal() + 0.02 * random.standard_normal(8)  # of one seed, in eight layouts
        table = pandas.DataFrame([row for number, log in enumerate(logs) for row in rows("b", {number: (math.exp(log),)}) + rows("a", {number: (1.0,)})])
        found, alone = timing.ratio(timing.Paired(table, beyond), "b", "a"), ratio(table, "b", "a")
        assert found.low <= alone.low and found.high >= alone.high and found.value == alone.value
        covered += found.low <= 1.0 <= found.high
    assert covered >= 88 and numpy.sqrt(numpy.mean(variances)) == pytest.approx(0.05, rel=0.1)
    assert beyond[1] == 8 and carry.of_seeds(groups.iloc[:0]) == timing.NO_VARIANCE


@pytest.mark.parametrize("each", [1, 3])
def test_the_interval_within_these_layouts_is_narrower_and_holds_their_own_mean(each):
    random, covered = numpy.random.default_rng(12), 0
    for _ in range(100):
        table = in_layouts(random, 1.2, 8, each, 0.04, 0.01 if each > 1 else 0.0)
        if each == 1:  # then rounds alone tell it
            table["samples"] = [tuple(one * numpy.exp(0.01 * random.standard_normal(9))) for one in table.samples.map(lambda some: some[0])]
        low, high = timing.within(timing.Paired(table), "a", "b")
        wide = ratio(table, "a", "b")
        assert low > wide.low and high < wide.high
        covered += low <= 1.2 * math.exp(numpy.mean([in_layouts.shift[place] for place in range(8)])) <= high
    assert covered >= 88


def test_controls_count_what_is_decided_though_nothing_differs():
    random = numpy.random.default_rng(10)

    def table(shift, scenes):
        return pandas.concat([pandas.DataFrame(
            rows("a", {AFTER + n: (1.0,) for n in range(1, 9)}) +
            rows("a+twin", {AFTER + n: (shift * math.exp(0.01 * random.standard_normal()),) for n in range(1, 9)})
        ).assign(scene=f"four-bar:{scene}", record="r") for scene in range(1, scenes + 1)])
    sound, unsound = (controls.judged(pandas.DataFrame(controls.controls(table(shift, 40)))) for shift in (1.0, 1.02))
    assert sound["pairs"] == 40 and sound["false"] <= 6 and sound["sound"]
    assert unsound["false"] > 30 and not unsound["sound"] and unsound["widest"] > 1.01


def test_the_equivalence_set_leaves_out_who_is_shown_to_be_over_five_percent_behind():
    behind = lambda value, low, high: timing.Ratio(value, low, high, freedom=7)
    ranking = timing.Ranking("a", {"a": timing.Ratio(1.0, 1.0, 1.0), "near": behind(1.02, 1.0, 1.04), "may": behind(1.2, 1.04, 1.4),
                                   "slower": behind(1.08, 1.045, 1.12), "far": behind(1.5, 1.4, 1.6), "alone": behind(3.0, 0.0, math.inf)})
    assert ranking.inside == ("a", "near", "may", "slower", "alone") and ranking.equivalent == ("a", "near")
    one, both = behind(1.1, 1.06, 1.14), {"a": timing.Ratio(1.0, 1.0, 1.0)}
    assert timing.Ranking("a", both | {"b": one}).inside == ("a",)
    assert len(timing.Ranking("a", both | {f"b{number}": one for number in range(9)}).inside) == 10  # asked at once


@pytest.mark.parametrize("slower", [1.0, 1.03])
def test_runs_that_are_there_twice_are_controls_of_the_first_in_each_process(slower):
    random = numpy.random.default_rng(2)
    def made(factor, name):
        return pandas.DataFrame([{"scene": "s", "implementation": who, "environment": "e", "process": number, "status": "ok", "record": f"{name}{number}",
                                  "step_us": factor * math.exp(0.002 * random.standard_normal())} for number in range(1, 7) for who in ("a", "b")])
    [row] = controls.repeated(made(1.0, "r"), made(slower, "again"))
    assert (row["implementation"], row["decided"]) == ("a", slower > 1) and row["ratio"] == pytest.approx(slower, rel=0.01)
    assert controls.repeated(made(1.0, "r"), made(1.0, "again")[:0]) == []


def test_clear_difference_is_decided_and_the_same_is_not():
    random = numpy.random.default_rng(3)
    found = rank(pandas.DataFrame(rows("a", noisy(random, 1.0)) + rows("b", noisy(random, 1.5))))
    assert (found.winner, found.second, found.decided) == ("a", "b", True)
    assert found.margin.low < found.margin.value < found.margin.high
    same = rank(pandas.DataFrame(rows("a", noisy(random, 1.0)) + rows("b", noisy(random, 1.0))))
    assert not same.decided and (same.open or len(same.equivalent) == 2)


def test_nobody_is_faster_than_the_winner_where_not_all_share_the_same_processes():
    table = pandas.DataFrame(rows("f", {1: (1.5,)}) + rows("a", {1: (1.0,), 2: (3.0,), 3: (3.0,)})
                             + rows("b", {1: (1.1,), 2: (1.0,), 3: (1.0,)}))
    found = rank(table)
    assert found.winner == "b" and all(one.value >= 1 for one in found.ratios.values())


def test_who_failed_once_is_not_ranked():
    table = pandas.DataFrame(rows("a", {1: (1.0,)}) + rows("b", {1: (2.0,)}) + rows("a", {2: ()}, status="crashed"))
    assert list(rank(table).ratios) == ["b"] and rank(table.iloc[:0]) is None


def asked(names, number, status="done", role="look/default", step="1e-3", environment="own"):
    return Record(f"{role}/{names}-{number}-{step}", {"scene": "s", "contenders": list(names), "environment": environment, "role": role,
                                               "number": number, "settings": ["--step", step, "--seed", number]}, status, "", 1.0, [], {}, {})


def test_a_process_that_was_measured_again_without_who_ended_it_does_not_count():
    lost = [asked("abc", 1), asked("abc", 2, "crashed"), asked("a", 0, role="look/default-alone"),
            asked("c", 0, "crashed", role="look/default-alone"), asked("c", 0, "crashed", role="look/default-left-out")]
    again = [asked("ab", 1), asked("ab", 2)]
    apart = [asked("abc", 1, step="2e-3"), asked("abc", 1, environment="other"),  # nobody was lost there
             asked("de", 1), asked("d", 1)]                                       # nor of these, who were asked apart
    found = counted([*lost, *again, *apart])
    assert [one.name for one in found] == [one.name for one in (lost[-1], *again, *apart)]
    assert {one.role for one in found} == {"look/default"}
    spent = counted([*lost, asked("ab", 1, "dropped")])  # what was measured before still counts
    assert [(one.cell["contenders"], one.status) for one in spent] == [
        (list("abc"), "done"), (["c"], "crashed"), (list("ab"), "dropped")]
    assert [one.status for one in counted([asked("ab", 1, "crashed")])] == ["crashed"]  # nobody knows yet who did it


def test_a_process_in_which_others_ran_does_not_count_where_most_were_calm():
    def timed(number, clock):
        found = asked("ab", number)
        found.output["rows"] = {"a/s": {"cpu_us": [10.0, 10.0], "stretch_us": [10.0 * clock, 10.0 * clock]}}
        return found
    calm, busy = [timed(number, 1.02) for number in (1, 2, 3)], timed(4, 1.5)
    assert counted([*calm, busy]) == calm
    assert len(counted([calm[0], busy])) == 2  # half of them: nobody knows which is the rule


def test_power_law_exponent():
    sizes = numpy.array([100.0, 200, 400, 1000])
    assert power_law(sizes, 7 * sizes**1.05)[0] == pytest.approx(1.05)
    assert power_law(sizes[:2], sizes[:2]) == (pytest.approx(1.0), *[pytest.approx(math.nan, nan_ok=True)] * 2)
    assert numpy.isnan(power_law(sizes[:1], sizes[:1])).all()


def test_others_are_seen_in_every_timed_process_and_said():
    def timed(seconds, **machine):
        return Record("c/x.json", {"kind": "simulate", "timed": True}, "done", "", seconds, [], {}, {"rows": []}, machine=machine)
    found = disturbance([timed(1.0, cpu_s=0.99, steal=0.01, mhz=2400.0), timed(1.0, cpu_s=0.7, steal=0.2, mhz=2500.0), timed(1.0)])
    assert found == {"processes": 2, "disturbed": 1, "steal": 0.2, "mhz": [2400.0, 2500.0]}
    assert told(found) == "others ran on the processor in 1 of 2 timed processes; the host took up to 20.0 % of its time; 2400 to 2500 MHz"
    assert told(disturbance([])) == told(None) == ""
