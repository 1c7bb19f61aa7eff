# A rule to apply by hand: at most three cases in each form of the step, in two numbers that `mbs describe` prints.
# A form's mechanisms are parted at a limit of one number, one of the parts once more at a limit of the other; at the least cost.
from itertools import permutations

import numpy

from analysis.core.gather import gather

NUMBERS = {"penalty": ("per_column", "dense"), "saddle-point": ("saddle_dense", "rows")}
SHOWN = ("per_column", "dense", "saddle_dense", "rows")
EVERYWHERE = dict.fromkeys(SHOWN, (-numpy.inf, numpy.inf))  # from, below


def table(data, worth, unknown):
    """A row a case. data: losses and costs of rule.py; worth: of the mean cost, that one more case must save; unknown: the cost of who has none."""
    for scheme, losses in data.losses.items():
        chosen = {}
        for family, left in gather((data.family[scene], scene) for scene in losses.index).items():
            for where, name in _cases(data.without(family), scheme, worth, unknown):
                chosen |= dict.fromkeys(_inside(where, data.features.loc[left]), name)
        for where, name in _cases(data, scheme, worth, unknown):
            scenes = _inside(where, data.features.loc[losses.index])
            found = numpy.array([losses.loc[scene, chosen[scene]] for scene in scenes])
            known = found[~numpy.isnan(found)]
            limits = {f"{end}_{number}": value if numpy.isfinite(value) else None
                      for number, ends in where.items() for end, value in zip(("least", "below"), ends)}
            yield {"scheme": scheme, "library": name} | limits | {
                "scenes": len(found), "unknown": len(found) - len(known), "mean_loss": known.mean() if len(known) else None,
                "worst_loss": known.max() if len(known) else None, "record": " ".join(data.record[scene] for scene in scenes)}


def summary(cases):
    """Losses of some rows of the table, on the scenes where they are known."""
    known = cases.scenes - cases.unknown
    return {"mean_loss": (cases.mean_loss * known).sum() / known.sum() if known.sum() else numpy.nan, "worst_loss": cases.worst_loss.max(),
            "unknown": int(cases.unknown.sum())}


def limit(values, costs):
    """(cost, limit, the column that is taken below it, that above): of the least cost. costs: a row for each of values."""
    order = numpy.argsort(values, kind="stable")
    values, below = values[order], numpy.cumsum(costs[order], axis=0)
    total = below[-1]
    places = numpy.flatnonzero(values[1:] > values[:-1])
    if not len(places):
        return total.min(), numpy.inf, *[total.argmin()] * 2
    cost = below[places].min(axis=1) + (total - below[places]).min(axis=1)
    best = places[cost.argmin()]
    return cost.min(), _round(values[best], values[best + 1]), below[best].argmin(), (total - below[best]).argmin()


def _round(least, most):
    """About the middle, in the fewest digits that part the two: least < it <= most."""
    middles = (float(f"{(least * most) ** 0.5:.{digits}g}") for digits in range(1, 17))
    return next((middle for middle in middles if least < middle <= most), most)


def _cases(data, scheme, worth, unknown):
    """[(where, library)]"""
    costs = data.costs(scheme).fillna(unknown)
    names, features = costs.columns, {number: data.features.loc[costs.index, number].to_numpy() for number in NUMBERS[scheme]}
    costs = costs.to_numpy() * data.weights(costs.index)[:, None]
    total = costs.sum(axis=0)
    tried = [(total.min(), [(EVERYWHERE, total.argmin())])]
    for first, second in permutations(NUMBERS[scheme]):
        cost, *found = limit(features[first], costs)
        tried.append((cost, _parted(EVERYWHERE, first, *found)))
        values = sorted(set(features[first]))
        for at in (_round(*ends) for ends in zip(values, values[1:])):
            low = features[first] < at
            parts = _parted(EVERYWHERE, first, at, costs[low].sum(axis=0).argmin(), costs[~low].sum(axis=0).argmin())
            for side, inside in ((0, low), (1, ~low)):
                cost, *found = limit(features[second][inside], costs[inside])
                split = _parted(parts[side][0], second, *found)
                tried.append((cost + costs[~inside].sum(axis=0).min(), [*parts[:side], *split, *parts[side + 1:]]))
    return [(where, names[place]) for where, place in min(tried, key=lambda one: one[0] + worth * len(one[1]))[1]]


def _parted(where, number, at, below, above):
    low, high = where[number]
    return [(where | {number: (low, at)}, below), (where | {number: (at, high)}, above)]


def _inside(where, features):
    return list(features.index[numpy.all([features[number].between(*ends, inclusive="left") for number, ends in where.items()], axis=0)])
