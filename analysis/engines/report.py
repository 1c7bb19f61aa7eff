# engines.html: other engines beside ours: work and precision, times at equal error, what was lost; self-contained.
from pathlib import Path

import pandas

from analysis import page
from analysis.engines import figure, sentences
from analysis.loader import TableError, _json

TABLES = ("engines", "work", "references", "gate", "equal_error")


def load(folder):
    """{name: DataFrame}"""
    tables = {}
    for name in TABLES:
        path = Path(folder) / f"{name}.csv"
        try:
            tables[name] = pandas.read_csv(path)
        except (OSError, ValueError) as error:
            raise TableError(f"{path}: cannot be read: {error}") from error
    return tables


def write(folder):
    """Writes figures/*.svg and .png, and engines.html, from the tables in `folder`."""
    folder = Path(folder)
    tables = load(folder)
    figures = {name: page.embedded(folder, name, figure.draw(tables["engines"], tables["work"], titles))
               for name, titles in panels(tables["references"]).items() if titles}
    page.write(folder / "engines.html", render(tables, _json(folder / "run.json"), figures))


def panels(references):
    """{figure: {subject: title}}: N-four-bars, and the scenes without singular positions."""
    titles = dict(zip(references.subject, references.title))
    free = regular(references)
    return {"singular": {one: title for one, title in titles.items() if not free[one]},
            "regular": {one: title for one, title in titles.items() if free[one]}}


def regular(references):
    """{subject: whether its motion passes no singular position}, by what study/engines/subjects.py calls them."""
    return {one: not one.startswith("four-bar:") or one.endswith(" regular") for one in references.subject}


def render(tables, run, figures):
    """The page; `figures`: {name: SVG in base 64}."""
    engines, table, references = tables["engines"], tables["equal_error"], tables["references"]
    titles = dict(zip(references.subject, references.title))
    comparisons = [{"title": titles[subject], "rows": _wide(rows)}
                   for subject, rows in table.groupby("subject", sort=False)]
    gate = tables["gate"]
    return page.template(Path(__file__).parent / "engines.html.j2").render(
        setting=sentences.value, engine=sentences.name,
        context=next(iter(run["contexts"].values())), inputs=run["inputs"], figures=figures, titles=titles,
        engines=list(engines.engine.unique()), says=sentences.of_engines(engines), ratios=sentences.of_ratios(
            table, regular(references)), least=sentences.LEAST, regular=regular(references),
        scopes={"every scheme and setting of ours": sentences.summary(table, "all"),
                "the paper's scheme alone": sentences.summary(table, "paper")},
        comparisons=comparisons, subjects=list(titles), reached=sentences.reached(engines, list(titles)),
        complaints=sentences.complaints(engines), refused=int((~gate.takes_part.astype(bool)).sum()),
        checked=len(gate), references=sentences.records(references))


def _wide(rows):
    """One row an engine and error, with that of the paper's scheme in "paper"."""
    wide = []
    for _, both in rows.groupby(["engine", "limit", "engine_setting", "engine_value"], sort=False):
        by_scope = {row["scope"]: row for row in sentences.records(both)}
        wide.append(by_scope["all"] | {"paper": by_scope["paper"]})
    return wide
