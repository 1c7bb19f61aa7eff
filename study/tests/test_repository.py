# The repository as a visitor finds it: what stands at the top, how long texts are, numbers that come from sets.
import re
import shutil
import subprocess
from collections import Counter

import pandas
import pytest
import yaml

from analysis.core import records, schema, site
from analysis.core.files import ROOT, read_json
from analysis.core.view import View, parts
from study.tests.browser import HIDDEN, TALL, Browser
from study.tests.conftest import study
from study.tools import fragments

TRACKED = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\n")[:-1]
SETS = sorted(path.parent for path in (ROOT / "results").glob("*/set.json"))
MAIN = fragments.main_set()
OTHERS = [folder for folder in SETS if folder != MAIN]
# A measured number: one with a unit of time or a ratio behind it, or that is said to be measured. Steps, durations and masses of
# scenes are settings.
MEASURED = re.compile(r"\d(?:[\d.,]*\d)?\s?(?:µs|ns|times (?:faster|slower|less|as (?:fast|slow|long))|× (?:faster|slower))|measured \d|about a second")


def test_the_top_level_holds_what_the_readme_names():
    named = (ROOT / "README.md").read_text(encoding="utf-8")
    top = {path.split("/")[0] for path in TRACKED}
    usual = {"README.md", "LICENSE", "CITATION.cff", "CMakeLists.txt", "CMakePresets.json", "CONTRIBUTING.md"}
    strange = {name for name in top if not name.startswith(".") and name not in usual and f"`{name}/`" not in named}
    assert strange == set()


def test_there_are_fewer_than_1800_files():
    assert len(TRACKED) < 1800


def test_the_example_to_read_is_short():
    sources = [ROOT / path for path in TRACKED if re.fullmatch(r"implementations/minimal_dense/\w+\.[ch]pp", path)]
    assert len(sources) == 3 and sum(len(path.read_text(encoding="utf-8").splitlines()) for path in sources) <= 250


def test_readmes_are_short():
    assert len((ROOT / "README.md").read_text().splitlines()) <= 70
    long = {path: count for path in TRACKED if path.endswith(".md")
            for count in [len((ROOT / path).read_text().splitlines())] if count > 150}
    assert long == {}


def test_every_part_says_what_it_runs():
    assert [part for part in parts() if f"study/{part}/README.md" not in TRACKED] == []


def test_the_rule_is_that_of_its_set():
    text = fragments.RULE.read_text(encoding="utf-8")
    assert fragments.of_set(text) == text, "study/store writes it anew"


def test_it_is_cited_with_the_commit_of_its_set_and_no_earlier_date(monkeypatch):
    text = fragments.CITATION.read_text(encoding="utf-8")
    cited, facts = yaml.safe_load(text), read_json(fragments.main_set() / "set.json")
    assert str(cited["date-released"]) >= facts["date"][:10] and cited["commit"] == facts["context"]["commit"]
    assert fragments.cited(text.replace(cited["commit"], "0" * 40)) == text, "study/store fills it anew"
    monkeypatch.setattr(fragments, "rewritten", lambda path, made: made is fragments.cited)
    assert fragments.refresh() == [fragments.CITATION]


@pytest.mark.parametrize("path", fragments.texts(), ids=lambda path: str(path.relative_to(ROOT)))
def test_numbers_in_texts_are_those_of_the_sets(path):
    text = path.read_text(encoding="utf-8")
    assert fragments.filled(text) == text, "study/store fills it anew"


def test_no_measured_number_is_typed():
    typed = {}
    for path in [*fragments.texts(), *(ROOT / name for name in TRACKED if name.endswith(".j2"))]:
        own = fragments.MARKED.sub("", path.read_text(encoding="utf-8"))
        found = MEASURED.findall(own)
        if found:
            typed[str(path.relative_to(ROOT))] = found
    assert typed == {}


@pytest.mark.parametrize("text", ["4 µs", "1.5 times faster", "2 times as long", "(measured 0.593 at N = 1)", "takes about a second"])
def test_a_measured_number_is_seen(text):
    assert MEASURED.search(text) and not MEASURED.search(re.sub(r"\d|about a second", "", text))


def test_at_most_three_sets_are_stored_each_of_a_clean_tree():
    assert len(SETS) <= 3
    for folder in SETS:
        assert str(read_json(folder / "set.json")["context"]["dirty"]).lower() == "false"


