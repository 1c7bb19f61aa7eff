# A rule that predicts: which library is fastest, and how long a step takes, from numbers that need no factorization.
#
# The choice is a tree of few ends for each form of the step, grown where it saves most time; a step's time is a sum of
# features with coefficients that are not negative (least squares of relative errors). Both are judged on families left out:
# each family is predicted by what was fitted on all others.
import numpy
import pandas

SPLITS = ("n", "fill", "per_column", "flops", "height")  # features that a tree may ask for
LEAVES = {"penalty": 3, "saddle-point": 2}  # of the two forms of the step: five ends in all
LEAST = 2        # families on each side of a question, so that none is asked for one machine's sake
WORTH = 0.003    # of the mean cost, that a further question must save
SADDLE = "saddle"  # the feature that is 1 in the saddle-point form, 0 in the penalty form
MISSED = 3.0     # loss of who has no time: excluded as far behind, or of no use there
SPARSE = ("one", "n", "jacobian", "tangent", "factor", "flops")  # features of a step's time
DENSE = ("one", "n", "jacobian", "n2", "n3")
USUAL = 1.5      # times the passes of the mechanism in the middle: who takes more, at a singular position, is no guide to times
FEWEST = 8       # scenes that the time of a step is fitted on
WITHIN = 1.5     # a predicted time is good within this factor
RANGE = 5, 95    # percentiles of measured over predicted time


def rule(tables, registry):
    """{"tree", "times", "held", "scenes"}: what `mbs describe` applies (harness/src/describe/README.md); None without data."""
    data = _Data(tables, registry)
    if data.families < 2 * LEAST:
        return None
    judged = held(tables, registry)
    return {"tree": data.both(), "times": data.times(judged), "held": summary(judged),
            "scenes": [{"scene": scene, "features": data.features.loc[scene].to_dict(), "fastest": fastest, "step_us": float(step)}
                       for scene, (fastest, step) in data.fastest().items()]}


def leaves(tables, registry):
    """[(conditions, library, its losses where the tree ends there)] of the rule on all mechanisms; conditions: (feature, whether
    below, number)."""
    data = _Data(tables, registry)
    if data.families < 2 * LEAST:
        return []
    found = []

    def walk(node, conditions, rows):
        if "take" in node:
            here = [losses.get(node["take"], MISSED) for features, losses in rows
                    if all((features[feature] < number) == below for feature, below, number in conditions)]
            found.append((conditions, node["take"], here))
        else:
            walk(node["then"], [*conditions, (node["feature"], True, node["below"])], rows)
            walk(node["else"], [*conditions, (node["feature"], False, node["below"])], rows)
    for scheme, losses in data.losses.items():
        rows = [({**data.features.loc[scene], SADDLE: float(scheme == "saddle-point")}, one) for scene, one in losses.iterrows()]
        walk(data.tree(scheme), [(SADDLE, scheme == "penalty", 0.5)], rows)
    return found


def alone(tables, registry):
    """A row for each feature: what trees lose on families left out that may ask for it alone. [Which number decides?]"""
    data, rows = _Data(tables, registry), []
    for feature in SPLITS if data.families >= 2 * LEAST else ():
        losses = []
        for family in dict.fromkeys(data.family.values()):
            rest = data.without(family)
            trees = {scheme: rest.tree(scheme, (feature,)) for scheme in data.losses}
            losses += [row.get(leaf(trees[scheme], data.features.loc[scene]), MISSED) for scheme, one in data.losses.items()
                       for scene, row in one.iterrows() if data.family[scene] == family]
        rows.append({"feature": feature, "mean_loss": numpy.mean(losses), "worst_loss": max(losses), "scenes": len(losses),
                     "record": " ".join(data.records[scene] for scene in data.features.index)})
    return pandas.DataFrame(rows)


