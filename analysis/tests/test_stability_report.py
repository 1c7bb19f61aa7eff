# The maps and the page of study/stability on a small table of every outcome.
import matplotlib.pyplot as plt
import pandas

from analysis.stability.figure import category, draw
from analysis.stability.report import automatic, inaccurate, render, valleys

STATUSES = ("diverged", "ok", "ok", "degraded", "wrong-branch", "not-converged", "timeout", "crashed")


def table():
    rows = [{"loops": 2, "scheme": "penalty", "precision": "double", "implementation": "one/a",
             "step": step, "penalty_asked": "x", "penalty": 4 * 10.0**power / step**2,
             "alpha_dt2_4": 10.0**power, "status": status, "status_reason": "because",
             "position_error_max": 1e-3 if status in ("ok", "degraded") else float("nan"),
             "command": f"run {power}"}
            for step in (1e-3, 2e-3) for power, status in enumerate(STATUSES)]
    rows.append(rows[0] | {"penalty_asked": "auto", "penalty": 1e7, "alpha_dt2_4": 2.5})
    return pandas.DataFrame(rows)


def windows():
    return pandas.DataFrame([{"loops": 2, "precision": "double", "step": step, "lower": 1e6, "upper": 1e9}
                             for step in (1e-3, 2e-3)])


def page(rows, long=None):
    context = {"compiler": "c", "commit": "0"}
    return render(rows, {"contexts": {"own": context}, "inputs": {"duration": 2.0}},
                  {("penalty", precision): "AAAA" for precision in dict.fromkeys(rows.precision)}, long)


def test_the_map_names_every_outcome_that_occurs():
    figure = draw(table(), windows(), "penalty", "double")
    [legend] = figure.legends
    named = {text.get_text() for text in legend.get_texts()}
    assert {category(status) for status in STATUSES} - {"ok"} <= named
    assert {"estimated lower end", "estimated upper end", "automatic α", "the paper's setting"} <= named
    plt.close(figure)


def test_a_map_of_one_cell_can_be_drawn():
    rows = table()
    figure = draw(rows[(rows.step == 1e-3) & (rows.status == "timeout")], windows(), "penalty", "double")
    plt.close(figure)


def test_valleys_are_the_ends_of_what_is_ok():
    rows = table()
    assert valleys(rows) == {2: {1e-3: (10, 100, 2, 2), 2e-3: (10, 100, 2, 2)}}
    rows.loc[rows.step == 2e-3, "status"] = ["ok", "diverged", "ok", *STATUSES[3:]]
    assert valleys(rows)[2][2e-3] == (1, 100, 2, 3)
    assert valleys(rows[rows.status == "timeout"]) == {2: {1e-3: None, 2e-3: None}}


def test_the_page_counts_outcomes_and_accuses_what_is_ok_but_wrong():
    rows = table()
    assert inaccurate(rows).empty and "No run is “ok” with a position error above" in page(rows)
    assert "diverged, because" in page(rows)  # the automatic penalty factor
    rows.loc[1, "position_error_max"] = 0.02
    assert "1 runs are “ok”" in page(rows) and "<code>run 1</code>" in page(rows)
    rows.loc[1, "position_error_max"] = float("nan")
    assert len(inaccurate(rows)) == 1


def test_where_the_automatic_penalty_factor_misses_a_valley_is_told_from_where_there_is_none():
    rows = table()
    [missed], none = automatic(rows)
    assert missed["valley"] == (10, 100, 2, 2) and none == []
    assert "In 1 cell another α is ok" in page(rows) and "no α is ok either" not in page(rows)
    rows.loc[(rows.step == 1e-3) & (rows.status == "ok"), "status"] = "degraded"
    missed, [alone] = automatic(rows)
    assert missed == [] and alone["valley"] is None
    assert "In no cell where another" in page(rows) and "In 1 where no α is ok either: N = 2 at 1 ms" in page(rows)
    rows.loc[rows.penalty_asked == "auto", "status"] = "ok"
    assert automatic(rows) == ([], []) and "no α is ok either" not in page(rows)


def test_valleys_that_are_missed_are_a_limit_of_single_precision_if_double_misses_none():
    single = table().assign(precision="single")
    double = table().assign(status=lambda rows: rows.status.mask(rows.penalty_asked == "auto", "ok"))
    text = page(pandas.concat([double, single]))
    assert "in 1 cell (below" in text and "there is no such cell: it is a limit of single precision" in text
    text = page(pandas.concat([table(), single]))
    assert "there is 1 such" in text and "it is a limit" not in text
    assert "it is a limit" not in page(single) and "neighbouring" not in page(table())


def test_the_page_says_what_the_whole_runs_are_of():
    long = pandas.DataFrame([{"scheme": scheme, "implementation": "one/a", "loops": loops, "status": "ok", "must_hold": "yes",
                              "position_error_max": 1e-3, "passes_per_step": 2.0, "steps_at_limit": 0}
                             for scheme, loops in (("penalty", 1), ("penalty", 40), ("rattle", 2))])
    text = page(table(), long)
    assert "everything automatic: penalty (one/a) N = 1, 40; rattle (one/a) N = 2. In" in text and "All do." in text
