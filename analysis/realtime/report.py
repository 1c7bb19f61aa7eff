# realtime.html: distributions, largest scenes, what judging costs; one self-contained page.
from pathlib import Path

from analysis import page
from analysis.accuracy.front import FINISHED
from analysis.loader import _json, plain_table
from analysis.realtime.figure import answer, distributions, sizes

JUDGED_FROM = 50  # variables, from which judging may take GUARD of a step
GUARD = 0.05


def write(folder):
    """Writes figures/steps.svg and .png, largest.svg and .png, and realtime.html."""
    folder = Path(folder)
    steps, largest = (plain_table(folder / f"{name}.csv") for name in ("steps", "largest"))
    figures = {}
    for name, figure in (("steps", distributions(steps)), ("largest", sizes(largest))):
        figures[name] = page.embedded(folder, name, figure)
    page.write(folder / "realtime.html", render(steps, largest, _json(folder / "run.json"), figures))


def render(steps, largest, run, figures):
    """The page; `figures`: {name: SVG in base 64}."""
    guards, searched = guard(steps), guard(largest.rename(columns={"largest": "loops"}))
    small = guards[guards.variables < JUDGED_FROM]
    return page.template(Path(__file__).parent / "realtime.html.j2").render(
        context=next(iter(run["contexts"].values())), figures=figures, inputs=run["inputs"],
        steps=steps.to_dict("records"), largest=largest.to_dict("records"),
        answers=[answer(row) for row in largest.itertuples()],
        late=steps[~steps.in_real_time.astype(bool)].to_dict("records"),
        repeats=run["inputs"]["repeats"], again=run["inputs"]["again"], pilot=run["inputs"]["pilot"],
        guards=guards.to_dict("records"), worst=[_worst(rows[rows.variables >= JUDGED_FROM]) for rows in (guards, searched)],
        smallest=_worst(small),
        finished=FINISHED, allowed=GUARD, judged_from=JUDGED_FROM)


def _worst(guards):
    """The row of the largest share; None if there is no row."""
    return None if guards.empty else guards.loc[guards.share.idxmax()]


def guard(steps):
    """Share of a step that judging takes, by size and implementation: means over
    one run, both as observed."""
    rows = steps[steps.judge_us.notna() & steps.observed_mean_us.notna()].copy()
    rows["variables"] = 2 * rows.loops + 2
    rows["share"] = rows.judge_us / rows.observed_mean_us
    return rows[["implementation", "scheme", "step", "steps", "variables", "judge_us", "observed_mean_us",
                 "share"]]
