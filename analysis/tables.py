# The report's tables, as rows of texts and numbers computed from the tidy tables.
import pandas

from analysis.loader import FAILURES, NULL, PHASES
from analysis.statistics import median, phase_shares, power_law_exponent, rank

LAST_CENTRED = 602  # variables; the harness centres stretches on the singular position up to here
BEFORE_SINGULAR = (f"sizes above {LAST_CENTRED} variables are timed before the singular position, "
                   "as crossing it multiplies rounding there")


def step_times(results):
    """Natural fill: per size the median, spread and set-up time of each implementation."""
    samples = results.samples(natural_only=True)
    rows = []
    for size, of_size in samples.groupby("variables"):
        ranking = rank(of_size, results.natural_failures(size))
        for name in results.implementations:
            mine = of_size[of_size.implementation == name]
            if len(mine):
                rows.append({
                    "variables": size, "implementation": name, "median": median(mine.step_us),
                    "low": mine.step_us.min(), "high": mine.step_us.max(), "samples": len(mine),
                    "rounds": mine["round"].nunique(), "steps": mine.stretch_steps.iloc[0],
                    "passes": mine.passes.iloc[0] / mine.stretch_steps.iloc[0],
                    "setup": median(mine.setup_us),
                    "winner": ranking.decided and ranking.winner == name})
    return rows


def winners(results):
    """Natural fill: the fastest of each size, its margin over the second and the interval."""
    samples = results.samples(natural_only=True)
    return [{"variables": size, "ranking": rank(of_size, results.natural_failures(size))}
            for size, of_size in samples.groupby("variables")]


def overhead(results):
    """Largest median of the null control, µs a step; NaN if it was not measured."""
    tidy = results.tidy
    null = tidy[(tidy.implementation == NULL) & (tidy.status == "ok")]
    return null.groupby("variables").step_us.median().max()


def verdicts(results):
    """Per implementation: how many scenes agree, and the scenes of every other verdict."""
    table = results.verification.drop_duplicates(["scene", "implementation"])
    scenes = list(dict.fromkeys(table.scene))
    found = {(row.scene, row.implementation): row for row in table.itertuples()}
    rows = []
    for name in results.implementations:
        others = {}
        cells = [(scene, found[scene, name].verdict) for scene in scenes if (scene, name) in found]
        for scene, verdict in cells:
            if verdict != "agrees":
                others.setdefault(verdict, []).append(scene)
        agreed = len(cells) - sum(map(len, others.values()))
        rows.append({"implementation": name, "agreed": agreed, "of": len(cells), "others": others})
    return rows


def checks(results):
    """Per implementation and check: how many ran, how many passed, and the worst value."""
    table = results.verification[results.verification.check != ""]
    rows = []
    for (name, check), group in table.groupby(["implementation", "check"], sort=False):
        ran = group[group.passed != ""]
        share = ran.value / ran.tolerance.where(ran.tolerance > 0, 1.0)
        worst = ran.loc[share.idxmax()] if share.notna().any() else None
        rows.append({"implementation": name, "check": check, "ran": len(ran),
                     "skipped": len(group) - len(ran),
                     "passed": int((ran.passed == "True").sum()), "worst": worst})
    order = {name: place for place, name in enumerate(results.implementations)}
    return sorted(rows, key=lambda row: order.get(row["implementation"], len(order)))


def accuracy(results):
    """Whole simulations, one row an implementation, grouped by scene and penalty."""
    groups = []
    for (scene, penalty), rows in results.accuracy.groupby(["scene", "penalty_asked"], sort=False):
        groups.append({"scene": scene, "asked": penalty, "rows": rows.to_dict("records"),
                       "failures": int((~rows.status.isin(["ok", "excluded"])).sum())})
    return groups


def losses(results):
    """Everything that was not timed or may not be ranked, one row a cell, with its reason."""
    tidy = results.tidy
    lost = tidy[tidy.status.isin([*FAILURES, "excluded", "unavailable"])]
    lost = lost.drop_duplicates(["scene", "implementation", "status", "reason"])
    return lost.to_dict("records")


def not_reached(results):
    """Scenes whose asked fill is below the mechanism's own."""
    tidy = results.tidy
    return tidy[tidy.status == "not-reached"].to_dict("records")


def must_hold(results):
    """The study's own bounds: [{"claim", "subject", "note", "bound", "value", "holds"}]; value None
    where this profile does not measure it."""
    phases = results.tidy[(results.tidy.kind == "phases") & (results.tidy.status == "ok")]
    rows = []
    for name in results.implementations:
        folder = name.split("/")[0]
        mine = phases[phases.implementation == name]
        if folder == "csc_klu":
            rows.append(_share("outside factorization and solves, N = 40", name, mine, 82, 0.40,
                               ("factorization", "solve")))
            rows.append(_exponent(results, name))
        elif folder.endswith("_dense"):
            rows.append(_share("outside factorization, solves and tangent products, n = 22", name,
                               mine, 22, 0.30, ("factorization", "solve", "assembly")))
    return rows


def _share(claim, name, phases, size, bound, inside):
    mine, value = phases[phases.variables == size], None
    if len(mine):
        shares = phase_shares(mine, PHASES)
        value = 1 - sum(shares[phase] for phase in inside)
    return {"claim": claim, "subject": name, "bound": f"{100 * bound:.0f} %",
            "note": "", "value": None if value is None else f"{100 * value:.1f} %",
            "holds": value is not None and value <= bound}


def _exponent(results, name):
    samples = results.samples(natural_only=True)
    mine = samples[(samples.implementation == name) & (samples.variables >= 100)]
    medians = mine.groupby("variables").step_us.median()
    value = power_law_exponent(medians.index, medians)
    passes = (mine.passes / mine.stretch_steps).groupby(mine.variables).median()
    note = "; ".join(f"n = {size:g}: {count:.2f}" for size, count in passes.items())
    return {"claim": "exponent of the step time over n, n ≥ 100", "subject": name, "bound": "1.1",
            "note": note and f"passes a step at {note}; {BEFORE_SINGULAR}",
            "value": None if pandas.isna(value) else f"{value:.2f}", "holds": value <= 1.1}
