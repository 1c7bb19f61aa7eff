# The report: one self-contained HTML page from the tidy tables and the figures.
import base64
import sys
from pathlib import Path

import jinja2
import pandas

from analysis import tables
from analysis.loader import TableError, load

CAPTIONS = {
    "step_time": "Median time of one step at the mechanism's own fill. All implementations are "
                 "timed over the same stretch of the motion, centred on its first singular "
                 f"position up to {tables.LAST_CENTRED} variables, before it above (crossing it "
                 "multiplies rounding there).",
    "region_map": "Winner of every cell, declared only if the 95 % interval of its ratio to the "
                  "second excludes 1.",
    "phases": "Ticks of the processor's counter booked by phase in extra profiled stretches, apart "
              "from the timed ones.",
}
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def number(value, digits=3):
    """`value` with `digits` significant digits; a dash if there is none."""
    if value is None or value == "" or pandas.isna(value):
        return "–"
    text = f"{float(value):.{digits}g}"
    if "e" not in text:
        return text
    mantissa, exponent = text.split("e")
    if -3 <= int(exponent) < digits + 3:
        return f"{float(value):.0f}"
    power = "10" + str(int(exponent)).translate(RAISED)
    return power if mantissa == "1" else f"{mantissa}·{power}"


def figures(folder):
    """Every figure of the results directory, the known ones first, embedded."""
    found = {path.stem: path for path in sorted((folder / "figures").glob("*.svg"))}
    order = [name for name in CAPTIONS if name in found] + [n for n in found if n not in CAPTIONS]
    return {name: {"caption": CAPTIONS.get(name, name.replace("_", " ")),
                   "data": base64.b64encode(found[name].read_bytes()).decode()} for name in order}


def render(folder):
    results = load(folder)
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(Path(__file__).parent),
                                     autoescape=True, trim_blocks=True, lstrip_blocks=True,
                                     undefined=jinja2.StrictUndefined)
    environment.filters["number"] = number
    return environment.get_template("report.html.j2").render(
        context=results.context, run=results.run, registry=results.registry,
        figures=figures(folder), times=tables.step_times(results), winners=tables.winners(results),
        overhead=tables.overhead(results), verdicts=tables.verdicts(results),
        checks=tables.checks(results), accuracy=tables.accuracy(results),
        losses=tables.losses(results), not_reached=tables.not_reached(results),
        must_hold=tables.must_hold(results), before_singular=tables.BEFORE_SINGULAR,
        samples=len(results.samples()), cells=results.samples().groupby(
            ["scene", "implementation"]).ngroups)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(f"usage: {sys.argv[0]} RESULTS_DIR OUTPUT.html")
    try:
        page = render(Path(sys.argv[1]))
    except TableError as error:
        sys.exit(f"error: {error}")
    Path(sys.argv[2]).write_text(page, encoding="utf-8")
