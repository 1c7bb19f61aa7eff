# The report and its tables on small data: what they show, and that they need nothing from outside.
import json
import re

import pytest

from analysis import bounds
from analysis import tables as report_tables
from analysis.loader import load
from analysis.report import CAPTIONS, render
from analysis.summary import by_size
from analysis.tests.conftest import timing, write
from analysis.text import number


def test_failed_cells_are_never_ranked(tables):
    folder, rows = tables
    for row in rows:
        if row["implementation"] == "a/x":  # the faster one
            row |= {"status": "disagrees", "reason": "wrong"}
    write(folder / "tidy.csv", "tidy", rows)
    results = load(folder)
    assert [row["implementation"] for row in report_tables.step_times(results)] == ["b/y"]
    assert not report_tables.step_times(results)[0]["winner"]  # nobody is left to beat
    assert report_tables.losses(results)[0]["reason"] == "wrong"
    assert "disagrees" in render(folder)


def test_exclusions_are_grouped_and_failures_stand_alone(tables):
    folder, rows = tables
    for size, ratio in ((50, 120), (82, 300)):
        rows.append(timing("c/z", "", "", "", variables=size, scene=f"n{size}", status="excluded",
                           reason=f"{ratio} times slower", pilot_ratio=ratio))
    rows.append(timing("c/z", 1, "", "", scene="n160", status="crashed", reason="SIGSEGV"))
    rows.append(timing("c/z", 1, "", "", scene="n100", status="crashed", reason="SIGBUS"))
    write(folder / "tidy.csv", "tidy", rows)
    found = report_tables.losses(load(folder))
    assert [(row["status"], row["cells"]) for row in found] == [
        ("crashed", 1), ("crashed", 1), ("excluded", 2)]
    assert (found[-1]["low"], found[-1]["high"], found[-1]["scenes"]) == (120, 300, ["n50", "n82"])


def test_exponent_names_the_passes_behind_it(tables):
    folder, rows = tables
    rows += [timing("csc_klu/refactor", 1, 1, size, variables=size, scene=f"n{size}", passes=200)
             for size in (100, 200, 1000)]
    registry = folder / "implementations.json"
    registry.write_text(registry.read_text().replace("c/z", "csc_klu/refactor"))
    write(folder / "tidy.csv", "tidy", rows)
    row = next(row for row in bounds.must_hold(load(folder)) if "exponent" in row["claim"])
    assert row["value"] == "1.00" and row["holds"]
    assert "n = 100: 2.00; n = 200: 2.00; n = 1000: 2.00; sizes above 602" in row["note"]
    assert row["note"].split("; ")[-1] in render(folder)


def test_blas_pairs_name_the_files_that_were_loaded(tables):
    folder, _ = tables
    listed = json.loads((folder / "implementations.json").read_text())
    names = ("openblas", "atlas", "blis-flame")
    listed["blas"] = [{"name": name, "blas": name.upper(), "lapack": "own", "reason": reason,
                       "available": not reason} for name, reason in zip(names, ("", "", "absent"))]
    (folder / "implementations.json").write_text(json.dumps(listed))
    contexts = {"|openblas": {"compiler": "GNU", "flags": "-O3", "blas_loaded": "/l/a.so;/l/b.so"},
                "clang-O2|openblas": {"compiler": "Clang 14", "flags": "-O2", "blas_loaded": "/x"}}
    (folder / "run.json").write_text(json.dumps({"profile": "p", "only": [],
                                                 "contexts": contexts}))
    results = load(folder)
    assert [pair["files"] for pair in report_tables.blas_pairs(results)] == [
        ["/l/a.so", "/l/b.so"], [], []]
    assert [(row["build"], row["flags"]) for row in report_tables.builds(results)] == [
        ("own", "-O3"), ("clang-O2", "-O2")]
    page = render(folder)
    for text in ("/l/a.so", "not used in this run", "absent", "Clang 14"):
        assert text in page


def test_stages_count_what_refinement_added(tables):
    folder, rows = tables
    rows.append(timing("a/x", 9, 1, 1.0, stage="refined"))
    write(folder / "tidy.csv", "tidy", rows)
    assert report_tables.stages(load(folder)) == {"grid": (2, 18), "refined": (1, 1)}
    assert "refined:\n1 cells, 1 samples" in render(folder)


def test_report_is_self_contained_and_escaped(tables):
    folder, rows = tables
    rows.append(timing("c/z", "", "", "", status="crashed", reason="<b>SIGSEGV</b>"))
    write(folder / "tidy.csv", "tidy", rows)
    page = render(folder)
    assert "&lt;b&gt;SIGSEGV" in page
    assert not re.search(r'(src|href)="(?!data:|#)', page)
    assert re.search(r"n = 10: <b>a/x</b>,\s+1.98 times ahead of the second", page)
    assert page.count("cannot be tested here") >= 12


def test_the_answer_says_whose_fill_it_is_and_that_higher_ones_are_artificial(tables):
    page = render(tables[0])
    answer, maps = page.split('class="answer"')[1].split("</section>")
    for text in (answer, maps.split('id="maps"')[1].split("<h2")[0]):
        assert "N-four-bar" in text and "artificial" in text and "real mechanism" in text
    assert "own fill” on this page is the\nfour-bar's" in answer and "mbs bench scene.json" in answer
    assert "artificial" in CAPTIONS["f6_map"] and "artificial" in CAPTIONS["f7_map"]


def test_report_of_nothing_timed(tables):
    folder, _ = tables
    write(folder / "tidy.csv", "tidy", [timing("a/x", "", "", "", status="timeout", reason="late")])
    assert by_size(load(folder)) == []
    page = render(folder)
    assert "Nothing was timed." in page and "late" in page


def test_every_figure_of_the_folder_is_on_the_page_in_order(tables):
    folder, _ = tables
    (folder / "figures").mkdir()
    for name in ("new_one", "t2_operations", "f6_map"):
        (folder / "figures" / f"{name}.svg").write_text("<svg/>")
    page = render(folder)
    places = [page.index(f'id="{name}"') for name in ("f6_map", "t2_operations", "new_one")]
    assert places == sorted(places)


@pytest.mark.parametrize("value, text", [
    (None, "–"), (float("nan"), "–"), (1.2345, "1.23"), (1234.5, "1234"), (1e8, "10⁸"),
    (2.5e-7, "2.5·10⁻⁷"), (0, "0")])
def test_number(value, text):
    assert number(value) == text


def test_pages_of_other_studies_beside_it_are_linked(tables):
    folder = tables[0]
    assert "Other studies" not in render(folder)
    (folder.parent / "stability").mkdir()
    (folder.parent / "stability" / "stability.html").write_text("")
    assert '<a href="../stability/stability.html">Stability</a>' in render(folder)
