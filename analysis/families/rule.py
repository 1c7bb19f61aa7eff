# A rule that predicts: how long a step takes with each library, and so which to take, from numbers of a scene's structure and the passes of its steps.
#
# A few libraries are compared in each form of the step; that of the least predicted time (times.py) is taken. That a dense one is always compared,
# and the sparse one that is predicted to be the fastest where a factorization takes most operations, was chosen with a look at families left out:
# without those that fill most, neither is worth it. A loss is of times taken in turns, else of the first look, else of the look at the next smaller
# machine of the shape, after which who had fallen far behind was not asked again. Where there is none of these a loss is not known: such scenes are
# counted, in no mean, and say nothing of who is worth comparing.
from collections import Counter
from itertools import combinations

import numpy
import pandas

from analysis.families import by_hand, defaults
from analysis.families.times import FEATURES, PASSES, TERMS, as_penalty, model, predicted

CANDIDATES = 3  # at most, in each form
WORTH = 0.01    # of the mean cost, that one more candidate must save
FAMILIES = 4     # at least, for a rule
MUCH = 0.30      # a loss
FAILED = 3.0     # loss of who is of no use there: it disagrees, crashes, ...
MOST = 3.0       # what a loss counts at most, where candidates are chosen
UNKNOWN = MOST * (1 + 4 * MOST)  # the cost of who has no loss, where one number chooses
COUNTABLE = 2.5e8  # operations of a factorization up to which `mbs describe` counts passes (harness/src/describe/passes.cpp)
WORK = {"penalty": "flops", "saddle-point": "saddle_flops"}  # of a factorization
FEWEST = 8       # scenes that the time of a step is fitted on
WITHIN = 1.5     # a predicted time is good within this factor
OWN, ALL = (0.025, 0.975), (0.05, 0.95)  # shares of measured over predicted times, of an implementation and of all in its form, that a range covers
ALONE = ("n", "fill", "tangent", "factor", "per_column", "flops", "dense", "height", "widest", "block")  # numbers that might decide alone
NEAREST = ("n", "per_column", "flops", "tangent")  # what `mbs describe` takes distances in


def judged(tables, registry):
    """{"defaults", "steps", "held", "alone", "by_hand"}: tables of the rule; but for the first without rows where there are too few families."""
    data = _Data(tables, registry)
    rows = {"defaults": defaults.table(data, tables["scenes"].set_index(["scheme", "scene", "implementation"]).record)}
    if len(set(data.family.values())) < FAMILIES:
        return {name: pandas.DataFrame(rows.get(name)) for name in ("defaults", "steps", "held", "alone", "by_hand")}
    rests = {family: _Rule(data.without(family)) for family in dict.fromkeys(data.family.values())}
    data.losses = {scheme: losses for scheme, losses in data.losses.items() if all(rest.candidates[scheme] for rest in rests.values())}
    ratios = pandas.DataFrame([row for family, rest in rests.items() for row in _ratios(data, family, rest)],
                              columns=["family", "scheme", "implementation", "ratio"])
    whole = _Rule(data)
    rows |= {"steps": _steps(data, whole, ratios, registry), "held": _held(data, rests, ratios), "alone": _alone(data),
             "by_hand": by_hand.table(data, rests, whole, WORTH)}
    return {name: pandas.DataFrame(found) for name, found in rows.items()}


def summary(held):
    """Families and scenes left out; mean and worst loss; step times that are known, shares of them within WITHIN and inside their range."""
    timed = held[held.step_us.notna() & held.predicted_us.notna()]
    ratio = timed.predicted_us / timed.step_us
    return {"families": int(held.family.nunique()), "scenes": int(held.scene.nunique()), "timed": len(timed),
            "mean_loss": float(held.loss.mean()), "worst_loss": float(held.loss.max()), "unknown": int(held.loss.isna().sum()),
            "within": float(ratio.between(1 / WITHIN, WITHIN).mean()), "inside": float(timed.step_us.between(timed.low_us, timed.high_us).mean())}


def missed(held):
    """Rows of `held` that lose much, or whose time is not within WITHIN or not inside its range."""
    ratio = held.predicted_us / held.step_us
    good = (held.loss <= MUCH) & (ratio.isna() | ratio.between(1 / WITHIN, WITHIN) & held.step_us.between(held.low_us, held.high_us))
    return held[~good]


