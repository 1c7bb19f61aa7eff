# What the page and the front page say, computed from the tables.
import math

from analysis.accuracy import figures, pairs
from analysis.accuracy.winners import LAYERS, NOT_TIMED, met
from analysis.core.text import between, bounded, number, rows_of, step
from study.core.setting import read_settings

WORDS = {"libraries": "Of the libraries", "all": "Of all, code without a library included,"}


def context(tables, view):
    points, winners, table = tables["points"], tables["winners"], tables["pairs"]
    by_subject = dict(list(points[points.fill_asked.isna()].groupby("subject", sort=False)))
    references = rows_of(tables["references"].drop_duplicates("subject"))
    subjects = [{"about": one, "figure": figures.name_of(one["subject"]), "statuses": by_subject[one["subject"]].status.value_counts().to_dict()}
                for one in references if one["subject"] in by_subject]
    problems = winners[winners.loops.isna()]
    kinds = {kind: rows_of(table[table.kind == kind]) for kind in pairs.PAIRS}
    return {
        "settings": view.settings, "step": step, "summary": [*summary(winners)], "pairs_step": pairs.STEP,
        "chains": [part for part in subjects if part["about"]["unit"] == "m"],
        "problems": [part for part in subjects if part["about"]["unit"] != "m"],
        "lost": [about for about in references if about["own_error"] is None],
        "problem_winners": rows_of(met(problems)), "problems_lost": problems.drop(met(problems).index).implementation.value_counts().to_dict(),
        "forms": kinds[pairs.FORMS], "forms_says": of_forms(table), "precision": kinds[pairs.PRECISION],
        "precision_says": of_precision(table), "reuse": reuse_rows(table), "reuse_says": of_reuse(table),
        "references": references, "left_out": tables["left_out"].reason.value_counts().to_dict()}


def answers(tables, view):
    """One to four sentences that answer the part's question."""
    asked = own_fill(tables["winners"])
    won = met(asked)
    if won.empty:
        dropped = (asked.implementation == NOT_TIMED).any()
        return [{"text": "Not measured: " + ("the budget ended before those that may be the fastest were timed." if dropped else
                                             "nobody reached a required error with a time."), "anchor": ""}]
    found = [{"text": of_layer(won[won.layer == layer], layer), "anchor": "short"} for layer in LAYERS if (won.layer == layer).any()]
    return found + [{"text": text, "anchor": anchor} for anchor, of in (("precision", of_precision), ("reuse", of_reuse))
                    for text in of(tables["pairs"])[:1]]


def cases(tables, view):
    """Row of the front page's table: at the largest size what each error takes, those that take the same together."""
    won = met(own_fill(tables["winners"]))
    rows = won[(won.layer == "libraries") & (won.variables == won.variables.max())].sort_values("required", ascending=False)
    options = {one.name: one.typed for one in read_settings()}
    errors = {}
    for one in rows.itertuples():
        given = options.get(one.setting, f"setting {one.setting}")
        take = f"{one.implementation}, {f'`{given}`, ' if given else ''}step {number(1e3 * one.step, 2)} ms" + (
            "" if one.settled else " (undecided: others may be as fast)")
        errors.setdefault(take, []).append(number(one.required))
    said = "; ".join(f"{', '.join(mine)} m: {take}" for take, mine in errors.items())
    return [{"case": "You know the error that the motion may have", "link": "accuracy.html#short",
             "take": "what `study/advise` names for your scene" + (
                 f"; for the four-bar of {rows.variables.iloc[0]:.0f} variables and an error of {said}" if said else "")}]


def own_fill(winners):
    """Of the N-four-bar at its own fill."""
    return winners[winners.loops.notna() & winners.fill_asked.isna()]


def of_layer(rows, layer):
    """Who is fastest most often, with what, and what a smaller error costs at the largest size."""
    (who, often), (setting, with_it) = (next(iter(names.value_counts().items())) for names in (rows.implementation, rows.setting))
    text = (f"{WORDS[layer]} {who} is fastest for {often} of {len(rows)} required errors and sizes of the N-four-bar; "
            f"{int(rows.settled.sum())} of these are settled. The best setting is most often {named(setting)}, in {with_it}.")
    if len(largest := rows[rows.variables == rows.variables.max()].sort_values("required")) > 1:
        fine, coarse = largest.iloc[0], largest.iloc[-1]
        text += (f" With n = {fine.variables:.0f}, {number(fine.required)} m instead of {number(coarse.required)} m takes "
                 f"{number(fine.time / coarse.time, 2)} times as long.")
    return text


def named(setting):
    """A setting with what one types for it: “loose” (--tolerance 1e-6)."""
    given = {one.name: one.typed for one in read_settings()}.get(setting)
    return f"“{setting}”" + (f" ({given})" if given else "")


