# extremes.html: figures, outcomes and what they say, of the parts that have been run; one self-contained page.
from pathlib import Path

from analysis import page
from analysis.accuracy.front import GOOD
from analysis.extremes import battery_figure, numbers, pivots_figure, roundoff_figure, sentences, ways_figure
from analysis.loader import TableError, _json, plain_table

TABLES = {"battery": ("battery",), "ways": ("ways", "ways_cost", "scaling"),
          "pivots": ("pivots", "pivots_claims"), "roundoff": ("roundoff", "roundoff_growth", "singular")}


def write(folder):
    """Writes figures/*.svg and .png and extremes.html from the tables in `folder`."""
    folder = Path(folder)
    tables = {part: {name: plain_table(folder / f"{name}.csv") for name in names}
              for part, names in TABLES.items() if (folder / f"{names[0]}.csv").exists()}
    if not tables:
        raise TableError(f"{folder}: holds no table of any part ({', '.join(TABLES)})")
    registry = _json(folder / "implementations.json")["implementations"]
    figures = {}
    for name, figure in _drawn(tables, registry):
        figures[name] = page.embedded(folder, name, figure)
    page.write(folder / "extremes.html", render(tables, _json(folder / "run.json"), figures))


def _drawn(tables, registry):
    """(name, figure) of every figure that the tables allow."""
    if "battery" in tables:
        yield from battery_figure.figures(tables["battery"]["battery"])
    if "ways" in tables:
        yield "ways", ways_figure.draw(tables["ways"]["ways"], tables["ways"]["ways_cost"])
    if "pivots" in tables:
        yield "pivots", pivots_figure.draw(tables["pivots"]["pivots"])
    if "roundoff" in tables:
        found = tables["roundoff"]
        for scheme in dict.fromkeys(found["roundoff_growth"].scheme):
            yield f"roundoff-{scheme}", roundoff_figure.draw(found["roundoff_growth"], found["singular"],
                                                             registry, scheme)


def render(tables, run, figures):
    """The page; `figures`: {name: SVG in base 64}."""
    parts = {"battery": _battery, "ways": _ways, "pivots": _pivots, "roundoff": _roundoff}
    return page.template(Path(__file__).parent / "extremes.html.j2").render(
        context=next(iter(run["contexts"].values())), inputs=run["inputs"], figures=figures,
        **{name: make(**tables[name]) if name in tables else None for name, make in parts.items()})


def _battery(battery):
    said, nobody = sentences.battery(battery)
    return {"said": said, "nobody": nobody, "total": len(numbers.ran(battery)), "rows": len(battery),
            "left_out": sentences.left_out(battery), "unlike": sentences.unlike(battery),
            "counts": battery.groupby("setting", sort=False).status.value_counts().unstack(
                fill_value=0).to_dict("index"),
            "statuses": list(dict.fromkeys([*GOOD, "degraded", *sorted(battery.status.unique())])),
            "silent": sentences.silent(battery),
            "unjudged": battery[battery.status.isin(GOOD) & battery.true_error.isna()].to_dict("records")}


def _ways(ways, ways_cost, scaling):
    rows = [{"way": way, "folder": folder, "share": numbers.share(own), "reason": numbers.not_served(own),
             "costs": numbers.costs(ways_cost, folder, way), "passes": numbers.passes(ways_cost, folder, way)}
            for way in dict.fromkeys(ways.way) for folder in numbers.folders(ways)
            for own in [ways[(ways.way == way) & (ways.implementation.str.split("/").str[0] == folder)]]]
    return {"rows": rows, "silent": sentences.silent(ways), "scaling": sentences.scaling(scaling)}


def _pivots(pivots, pivots_claims):
    return {"said": sentences.pivots(pivots), "claims": pivots_claims.to_dict("records"),
            "matrices": int(pivots.matrices.max())}


def _roundoff(roundoff, roundoff_growth, singular):
    found = sentences.roundoff(roundoff, roundoff_growth, singular)
    return {"sizes": found, "jumps": sentences.jumps(found), "rows": roundoff.to_dict("records")}
