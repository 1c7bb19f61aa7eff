# explore.html of a stored set in Chromium: what it ranks is what Python ranks, every control obeys, and it asks nobody.
import json
import math
import random
import re
import shutil
from functools import cache
from urllib.parse import quote

import pandas
import pytest

from analysis.accuracy.winners import fastest, meeting
from analysis.core import site, timing
from analysis.core.files import read_json, write_json
from analysis.explorer import data
from analysis.core.view import others
from study.tests.test_site import BEYOND, HIDDEN
from study.tools import fragments

STORED = fragments.main_set()
QUESTIONS = 200
SECOND, COMMIT = "Another processor", "0" * 40  # of a copy beside the set
WITHOUT = ("own", "gpl", "dense")
DESCRIBED = {"scene": "<img src=x onerror=alert(1)>", "variables": 50, "tangent": {"fill": 0.2}, "warnings": ["<b>a step too long</b>"],
             "scheme": {"take": "penalty"}, "features": {"n": 50, "per_column": 1e5, "flops": 9000, "tangent": 500, "fill": 20}}
PRINTED = """Release build by GNU 12.2.0 on Some processor, BLAS system

four-bar:10: 22 variables, 21 constraints, tangent filled to 25.6 %
800 steps of 1.25 ms from t = 0.220308 s; 3 samples of each, a turn each, of one or more stretches
                        step, µs  to the fastest           set-up, µs  passes  error, m
compiled_ldl/fronts        1.279  1                             48.86   2.256  3.69e-05
csc_klu/refactor           2.188  1.712 (1.710..1.713)          19.27   2.256  3.69e-05

four-bar:40: 82 variables, 81 constraints, tangent filled to 7.2 %
csc_klu/refactor           9.188  1.712 (1.710..1.713)          19.27   2.256  3.69e-05
"""
SUMMARY = """Release build by GNU 12.2.0 on A processor with a name of quite many words,
    BLAS system

harness/scenes/problems/a_mechanism_with_a_name_of_many_words.json: 22
    variables, 21 constraints, tangent filled to 25.6 %
800 steps of 1.25 ms from t = 0.220308 s, 12 samples of each
                           µs a step  to the fastest         passes
compiled_ldl/fronts    own     1.279  1                       2.256
csc_klu/refactor               2.188  1.712 (1.710..1.713)    2.256
null/null                    0.00123  -                       2.256

shares of the time, %   evaluate assemble   factor    solve  project    other
compiled_ldl/fronts         20.1     11.2     30.3     20.4     10.0      8.0
csc_klu/refactor            12.1     10.2     40.3     20.4      9.0      8.0

fastest library:  csc_klu/refactor, 2.188 µs a step
fastest own code: compiled_ldl/fronts, 1.279 µs a step
left out:
  slower: at least 10 times the fastest of its layer: csc_mumps/spd
  unsupported: only chains (mbs list tells who does): compiled_chains/sweeps,
    eigen_dense/llt

four-bar:40: 82 variables, 81 constraints, tangent filled to 7.2 %
csc_klu/refactor               9.188  1.712 (1.710..1.713)    2.256
left out:
  unsupported: only what is sparse: hybrid_dense/llt

To the fastest: median of the ratios of samples taken side by side, and its
95 % interval (below 6 samples: the least and the largest).
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """(the set with its page, and another one of another processor beside it, which has the map alone; what was read of it)"""
    base = tmp_path_factory.mktemp("sets")
    for name, without in (("first", ("engines", "extremes*")), ("second", ("families*", "accuracy*"))):
        shutil.copytree(STORED, base / name, ignore=shutil.ignore_patterns(*without))
    facts = read_json(base / "second" / "set.json")
    write_json(base / "second" / "set.json", facts | {"context": facts["context"] | {"cpu_model": SECOND, "commit": COMMIT}})
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(data, "read", cache(data.read))  # takes seconds
        site.write_index(base / "first")
        return base / "first", data.read(base / "first")


@pytest.fixture
def folder(made):
    return made[0]


@pytest.fixture
def found(made):
    return made[1]


@pytest.fixture
def page(browser, folder):
    """The page with a question in its address; looks for complaints and requests when the test is done."""
    browser.complaints.clear()
    browser.requests.clear()

    def ask(question=""):
        browser.open(folder / "index.html")
        browser.value(f"location.href = {json.dumps((folder / 'explore.html').as_uri() + '#' + question)}")
        browser.wait("location.pathname.endsWith('explore.html') && document.readyState === 'complete' && !!window.explorer")
        return browser
    yield ask
    assert browser.complaints == []
    assert all(address.startswith(("file:", "data:", "blob:")) for address in browser.requests)


def said(browser):
    return browser.value("document.getElementById('answer').innerText")


def put(browser, name, value, event="input"):
    browser.value(f"(() => {{ const one = document.getElementById('{name}'); one.value = {json.dumps(str(value))};"
                  f"one.dispatchEvent(new Event('{event}', {{bubbles: true}})); }})()")


def press(browser, name):
    browser.value(f"document.getElementById('{name}').click()")


def winner(browser):
    return browser.value("explorer.shown.near[0]?.ranking.winner ?? ''")


def test_other_processors_are_shown_with_the_same_commit_where_there_is_one(tmp_path):
    def stored(name, cpu, commit):
        facts = read_json(STORED / "set.json")
        write_json(tmp_path / name / "set.json", facts | {"context": facts["context"] | {"cpu_model": cpu, "commit": commit}})
        (tmp_path / name / "raw").mkdir()
        (tmp_path / name / "raw" / "map.tar.xz").touch()
        return tmp_path / name
    mine, old = stored("mine", "x", "new"), stored("a-old", "y", "old")
    assert others(mine) == [old] and others(old) == [mine]
    new = stored("b-new", "y", "new")
    assert others(mine) == [new] and others(old) == [mine]


def test_winners_are_those_of_python(page, found):
    everyone = {one.name: one for one in _about(page().value("DATA.names"))}
    contests = {(one.part, one.scene, one.form): one for part in ("families", "map") for one in found[part]}
    draw, questions = random.Random(1), []
    for _ in range(QUESTIONS):
        asked = {"no": draw.sample(WITHOUT, draw.randint(0, 2)) + draw.choice([[], [], ["penalty"], ["saddle"]]), "without": draw.sample(sorted(everyone), draw.randint(0, 8)),
                 "error": 10 ** draw.uniform(-5, -1), "scene": "", "family": ""}
        if draw.random() < 0.7:
            asked["scene"] = draw.choice(list(contests))[1]
        else:
            asked |= {"n": 10 ** draw.uniform(1, 3), "fill": 10 ** draw.uniform(0, 2), "family": draw.choice(["", *{one.family for one in contests.values()}])}
        questions.append(asked)
    answers = page().value(f"""{json.dumps(questions)}.map((asked) => {{ const found = explorer.ask(asked); return {{
      near: found.near.map(({{contest, ranking}}) => ({{...ranking, key: [contest.part, contest.scene, contest.form]}})),
      curve: found.error?.curve.scene, point: found.error?.ranking && {{...found.error.ranking.winner, decided: found.error.ranking.decided,
        settled: found.error.ranking.settled, equal: found.error.ranking.equivalent.map((one) => one.name)}}}}; }})""")
    ranked = 0
    for asked, answer in zip(questions, answers):
        names = {name for name, one in everyone.items() if "+" not in name and name not in asked["without"] and not any(getattr(one, word) for word in WITHOUT if word in asked["no"])}
        there = [key for key, one in contests.items() if (key[1] == asked["scene"] if asked["scene"] else asked["family"] in ("", one.family))
                 and set(one.able) & names and key[2].split("-")[0] not in asked["no"]]
        assert answer["near"] or not there
        if asked["scene"] and there:
            assert tuple(answer["near"][0]["key"]) in there
        for one in answer["near"]:
            _same(one, contests[tuple(one["key"])], names)
            ranked += 1
        _same_point(asked, answer, found["accuracy"], names - _refused(contests, answer["near"]), everyone)
    assert ranked > QUESTIONS and sum(1 for answer in answers if answer["point"]) > QUESTIONS / 4


def test_a_curve_that_the_budget_cut_leaves_a_faster_one_possible(page):
    browser = page("scene=four-bar:10&error=0.01")
    rounds = [[name, number, seconds] for number in (1, 2, 3) for name, seconds in (("x", 1), ("y", 2))]
    ranked = lambda cut: browser.value(f"""(() => {{
      const points = ["x", "y"].map((name, i) => ({{name, setting: "default", step: 1, error: 1e-3, time: 1 + i, from: "rounds"}}));
      const rounds = {json.dumps(rounds)}.map(([name, process, seconds]) => ({{point: points["xy".indexOf(name)], process, seconds, status: "ok"}}));
      const found = rankPoints({{rounds}}, points, {json.dumps(cut)}); return [found.winner.name, found.decided, found.settled]; }})()""")
    assert ranked([]) == ranked([{"time": 1.5}]) == ["x", True, True] and ranked([{"time": 0.5}]) == ["x", False, False]
    settled = lambda **asked: browser.value(f"explorer.ask({json.dumps({'scene': 'four-bar:10', 'error': 0.01, 'no': []} | asked)}).error.ranking?.settled ?? null")
    browser.value("DATA.sets[0].curves.forEach((one) => { one.cut = []; })")
    before = settled(), settled(no=["penalty"])
    library = browser.value("DATA.names.find((one) => !one.own).name")
    browser.value(f"DATA.sets[0].curves.forEach((one) => {{ one.cut = [{{name: {json.dumps(library)}, setting: 'default', error: 0.02, time: 0}}]; }})")
    assert (settled(), settled(no=["penalty"])) == (False, before[1]) and not settled(without=[library])  # the curve is its setting's
    browser.value("DATA.sets[0].curves.forEach((one) => { one.cut[0].error = 0.001; })")
    assert settled() == before[0]


def test_layouts_of_the_program_count_as_one_each(page):
    draw, rows = random.Random(2), []
    for number in range(1, 10):
        for name in ("a", "b"):
            rows.append({"implementation": name, "environment": "own", "process": number, "layout": f"layouts/mbs-{number % 3}", "status": "ok",
                         "samples": tuple(draw.uniform(1, 2) for _ in range(4))})
    found = timing.ratio(pandas.DataFrame(rows), "a", "b")
    asked = [[row["implementation"], {"environment": "own", "number": row["process"], "layout": row["layout"]}, row["samples"]] for row in rows]
    assert page().value(f"Object.values(new Paired({json.dumps(asked)}).ratio('a', 'b'))") == pytest.approx([found.value, found.low, found.high])


class _about(list):
    """Names of the page as objects."""

    def __init__(self, rows):
        super().__init__(type("About", (), row) for row in rows)


def _same(one, contest, names):
    ranking = contest.rank(names)
    assert one["winner"] == ranking.winner and [name for name, _ in one["ratios"]] == list(ranking.ratios)
    failed = set(contest.failed) & names
    assert one["decided"] == (ranking.decided and (bool(ranking.second) or not failed))
    assert one["settled"] == (ranking.settled and (bool(ranking.second) or not failed))
    assert one["equivalent"] == list(ranking.equivalent) and one["open"] == list(ranking.open)
    for (_, mine), theirs in zip(one["ratios"], ranking.ratios.values()):
        for bound in ("value", "low", "high"):
            value = math.inf if mine[bound] is None else mine[bound]  # as JSON has no infinity
            assert value == pytest.approx(getattr(theirs, bound), rel=1e-5)


def _refused(contests, near):
    """Who takes a scene that is near in no form of the step."""
    return {name for part, scene, form in (one["key"] for one in near) for name, (status, _) in contests[part, scene, form].lost.items()
            if status == "unsupported" and not any(key[1] == scene and name in one.able for key, one in contests.items())}


def _same_point(asked, answer, curves, names, everyone):
    def left(setting):
        return ("saddle" if setting.startswith("saddle") else "" if setting.startswith(("rattle", "multistep")) else "penalty") not in asked["no"]
    curve = next(one for one in curves if one.scene == answer["curve"])
    found = meeting(curve.points[curve.points.implementation.isin(names) & curve.points.setting.map(left)], asked["error"])
    row = fastest(found.to_dict("records"), curve.rounds)
    assert (row is None) == (answer["point"] is None)
    if row:
        layers = {everyone[name].own for name in names}
        if any(not error <= asked["error"] and time < row["time"] for name, setting, error, time in curve.cut if everyone[name].own in layers and left(setting)):
            row |= {"decided": False, "settled": False}
        assert (row["implementation"], row["setting"], row["step"]) == tuple(answer["point"][key] for key in ("name", "setting", "step"))
        assert (bool(row["decided"]), bool(row["settled"])) == (answer["point"]["decided"], answer["point"]["settled"])
        assert row["equivalent"].split("; ") == (answer["point"]["equal"] or [""])


def test_an_example_of_the_front_page_is_what_the_page_says(page, folder):
    browser = page()
    browser.open(folder / "index.html")
    links = browser.value("[...document.querySelectorAll('#explore ~ ul li')].map(one => [one.querySelector('a').getAttribute('href'), one.innerText])")
    assert len(links) == 3
    for link, text in links:
        page(link.partition("#")[2])
        assert f": {winner(browser)}" in text


def test_who_does_not_take_what_is_near_is_not_predicted(page):
    predicted = {scene: page(f"scene={scene}").value("explorer.shown.predicted.map((one) => one.name)") for scene in ("chain:10", "ladder:10")}
    assert set(predicted["chain:10"]) - set(predicted["ladder:10"]) == {"compiled_chains/sweeps"}


def test_who_does_not_take_the_case_reaches_no_error_there(page):
    """Though both have the same points, those of the nearest four-bar."""
    reached = {scene: page(f"scene={scene}&error=0.001").value("""[explorer.shown.error.curve.scene, explorer.shown.error.ranking.winner.name,
        explorer.shown.error.ranking.ratios.map(([point]) => point.name)]""") for scene in ("chain:10", "ladder:10")}
    (there, _, chain), (here, first, ladder) = reached["chain:10"], reached["ladder:10"]
    assert there == here and set(chain) - set(ladder) == {"compiled_chains/sweeps"} and first in ladder


def test_the_case_is_measured_only_where_more_than_its_size_is_that_of_a_scene(page):
    browser = page("family=&n=100")
    exact = lambda asked: browser.value(f"explorer.ask({json.dumps(asked)}).near[0].exact")
    assert "Measured at this very case" not in browser.value("document.getElementById('near').innerText")
    assert not exact({"family": "", "n": 100}) and not exact({"family": "four-bar, filled", "n": 100})
    assert exact({"family": "four-bar", "n": 100}) and exact({"scene": "four-bar:49"})


def test_each_box_takes_somebody_out(page):
    browser = page("scene=four-bar:49")
    everyone = browser.value("explorer.shown.names.size")
    for box in WITHOUT:
        press(browser, box)
        assert browser.value("explorer.shown.names.size") < everyone
        assert browser.value(f"[...explorer.shown.names].every((name) => !ABOUT.get(name).{box})")
        assert f"no={box}" in browser.value("location.hash")
        press(browser, box)
    press(browser, "penalty")
    assert browser.value("explorer.shown.form") == "saddle-point"
    press(browser, "saddle")
    assert "None of those that are left" in said(browser)
    press(browser, "reset")
    first = winner(browser)
    browser.value(f"[...document.querySelectorAll('#contenders input')].find((one) => one.value === {json.dumps(first)}).click()")
    assert winner(browser) not in ("", first) and "without=" in browser.value("location.hash")
    press(browser, "reset")
    assert winner(browser) == first and browser.value("document.querySelectorAll('input[type=checkbox]:checked').length") >= 5


def test_the_case_can_be_chosen_and_stands_in_the_address(page):
    browser = page()
    put(browser, "family", "ladder", "change")
    put(browser, "n", 150)
    assert browser.value("explorer.shown.near.map((one) => one.contest.family)") == ["ladder", "ladder"]
    assert not browser.value("explorer.shown.near[0].exact") and "ladder" in said(browser) and "lies between these" in said(browser)
    assert browser.value("document.querySelector('#copy pre').textContent").startswith("build/mbs bench ladder:38 ")
    assert "152 variables, not 150" in browser.value("document.getElementById('copy').innerText")
    put(browser, "family", "", "change")
    put(browser, "fill", 40)
    assert "lies between" not in said(browser) and "These two are the nearest" in said(browser)  # perhaps both are smaller
    put(browser, "error", 1e-3)
    put(browser, "deadline", 30)
    assert "30 µs" in said(browser) and "0.001 m" in said(browser) and browser.value("!!document.querySelector('#points svg') && !!document.querySelector('#model svg')")
    assert browser.value("[3, 0.5, 1.5].map((deadline) => fits({low: 1, high: 2}, deadline))") == ["mean below", "mean above", "not said"]
    commands = browser.value("[...document.querySelectorAll('#copy pre')].map((one) => one.textContent)")
    assert commands[-1].startswith("study/advise ") and "--error 0.001 --deadline-us 30" in commands[-1]
    before, address = said(browser), browser.value("location.hash")
    page(address[1:])
    assert said(browser) == before and browser.value("location.hash") == address
    put(browser, "scene", "four-bar:49", "change")
    assert browser.value("explorer.shown.near[0].exact") and browser.value("document.getElementById('n').value") == "100"
    there = f"{SECOND} at commit {COMMIT[:10]}"
    assert f"On {there} it leads too." in said(browser)
    assert re.fullmatch(r"This answer took \d+ ms here\.", browser.value("document.getElementById('took').textContent"))
    machines = browser.value("[...document.getElementById('machine').options].map((one) => one.text)")
    assert "commit" not in machines[0] and machines[1].startswith(there)
    put(browser, "machine", "second", "change")
    assert there in browser.value("document.querySelector('#map figcaption').textContent")
    assert browser.value("explorer.shown.set.machine") == SECOND and "machine=second" in browser.value("location.hash")
    assert browser.value("explorer.state.scene") == "four-bar:49" and f"On {SECOND}" not in said(browser)


def test_a_family_that_a_machine_lacks_is_given_up(page):
    browser = page("family=ladder&n=150")
    put(browser, "machine", "second", "change")
    assert browser.value("[state.machine, state.family, document.getElementById('family').value]") == ["second", "four-bar", "four-bar"]
    assert winner(browser) and "Nobody" not in said(browser)
    address = browser.value("location.hash")
    assert page(address[1:]).value("location.hash") == address and browser.value("state.family") == "four-bar"


def test_a_command_has_the_options_of_the_scene_that_is_near(page):
    browser = page()
    browser.value("""DATA.sizes.splice(0, Infinity, ["bodies", "", 3, -6], ["bodies", ",dimension=3", 6, 0])""")
    near = lambda scene: browser.value(f"""sceneOf({{asked: {{family: "bodies", n: 144, scene: ""}}, near: [{{contest: {{scene: "{scene}"}}}}]}})""")
    assert near("bodies:24,dimension=3") == {"scene": "bodies:24,dimension=3", "note": ""}
    assert near("bodies:40") == {"scene": "bodies:50", "note": ""} and near("bodies:40,dimension=4")["scene"] == "bodies:40,dimension=4"


def test_a_step_is_offered_for_the_motion_alone_that_it_was_measured_on(page):
    def copied(question):
        return page(question).value("[document.getElementById('copy').innerText, ...[...document.querySelectorAll('#copy pre')].map((one) => one.textContent)]")
    told, *commands = copied("scene=ladder:10&error=0.001")
    assert [one.split()[:3] for one in commands] == [["build/mbs", "bench", "ladder:10"], ["study/advise", "ladder:10", "--error"]]
    assert re.search(r"0\.001 m was measured on four-bar:\d+.*; study/advise finds yours", told) and "--step" not in told
    told, _, simulate, advise = copied("scene=four-bar:10&error=0.001")
    assert re.match(r"build/mbs simulate four-bar:10 --implementation .* --step [\d.e-]+$", simulate) and advise.startswith("study/advise four-bar:10 ")
    assert "was measured on" not in told
    assert [one.split()[1] for one in copied("scene=ladder:10")[1:]] == ["bench", "simulate", "ladder:10"]


def test_damaged_addresses_do_no_harm(page):
    mine = ["5", {"n": 5}, {"n": "5"}, {"n": True}, {"n": 5, "own": 5, "features": "x", "warnings": "x"}, {"n": 5, "own": [None, {"us": "5"}]},
            {"n": 1e300, "features": {"n": 1e300, "flops": 1e300}}]
    browser = page("n=0.5&fill=150")
    assert browser.value("[state.n, state.fill]") == [100, None]
    for wrong in (2e6, ""):
        put(browser, "n", wrong)
        assert browser.value("[state.n, document.querySelectorAll('input:invalid').length]") == [100, 1]
    for question in ("n=-3&family=<b>&no=x,own&without=nobody&mine={", "scene=%00&machine=..&n=1e99&error=x", "mine={%22n%22:1e999}",
                     "n=1e120", "n=1.7e308", "n=1e-300&fill=1e-300", "fill=1e300&error=1e300&deadline=1e308",
                     *(f"mine={quote(json.dumps(one))}" for one in mine)):
        browser = page(question)
        assert said(browser)
        assert browser.value("NUMBERS.every((key) => Math.abs(Math.log10(state[key] ?? 1)) <= 18) && (state.mine?.n ?? 5) === 5"), question


def test_my_scene_moves_the_pin(page):
    browser = page()
    before = browser.value("document.getElementById('pin').dataset.n")
    put(browser, "mine", json.dumps(DESCRIBED))
    press(browser, "use")
    assert (before, browser.value("document.getElementById('pin').dataset.n")) == ("100", "50")
    assert browser.value("document.images.length") == 0 and DESCRIBED["scene"] in browser.value("document.getElementById('mine-said').innerText")
    assert "non-zeros a column of the factor: 100000 lies outside" in said(browser) and "<b>a step too long</b>" in said(browser)
    assert browser.value("document.querySelector('#copy pre').textContent").startswith(f"build/mbs bench '{DESCRIBED['scene']}' ")
    ranked = lambda: set(browser.value("explorer.shown.near.flatMap((one) => one.ranking.ratios.map(([name]) => name))"))
    predicted = lambda: set(browser.value("explorer.shown.predicted.map((one) => one.name)"))
    assert "compiled_ldl/fronts" in ranked()
    for names, told in ((["n", "flops", "widest"], "was fitted on (n, operations of a factorization, widest): its times are extrapolated"),
                        ([*"abcdefg", 5, {}], "(a, b, c, d, e and 4 more)"), ([], ""), (3, "")):
        put(browser, "mine", json.dumps(DESCRIBED | {"rule": {"set": "first", "outside": names}, "warnings": ["w"] * 20}))
        press(browser, "use")
        assert told in said(browser) and ("outside of all that the rule" in said(browser)) == bool(told)
    put(browser, "mine", json.dumps(DESCRIBED | {"recommendation": [{"implementation": "csc_ldl/uplooking"}]}))
    press(browser, "use")
    # Of whom the rule has no times, a recommendation says nothing.
    timed = set(browser.value("Object.entries(DATA.sets[0].times).filter(([, one]) => one.penalty).map(([name]) => name)"))
    assert set(browser.value("state.mine.unable")) == timed - {"csc_ldl/uplooking"}
    assert ranked() & timed == {"csc_ldl/uplooking"} and "do not take it" in browser.value("document.getElementById('mine-said').innerText")
    for said_so in (PRINTED.replace("\n\nfour-bar:40", "\ncompiled_ldl/fronts  unsupported: it does not serve laws\n\nfour-bar:40"),
                    json.dumps({"benchmarks": [{"name": "csc_klu/refactor/x", "run_type": "iteration", "steps": 1, "cpu_time": 1, "variables": 50},
                                               {"name": "compiled_ldl/fronts/x", "error_occurred": True, "error_message": "unsupported: it does not serve laws"}]})):
        put(browser, "mine", said_so)
        press(browser, "use")
        browser = page(browser.value("location.hash")[1:])
        assert "compiled_ldl/fronts" not in ranked() | predicted() and "csc_klu/refactor" in ranked()
    press(browser, "forget")
    assert browser.value("document.getElementById('pin').dataset.n") == "100"
    for text, what in (('{"benchmarks": [null, {"name": 5, "run_type": "iteration", "steps": 1, "cpu_time": 1}]}', "no contender"),
                       ('{"variables": "5", "features": {"n": 5}}', "how many variables"), ("{", "whole JSON"), ("[1]", "not what"), ("{}", "neither"), ("hello", "not what"), (" ", "nothing")):
        put(browser, "mine", text)
        press(browser, "use")
        assert what in browser.value("document.getElementById('mine-said').innerText")


def test_a_summary_is_read_as_a_terminal_shows_it(page):
    """Lines that are too long go on after four blanks; with shares of the time, and with who was left out."""
    browser = page()
    mine = browser.value(f"readScene({json.dumps(SUMMARY)})")
    assert (mine["scene"], mine["n"], mine["fill"]) == ("harness/scenes/problems/a_mechanism_with_a_name_of_many_words.json", 22, 25.6)
    assert mine["machine"] == "A processor with a name of quite many words"
    assert mine["own"] == [{"name": "compiled_ldl/fronts", "us": 1.279}, {"name": "csc_klu/refactor", "us": 2.188}]
    assert mine["unable"] == ["compiled_chains/sweeps", "eigen_dense/llt"]
    put(browser, "mine", SUMMARY)
    press(browser, "use")
    browser.wait("!!explorer.state.mine")
    assert f"yours was measured on {mine['machine']}" in said(browser)
    assert browser.value("explorer.shown.near.flatMap((one) => one.ranking.ratios).filter(([name]) => explorer.state.mine.unable.includes(name))") == []


def test_a_hostile_scene_reaches_neither_a_terminal_nor_a_spreadsheet_nor_the_order(page):
    browser = page()
    for scene, word in (("--benchmark_out=/etc/passwd", "./--benchmark_out=/etc/passwd"), ("a\u0003\nrm -rf ~\u202e;", "'a  rm -rf ~ ;'")):
        put(browser, "mine", json.dumps(DESCRIBED | {"scene": scene}))
        press(browser, "use")
        assert browser.value("document.querySelector('#copy pre').textContent").startswith(f"build/mbs bench {word} --implementation=")
    assert browser.value("""[cell("-1+cmd"), cell(-1)]""") == ["'-1+cmd", "-1"]
    put(browser, "mine", json.dumps(DESCRIBED | {"features": {"n": 50, "flops": 0}}))  # by which nothing is near
    press(browser, "use")
    assert browser.value("explorer.shown.near[0].contest.n") == pytest.approx(50, rel=0.5)
    browser.value("useText(Promise.reject(new Error('a folder')))")
    assert browser.value("document.getElementById('mine-said').textContent") == "not used: a folder"


def test_own_measurements_are_drawn_over_ours(page):
    browser = page()
    drop = "document.getElementById('drop').dispatchEvent(new DragEvent('drop', {{dataTransfer: (() => {{ const one = new DataTransfer(); {0}; return one; }})(), bubbles: true, cancelable: true}}))"
    browser.value(drop.format(f"one.items.add(new File([{json.dumps(PRINTED)}], 'bench.txt'))"))
    browser.wait("document.querySelectorAll('#near-0 .own').length === 2")
    assert "Some processor" in said(browser) and browser.value("explorer.shown.near[0].contest.scene") == "four-bar:10"
    assert "2.19" in browser.value("document.querySelector('#near-0 tr[data-name=\"csc_klu/refactor\"]').textContent")
    rows = [{"run_type": "iteration", "name": f"{name}/four-bar:10", "cpu_time": us, "steps": 10, "variables": 22, "fill_percent": 25.6}
            for name, us in (("eigen_dense/llt", 50), ("eigen_dense/llt", 70), ("csc_klu/refactor", 20))]
    browser.value(drop.format(f"one.setData('text', {json.dumps(json.dumps({'context': {'cpu_model': SECOND}, 'benchmarks': rows}))})"))
    browser.wait("document.querySelectorAll('#near-0 .own').length === 2 && explorer.state.mine.own[0].us === 6")
    address = browser.value("location.hash")
    page(address[1:])
    assert browser.value("document.querySelectorAll('#near-0 .own').length") == 2
    shown = lambda: browser.value("[...document.querySelectorAll('#near-0 .own')].map((one) => one.parentNode.dataset.name)")
    more = PRINTED.replace("\n\nfour-bar:40", "\na/newcomer                 3.188  2.493 (2.490..2.496)          19.27   2.256  3.69e-05\n\nfour-bar:40")
    put(browser, "mine", more)
    press(browser, "use")
    browser.wait("explorer.state.mine.own.length === 3")
    assert set(shown()) == {"compiled_ldl/fronts", "csc_klu/refactor", "a/newcomer"}
    assert "3 measurements, 3 drawn" in browser.value("document.getElementById('mine-said').textContent")
    put(browser, "mine", more.replace("compiled_ldl/fronts ", "b/newcomer ").replace("csc_klu/refactor ", "c/newcomer "))  # beside nobody of ours
    press(browser, "use")
    browser.wait("explorer.state.mine.own[0].name === 'b/newcomer'")
    assert shown() == [] and "3 measurements, 0 drawn" in browser.value("document.getElementById('mine-said').textContent")


def test_a_second_instance_stands_for_nobody(page):
    rows = [["x", "a", 2], ["csc_klu/refactor", "a", 1], ["csc_klu/refactor+twin", "a", 4], ["y", "b", 3], ["csc_klu/refactor", "b", 1]]
    asked = [[name, {"environment": environment, "number": 1}, [us]] for name, environment, us in rows]
    assert page().value(f"new Paired({json.dumps(asked)}).ratio('x', 'y').value") == pytest.approx(2 / 3)


def test_what_is_copied_chosen_and_pasted(page):
    browser = page("scene=ladder:10")
    browser.value("Object.defineProperty(navigator, 'clipboard', {value: {writeText: async (text) => { window.copied = text; }}})")
    press(browser, "link")
    press(browser, "link")
    browser.wait("document.getElementById('link').textContent === 'copied'")
    browser.wait("document.getElementById('link').textContent.startsWith('copy a link')", 5)
    assert browser.value("copied") == browser.value("location.href") and "scene=ladder" in browser.value("copied")
    lines = browser.value("""[...document.querySelectorAll('#copy .command')].map((one) => {
      one.querySelector('button').click(); return [one.querySelector('pre').textContent, copied]; })""")
    assert len(lines) == 3 and all(line == copied for line, copied in lines)
    browser.value(f"""(() => {{ const data = new DataTransfer(), file = document.getElementById('file');
      data.items.add(new File([{json.dumps(PRINTED)}], 'bench.txt')); file.files = data.files; file.dispatchEvent(new Event('change')); }})()""")
    browser.wait("explorer.state.mine?.scene === 'four-bar:10' && document.querySelectorAll('#near-0 .own').length === 2")
    browser.value(f"""(() => {{ const mine = document.getElementById('mine'); mine.value = {json.dumps(json.dumps(DESCRIBED))};
      mine.dispatchEvent(new ClipboardEvent('paste')); }})()""")
    browser.wait("document.getElementById('pin').dataset.n === '50'")
    kept = lambda: browser.value("[document.getElementById('file').value, document.getElementById('mine-said').textContent].filter(Boolean).length")
    assert kept() == 2
    put(browser, "scene", "four-bar:49", "change")  # with which one's own scene is given up
    assert kept() == 0


def test_rows_marks_and_files(page):
    browser = page("scene=ladder:10&no=own")
    browser.value("document.querySelector('#near-0 .bar').dispatchEvent(new MouseEvent('click'))")
    assert browser.value("document.querySelector('#near-0 details').open && !document.querySelector('#near-0 tr.raw').hidden")
    assert "raw/families/" in browser.value("document.querySelector('#near-0 tr.raw').textContent")
    browser.value("""URL.createObjectURL = (blob) => { window.saved = blob; return 'blob:none'; }; HTMLAnchorElement.prototype.click = function () { window.link = this.download; };""")
    for button, name, start in (("csv", "ranking.csv", "kind,machine"), ("svg-map", "map.svg", "<svg"), ("svg-ranking", "ranking.svg", "<svg")):
        press(browser, button)
        text = browser.value("saved.text()")
        assert browser.value("link") == name and text.startswith(start) and "var(--" not in text
        if start == "<svg":
            line = browser.value(f"new DOMParser().parseFromString({json.dumps(text)}, 'image/svg+xml').documentElement.lastChild.textContent")
            assert all(part in line for part in browser.value("[shown.set.machine, shown.set.date.slice(0, 10), `${shown.form} form`]"))
            assert line.endswith("left out: code of our own, on no library")
    press(browser, "csv")
    lines = browser.value("saved.text()").splitlines()
    assert lines[0].endswith(",settled") and {line.rpartition(",")[2] for line in lines if line.startswith("measured,")} <= {"true", "false"}
    assert any(line.startswith("measured,") and f",{winner(browser)},fastest,1,1,1," in line for line in lines) and any(line.startswith("interpolated,") for line in lines)
    assert browser.value("[Infinity, NaN, undefined, null].map(cell)") == [""] * 4 and "Infinity" not in "".join(lines)
    assert browser.value("cell('=1+1')") == "'=1+1" and browser.value("cell('a\"b,c')") == '"a""b,c"'
    browser.value("document.querySelectorAll('#map .mark')[3].dispatchEvent(new MouseEvent('click'))")
    assert browser.value("explorer.state.scene") == browser.value("document.querySelectorAll('#map .mark title')[3].textContent.split(': ')[0]")


BEYOND_FRAME = """[...document.querySelectorAll('svg text')].filter((one) => { const [box, frame] = [one, one.ownerSVGElement].map(
  (some) => some.getBoundingClientRect()); return box.left < frame.left || box.right > frame.right; }).map((one) => one.textContent)"""
TOUCHING = """[...document.querySelectorAll('.bar')].flatMap((bar) => [...bar.querySelectorAll('text')].flatMap((one, i, all) => all.slice(i + 1).filter((other) => {
  const [a, b] = [one, other].map((some) => some.getBoundingClientRect());
  return a.left < b.right && b.left < a.right && a.top < b.bottom - 2 && b.top < a.bottom - 2; }).map((other) => `${one.textContent} | ${other.textContent}`)))"""


@pytest.mark.parametrize("scene", ["four-bar:10", "ladder:10"])
def test_no_words_of_a_ranking_touch_each_other_or_leave_it(page, scene):
    browser = page(f"scene={scene}&error=0.001&deadline=5")
    for width in (360, 700, 1200):
        browser.resize(width, 760)
        browser.value("new Promise((done) => setTimeout(done, 400))")
        assert browser.value("document.querySelectorAll('#points .bar').length") > 3
        assert browser.value(TOUCHING) == browser.value(BEYOND_FRAME) == [], width


def test_what_is_not_drawn_cannot_be_saved(page):
    browser = page("no=penalty,saddle")
    assert browser.value("document.querySelectorAll('#map svg, #near svg').length") == 0
    for button in ("svg-map", "svg-ranking"):
        assert browser.value(f"document.getElementById('{button}').disabled")
        press(browser, button)
    press(browser, "saddle")
    assert not browser.value("document.getElementById('svg-map').disabled") and "saddle-point form" in browser.value("document.querySelector('#map figcaption').innerText")


def test_a_set_without_contests_has_a_page(browser, folder, tmp_path):
    for name in ("set.json", "registry.json"):
        shutil.copyfile(folder / name, tmp_path / name)
    site.write_index(tmp_path)
    browser.complaints.clear()
    browser.open(tmp_path / "explore.html")
    browser.wait("!!window.explorer")
    assert "None of those that are left" in said(browser) and browser.complaints == []


def test_keys_and_width(page):
    browser = page("scene=ladder:10")
    browser.value("document.getElementById('own').focus()")
    browser.key(" ")
    assert browser.value("explorer.state.no") == ["own"]
    unnamed = browser.value("""[...document.querySelectorAll('input, select, textarea, button')].filter((one) =>
      !one.labels?.length && !one.getAttribute('aria-label') && !one.textContent.trim()).map((one) => one.outerHTML)""")
    assert unnamed == []
    assert browser.value("[...document.querySelectorAll('svg')].every((one) => one.getAttribute('role') === 'img' && one.getAttribute('aria-label'))")
    for width in (360, 1300, 1600):
        browser.resize(width, 800)
        browser.value("new Promise((done) => setTimeout(done, 400))")
        browser.value("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
        assert browser.value(BEYOND) <= 0
        assert browser.value(BEYOND_FRAME) == []
        assert width == 360 or browser.value(HIDDEN) == []
    browser.resize(1200, 760)
