# What an implementation without a library is held to: bounds, and the worst that was measured for each.
#
# An implementation is a folder; of its variants the fastest counts, size by size and scene by scene.
from dataclasses import dataclass

import numpy

from analysis.limit.figure import LIMIT, timed
from analysis.text import number

AHEAD_SIZES, NEAR_SIZES = (22, 50, 82, 160, 1000, 4000), (22, 82, 1000)  # n
AHEAD, AHEAD_PLANAR, AHEAD_SPATIAL = 3.0, 2.0, 1.5
NEAR_LIMIT, BEHIND_FILLED, GAIN, EXPONENT, SET_UP = 1.5, 1.1, 4.0, 1.05, 0.5  # the last in s
GROWTH_FROM, GROWTH_TO = 100, 20000  # n
STANDARD = "/problems/"  # in the path of a standard problem; the other scenes are examples and fills


@dataclass(frozen=True)
class Held:
    what: str
    bound: str
    worst: str  # with where; empty: not measured
    holds: bool


def own(registry):
    return [variant["name"] for entry in registry if entry.get("library") == "none"
            for variant in entry["variants"]]


def own_folders(registry):
    return list(dict.fromkeys(name.partition("/")[0] for name in own(registry)))


def of_folder(rows, folder):
    """Rows of the variants of `folder`."""
    return rows[rows.implementation.str.startswith(f"{folder}/", na=False)]


def leads(rows, folder, mine, key):
    """Series: the least time of those with a library over the least of `folder`'s, by `key`, of what passed the gate.
    `mine`: all variants without a library."""
    good = rows[rows.status == "ok"]
    others = good[~good.implementation.isin([*mine, LIMIT])].groupby(key).step_us.min()
    return (others / of_folder(good, folder).groupby(key).step_us.min()).dropna()


def fastest(rows, folder, key):
    """Series: the fastest variant of `folder`, by `key`."""
    rows = of_folder(rows[rows.status == "ok"], folder).sort_values("step_us").drop_duplicates(key).set_index(key)
    return rows.implementation.str.partition("/")[2]


def wanted(scene, dimension, filled):
    """The least that leads() may be in a scene; not a number in examples, which nothing is held to."""
    if filled:
        return 1 / BEHIND_FILLED
    return (AHEAD_PLANAR if dimension == 2 else AHEAD_SPATIAL) if STANDARD in scene else numpy.nan


def must_hold(folder, registry, steps=None, growth=None, scenes=None, batches=None):
    """[Held] of `folder`; a table that is None was not measured."""
    mine, found = own(registry), []
    if steps is not None:
        found += _sizes(folder, mine, steps) + _growth(folder, steps)
    if growth is not None:
        rows = _growing(folder, growth)
        found.append(_exponent("a step's time", rows, rows.step_us, "saddle-point"))
    if scenes is not None:
        found += _scenes(folder, mine, scenes)
    if batches is not None:
        found += [_gain(folder, sets, rows) for sets, rows in batches.groupby("sets", sort=False)]
    return found


def _gain(folder, sets, rows):
    good = of_folder(rows[rows.status == "ok"], folder).sort_values("step_us")
    return _least(f"throughput of batches ÷ that of their lanes alone, {sets:.0f} sets of parameters",
                  good.drop_duplicates("scene").set_index("scene").gain.dropna(), GAIN,
                  fastest(rows, folder, "scene"), of=rows.scene.nunique())


def _sizes(folder, mine, steps):
    ahead = leads(steps, folder, mine, "variables")
    near = of_folder(timed(steps), folder).groupby("variables").multiple.min()
    by = fastest(steps, folder, "variables")
    return [_least("times faster than the fastest with a library, N-four-bar",
                   ahead[ahead.index.isin(AHEAD_SIZES)], AHEAD, by, "n = {}", len(AHEAD_SIZES)),
            _most("times the limit code's step", near[near.index.isin(NEAR_SIZES)], NEAR_LIMIT, by, "n = {}",
                  len(NEAR_SIZES))]


def _scenes(folder, mine, scenes):
    plain, filled = scenes[scenes.scene.str.contains(STANDARD, regex=False)], scenes[scenes.filled]
    behind, by = 1 / leads(filled, folder, mine, "scene"), fastest(scenes, folder, "scene")
    return [_least("times faster than the fastest with a library, planar standard problems",
                   leads(plain[plain.dimension == 2], folder, mine, "scene"), AHEAD_PLANAR, by),
            _least("times faster than the fastest with a library, spatial standard problems",
                   leads(plain[plain.dimension == 3], folder, mine, "scene"), AHEAD_SPATIAL, by),
            _most("times the step of the fastest with a library, n = 100, filled", behind, BEHIND_FILLED, by)]


def _growing(folder, steps):
    """The fastest of `folder` at each size from GROWTH_FROM on."""
    rows = of_folder(steps[(steps.status == "ok") & (steps.variables >= GROWTH_FROM)], folder)
    return rows.sort_values(["variables", "step_us"]).drop_duplicates("variables")


def _exponent(what, rows, values, form):
    what = f"exponent of {what} over n, {form} form"
    if len(rows) < 2 or rows.variables.iloc[-1] < GROWTH_TO or values.isna().any():
        return Held(what, f"≤ {EXPONENT}", "", False)
    exponent = numpy.polyfit(numpy.log(rows.variables), numpy.log(values), 1)[0]
    return Held(what, f"≤ {EXPONENT}", number(exponent), bool(exponent <= EXPONENT))


def _growth(folder, steps):
    rows = _growing(folder, steps)
    found = [_exponent(what, rows, values, "penalty") for what, values in (
        ("a step's time", rows.step_us), ("a pass's time", rows.step_us / rows.passes),
        ("memory", rows.memory_bytes))]
    largest = rows[rows.variables >= GROWTH_TO].set_index("variables").setup_us / 1e6
    return [*found, _most("set-up, s", largest, SET_UP, fastest(steps, folder, "variables"), "n = {}")]


def _least(what, values, bound, by, where="{}", of=1):
    return _worst(what, f"≥ {bound}", values, values.idxmin() if len(values) else None,
                  lambda worst: worst >= bound, by, where, of)


def _most(what, values, bound, by, where="{}", of=1):
    return _worst(what, f"≤ {bound}", values, values.idxmax() if len(values) else None,
                  lambda worst: worst <= bound, by, where, of)


def _worst(what, bound, values, at, good, by, where, of):
    """`by`: the variants that the values are of; `of`: how many values there have to be."""
    if len(values) < of:
        return Held(what, bound, "", False)
    place = where.format(at).removeprefix("harness/scenes/").removesuffix(".json")
    return Held(what, bound, f"{number(values[at])} ({place}, {by[at]})", bool(good(values[at])))
