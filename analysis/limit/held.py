# What code without a library is held to: bounds, and the worst that was measured for each.
#
# Of all such code the fastest counts, size by size and scene by scene. A ratio is held or not held where its whole interval
# says so, else open; an exponent too, by the interval of its fit; a set-up, which has none, by its value. A sweep's gain is of `mbs sweep`, whoever
# simulates its lanes. Where not all cases were measured nothing is held as a whole.
import numpy

from analysis.core.timing import power_law

AHEAD_SIZES, NEAR_SIZES = (22, 50, 82, 160, 1000, 4000), (22, 82, 1000)  # n
AHEAD, AHEAD_PLANAR, AHEAD_SPATIAL = 3.0, 2.0, 1.5
NEAR_LIMIT, BEHIND_FILLED, GAIN, TWO_JOBS, EXPONENT, SET_UP_S = 1.5, 1.1, 4.0, 1.8, 1.05, 0.5
GROWTH_FROM, GROWTH_TO = 100, 20000  # n
HELD, PARTLY, NOT_HELD, OPEN, NOT_MEASURED = "held", "held where measured", "not held", "open", "not measured"
LEAST, MOST = "≥", "≤"


def wanted(kind, dimension):
    """The least that a lead may be in a scene; not a number where nothing is held to anything."""
    return {"fill": 1 / BEHIND_FILLED, "problem": AHEAD_PLANAR if dimension == 2 else AHEAD_SPATIAL}.get(kind, numpy.nan)


def must_hold(own, tables):
    """Rows of held.csv. `own`: variants of such code; `tables`: as the schema has them."""
    steps, leads, batches = (tables[name][tables[name].implementation.isin(own)] for name in ("steps", "leads", "batches"))
    found = [_lead("N-four-bar", AHEAD, leads[(leads.kind == "four-bar") & leads.variables.isin(AHEAD_SIZES)], len(AHEAD_SIZES)),
             _worst("times the limit code's step", MOST, NEAR_LIMIT,
                    _fastest(steps[(steps.form == "penalty") & steps.variables.isin(NEAR_SIZES)], "loops", "multiple", True), "multiple",
                    len(NEAR_SIZES))]
    for where, kind, dimension, bound in (("planar standard problems", "problem", 2, AHEAD_PLANAR), ("spatial standard problems", "problem", 3, AHEAD_SPATIAL),
                                          ("n = 100, filled", "fill", 2, round(1 / BEHIND_FILLED, 3))):
        rows = leads[(leads.kind == kind) & (leads.dimension.isin([dimension]) | leads.dimension.isna())]  # that of some is not known
        found.append(_lead(where, bound, rows[rows.dimension.notna()], rows.scene.nunique()))
    for form in ("penalty", "saddle-point"):
        found += _growth(steps[steps.form == form], form)
    for sets in sorted(set(batches.sets)):
        rows = batches[(batches.sets == sets) & (batches.status != "unsupported")]
        found.append(_worst(f"throughput of batches ÷ that of their lanes alone, {sets:.0f} sets of parameters", LEAST, GAIN,
                            _fastest(rows, "scene", "step_us", True), "gain", rows.scene.nunique()))
    sweeps = tables["sweeps"]
    return [*found, _worst("lanes a second of a sweep by two jobs ÷ by one", LEAST, TWO_JOBS, sweeps[sweeps.jobs == 2], "gain", sweeps.scene.nunique())]


def _lead(where, bound, rows, cases):
    return _worst(f"times faster than the fastest library, {where}", LEAST, bound, _fastest(rows, "scene", "lead", False), "lead", cases)


def _fastest(rows, key, column, least):
    """The row of the variant with the least (or most) of a column, by `key`."""
    rows = rows[rows[column].notna() & (rows.status == "ok")]
    return rows.sort_values(column, ascending=least).drop_duplicates(key)


def _worst(what, sign, bound, rows, column, cases):
    """`cases`: how many there are to be; fewer are said, none is not measured. All of them have to keep the bound: the
    interval is that of the worst over all, and reaches from the worst lower end to the worst upper end."""
    row = {"what": what, "sign": sign, "bound": bound, "cases": cases, "measured": len(rows), "verdict": NOT_MEASURED, "record": ""}
    if rows.empty:
        return row
    ends = ("low", "high") if column != "multiple" else ("multiple_low", "multiple_high")
    places = [rows[key].idxmin() if sign == LEAST else rows[key].idxmax() for key in (column, *ends) if key in rows]
    worst = rows.loc[places[0]]
    low, high = (rows.loc[place, end] for place, end in zip(places[1:], ends)) if len(places) > 1 else (numpy.nan,) * 2
    where = worst.scene if "scene" in worst.index else f"n = {worst.variables:.0f}"
    verdict = _verdict(sign, bound, worst[column], low, high)
    return row | {"worst": worst[column], "low": low, "high": high, "variant": worst.implementation,
                  "record": " ".join(dict.fromkeys(rows.record[places])),
                  "where": where.removeprefix("harness/scenes/").removesuffix(".json"),
                  "verdict": PARTLY if verdict == HELD and len(rows) < cases else verdict}


def _verdict(sign, bound, value, low, high):
    low, high = (value, value) if numpy.isnan(low) or numpy.isnan(high) else (low, high)
    low, high, bound = (low, high, bound) if sign == LEAST else (-high, -low, -bound)
    return HELD if low >= bound else NOT_HELD if high < bound else OPEN


def _growth(steps, form):
    """Exponents of the fastest variant at each size from GROWTH_FROM on, with Student's interval of the fit; and the largest one's set-up."""
    rows = _fastest(steps[steps.variables >= GROWTH_FROM], "loops", "step_us", True).sort_values("variables")
    whole = len(rows) > 2 and rows.variables.iloc[-1] >= GROWTH_TO
    for name, column in (("a step's time", "step_us"), ("a pass's time", "pass_us"), ("memory", "memory_bytes")):
        fit = rows.tail(1) if whole and rows[column].notna().all() else rows[:0]
        if len(fit):
            fit = fit.assign(**dict(zip(("exponent", "low", "high"), power_law(rows.variables, rows[column]))), record=" ".join(rows.record),
                             scene=f"fit of {len(rows)} sizes, n = {rows.variables.iloc[0]:.0f} to {rows.variables.iloc[-1]:.0f}")
        yield _worst(f"exponent of {name} over n, {form} form", MOST, EXPONENT, fit, "exponent", 1) | {
            "cases": len(rows), "measured": len(rows) if whole else 0}
    if form == "penalty":
        last = rows[rows.variables >= GROWTH_TO]
        yield _worst("set-up, s", MOST, SET_UP_S, last.assign(setup=last.setup_us / 1e6), "setup", 1)
