# limit.html: bounds, the limit code and the implementations; one self-contained page.
from pathlib import Path

from analysis import page
from analysis.limit.figure import LIMIT, by_phase, over_size, timed
from analysis.loader import PHASES, TableError, _json, plain_table


def write(folder):
    """Writes figures/over_size and by_phase (.svg, .png), and limit.html."""
    folder = Path(folder)
    bounds, steps = (plain_table(folder / f"{name}.csv") for name in ("bounds", "steps"))
    if "step_us" not in steps or timed(steps).empty:
        raise TableError(f"{folder / 'steps.csv'}: no size has a time of {LIMIT}")
    registry = _json(folder / "implementations.json")["implementations"]
    figures = {"over_size": page.embedded(folder, "over_size", over_size(bounds, steps, registry)),
               "by_phase": page.embedded(folder, "by_phase", by_phase(steps))}
    page.write(folder / "limit.html", render(bounds, steps, _json(folder / "run.json"), figures))


def render(bounds, steps, run, figures):
    """The page; `figures`: {name: SVG in base 64}."""
    return page.template(Path(__file__).parent / "limit.html.j2").render(
        context=next(iter(run["contexts"].values())), figures=figures, limit=LIMIT,
        counted="instructions" in steps and steps.instructions.notna().any(),
        bounds=bounds.sort_values("loops").to_dict("records"), sizes=by_size(steps), phases=PHASES,
        lost=steps[steps.status != "ok"].to_dict("records"))


def by_size(steps):
    """[(n, rows)] with every timed variant, the fastest first; phases in ns and as multiples."""
    rows = timed(steps).sort_values(["loops", "step_us"])
    found = []
    for loops, group in rows.groupby("loops"):
        limit = 1e3 * group[group.implementation == LIMIT].step_us.iloc[0]
        found.append((2 * loops + 2, [
            {"implementation": row.implementation, "ns": 1e3 * row.step_us,
             "multiple": row.multiple, "passes": row.passes,
             "instructions": getattr(row, "instructions", None),
             "phases": [] if row.implementation == LIMIT else [
                 (1e3 * getattr(row, f"{phase}_us"), 1e3 * getattr(row, f"{phase}_us") / limit)
                 for phase in PHASES]} for row in group.itertuples()]))
    return found
