# A rule to apply by hand: at most four cases in each form of the step, in two numbers that `mbs describe` prints.
# A form's mechanisms are parted at a limit of one number, each part once more at a limit of the other. The limits are those that cost least by
# the times that the rule of rule.py predicts for all mechanisms that were timed in the form: measured ones of few that fill much would leave
# them to chance.
from itertools import permutations

import numpy

NUMBERS = {"penalty": ("dense", "per_column"), "saddle-point": ("saddle_dense", "saddle_per_column")}
SHOWN = sum(NUMBERS.values(), ())
EVERYWHERE = dict.fromkeys(SHOWN, (-numpy.inf, numpy.inf))  # from, below


def table(data, rests, rule, worth):
    """A row a case. data, rule, rests: of rule.py, {family: the rule without its times}; worth: of the mean cost, that one more case must save."""
    for scheme, losses in data.losses.items():
        features, weights = data.features.loc[losses.index], data.weights(losses.index)
        chosen = {}
        for family, rest in rests.items():
            out = numpy.array([data.family[scene] == family for scene in features.index])
            left, others = features[out], features[~out]  # nor are limits placed by the counts of who is left out
            for where, name in _cases(rest, scheme, others, data.weights(others.index), worth):
                chosen |= dict.fromkeys(_inside(where, left), name)
        for where, name in _cases(rule, scheme, features, weights, worth):
            scenes = _inside(where, features)
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
    cost = below[places].min(axis=1) + (total - below[places]).min(axis=1)
    for at in numpy.argsort(cost, kind="stable"):
        if (found := _round(*values[places[at]:places[at] + 2])) is not None:
            return cost[at], found, below[places[at]].argmin(), (total - below[places[at]]).argmin()
    return total.min(), numpy.inf, *[total.argmin()] * 2


def _round(least, most):
    """About the middle, in the fewest digits that part the two: least < it <= most; None if two are not enough for that."""
    middles = (float(f"{(least * most) ** 0.5:.{digits}g}") for digits in (1, 2))
    return next((middle for middle in middles if least < middle <= most), None)


def _cases(rule, scheme, features, weights, worth):
    """[(where, library)]"""
    costs = rule.costs(scheme, features).mul(weights, axis=0)
    names, costs, values = costs.columns, costs.to_numpy(), {name: features[name].to_numpy() for name in NUMBERS[scheme]}
    tried = [_one(EVERYWHERE, costs, worth)]
    for first, second in permutations(values):
        known = sorted(set(values[first]))
        for at in filter(None, (_round(*ends) for ends in zip(known, known[1:]))):
            cost, cases = 0.0, []
            for where, inside in zip(_parted(EVERYWHERE, first, at), (values[first] < at, values[first] >= at)):
                split, *found = limit(values[second][inside], costs[inside])
                ends = zip(_parted(where, second, found[0]), found[1:])
                own = min(_one(where, costs[inside], worth), (split + 2 * worth, list(ends)), key=lambda one: one[0])
                cost, cases = cost + own[0], cases + own[1]
            tried.append((cost, cases))
    return [(where, names[place]) for where, place in min(tried, key=lambda one: one[0])[1]]


def _one(where, costs, worth):
    total = costs.sum(axis=0)
    return total.min() + worth, [(where, total.argmin())]


def _parted(where, number, at):
    low, high = where[number]
    return where | {number: (low, at)}, where | {number: (at, high)}


def _inside(where, features):
    return list(features.index[numpy.all([features[number].between(*ends, inclusive="left") for number, ends in where.items()], axis=0)])
