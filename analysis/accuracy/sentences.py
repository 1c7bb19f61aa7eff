# What the page says of each figure and table, computed from its rows.
from analysis.accuracy import names
from analysis.accuracy.front import fastest, finished, pareto
from analysis.accuracy.pairs_figure import GAIN, gains, same_class
from analysis.text import number


def _list(words):
    words = list(dict.fromkeys(words))
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def of_subject(rows):
    """Two sentences: who is on the front, and what a tenth of the error costs there."""
    front = rows.loc[pareto(rows)]
    if front.empty:
        return ["No run finished."]
    counts = front.implementation.value_counts()
    settings = front.setting.value_counts()
    first = (f"The front has {len(front)} runs: {counts.index[0]} makes {counts.iloc[0]} of them, and the "
             f"settings on it are {_list(settings.index)}.")
    best = front.loc[front.error.idxmin()]
    default = finished(rows[rows.setting == "default"])
    second = (f"The smallest error, {number(best.error, 2)}, is that of {best.implementation}, "
              f"{best.setting}, at a step of {names.step(best.step)}")
    rival = default.loc[default.error.idxmin()] if len(default) else None
    if rival is not None and rival.error > best.error:
        same = fastest(rows, rival.error)
        second += (f"; the default setting gets to {number(rival.error, 2)}, for which it takes "
                   f"{number(rival.time / same.time, 2)} times as long as {same.implementation}, "
                   f"{same.setting}")
    return [first, second + "."]


def summary(winners, work, without_library):
    """Who wins at the mechanism's own fill for each required error, and who of those with a library is fastest on
    the curves there."""
    found = []
    if winners.empty:
        return found
    own = winners[winners.fill_asked.isna()]
    curves = dict(list(work[~work.implementation.isin(without_library)].groupby("loops")))
    for required, rows in sorted(own.groupby("required"), reverse=True):
        first, second = {}, {}
        for row in rows.itertuples():
            words = ("nobody" if row.implementation == "nobody" else
                     f"{row.implementation}, {row.setting}" + ("" if row.decided is True else " (undecided)"))
            first.setdefault(words, []).append(f"{row.variables:.0f}")
            best = fastest(curves[row.loops], required) if row.loops in curves else None
            words = "nobody" if best is None else f"{best.implementation}, {best.setting}"
            second.setdefault(words, []).append(f"{row.variables:.0f}")
        found.append({"required": required, "winners": _sizes(first), "with_library": _sizes(second)})
    return found


def _sizes(groups):
    return [{"who": who, "sizes": ", ".join(sizes)} for who, sizes in groups.items()]


def of_regions(tables):
    """Two sentences on the regions, and one on the premise."""
    winners, regions, fills = (tables[name] for name in ("winners", "regions", "fills"))
    if winners.empty:
        return []
    met = winners[winners.implementation != "nobody"]
    said = [f"Somebody meets the required error in {len(met)} of {len(winners)} cells."]
    if len(met):
        counts, settings = met.implementation.value_counts(), met.setting.value_counts()
        decided = int((met.decided.astype(str) == "True").sum())
        said[0] += (f" {counts.index[0]} is fastest in {counts.iloc[0]} of them, most often with the setting "
                    f"{settings.index[0]} ({settings.iloc[0]}); {decided} are decided.")
    reasons = regions.reason.dropna()
    pruned = int(reasons.str.startswith("pruned").sum())
    unknown = int(reasons.str.startswith("error class not known").sum())
    said.append(f"Of {len(regions)} candidates {pruned} were pruned by their pilots, {len(reasons) - pruned - unknown} by "
                f"a run of their own that does not have the error class, and {unknown} because a run that tells it would "
                "take too long; each has its reason in regions.csv.")
    if len(fills):
        same = fills.same.astype(bool)
        worst = fills.difference.max()
        said.append(f"Artificial fill left the error as it was in {same.sum()} of {len(fills)} runs that check "
                    f"it (largest difference: {number(100 * worst, 2)} % of the error).")
    return said


