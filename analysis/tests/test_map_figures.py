# What the maps show on small tables: winners, losses, regions, families, regrets, repeated runs.
import json
import shutil

import matplotlib.pyplot as plt
import numpy
import pytest

from analysis import repeat
from analysis.figures import f6_map, f7_map, map_families, regret_map
from analysis.loader import load
from analysis.maps import map_cells
from analysis.maps_drawing import UNMEASURED, UNREACHED
from analysis.style import Look
from analysis.tests.conftest import write
from analysis.tests.test_maps import cell

FIGURES = [f6_map, f7_map, map_families, regret_map]


@pytest.fixture
def results(tables):
    """Turns rows into results; keywords set what the registry says of a variant."""
    def build(rows, **variants):
        write(tables[0] / "tidy.csv", "tidy", rows)
        path = tables[0] / "implementations.json"
        registry = json.loads(path.read_text())
        for variant in registry["implementations"][0]["variants"]:
            variant |= variants.get(variant["name"][0], {})
        path.write_text(json.dumps(registry))
        return load(tables[0])
    yield build
    plt.close("all")


def texts(figure):
    return [text.get_text() for axes in figure.axes for text in axes.texts]


def hatches(figure):
    return [patch.get_hatch() for axes in figure.axes for patch in axes.patches]


@pytest.mark.parametrize("figure", FIGURES)
@pytest.mark.parametrize("rows", [[], cell(None, {"a/x": "crashed", "b/y": "excluded"}),
                                  cell(None, {"a/x": 1.0}, size=4)])
def test_figures_need_no_data(results, figure, rows):
    figure.draw(results(rows)).canvas.draw()


@pytest.mark.parametrize("levels, text, hatched", [
    ({"a/x": 1.0, "b/y": 2.0}, "A 2.00× B", False),
    ({"a/x": 1.0, "b/y": 2.0, "c/z": "excluded"}, "A 2.00× B ▲1", False),
    ({"a/x": 1.0, "b/y": "excluded"}, "A alone ▲1", False),
    ({"a/x": 1.0, "b/y": "excluded", "c/z": "crashed"}, "A alone ▲1✕1", True),
    ({"a/x": 1.0, "b/y": 1.0}, "A 1.00× B", True),
    ({"a/x": "crashed", "b/y": "timeout"}, "none ✕2", True)])
def test_a_cell_says_winner_margin_and_second(results, levels, text, hatched):
    drawn = f7_map.draw(results(cell(None, levels, (1, 2, 3, 4))))
    assert text in texts(drawn)
    assert ("////" in hatches(drawn)) == hatched


def colours(figure):
    return [patch.get_facecolor() for patch in figure.axes[0].patches if patch.get_height() > 1]


def test_below_the_own_fill_is_not_reached_and_elsewhere_not_measured(results):
    natural = f7_map.draw(results(cell(None, {"a/x": 1.0, "b/y": 2.0})))
    unreached = plt.matplotlib.colors.to_rgba(UNREACHED)
    assert unreached in colours(natural) and UNMEASURED["hatch"] in hatches(natural)
    filled = f7_map.draw(results(cell(0.6, {"a/x": 1.0, "b/y": 2.0})))
    assert unreached not in colours(filled)  # nobody knows where the own fill lies


def test_f6_stops_at_100_variables_and_f7_does_not(results):
    levels = {"a/x": 1.0, "b/y": 2.0}
    both = results(sum((cell(None, levels, size=size) for size in (4, 10, 100, 160)), []))

    def sizes(figure):
        return [label.get_text() for label in figure.axes[0].get_xticklabels()]
    assert sizes(f6_map.draw(both)) == ["10", "100"]
    assert sizes(f7_map.draw(both)) == ["4", "10", "100", "160"]


def test_refined_cells_are_marked(results):
    rows = cell(None, {"a/x": 1.0, "b/y": 2.0}) + cell(0.7, {"a/x": 1.0, "b/y": 2.0},
                                                       stage="refined")
    rows += cell(None, {"a/x": 1.0, "b/y": 2.0}, (4, 5), "refined")
    shown = texts(f7_map.draw(results(rows)))
    assert shown.count("•") == 1 and shown.count("+") == 1


def test_the_crossing_is_drawn_where_dense_overtakes(results):
    rows = (cell(0.6, {"a/x": 4.0, "b/y": 1.0}, spread=0)
            + cell(0.9, {"a/x": 1.0, "b/y": 2.0}, spread=0))
    drawn = f7_map.draw(results(rows, a={"dense": True}))
    assert drawn.axes[0].lines[0].get_ydata() == pytest.approx([80, 80, 80])
    assert not f7_map.draw(results(rows, a={"dense": False})).axes[0].lines


def test_families_come_from_the_registry(results):
    rows = cell(None, {"a/x": 1.0, "b/y": 2.0}, spread=0)
    both = results(rows, b={"unsymmetric": True})
    named = map_families.families(both)
    assert list(named.values()) == [["a/x", "b/y"], ["a/x", "b/y"], ["a/x"], ["b/y"]]
    shown = texts(map_families.draw(both))
    assert "one member only, a/x: nothing is compared" in shown and "A 2.00× B" in shown
    empty = texts(map_families.draw(results(cell(None, {"a/x": 1.0}), a={"unsymmetric": True})))
    assert "nobody of this family is in these results" in empty


