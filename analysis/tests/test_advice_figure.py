# The picture of an advice on a small answer: the choice, what does not count, and no choice at all.
import matplotlib.pyplot as plt
import pandas

from analysis.advice.figure import draw
from analysis.advice.validation import draw as draw_validation, verdict


def answer(met=True, deadline=None):
    pilots = [{"step": 1e-2 / 2**k, "status": "ok", "estimate": 1e-2 / 4**k, "counts": k > 0, "step_us": 2.0}
              for k in range(3)]
    settings = [{"setting": name, "pilots": pilots} for name in ("penalty", "saddle-point, tolerance loose")]
    settings.append({"setting": "rattle", "pilots": [pilots[0] | {"status": "diverged"}]})
    told = {"implementation": "one/a", "setting": "penalty", "step": 5e-3,
            "us_per_second": {"median": 400.0, "low": 390.0, "high": 420.0},
            "error": {"estimate": 2.5e-3, "low": 1.9e-3, "high": 2.5e-3}}
    return {"question": {"scene": "some/where/car.json", "error": 5e-3, "duration": 5.0, "deadline_us": deadline},
            "met": met, "advice": told if met else None, "pilot_duration": 5.0, "settings": settings}


def labels(figure):
    return {text.get_text() for text in figure.axes[0].get_legend().get_texts()}


def test_the_choice_and_what_does_not_count_are_named():
    figure = draw(answer(deadline=50.0))
    told = {text.get_text() for text in figure.axes[0].texts}
    assert {"E = 0.005 m", "D = 50 µs a step"} <= told and "car.json" in figure.axes[0].get_title(loc="left")
    assert {"penalty", "estimate does not count", "advised: one/a,\npenalty, step 0.005 s"} <= labels(figure)
    assert "rattle" not in labels(figure)  # a run that was lost has no estimate
    plt.close(figure)


def test_no_setting_is_drawn_as_such():
    figure = draw(answer(met=False))
    assert "no setting meets this" in {text.get_text() for text in figure.axes[0].texts}
    assert not any(label.startswith("advised") for label in labels(figure))
    plt.close(figure)


def validation():
    return pandas.DataFrame([{"scene": scene, "error": error, "estimate": 0.5 * error, "exact": 0.6 * error,
                              "meets": True, "ratio": 1.2, "advised_low": 11.0, "advised_high": 13.0,
                              "best_us_per_second": 10.0}
                             for scene in ("four-bar:1", "four-bar:2") for error in (1e-2, 1e-3)])


def test_the_validation_names_what_did_not_hold():
    table = validation()
    held, sentence = verdict(table, 1.5)
    assert held and sentence.startswith("4 of 4 advised runs are as accurate as asked; 4 take at most 1.5")
    table.loc[0, ["meets", "ratio"]] = [False, float("nan")]
    table.loc[3, "ratio"] = 1.6
    held, sentence = verdict(table, 1.5)
    assert not held and sentence.endswith("not so: four-bar:1 at 0.01 m, four-bar:2 at 0.001 m")
    figure = draw_validation(table, 1.5)
    [legend] = figure.legends  # below the axes: on them it would lie on a line
    assert len(figure.axes) == 2 and {"four-bar:1", "four-bar:2", "estimate"} == {text.get_text() for text in legend.get_texts()}
    figure.canvas.draw()
    assert legend.get_window_extent().y1 <= min(axes.get_tightbbox().y0 for axes in figure.axes)
    plt.close(figure)