def test_stored_sweeps_are_a_million_lanes_of_a_clean_tree_in_little_memory():
    for record in map(read_json, fragments.SWEEPS.glob("*.json")):
        assert str(record["context"]["dirty"]).lower() == "false" and record["lanes"] >= 10**6 == 100 * record["part"][0]["lanes"]
        assert record["lanes"] == sum(record["outcomes"].values()) == record["whole"]["lanes"] == record["merge"]["lanes"]
        assert Counter(row["jobs"] for row in record["part"]) == dict.fromkeys((1, 2), fragments.gain(record["part"])["turns"])
        assert max(row["memory_mb"] for row in (*record["part"], record["whole"], record["merge"])) < 500


@pytest.mark.parametrize("folder", SETS, ids=lambda folder: folder.name)
def test_a_stored_set_has_all_parts(folder):
    assert set(read_json(folder / "set.json")["parts"]) == set(parts())
    assert [part for part in parts() if not records.archive_of(folder, part).exists()] == []


@pytest.fixture(scope="module")
def shipped(tmp_path_factory):
    """The main set, drawn again, among the others that are stored."""
    base = tmp_path_factory.mktemp("results")
    for other in OTHERS:
        (base / other.name).symlink_to(other)
    copy = shutil.copytree(MAIN, base / MAIN.name)  # whose records are of one machine and commit, or it is not drawn
    done = study("figures", copy, seconds=1500)
    assert done.returncode == 0, done.stderr
    return copy


def need_tables_of(folder, copy):
    """What set and code share, as a set of another state of the code may have more or less. References are integrated anew: another
    processor takes other steps, so errors differ to their tolerance, and what two tolerances differ by in any digit."""
    for part in parts():
        for table in read_json(folder / part / schema.DIGESTS)["tables"].keys() & schema.of_part(part).keys():
            there = pandas.read_csv(folder / part / f"{table}.csv", nrows=0).columns.difference(["own_error"])
            drawn, stored = (schema.read_table(one, part, table).filter(there) for one in (copy, folder))
            pandas.testing.assert_frame_equal(drawn, stored, rtol=1e-4, atol=1e-9, obj=f"{part}/{table}")


@pytest.mark.slow
@pytest.mark.xdist_group("stored main")
def test_the_main_set_is_drawn_again_as_it_was(shipped, tmp_path):
    with Browser(tmp_path, 1300, 900) as browser:
        for page in sorted(shipped.glob("*.html")):
            browser.open(page)
            assert browser.value(TALL) == browser.value(HIDDEN) == [], page.name
    assert [part for part in parts() if not (shipped / f"{part}.html").exists()] == []
    need_tables_of(MAIN, shipped)


@pytest.mark.slow
@pytest.mark.xdist_group("stored main")
def test_what_is_shipped_is_small_and_whole(shipped):
    text = (shipped / "explore.html").read_text(encoding="utf-8")
    assert len(text.encode()) < 3e6
    assert "http://" not in text.replace("http://www.w3.org/", "") and "https://" not in text
    front = (shipped / "index.html").read_text(encoding="utf-8")
    assert "<code>study/advise</code>" in front and "`" not in front


@pytest.mark.slow
@pytest.mark.xdist_group("stored main")
def test_the_site_is_of_the_commit_that_the_rule_names(browser, shipped):
    commit = read_json(fragments.RULE)["commit"]
    assert commit[:10] in (shipped / "index.html").read_text(encoding="utf-8")
    browser.open(shipped / "explore.html")
    commits, machines = (browser.value(asked) for asked in (
        "DATA.sets.map((one) => one.commit)", "[...document.getElementById('machine').options].map((one) => one.text)"))
    assert {*commits} == {commit} and len(machines) == len(commits) >= 2


@pytest.mark.slow
@pytest.mark.xdist_group("stored others")  # in one process: of what both ask alike, the references, each is integrated once
@pytest.mark.parametrize("folder", OTHERS, ids=lambda folder: folder.name)
def test_the_same_code_makes_the_tables_of_another_set_as_they_were(folder, tmp_path):
    copy = shutil.copytree(folder, tmp_path / folder.name)
    for part in parts():
        site.write_tables(View(copy, part))
    need_tables_of(folder, copy)