def carried(own, there):
    """Losses {(form, scene): loss} of the rule of a set on the mechanisms of another one; each is (tables, registry)."""
    rule, data = _Rule(_Data(*own)), _Data(*there)
    return {(scheme, scene): losses.loc[scene].get(rule.choice(scheme, data.features.loc[[scene]])[0], numpy.nan)
            for scheme, losses in data.losses.items() if rule.candidates.get(scheme) for scene in losses.index}


def document(tables):
    """What `mbs describe` applies: candidates, times, held, scenes (harness/src/describe/README.md); None without a rule."""
    steps, known = tables["steps"], tables["mechanisms"].set_index("scene")
    if steps.empty:
        return None
    times, candidates = {}, {}
    for (name, scheme), rows in steps.groupby(["implementation", "scheme"], sort=False):
        times.setdefault(name, {"layer": rows.layer.iloc[0]})[scheme] = {
            "coefficients": dict(zip(rows.term, rows.us)), "low": rows.low.iloc[0], "high": rows.high.iloc[0]}
        if rows.candidate.iloc[0]:
            candidates.setdefault(scheme, []).append(name)
    fastest = tables["winners"][(tables["winners"].layer == "libraries") & (tables["winners"].winner != "")].drop_duplicates("scene")
    names = list(dict.fromkeys((*FEATURES, *NEAREST, *ALONE)))
    scenes = [{"scene": row.scene, "features": known.loc[row.scene, names].dropna().astype(float).to_dict(), "fastest": row.winner, "step_us": row.step_us}
              for row in fastest.itertuples() if row.scene in known.index and known.loc[row.scene, list(NEAREST)].notna().all()]
    return {"candidates": candidates, "times": times, "held": summary(tables["held"]), "scenes": scenes}


def _ratios(data, family, rest):
    """Measured over predicted times of a family left out, with all that have a model."""
    for (scheme, name), found in rest.models.items():
        times = data.us[scheme][name].dropna()
        times = times[[scene for scene in times.index if data.family[scene] == family]]
        yield from ((family, scheme, name, ratio) for ratio in times / predicted(found, data.features.loc[times.index]))


def _range(ratios, scheme, name, without=None):
    """(low, high), as factors of a predicted time."""
    here = ratios[(ratios.scheme == scheme) & (ratios.family != without)]
    groups = [(here[here.implementation == name].ratio, OWN), (here.ratio, ALL)]
    ends = [numpy.quantile(found, shares) for found, shares in groups if len(found)] or [(1 / WITHIN, WITHIN)]
    return float(min(low for low, _ in ends)), float(max(high for _, high in ends))


def _steps(data, rule, ratios, registry):
    for (scheme, name), found in rule.models.items():
        low, high = _range(ratios, scheme, name)
        yield from ({"scheme": scheme, "implementation": name, "layer": "own" if name in registry.own else "library",
                     "candidate": name in rule.candidates[scheme], "term": term, "us": us,
                     "low": low, "high": high, "scenes": data.us[scheme][name].notna().sum(), "record": data.records} for term, us in found.items())


def _held(data, rests, ratios):
    """A row for each scene and form: what was chosen and predicted by what was fitted on the other families."""
    for family, rest in rests.items():
        for scheme, losses in data.losses.items():
            for scene in [one for one in losses.index if data.family[one] == family]:
                name, us = rest.choice(scheme, data.features.loc[[scene]])
                low, high = _range(ratios, scheme, name, family)
                yield {"family": family, "scene": scene, "scheme": scheme, "variables": data.features.loc[scene, "n"], "chosen": name,
                       "fastest": losses.loc[scene].idxmin(), "loss": losses.loc[scene, name], "known_by": data.known_by[scheme].loc[scene, name],
                       "step_us": data.us[scheme].loc[scene].get(name, numpy.nan), "predicted_us": us, "low_us": low * us, "high_us": high * us, "record": data.record[scene]}


