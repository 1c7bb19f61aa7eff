# The report of study/scenes on small tables: whom it compares and what it says of the references.
import json

import pandas

from analysis.scenes.report import render

COMPARED = ["one/a", "two/b"]
OWN, SELF = "own equations, integrated", "self-convergence of two implementations"


def tables(published):
    problems = [{"problem": name, "title": f"Problem {name}", "scene": "s", "implementation": one,
                 "step": step, "duration": 1.0, "reference": reference, "status": "ok",
                 "precision": "high", "error_rms": 1e-4, "error_max": 2e-4, "conserved": False,
                 "energy_drift_max": 1e-5, "passes_per_step": 2.0, "step_us": 3.0,
                 "variables": 4, "constraints": 3}
                for name, reference in (("P", OWN), ("Q", SELF))
                for one in [*COMPARED, "three/c"] for step in (1e-3, 5e-4)]
    convergence = [{"problem": name, "implementation": one, "component": "E.x", "time": 1.0,
                    "finest": 0.5, "order": 2.0, "order_meaningful": True,
                    "extrapolated": 0.50000012, "published": value, "difference": 0.50000012 - value}
                   for name, value in (("P", float("nan")), ("Q", published)) for one in COMPARED]
    return {"problems": pandas.DataFrame(problems), "convergence": pandas.DataFrame(convergence),
            "gate": pandas.DataFrame(), "modelling": pandas.DataFrame()}


def page(folder, published=0.5):
    (folder / "figures").mkdir()
    (folder / "figures" / "modelling.svg").write_text("<svg/>")
    (folder / "run.json").write_text(json.dumps(
        {"contexts": {"own": {"machine": "m", "compiler": "c", "commit": "0"}}}))
    return render(folder, tables(published), COMPARED)


def test_the_table_of_problems_shows_the_two_that_are_compared(tmp_path):
    table = page(tmp_path).split("<h2>Standard problems</h2>")[1].split("</tbody>")[0]
    assert "one/a and two/b" in table and "three/c" not in table
    assert table.count('<td class="s">one/a</td>') == table.count('<td class="s">two/b</td>') == 2


def test_every_problem_says_what_its_reference_is(tmp_path):
    text = page(tmp_path)
    assert f"<td>{OWN}</td>" in text and f"<td>{SELF}</td>" in text


def test_published_values_stand_beside_ours_with_the_difference(tmp_path):
    without, beside = page(tmp_path).split("<summary>")[1:3]
    assert "published" not in without
    assert '<th class="n">published</th><th class="n">difference</th>' in beside
    assert "0.50000000" in beside and "0.50000012" in beside and "1.2·10⁻⁷" in beside