@pytest.mark.parametrize("folder, library, member", [
    ("csc_klu", "KLU", True), ("own", "none", False), ("own", "", False), ("own", None, False),
    ("starting_sparse", "MUMPS", False), ("ublas_sparse", "Boost.uBLAS + KLU", False)])
def test_library_solvers(results, folder, library, member):
    both = results(cell(None, {"a/x": 1.0}), a={"folder": folder, "library": library})
    family = [names for title, names in map_families.families(both).items() if "librar" in title]
    assert family == [["a/x"] if member else []]


def test_regrets(results):
    rows = (cell(None, {"a/x": 1.0, "b/y": 4.0, "c/z": 2.0}, spread=0)
            + cell(0.8, {"a/x": "excluded", "b/y": 1.0, "c/z": "crashed"}, spread=0))
    for row in rows:
        row |= {"pilot_ratio": 400.0} if row["status"] == "excluded" else {}
    both = results(rows)
    first, second, last = regret_map.regrets(both, map_cells(both))
    assert (first.name, second.name, last.name) == ("b/y", "a/x", "c/z")  # who fails comes last
    assert (first.mean, first.worst) == pytest.approx((2.0, 4.0))
    assert (second.mean, second.worst) == pytest.approx((20.0, 400.0)) and len(second.rough) == 1
    assert last.mean == pytest.approx(2.0) and len(last.failed) == 1
    drawn = regret_map.draw(both)
    assert {"~400", "4.0", "✕"} <= set(texts(drawn))
    assert "B  b/y\nmean 2.0×, worst 4.0×" == drawn.axes[0].get_title(loc="left")


def test_excluded_without_a_pilot_has_no_number(results):
    both = results(cell(None, {"a/x": 1.0, "b/y": "excluded"}))
    last = regret_map.regrets(both, map_cells(both))[-1]
    assert last.name == "b/y" and last.mean == numpy.inf
    assert "▲" in texts(regret_map.draw(both))


def maps_of(tables, *runs):
    found = []
    for rows in runs:
        write(tables[0] / "tidy.csv", "tidy", rows)
        found.append(load(tables[0]))
    return found


def test_two_runs(tables):
    fast, slow, tie = ({"a/x": 1.0, "b/y": level} for level in (2.0, 0.5, 1.005))
    runs = maps_of(tables, cell(None, fast) + cell(0.7, fast) + cell(0.8, fast) + cell(0.9, fast),
                   cell(None, fast) + cell(0.7, slow) + cell(0.8, tie))
    maps = repeat.shared_maps(*runs)
    lines = repeat.summary(repeat.pairs(*maps))
    assert lines[0] == "3 common cells, 2 decided in both, 1 of them with the same winner: 50.0 %"
    assert len(lines) == 2 and lines[1].startswith("four-bar:4,fill=0.70: a/x 1.96")
    assert "| b/y 2.04" in lines[1]
    assert repeat.differences(*runs) == ["cells in one run only: 1 in the first, 0 in the second"]
    ratios = repeat.time_ratios(repeat.pairs(*maps))
    assert sorted(ratios[:, 1].round(2)) == pytest.approx([0.25, 0.5, 1, 1, 1, 1], abs=0.02)
    figure = repeat.draw(Look(runs[0]), *maps)
    figure.canvas.draw()
    plt.close(figure)


def test_runs_of_other_implementations_are_compared_on_the_shared_ones(tables):
    runs = maps_of(tables, cell(None, {"a/x": 1.0, "b/y": 2.0, "c/z": 0.1}),
                   cell(None, {"a/x": 1.0, "b/y": 2.0}))
    assert repeat.summary(repeat.pairs(*repeat.shared_maps(*runs)))[0].endswith("100.0 %")
    assert repeat.differences(*runs) == ["left out, in one run only: c/z"]


def test_nothing_in_common_is_no_crash(tables):
    runs = maps_of(tables, cell(None, {"a/x": 1.0}), cell(0.7, {"a/x": 1.0}))
    maps = repeat.shared_maps(*runs)
    assert repeat.summary(repeat.pairs(*maps))[0].endswith("no share")
    plt.close(repeat.draw(Look(runs[0]), *maps))


def test_repeat_command_line(tables, capsys):
    write(tables[0] / "tidy.csv", "tidy", cell(None, {"a/x": 1.0, "b/y": 2.0}))
    output, other = tables[0] / "out.png", tables[0].with_name("other")
    shutil.copytree(tables[0], other)
    repeat.main([str(tables[0]), str(other), str(output)])
    assert "1 decided in both, 1 of them" in capsys.readouterr().out and output.stat().st_size
    with pytest.raises(SystemExit, match="error: .*missing/tidy.csv: cannot be read"):
        repeat.main([str(tables[0]), "missing", str(output)])