def held(tables, registry):
    """A row for each scene and form: what was chosen and predicted by what was fitted on the other families."""
    data = _Data(tables, registry)
    rows = []
    for family in dict.fromkeys(data.family.values()) if data.families >= 2 * LEAST else ():
        rest = data.without(family)
        trees, models = {scheme: rest.tree(scheme) for scheme in data.losses}, {(scheme, name): rest.model(scheme, name) for scheme, name in data.timed}
        for scene in [one for one in data.features.index if data.family[one] == family]:
            for scheme, losses in data.losses.items():
                if scene not in losses.index:
                    continue
                predicted = {one: _time(models[scheme, one], data.features.loc[scene]) for at, one in models if at == scheme}
                name = leaf(trees[scheme], data.features.loc[scene])
                measured = data.us[scheme].loc[scene].get(name, numpy.nan) if data.usual[scheme][scene] else numpy.nan
                rows.append({"family": family, "scene": scene, "scheme": scheme, "variables": data.features.loc[scene, "n"],
                             "chosen": name, "fastest": losses.loc[scene].idxmin(), "loss": losses.loc[scene].get(name, MISSED),
                             "step_us": measured, "predicted_us": predicted.get(name, numpy.nan),
                             "record": data.records[scene], "models": predicted})
    return pandas.DataFrame(rows)


def summary(judged):
    """Families and scenes left out; mean and worst loss; share of the step times within WITHIN."""
    ratio = (judged.predicted_us / judged.step_us).dropna()
    return {"families": int(judged.family.nunique()), "scenes": int(judged.scene.nunique()),
            "mean_loss": float(judged.loss.mean()), "worst_loss": float(judged.loss.max()),
            "within": float(((ratio <= WITHIN) & (ratio >= 1 / WITHIN)).mean())}


def leaf(tree, features):
    while "take" not in tree:
        tree = tree["then"] if features[tree["feature"]] < tree["below"] else tree["else"]
    return tree["take"]


def _time(model, features):
    return sum(value * features[name] for name, value in model.items()) if model else numpy.nan


class _Data:
    """Times and losses of the scenes whose features are known."""

    def __init__(self, tables, registry):
        self.registry = registry
        known = tables["mechanisms"]
        known = known.set_index("scene") if set(FEATURES) < set(known) else pandas.DataFrame(columns=[*FEATURES, "family", "record"])
        self.family, self.records = known.family.to_dict(), known.record.to_dict()
        self.features = known[list(FEATURES)].astype(float).dropna()
        self.us, self.losses, self.usual = {}, {}, {}
        for scheme, rows in tables["scenes"].groupby("scheme", sort=False) if len(self.features) else ():
            us = pandas.DataFrame({scene: _times(one, registry.libraries) for scene, one in rows.groupby("scene", sort=False)
                                   if scene in self.features.index}).T
            best = us[[name for name in registry.libraries if name in us]]
            best = best[best.notna().any(axis=1)]
            self.us[scheme] = us.loc[best.index]
            passes = rows[rows.passes.notna()].groupby("scene").passes.median().reindex(best.index)
            self.usual[scheme] = ~(passes > USUAL * passes.median())
            self.losses[scheme] = best.div(best.min(axis=1), axis=0).sub(1.0).fillna(MISSED).clip(upper=MISSED)

    @property
    def families(self):
        return len({self.family[scene] for losses in self.losses.values() for scene in losses.index})

    @property
    def timed(self):
        """(scheme, implementation) with enough scenes for a model."""
        return [(scheme, name) for scheme, us in self.us.items() for name in us if us[name].notna().sum() >= FEWEST]

    def without(self, family):
        found = object.__new__(_Data)
        keep = [scene for scene in self.features.index if self.family[scene] != family]
        found.__dict__ |= self.__dict__ | {
            "features": self.features.loc[keep],
            **{name: {scheme: one[one.index.isin(keep)] for scheme, one in getattr(self, name).items()} for name in ("us", "losses")}}
        return found

    def tree(self, scheme, splits=SPLITS):
        losses = self.losses[scheme]
        losses = losses.loc[:, (losses < MISSED).any()]
        features = {name: self.features.loc[losses.index, name].to_numpy() for name in splits}
        families = numpy.array([self.family[scene] for scene in losses.index])
        counts = pandas.Series(families).value_counts()
        weights = numpy.array([1 / counts[one] for one in families]) / len(counts)  # a family counts once, whatever its sizes
        costs = losses * (1 + 4 * losses)  # one loss of a fifth is worse than four of a twentieth
        return _grow(costs.mul(weights, axis=0), features, families, splits, LEAVES[scheme])

    def both(self):
        """The trees of both forms as one, which asks for the form first."""
        trees = {scheme: self.tree(scheme) for scheme in self.losses}
        first, *others = trees.values()
        return {"feature": SADDLE, "below": 0.5, "then": first, "else": others[0]} if others else first

    def model(self, scheme, name):
        """{feature: µs}; None of too few scenes."""
        times = self.us[scheme][name].dropna() if name in self.us.get(scheme, ()) else pandas.Series(dtype=float)
        times = times[self.usual[scheme][times.index]] if len(times) else times
        if len(times) < FEWEST:
            return None
        from scipy.optimize import nnls
        chosen = DENSE if self.registry.variants[name].get("dense") else SPARSE
        matrix = self.features.loc[times.index, list(chosen)].to_numpy(float) / times.to_numpy(float)[:, None]
        scale = matrix.max(axis=0)
        values, _ = nnls(matrix / scale, numpy.ones(len(times)))
        return {feature: float(value / size) for feature, value, size in zip(chosen, values, scale) if value > 0}

    def times(self, judged):
        found = {}
        for scheme, name in self.timed:
            ratio = [self.us[scheme].loc[row.scene, name] / row.models[name] for row in judged.itertuples()
                     if row.scheme == scheme and row.models.get(name, 0) > 0]
            low, high = numpy.nanpercentile(ratio, RANGE) if numpy.isfinite(ratio).any() else (0.5, 2.0)
            entry = found.setdefault(name, {"layer": "own" if name in self.registry.own else "library"})
            entry[scheme] = {"coefficients": self.model(scheme, name), "low": float(min(low, 1)), "high": float(max(high, 1))}
        return found

    def fastest(self):
        """{scene: (library, µs)}, in the first form in which one was timed."""
        found = {}
        for scheme, losses in self.losses.items():
            for scene, row in losses.iterrows():
                found.setdefault(scene, (row.idxmin(), self.us[scheme].loc[scene, row.idxmin()]))
        return found


