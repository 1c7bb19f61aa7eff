# The site of a set: a page a part, index.html with the answers, one look.
import base64
import importlib
from pathlib import Path

import jinja2
import matplotlib.pyplot as plt

from analysis.core import records, schema
from analysis.core.files import ROOT, read_object, write_json, write_text
from analysis.core.parts import parts
from analysis.core.style import save
from analysis.core.text import number
from analysis.core.view import View

HERE = Path(__file__).parent


def write_part(folder, part):
    """Tables, figures and page of a part from its records; the front page again."""
    schema.need_unchanged(folder, part)
    view, found = View(folder, part), records.read_part(folder, part)
    schema.need_same_records(folder, part, found)
    tables = schema.write_tables(folder, part, _module(part, "tables").build(found, view), found)
    figures = {name: _saved(folder, part, name, figure)
               for name, figure in _module(part, "figures").draw(tables, view).items()}
    known = _module(part, "page").context(tables, view)
    _write(folder, part, _template(ROOT / "analysis" / part / "page.html.j2").render(
        **_frame(folder, part), **known, figures=figures, schema=schema.of_part(part)))
    said = _module(part, "sentences")
    write_json(folder / part / "answers.json", {
        "answers": said.answers(tables, view), "cases": said.cases(tables, view) if hasattr(said, "cases") else []})
    write_index(folder)


def write_index(folder):
    """index.html: the answers of the parts that are done; and a page for each of the others."""
    frame = _frame(folder, "index")
    answers = answers_of(folder)
    _write(folder, "index", _template(HERE / "index.html.j2").render(**frame, answers=answers))
    for part, known in answers.items():
        if known is None:
            _write(folder, part, _template(HERE / "pending.html.j2").render(
                **_frame(folder, part), chosen=part in frame["facts"]["parts"]))


def answers_of(folder):
    """{part: what its sentences.py says: "answers" and "cases" (your case, take this, link)}; None of one not done."""
    return {part: read_object(folder / part / "answers.json", answers=list, cases=list) if (folder / part / "answers.json").exists() else None
            for part in parts()}


def _write(folder, name, text):
    write_text(folder / f"{name}.html", text)


def _module(part, name):
    return importlib.import_module(f"analysis.{part}.{name}")


def _frame(folder, part):
    """What the frame of every page shows."""
    view = View(folder, part)
    return {"part": part, "parts": parts(), "question": parts().get(part, ""), "facts": view.facts,
            "context": view.context}


def _template(path):
    loader = jinja2.FileSystemLoader([path.parent, HERE])
    environment = jinja2.Environment(loader=loader, autoescape=True, trim_blocks=True,
                                     lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.filters |= {"number": number}
    return environment.get_template(path.name)


def _saved(folder, part, name, figure):
    """Writes PART/figures/NAME.svg and .png and closes the figure; the SVG in base 64."""
    base = Path(folder) / part / "figures"
    base.mkdir(parents=True, exist_ok=True)
    for kind in ("svg", "png"):
        save(figure, base / f"{name}.{kind}")
    plt.close(figure)
    return base64.b64encode((base / f"{name}.svg").read_bytes()).decode()