def summary(winners):
    """For each required error the fastest at own fill, by layer: {"who", "sizes"}."""
    for required, rows in sorted(own_fill(winners).groupby("required"), reverse=True):
        row = {"required": required}
        for layer in LAYERS:
            groups = {}
            for one in rows[rows.layer == layer].sort_values("variables").itertuples():
                words = f", {one.setting}{'' if one.settled else ' (open)'}" if one.setting else ""
                groups.setdefault(one.implementation + words, []).append(f"{one.variables:.0f}")
            row[layer] = [{"who": who, "sizes": ", ".join(sizes)} for who, sizes in groups.items()]
        yield row


def of_forms(table):
    rows = table[(table.kind == pairs.FORMS) & table.ratio.notna()]
    if rows.empty:
        return []
    least, largest = rows.loc[rows.ratio.idxmin()], rows.loc[rows.ratio.idxmax()]
    said = [f"A step of the saddle-point form takes {_cost(least)} to {_cost(largest)} times as long as one of the penalty form."]
    if len(per_pass := ((rows.second_us / rows.second_passes) / (rows.first_us / rows.first_passes)).dropna()):
        said.append(f"A pass takes {number(per_pass.min(), 2)} to {number(per_pass.max(), 2)} times as long; the rest is the number of passes.")
    return said


def _cost(row):
    return between(row.ratio, row.low, row.high, 2, f"; {row.implementation}, n = {row.variables:.0f}")


def of_precision(table):
    """What factors in single precision (mixed) gain over double, and what single gains."""
    rows = table[(table.kind == pairs.PRECISION) & table.ratio.notna()]
    mixed, said = rows.second.str.contains("mixed"), []
    for what, kind in [one for one in (("Mixed precision", rows[mixed]), ("Single precision", rows[~mixed])) if len(one[1])]:
        same, unknown = kind[pairs.same_class(kind)], kind[kind[["first_status", "second_status"]].isin(pairs.NO_CLASS).any(axis=1)]
        text = (f"{what}: of {len(kind)} pairs with double {len(same)} are in the same error class, "
                f"{len(kind) - len(same) - len(unknown)} in another; of {len(unknown)} it is not known. ")
        text += (f"At least {pairs.GAIN:g} times faster in {len(pairs.gains(kind))} of {len(pairs.shown(kind))} of the same class that have an interval"
                 if len(pairs.shown(kind)) else "None of the same class has an interval, so nothing is shown" if (kind.high < math.inf).any() else
                 "All were timed in one process only, so nothing is shown")
        if len(of := same if len(same) else unknown):
            best = of.loc[of.ratio.idxmin()]
            ends = (1 / best.high, 1 / best.low) if bounded(best.low, best.high) else (best.low, best.high)
            text += (f"; the best speed-up{'' if len(same) else ', at an unknown error class,'} is {between(1 / best.ratio, *ends)} of "
                     f"{best.implementation}, {best.second}, n = {best.variables:.0f}")
        said.append(text + ".")
    return said


def reuse_rows(table):
    """For each setting that reuses factors: medians over those that were timed, size by size; of `counted` factorizations are known."""
    rows = table[(table.kind == pairs.REUSE) & table.ratio.notna()]
    rows = rows.assign(saved=1 - rows.second_factorizations / rows.first_factorizations)
    found = rows.groupby(["variables", "first", "second"], sort=False).agg(
        implementations=("implementation", "nunique"), saved=("saved", "median"), counted=("saved", "count"), high=("high", "min"),
        factorizations=("second_factorizations", "median"), passes=("second_passes", "median"),
        usual_passes=("first_passes", "median"), ratio=("ratio", "median"), least=("ratio", "min"),
        error=("second_error", "median"), usual_error=("first_error", "median"))
    return rows_of(found.reset_index())


def of_reuse(table):
    if not (rows := reuse_rows(table)):
        return []
    quickest, said = min(rows, key=lambda row: row["ratio"]), f"Reuse of factors, in steps of {step(pairs.STEP)}: "
    if counted := [row for row in rows if row["counted"]]:
        most = max(counted, key=lambda row: row["saved"])
        said += (f"where factorizations are known, {named(most['second'])} saves the most of them, {number(100 * most['saved'])} % with n = "
                 f"{most['variables']:.0f} (median of {most['counted']} implementations), where a step takes {number(most['ratio'], 2)} times "
                 f"that of {most['first']}; ")
    said += (f"{named(quickest['second'])} with n = {quickest['variables']:.0f} is the quickest: in the median over {quickest['implementations']} "
             f"implementations its step takes {number(quickest['ratio'], 2)} times that of {quickest['first']}")
    return [said + ("" if bounded(0, quickest["high"]) else ", timed in one process")
            + (", at an error that is not known." if quickest["error"] is None else ".")]
