# What an implementation without a library is held to: bounds, and the worst that was measured for each.
from dataclasses import dataclass

import numpy

from analysis.limit.figure import LIMIT, timed
from analysis.text import number

AHEAD_SIZES, NEAR_SIZES = (22, 50, 82, 160, 1000, 4000), (22, 82, 1000)  # n
AHEAD, AHEAD_PLANAR, AHEAD_SPATIAL = 3.0, 2.0, 1.5
NEAR_LIMIT, BEHIND_FILLED, GAIN, EXPONENT, SET_UP = 1.5, 1.1, 4.0, 1.05, 0.5  # the last in s
GROWTH_FROM, GROWTH_TO = 100, 20000  # n


@dataclass(frozen=True)
class Held:
    what: str
    bound: str
    worst: str  # with where; empty: not measured
    holds: bool


def own(registry):
    return [variant["name"] for entry in registry if entry.get("library") == "none"
            for variant in entry["variants"]]


def leads(rows, name, mine, key):
    """Series: the least time of those with a library over that of `name`, by `key`."""
    good = rows[(rows.status == "ok") | (rows.status == "slower")]
    others = good[~good.implementation.isin([*mine, LIMIT])].groupby(key).step_us.min()
    ours = good[good.implementation == name].set_index(key).step_us
    return (others / ours).dropna()


def wanted(dimension, filled):
    """The least that leads() may be in a scene."""
    return 1 / BEHIND_FILLED if filled else AHEAD_PLANAR if dimension == 2 else AHEAD_SPATIAL


def must_hold(name, registry, steps=None, scenes=None, batches=None):
    """[Held] of `name`; a table that is None was not measured."""
    mine, found = own(registry), []
    if steps is not None:
        found += _sizes(name, mine, steps) + _growth(name, steps)
    if scenes is not None:
        found += _scenes(name, mine, scenes)
    if batches is not None:
        gains = batches[(batches.implementation == name) & (batches.status == "ok")].set_index("scene").gain
        found.append(_least("throughput of a batch ÷ that of its lanes alone", gains, GAIN))
    return found


def _sizes(name, mine, steps):
    ahead = leads(steps, name, mine, "variables")
    limit = timed(steps)
    near = limit[limit.implementation == name].set_index("variables").multiple
    return [_least("times faster than the fastest with a library, N-four-bar",
                   ahead[ahead.index.isin(AHEAD_SIZES)], AHEAD, "n = {}", len(AHEAD_SIZES)),
            _most("times the limit code's step", near[near.index.isin(NEAR_SIZES)], NEAR_LIMIT, "n = {}",
                  len(NEAR_SIZES))]


def _scenes(name, mine, scenes):
    plain, filled = scenes[~scenes.filled], scenes[scenes.filled]
    behind = 1 / leads(filled, name, mine, "scene")
    return [_least("times faster than the fastest with a library, planar scenes",
                   leads(plain[plain.dimension == 2], name, mine, "scene"), AHEAD_PLANAR),
            _least("times faster than the fastest with a library, spatial scenes",
                   leads(plain[plain.dimension == 3], name, mine, "scene"), AHEAD_SPATIAL),
            _most("times the step of the fastest with a library, n = 100, filled", behind, BEHIND_FILLED)]


def _growth(name, steps):
    rows = steps[(steps.implementation == name) & (steps.status == "ok")
                 & (steps.variables >= GROWTH_FROM)].sort_values("variables")
    whole = len(rows) > 1 and rows.variables.iloc[-1] >= GROWTH_TO
    found = []
    for column, what in (("step_us", "exponent of a step's time over n"),
                         ("pass_us", "exponent of a pass's time over n"),
                         ("memory_bytes", "exponent of memory over n")):
        values = rows.step_us / rows.passes if column == "pass_us" else rows[column]
        if not whole or values.isna().any():
            found.append(Held(what, f"≤ {EXPONENT}", "", False))
            continue
        exponent = numpy.polyfit(numpy.log(rows.variables), numpy.log(values), 1)[0]
        found.append(Held(what, f"≤ {EXPONENT}", number(exponent), bool(exponent <= EXPONENT)))
    largest = rows[rows.variables >= GROWTH_TO].set_index("variables").setup_us / 1e6
    return [*found, _most("set-up, s", largest, SET_UP, "n = {}")]


def _least(what, values, bound, where="{}", of=1):
    return _worst(what, f"≥ {bound}", values, values.idxmin() if len(values) else None,
                  lambda worst: worst >= bound, where, of)


def _most(what, values, bound, where="{}", of=1):
    return _worst(what, f"≤ {bound}", values, values.idxmax() if len(values) else None,
                  lambda worst: worst <= bound, where, of)


def _worst(what, bound, values, at, good, where, of):
    """`of`: how many values there have to be."""
    if len(values) < of:
        return Held(what, bound, "", False)
    place = where.format(at).removeprefix("harness/scenes/").removesuffix(".json")
    return Held(what, bound, f"{number(values[at])} ({place})", bool(good(values[at])))
