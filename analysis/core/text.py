# Numbers as the report and the claims ledger print them.
import pandas

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


def interval(ratio, digits=3):
    """"2.51 (2.43 to 2.60)" of a compare.Ratio."""
    return (f"{number(ratio.value, digits)} ({number(ratio.low, digits)} to "
            f"{number(ratio.high, digits)})")