def _alone(data):
    """A row for each number: what is lost on families left out if it alone decides, below a limit one library, above another."""
    losses = {feature: [] for feature in ALONE}
    for family in dict.fromkeys(data.family.values()):
        rest = data.without(family)
        for scheme, one in data.losses.items():
            left = one.index[[data.family[scene] == family for scene in one.index]]
            if len(left) and len(rest.losses[scheme]):
                costs = cost(rest.losses[scheme]).fillna(UNKNOWN)
                weighted, known = costs.to_numpy() * rest.weights(costs.index)[:, None], rest.features.loc[costs.index]
                for feature, found in losses.items():
                    _, limit, below, above = by_hand.limit(known[feature].to_numpy(), weighted)
                    found += [one.loc[scene, costs.columns[below if data.features.loc[scene, feature] < limit else above]] for scene in left]
    for feature, found in losses.items():
        yield {"feature": feature, "mean_loss": numpy.nanmean(found), "worst_loss": numpy.nanmax(found), "scenes": len(found), "record": data.records}


class _Rule:
    """Models of all and candidates, fitted on some families."""

    def __init__(self, data):
        self.models = {}  # µs a step
        for scheme in PASSES:  # the penalty form first
            for name in (us := data.us.get(scheme, {})):
                if len(times := us[name].dropna()) >= FEWEST:
                    dense = bool(data.registry.variants[name].get("dense"))
                    features, weights = data.features.loc[times.index], data.weights(times.index)
                    known = as_penalty(self.models.get(("penalty", name), {}), dense) if scheme == "saddle-point" else {}
                    self.models[scheme, name] = model(TERMS[scheme, dense], features, times, weights**0.5, known)
        self.candidates = self._compared(data)

    def choice(self, scheme, features):
        """(name, predicted µs) of the candidate that is taken on a scene."""
        times = self._times(scheme, self.candidates[scheme], features).iloc[0]
        return times.idxmin(), times.min()

    def costs(self, scheme, features):
        """Of scenes and candidates, by predicted times."""
        times = self._times(scheme, self.candidates[scheme], features)
        return cost(times.div(times.min(axis=1), axis=0) - 1)

    def _times(self, scheme, names, features):
        """Predicted µs, of scenes and names."""
        return pandas.DataFrame({name: predicted(self.models[scheme, name], features) for name in names}, index=features.index)

    def _compared(self, data):
        """{form: names} of the least cost, each name counting as WORTH; of those who are the fastest somewhere. Among them are a dense one and
        the sparse one that is predicted the fastest on the scene with most operations: another family may fill more than all that are known."""
        found = {}
        for scheme in data.losses:
            costs, weights = cost(data.losses[scheme]), data.weights(data.losses[scheme].index)
            names = [name for name in costs if (scheme, name) in self.models and (costs[name] == 0).any()]
            if not names:  # too few were timed in this form
                found[scheme] = []
                continue
            features, rows = data.features.loc[costs.index], numpy.arange(len(costs))
            times = self._times(scheme, names, features).to_numpy()
            costs = costs[names].to_numpy()
            best, most = {}, features[WORK[scheme]].argmax()
            dense = {place for place, name in enumerate(names) if data.registry.variants[name].get("dense")}
            sparse = set(range(len(names))) - dense
            asked = [dense, {min(sparse, key=lambda place: times[most, place])} if sparse else set()]
            for places in (some for size in range(1, CANDIDATES + 1) for some in combinations(range(len(names)), size)
                           if all(not kind or kind & {*some} for kind in asked)):
                found_cost = costs[rows, numpy.array(places)[times[:, places].argmin(axis=1)]]
                tried = ~numpy.isnan(found_cost)
                best[places] = numpy.average(found_cost[tried], weights=weights[tried]) + WORTH * len(places) if tried.any() else numpy.inf
            found[scheme] = [names[place] for place in min(best, key=best.get)]
        return found


