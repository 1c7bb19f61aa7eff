# realtime.html: distributions, largest scenes, what judging costs; one self-contained page.
import base64
from pathlib import Path

import jinja2
import matplotlib.pyplot as plt

from analysis.loader import _json, plain_table
from analysis.realtime.figure import distributions, sizes
from analysis.style import save
from analysis.text import number

JUDGED_FROM = 50  # variables, from which judging may take GUARD of a step
GUARD = 0.05


def write(folder):
    """Writes figures/steps.svg and .png, largest.svg and .png, and realtime.html."""
    folder = Path(folder)
    steps, largest = (plain_table(folder / f"{name}.csv") for name in ("steps", "largest"))
    (folder / "figures").mkdir(exist_ok=True)
    figures = {}
    for name, figure in (("steps", distributions(steps)), ("largest", sizes(largest))):
        for kind in ("svg", "png"):
            save(figure, folder / "figures" / f"{name}.{kind}")
        plt.close(figure)
        figures[name] = base64.b64encode((folder / "figures" / f"{name}.svg").read_bytes()).decode()
    partial = folder / "realtime.html.partial"
    partial.write_text(render(steps, largest, _json(folder / "run.json"), figures), encoding="utf-8")
    partial.replace(folder / "realtime.html")


def render(steps, largest, run, figures):
    """The page; `figures`: {name: SVG in base 64}."""
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(Path(__file__).parent),
                                     autoescape=True, trim_blocks=True, lstrip_blocks=True,
                                     undefined=jinja2.StrictUndefined)
    environment.filters["number"] = number
    guards = guard(steps)
    large = guards[guards.variables >= JUDGED_FROM]
    return environment.get_template("realtime.html.j2").render(
        context=next(iter(run["contexts"].values())), figures=figures, inputs=run["inputs"],
        steps=steps.to_dict("records"), largest=largest.to_dict("records"),
        late=steps[~steps.in_real_time.astype(bool)].to_dict("records"),
        guards=guards.to_dict("records"), worst=None if large.empty else large.share.max(),
        allowed=GUARD, judged_from=JUDGED_FROM)


def guard(steps):
    """Share of a step that judging every 32nd state takes, by size and implementation."""
    rows = steps[steps.judge_us.notna() & steps.mean_us.notna()].copy()
    rows["variables"] = 2 * rows.loops + 2
    rows["share"] = rows.judge_us / rows.mean_us
    return rows[["implementation", "scheme", "step", "variables", "judge_us", "mean_us", "share"]]