FEATURES = tuple(dict.fromkeys((*SPLITS, *SPARSE, *DENSE)))


def _times(rows, libraries):
    """µs a step by contender: measured in turns, or of the look, scaled by the fastest library's two times."""
    rows = rows[rows.verdict.isin(["agrees", ""])].set_index("implementation")
    timed = rows[(rows.status == "ok") & (rows.verdict == "agrees")]
    known = [name for name in timed.index if name in libraries]
    if not known:
        return pandas.Series(dtype=float)
    first = timed.loc[known, "to_rival"].astype(float).idxmin()
    looks = rows.look_us * (timed.step_us[first] / rows.look_us[first])
    found = looks.where(rows.status.isin(["ok", "slower"]))
    found.update(timed.step_us[first] * timed.to_rival.astype(float))
    return found.astype(float)


def _grow(costs, features, families, splits, most):
    """A tree of at most `most` leaves: the question that saves most is asked first. `costs`: scenes by libraries, a data frame."""
    names, costs = list(costs.columns), costs.to_numpy()
    root = _node(numpy.ones(len(costs), bool), names, costs)
    leaves = [root]
    while len(leaves) < most:
        options = [(saved, number, question) for number, one in enumerate(leaves)
                   for saved, question in _questions(one, costs, features, families, splits)]
        saved, number, (feature, below) = max(options, key=lambda one: one[0], default=(0.0, 0, ("", 0.0)))
        if saved < WORTH:
            break
        one = leaves.pop(number)
        yes = features[feature] < below
        one |= {"feature": feature, "below": below, "then": _node(one["rows"] & yes, names, costs),
                "else": _node(one["rows"] & ~yes, names, costs)}
        leaves += [one["then"], one["else"]]
    return _plain(root)


def _node(rows, names, costs):
    sums = costs[rows].sum(axis=0)
    return {"rows": rows, "take": names[sums.argmin()], "cost": sums.min()}


def _questions(node, costs, features, families, splits):
    for feature in splits:
        values = numpy.unique(features[feature][node["rows"]])
        for low, high in zip(values, values[1:]):
            below = _between(low, high)
            yes = node["rows"] & (features[feature] < below)
            no = node["rows"] & ~yes
            if min(len(set(families[side])) for side in (yes, no)) >= LEAST:
                yield node["cost"] - costs[yes].sum(axis=0).min() - costs[no].sum(axis=0).min(), (feature, below)


def _between(low, high):
    """A round number between two."""
    middle = (low * high) ** 0.5 if low > 0 else (low + high) / 2
    for digits in (1, 2, 3):
        rounded = float(f"{middle:.{digits}g}")
        if low < rounded <= high:
            return rounded
    return float(high)


def _plain(node):
    if "feature" not in node:
        return {"take": node["take"]}
    then, other = _plain(node["then"]), _plain(node["else"])
    return then if then == other else {"feature": node["feature"], "below": node["below"], "then": then, "else": other}