class _Data:
    """Times and losses of the scenes whose features are known, by form."""

    def __init__(self, tables, registry):
        self.registry, known = registry, tables["mechanisms"].set_index("scene")
        complete = known[known[list(FEATURES)].notna().all(axis=1)]
        self.features, self.record = complete[list(dict.fromkeys((*FEATURES, *ALONE)))].astype(float), complete.record
        n, m, full_flops = self.features.n, self.features.m, lambda n: n * (n + 1) * (2 * n + 1) / 6
        self.features["saddle_per_column"] = self.features.saddle_factor / (n + m)
        # Operations in % of a dense solver's, as elimination.hpp has them.
        dense = n * m**2 + full_flops(m) + self.features.stiff * (full_flops(n) + n**2 * m)
        self.features["saddle_dense"] = 100 * self.features.saddle_flops / dense.clip(lower=1)
        self.us, self.losses, self.known_by = {}, {}, {}
        shapes = {scene: shape(scene) for scene in known.sort_values("n").index}
        for scheme, rows in tables["scenes"][tables["scenes"].scene.isin(complete.index)].groupby("scheme", sort=False):
            us = pandas.DataFrame({scene: _times(one, registry.libraries) for scene, one in rows.groupby("scene", sort=False)}).T
            best = us[[name for name in registry.libraries if name in us]]
            best = best[best.notna().any(axis=1)]
            self.us[scheme] = us.loc[best.index]
            # `mbs describe` counts them in the steps that `mbs bench` times, which are not always those that were timed here.
            passes = rows[(rows.status == "ok") & rows.passes.notna()].groupby("scene").passes.median()
            self.features[PASSES[scheme]].update(passes[self.features.loc[passes.index, WORK[scheme]] <= COUNTABLE])
            status = rows.pivot(index="scene", columns="implementation", values="status").reindex(index=best.index, columns=best.columns).fillna("")
            self.losses[scheme], self.known_by[scheme] = _losses(best.div(best.min(axis=1), axis=0).sub(1.0), status, shapes)
        self.family = {scene: known.family[scene] for losses in self.losses.values() for scene in losses.index}

    records = property(lambda self: " ".join(self.record[scene] for scene in self.family))

    def without(self, family):
        rest = object.__new__(_Data)
        rest.__dict__ = self.__dict__ | {name: {scheme: rows[[self.family[scene] != family for scene in rows.index]]
                                                for scheme, rows in getattr(self, name).items()} for name in ("us", "losses")}
        return rest

    def weights(self, scenes):
        """Families count alike, whatever their sizes; 1 in all."""
        sizes = Counter(self.family[scene] for scene in scenes)
        return numpy.array([1 / sizes[self.family[scene]] / len(sizes) for scene in scenes])


def cost(losses):
    """Of scenes and libraries: one loss of a fifth is worse than four of a twentieth."""
    losses = losses.clip(upper=MOST)
    return losses * (1 + 4 * losses)


def shape(scene):
    """The family and its options, which make other machines of it: "flexible:2,nodes=100" is a "flexible,nodes=100"."""
    name, _, rest = scene.partition(":")
    return ",".join([name, *rest.split(",")[1:]])


def _losses(losses, status, shapes):
    """Losses, with those that only the look at a smaller one of the shape tells or that are of a failure; and what each is known by."""
    by = status.replace({"ok": "turns", "slower": "look"}).where(losses.notna(), "")
    known = losses.loc[[scene for scene in shapes if scene in losses.index]]  # from small to large
    smaller = known.groupby([shapes[scene] for scene in known.index]).ffill().reindex_like(losses)
    failed = losses.isna() & ~status.isin(["excluded", "slower", "dropped", ""])
    told = losses.isna() & status.isin(["excluded", "slower"]) & smaller.notna()
    return losses.mask(failed, FAILED).mask(told, smaller), by.mask(failed, "failed").mask(told, "smaller")


def _times(rows, libraries):
    """µs a step by contender: measured in turns, or of the look, scaled by the fastest library's two times."""
    rows = rows[rows.verdict == "agrees"].set_index("implementation")
    timed = rows[rows.status == "ok"]
    if not (known := [name for name in timed.index if name in libraries]):
        return pandas.Series(dtype=float)
    first = timed.loc[known, "to_rival"].astype(float).idxmin()
    found = (rows.look_us * (timed.step_us[first] / rows.look_us[first])).where(rows.status.isin(["ok", "slower"]))
    found.update(timed.step_us[first] * timed.to_rival.astype(float))
    return found.astype(float)