def of_forms(forms):
    if forms.empty or "ratio" not in forms or forms.ratio.notna().sum() == 0:
        return []
    rows = forms[forms.ratio.notna()]
    cost = 1 / rows.ratio
    least, most = rows.loc[cost.idxmin()], rows.loc[cost.idxmax()]
    per_pass = (rows.second_step_us / rows.second_passes_per_step) / (
        rows.first_step_us / rows.first_passes_per_step)
    return [f"A step of the saddle-point form takes {_cost(least)} to {_cost(most)} times as long as one of the "
            "penalty form.",
            f"A pass takes {number(per_pass.min(), 2)} to {number(per_pass.max(), 2)} times as long; the "
            "rest is the number of passes."]


def _cost(row):
    return (f"{number(1 / row.ratio, 2)} ({number(1 / row.high, 2)} to {number(1 / row.low, 2)}; "
            f"{row.implementation}, n = {row.variables:.0f})")


def of_precision(precision):
    """What factors in single precision with refined projections (mixed) gain over double, and what single gains."""
    if precision.empty or "ratio" not in precision or precision.ratio.notna().sum() == 0:
        return []
    rows = precision[precision.ratio.notna()]
    mixed = rows.second.str.split().map(lambda words: "mixed" in words)
    return [sentence for what, kind in (("Mixed precision", rows[mixed]), ("Single precision", rows[~mixed]))
            if len(kind) for sentence in _gain(what, kind)]


def _gain(what, rows):
    won, same = gains(rows), rows[same_class(rows)]
    if same.empty:
        return [f"{what}: none of {len(rows)} pairs with double is in the same error class."]
    if won.empty:
        best = same.loc[same.low.idxmax()]
        return [f"{what} is nowhere at least {GAIN:g} times faster than double at the same error class: the best there "
                f"is {number(best.ratio)} ({number(best.low)} to {number(best.high)}; "
                f"{best.implementation}, {best.second}, n = {best.variables:.0f}), error "
                f"{number(best.second_error, 2)} m against {number(best.first_error, 2)} m in double.",
                f"{len(same)} of {len(rows)} pairs are in the same error class; the passes a step go "
                f"from {number(same.first_passes_per_step.median(), 2)} to "
                f"{number(same.second_passes_per_step.median(), 2)} (medians)."]
    best = won.loc[won.low.idxmax()]
    return [f"{what} is at least {GAIN:g} times faster than double at the same error class in {len(won)} of {len(rows)} "
            f"pairs: {_list(f'{r.implementation}, {r.second}, n = {r.variables:.0f}' for r in won.itertuples())}.",
            f"The best is {number(best.ratio)} ({number(best.low)} to {number(best.high)}) of "
            f"{best.implementation}, {best.second}, n = {best.variables:.0f}."]


def tangent_rows(tangents):
    """For each setting that reuses factors: medians over implementations, subject by subject."""
    if tangents.empty:
        return []
    chosen = tangents[tangents.subject.str.startswith("four-bar")]
    table = chosen.groupby(["subject", "setting"], sort=False).agg(
        implementations=("implementation", "nunique"), saved=("saved", "median"),
        factorizations=("factorizations_per_step", "median"), passes=("passes_per_step", "median"),
        usual_passes=("usual_passes", "median"), time_ratio=("time_ratio", "median"),
        error=("error", "median"), usual_error=("usual_error", "median"))
    return table.reset_index().to_dict("records")


def of_tangents(tangents):
    rows = tangent_rows(tangents)
    if not rows:
        return []
    most, quickest = max(rows, key=lambda r: r["saved"]), min(rows, key=lambda r: r["time_ratio"])
    said = [f"{most['setting']} saves the most factorizations, {number(100 * most['saved'], 3)} % of them on "
            f"{most['subject']}; its error there is {number(most['error'], 2)} m against "
            f"{number(most['usual_error'], 2)} m."]
    faster = quickest["time_ratio"]
    said.append(f"The best time is {number(faster, 2)} of that without reuse ({quickest['setting']}, "
                f"{quickest['subject']})." if faster < 1 else "Nowhere does reuse make a step faster.")
    return said
