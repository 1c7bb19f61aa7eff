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
    assert report_tables.losses(results)[0]["reason"] == "wrong"
    assert "B alone  ✕1" in texts(region_map.draw(results))


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
