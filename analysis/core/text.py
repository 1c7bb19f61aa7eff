# Numbers and tables as pages show them.
import math

import jinja2
import pandas

RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def number(value, digits=3):
    """`value` with `digits` significant digits, or as a whole number if that is not much longer; a dash if there is none."""
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


def percent(share, digits=0):
    """"5 %"; a dash if there is none."""
    return "–" if share is None or math.isnan(share) else f"{100 * share:.{digits}f} %"


def step(seconds):
    """"1.25 ms" or "39 µs"."""
    return f"{1e3 * seconds:.3g} ms" if seconds >= 1e-4 else f"{1e6 * seconds:.3g} µs"


def bounded(low, high):
    """Whether an interval says something: that of a single process does not, it reaches from 0 to infinity."""
    return math.isfinite(low) and math.isfinite(high)


def rough(value):
    """"about 6600": a value of which nobody knows how far it may be off."""
    return f"about {number(float(f'{value:.2g}'))}"


def span(values, digits=3):
    """"1.2 to 3.4", or one number."""
    return " to ".join(dict.fromkeys(number(value, digits) for value in (min(values), max(values))))


def ends(low, high, digits=3):
    """"2.43 to 2.6", or that the interval says nothing; a dash if there is none."""
    if pandas.isna(low) or pandas.isna(high):
        return "–"
    return f"{number(low, digits)} to {number(high, digits)}" if bounded(low, high) else "not bounded"


def between(value, low, high, digits=3, more=""):
    """"2.51 (2.43 to 2.6)", or "about 2.5 (not bounded)"; a dash if there is no value. `more`: behind the interval."""
    if pandas.isna(value):
        return "–"
    return f"{number(value, digits) if bounded(low, high) else rough(value)} ({ends(low, high, digits)}{more})"


def rows_of(table):
    """The table as dictionaries, None where there is nothing."""
    return table.astype(object).where(table.notna(), None).to_dict("records")


def grouped(table, key):
    """[(key, rows)], in the table's order; what is empty stays NaN."""
    return [(name, group.to_dict("records")) for name, group in table.groupby(key, sort=False)]


def layout(path):
    """The template of a text that is no page."""
    return jinja2.Template(path.read_text(encoding="utf-8"), trim_blocks=True, undefined=jinja2.StrictUndefined)


def answers(path, otherwise, **known):
    """What a template says, a line an answer: "ANCHOR: sentences"; `otherwise`, where that is nothing."""
    said = layout(path).render(known, number=number, between=between, span=span).splitlines() if known else []
    found = [(anchor, text.strip()) for anchor, _, text in (line.partition(":") for line in said) if text.strip()]
    return [{"anchor": anchor, "text": text} for anchor, text in found or [("", otherwise)]]
