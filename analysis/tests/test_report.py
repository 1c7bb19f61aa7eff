# Figures and report on small tables: what they show, and that they need nothing from outside.
import re

import matplotlib.pyplot as plt
import pytest

from analysis import tables as report_tables
from analysis.figures import phases, region_map, step_time
from analysis.loader import load
from analysis.report import number, render
from analysis.tests.conftest import timing, write


@pytest.mark.parametrize("figure", [step_time, phases, region_map])
def test_figures_are_drawn(tables, figure):
    drawn = figure.draw(load(tables[0]))
    assert drawn.axes
    plt.close(drawn)


def texts(figure):
    return [text.get_text() for axes in figure.axes for text in axes.texts]


def test_region_map_shows_margin_failures_and_exclusions(tables):
    folder, rows = tables
    rows.append(timing("c/z", "", "", "", status="excluded", reason="at least 100 times slower"))
    write(folder / "tidy.csv", "tidy", rows)
    assert "A 1.98×  ▲1" in texts(region_map.draw(load(folder)))


def test_failed_cells_are_never_ranked(tables):
    folder, rows = tables
    for row in rows:
        if row["implementation"] == "a/x":  # the faster one
            row |= {"status": "disagrees", "reason": "wrong"}
    write(folder / "tidy.csv", "tidy", rows)
    results = load(folder)
    assert [entry["ranking"].winner for entry in report_tables.winners(results)] == ["b/y"]
    assert not report_tables.winners(results)[0]["ranking"].decided  # nobody is left to beat
    assert report_tables.losses(results)[0]["reason"] == "wrong"
    drawn = region_map.draw(results)
    assert "B alone  ✕1" in texts(drawn)
    assert any(patch.get_hatch() == "////" for patch in drawn.axes[0].patches)


def test_alone_against_excluded_ones_is_decided(tables):
    folder, rows = tables
    kept = [row for row in rows if row["implementation"] == "a/x"]
    kept.append(timing("b/y", "", "", "", status="excluded", reason="at least 100 times slower"))
    write(folder / "tidy.csv", "tidy", kept)
    results = load(folder)
    assert report_tables.winners(results)[0]["ranking"].decided
    drawn = region_map.draw(results)
    assert "A alone  ▲1" in texts(drawn)
    assert not any(patch.get_hatch() == "////" for patch in drawn.axes[0].patches)


@pytest.mark.parametrize("fills, bounds", [
    ([], [0.0]), ([0.6], [0.6, 5.6]), ([98.0], [98.0, 100.0]),
    ([10, 20, 40], [10, 15, 30, 50]), ([50, 75, 100], [50, 62.5, 87.5, 100])])
def test_cells_reach_no_further_than_their_own_fill(fills, bounds):
    assert region_map.cell_bounds(fills) == pytest.approx(bounds)


def test_a_scene_without_any_pilot_stays_on_the_map(tables):
    folder, rows = tables
    for name in ("a/x", "b/y"):
        rows.append(timing(name, "", "", "", status="crashed", reason="SIGSEGV", fill_percent="",
                           scene="four-bar:4,fill=0.80", fill_asked=0.8))
    write(folder / "tidy.csv", "tidy", rows)
    results = load(folder)
    assert list(region_map.scene_fills(results.tidy)) == [52, 80]
    assert "none  ✕2" in texts(region_map.draw(results))


def test_exponent_names_the_passes_behind_it(tables):
    folder, rows = tables
    rows += [timing("csc_klu/refactor", 1, 1, size, variables=size, scene=f"n{size}", passes=200)
             for size in (100, 200, 1000)]
    registry = folder / "implementations.json"
    registry.write_text(registry.read_text().replace("c/z", "csc_klu/refactor"))
    write(folder / "tidy.csv", "tidy", rows)
    row = next(row for row in report_tables.must_hold(load(folder)) if "exponent" in row["claim"])
    assert row["value"] == "1.00" and row["holds"]
    assert "n = 100: 2.00; n = 200: 2.00; n = 1000: 2.00; sizes above 602" in row["note"]
    assert row["note"].split("; ")[-1] in render(folder)


def test_report_is_self_contained_and_escaped(tables):
    folder, rows = tables
    rows.append(timing("c/z", "", "", "", status="crashed", reason="<b>SIGSEGV</b>"))
    write(folder / "tidy.csv", "tidy", rows)
    page = render(folder)
    assert "&lt;b&gt;SIGSEGV" in page
    assert not re.search(r'(src|href)="(?!data:|#)', page)
    assert "a/x" in page and "1.98 times" in page


@pytest.mark.parametrize("value, text", [
    (None, "–"), (float("nan"), "–"), (1.2345, "1.23"), (1234.5, "1234"), (1e8, "10⁸"),
    (2.5e-7, "2.5·10⁻⁷"), (0, "0")])
def test_number(value, text):
    assert number(value) == text
