# scenes.html: the standard problems and the cost of modelling, one self-contained page.
import base64
from pathlib import Path

from analysis import page
from analysis.loader import _json
from analysis.scenes import modelling_figure, tables

SHEETS = Path(__file__).resolve().parents[2] / "harness" / "scenes" / "pictures"
CONSERVED = 1e-3  # of the range of the energy


def write(folder, compared):
    """Writes figures/modelling.svg and .png, and scenes.html, atomically. `compared`: names of the two
    implementations that ran every problem at every step."""
    folder = Path(folder)
    data = tables.load(folder)
    page.embedded(folder, "modelling", modelling_figure.draw(data["modelling"]))
    page.write(folder / "scenes.html", render(folder, data, compared))


def render(folder, data, compared):
    run = _json(folder / "run.json")
    context = next(iter(run["contexts"].values()))
    problems, convergence = data["problems"], data["convergence"]
    return page.template(Path(__file__).parent / "scenes.html.j2", digits=tables.digits).render(
        context=context, compared=compared, problems=[] if problems.empty else tables.best_errors(problems),
        agreement={} if data["gate"].empty else tables.agreement(data["gate"]),
        convergence=[] if convergence.empty else convergence.to_dict("records"),
        with_published=set() if convergence.empty else set(
            convergence[convergence.published.notna()].problem),
        everyone=[] if problems.empty else _everyone(problems),
        costs=tables.costs(data["modelling"]), conserved_limit=CONSERVED,
        figure=base64.b64encode((folder / "figures" / "modelling.svg").read_bytes()).decode(),
        sheets=_sheets())


def _everyone(problems):
    """Problems that every implementation ran at the first step: energy drift of each."""
    result = []
    for name, group in problems.groupby("problem", sort=False):
        first = group[group.step == group.step.max()]
        if first.implementation.nunique() > 2:
            result.append({"problem": name, "step": first.step.iloc[0],
                           "rows": first.to_dict("records")})
    return result


def _sheets():
    return {path.stem: base64.b64encode(path.read_bytes()).decode()
            for path in sorted(SHEETS.glob("*.png"))}
