# accuracy.html: error against time, the regions for a required error, settings side by side; self-contained.
from pathlib import Path

import pandas

from analysis import page
from analysis.accuracy import names, pairs_figure, regions_figure, sentences, work_figure
from analysis.limit.must_hold import own
from analysis.loader import TableError, _json

NEEDED = ("work", "gate", "references")
OTHERS = ("regions", "winners", "fills", "forms", "precision", "tangents")  # of parts that were run


def load(folder):
    """{name: DataFrame}; empty where a part was not run."""
    tables = {}
    for name in (*NEEDED, *OTHERS):
        path = Path(folder) / f"{name}.csv"
        try:
            tables[name] = pandas.read_csv(path)
        except (FileNotFoundError, pandas.errors.EmptyDataError) as error:
            if name in NEEDED:
                raise TableError(f"{path}: cannot be read: {error}") from error
            tables[name] = pandas.DataFrame()
        except (OSError, ValueError) as error:
            raise TableError(f"{path}: cannot be read: {error}") from error
    return tables


def write(folder):
    """Writes figures/*.svg and .png, and accuracy.html, from the tables in `folder`."""
    folder = Path(folder)
    tables = load(folder)
    registry = _json(folder / "implementations.json")["implementations"]
    figures = {}
    for name, figure in _figures(tables, registry):
        figures[name] = page.embedded(folder, name, figure)
    page.write(folder / "accuracy.html", render(tables, _json(folder / "run.json"), figures, registry))


def file_name(subject):
    return "work-" + subject.replace(":", "-").replace(" ", "-").lower()


def _figures(tables, registry):
    """(name, figure) of what there are tables for."""
    look = names.look(registry)
    dense = {variant["name"]: bool(variant.get("dense")) for entry in registry
             for variant in entry["variants"]}
    references = tables["references"].set_index("subject")
    for subject, rows in tables["work"].groupby("subject", sort=False):
        about = references.loc[subject]
        title = (f"{about.title}, n = {rows.variables.dropna().iloc[0]:.0f}, {about.duration:g} s"
                 if rows.variables.notna().any() else about.title)
        unit = "largest of position, m" if about.unit == "m" else "root mean square, relative"
        yield file_name(subject), work_figure.draw(rows, look, dense, unit, title)
    if not tables["winners"].empty:
        yield "regions", regions_figure.draw(tables["winners"], look)
    for name, title, goal in (
            ("forms", "The saddle-point form beside the penalty form", None),
            ("precision", "Lower precision beside double; hollow: another error class, or none", pairs_figure.GAIN)):
        if "ratio" in tables[name] and tables[name].ratio.notna().any():
            yield name, pairs_figure.draw(tables[name], look, title, goal)


def render(tables, run, figures, registry):
    """The page; `figures`: {name: SVG in base 64}."""
    work, gate = tables["work"], tables["gate"]
    references = tables["references"].to_dict("records")
    by_subject = dict(list(work.groupby("subject", sort=False)))
    parts = [{"about": about, "figure": figures.get(file_name(about["subject"])),
              "says": sentences.of_subject(by_subject[about["subject"]]),
              "statuses": by_subject[about["subject"]].status.value_counts().to_dict()}
             for about in references if about["subject"] in by_subject]
    return page.template(Path(__file__).parent / "accuracy.html.j2", step=names.step).render(
        context=next(iter(run["contexts"].values())), inputs=run["inputs"], parts=parts,
        chains=[part for part in parts if part["about"]["unit"] == "m"],
        scenes=[part for part in parts if part["about"]["unit"] != "m"],
        references=references, figures=figures, runs=int(work["rounds"].sum()) if len(work) else 0,
        refused=_records(gate[~gate.takes_part.astype(bool)]),
        inaccurate=_records(gate[gate.only_inaccurate.astype(bool)]), checked=len(gate),
        statuses=list(dict.fromkeys(["ok", "degraded", *sorted(work.status.unique())])),
        summary=sentences.summary(tables["winners"], work, own(registry)), regions=sentences.of_regions(tables),
        fills=_records(tables["fills"]), forms=_records(tables["forms"]),
        forms_says=sentences.of_forms(tables["forms"]),
        precision=_records(tables["precision"]),
        precision_says=sentences.of_precision(tables["precision"]),
        tangents=sentences.tangent_rows(tables["tangents"]),
        tangents_says=sentences.of_tangents(tables["tangents"]))


def _records(table):
    """Rows as dictionaries, without NaN."""
    return table.astype(object).where(table.notna(), None).to_dict("records")
