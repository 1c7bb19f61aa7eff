# What the pages share: their templates, figures that are saved and embedded, atomic writing.
import base64
from pathlib import Path

import jinja2
import matplotlib.pyplot as plt

from analysis.style import save
from analysis.text import number


def template(path, **filters):
    """The template in `path`, with `number` and further filters; it may include what is beside this file."""
    loader = jinja2.FileSystemLoader([path.parent, Path(__file__).parent])
    environment = jinja2.Environment(loader=loader, autoescape=True, trim_blocks=True,
                                     lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.filters |= {"number": number} | filters
    return environment.get_template(path.name)


def embedded(folder, name, figure):
    """Writes figures/NAME.svg and .png in `folder`, closes the figure; the SVG in base 64."""
    (folder / "figures").mkdir(exist_ok=True)
    for kind in ("svg", "png"):
        save(figure, folder / "figures" / f"{name}.{kind}")
    plt.close(figure)
    return base64.b64encode((folder / "figures" / f"{name}.svg").read_bytes()).decode()


def write(path, text):
    """A reader sees the whole page or the one before."""
    partial = path.with_name(path.name + ".partial")
    partial.write_text(text, encoding="utf-8")
    partial.replace(path)
