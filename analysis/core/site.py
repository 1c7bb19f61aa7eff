# The site of a set: a page a part, index.html with the answers, one look.
import base64
import importlib
import re
from functools import partial
from pathlib import Path

import jinja2
import markupsafe
import matplotlib.pyplot as plt

from analysis.core import schema
from analysis.core.controls import disturbance, said as said_of_controls, told
from analysis.core.files import ROOT, read_json, read_object, write_json, write_text
from analysis.core.style import save
from analysis.core.text import between, ends, number
from analysis.core.view import View, pages, parts

HERE = Path(__file__).parent


def write_part(folder, part):
    """Tables, figures and page of a part from its records. The front page is left to the caller: beside another part at work it would
    overwrite that one's page by one to come."""
    view = View(folder, part)
    tables, found = write_tables(view)
    figures = draw(tables, view, folder / part / "figures")
    page, others = _module(part, "page"), told(disturbance(found))
    known, answers = page.context(tables, view), page.answers(tables, view)
    write_text(folder / f"{part}.html", template(ROOT / "analysis" / part / "page.html.j2").render(
        **_frame(folder, part), **known, said=answers, disturbance=others, figures=figures, schema=schema.of_part(part),
        control="" if "controls" in known else said_of_controls(tables.get("controls", ()))))
    write_json(folder / part / "answers.json", {
        "answers": answers, "cases": page.cases(tables, view) if hasattr(page, "cases") else [], "disturbance": others})
    for name, known in (page.files(tables, view) if hasattr(page, "files") else {}).items():
        write_json(folder / part / name, known)


def draw(tables, view, into, **more):
    """{name: its file in base 64} of a part's figures, which are written into a folder. `more`: what several sets say together."""
    drawn = _module(view.part, "figures").draw(tables, view, **more) if (ROOT / "analysis" / view.part / "figures.py").exists() else {}
    about = f"{view.context.get('cpu_model', '')} · {view.facts['date'][:10]} · {view.part}, profile {view.facts['profile']}"
    for name, figure in drawn.items():
        save(figure, into / f"{name}.svg", about)
    plt.close("all")
    return {name: base64.b64encode((into / f"{name}.svg").read_bytes()).decode() for name in drawn}


def write_tables(view):
    """(tables of a part, the records that they are made from)"""
    found = schema.records_of(view.folder, view.part, view.context)
    return schema.write_tables(view.folder, view.part, _module(view.part, "tables").build(found, view), found), found


def write_index(folder, part=None):
    """index.html: the answers of the parts that are done; the further pages, where all that is new is `part` only those that are made
    of it; and a page for each of the other parts."""
    answers, examples, made = answers_of(folder), {}, {}
    for name, one in pages().items():
        kept = folder / f".{name}.json"  # what the front page shows of it
        if part in (None, *one["parts"]) or not kept.exists():
            known = _module(one["folder"], "page").context(folder)
            made[name] = ROOT / "analysis" / one["folder"] / "page.html.j2", known
            write_json(kept, known["examples"])
        examples[name] = read_json(kept)
    made |= {one: (HERE / "pending.html.j2", {}) for one, said in answers.items() if said is None}
    made["index"] = HERE / "index.html.j2", {"answers": answers, "examples": examples}
    for name, (path, more) in made.items():
        write_text(folder / f"{name}.html", template(path).render(**_frame(folder, name), **more))


def answers_of(folder):
    """{part: what its page.py says: "answers" and "cases" (your case, take this, link)}; None of one not done."""
    return {part: read_object(folder / part / "answers.json", answers=list, cases=list) if (folder / part / "answers.json").exists() else None
            for part in parts()}


def _module(part, name):
    return importlib.import_module(f"analysis.{part}.{name}")


def _frame(folder, part):
    view = View(folder, part)
    return {"part": part, "parts": parts(), "pages": pages(), "question": parts().get(part, ""), "facts": view.facts,
            "context": view.context, "libraries": view.registry.versions}


def template(path):
    loader = jinja2.FileSystemLoader([path.parent, HERE])
    environment = jinja2.Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.filters |= {"number": number, "name": partial(marked, "([/,])", r"\1<wbr>"), "code": partial(marked, "`(.+?)`", r"<code>\1</code>")}
    environment.globals |= {"between": between, "ends": ends}
    return environment.get_template(path.name)


def marked(what, by, text):
    """"name": a narrow column breaks it after / and comma; "code": what texts of this repository have between backticks."""
    return markupsafe.Markup(re.sub(what, by, str(markupsafe.escape(text))))
