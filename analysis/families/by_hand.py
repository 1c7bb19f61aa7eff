# A rule to apply by hand: at most three cases in each form of the step, in two numbers that `mbs describe` prints.
#
# A form's mechanisms are parted at a limit of one number, one of the parts once more at a limit of the other.
# Limits and libraries are those of the least cost, the limits as round as they may be. Judged on families left out, as rule.py is;
# but which two numbers was chosen with a look at that.
from itertools import permutations

import numpy
import pandas

NUMBERS = {"penalty": ("per_column", "n"), "saddle-point": ("dense", "n")}
SHOWN = ("per_column", "dense", "n")
EVERYWHERE = dict.fromkeys(SHOWN, (-numpy.inf, numpy.inf))  # from, below


def table(data, worth, unknown):
    """A row a case. data: losses and costs of rule.py; worth: of the mean cost, that one more case must save; unknown: the
    cost of who has none."""
    rows = []
    for scheme, losses in data.losses.items():
        chosen = {}
        for family in dict.fromkeys(data.family[scene] for scene in losses.index):
            left = [scene for scene in losses.index if data.family[scene] == family]
            for where, name in _cases(data.without(family), scheme, worth, unknown):
                chosen |= dict.fromkeys(_inside(where, data.features.loc[left]), name)
        for where, name in _cases(data, scheme, worth, unknown):
            scenes = _inside(where, data.features.loc[losses.index])
            found = numpy.array([losses.loc[scene, chosen[scene]] for scene in scenes])
            known = found[~numpy.isnan(found)]
            rows.append({"scheme": scheme, "library": name} | {f"{end}_{number}": value if numpy.isfinite(value) else None
                                                               for number, ends in where.items() for end, value in zip(("least", "below"), ends)}
                        | {"scenes": len(found), "unknown": len(found) - len(known), "mean_loss": known.mean() if len(known) else None,
                           "worst_loss": known.max() if len(known) else None, "record": " ".join(data.record[scene] for scene in scenes)})
    return pandas.DataFrame(rows)


def summary(cases):
    """Losses of some rows of the table, on the scenes where they are known."""
    known = cases.scenes - cases.unknown
    return {"mean_loss": (cases.mean_loss * known).sum() / known.sum() if known.sum() else numpy.nan, "worst_loss": cases.worst_loss.max(),
            "unknown": int(cases.unknown.sum())}


def limit(values, costs):
    """(cost, limit, who is taken below it, who above): of the least cost. costs: a row for each of values, a column for each name."""
    order = numpy.argsort(values, kind="stable")
    values, below = values[order], numpy.cumsum(costs.to_numpy()[order], axis=0)
    total = below[-1]
    places = numpy.flatnonzero(values[1:] > values[:-1])
    if not len(places):
        return total.min(), numpy.inf, *[costs.columns[total.argmin()]] * 2
    cost = below[places].min(axis=1) + (total - below[places]).min(axis=1)
    best = places[cost.argmin()]
    return cost.min(), _round(values[best], values[best + 1]), costs.columns[below[best].argmin()], costs.columns[(total - below[best]).argmin()]


def _round(least, most):
    """About the middle, in the fewest digits that part the two: least < it <= most."""
    middles = (float(f"{(least * most) ** 0.5:.{digits}g}") for digits in range(1, 17))
    return next((middle for middle in middles if least < middle <= most), most)


def _cases(data, scheme, worth, unknown):
    """[(where, library)]"""
    costs = data.costs(scheme).fillna(unknown)
    costs, features = costs.mul(data.weights(costs.index), axis=0), data.features.loc[costs.index]
    total = costs.sum()
    tried = [(total.min(), [(EVERYWHERE, total.idxmin())])]
    for first, second in permutations(NUMBERS[scheme]):
        cost, *found = limit(features[first].to_numpy(), costs)
        tried.append((cost, _parted(EVERYWHERE, first, *found)))
        values = sorted(set(features[first]))
        for at in (_round(*ends) for ends in zip(values, values[1:])):
            low = (features[first] < at).to_numpy()
            parts = _parted(EVERYWHERE, first, at, costs[low].sum().idxmin(), costs[~low].sum().idxmin())
            for side, inside in ((0, low), (1, ~low)):
                cost, *found = limit(features[second].to_numpy()[inside], costs[inside])
                split = _parted(parts[side][0], second, *found)
                tried.append((cost + costs[~inside].sum().min(), [*parts[:side], *split, *parts[side + 1:]]))
    return min(tried, key=lambda one: one[0] + worth * len(one[1]))[1]


def _parted(where, number, at, below, above):
    low, high = where[number]
    return [(where | {number: (low, at)}, below), (where | {number: (at, high)}, above)]


def _inside(where, features):
    there = pandas.Series(True, features.index)
    for number, (low, high) in where.items():
        there &= (features[number] >= low) & (features[number] < high)
    return list(features.index[there])
