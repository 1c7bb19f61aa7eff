# What the page shows: sentences and tables beside the figures.
from analysis.accuracy import figures, pairs, sentences
from analysis.accuracy.winners import met
from analysis.core.text import rows_of, step


def context(tables, view):
    points, winners, table = tables["points"], tables["winners"], tables["pairs"]
    by_subject = dict(list(points[points.fill_asked.isna()].groupby("subject", sort=False)))
    references = rows_of(tables["references"].drop_duplicates("subject"))
    subjects = [{"about": one, "figure": figures.name_of(one["subject"]), "statuses": by_subject[one["subject"]].status.value_counts().to_dict()}
                for one in references if one["subject"] in by_subject]
    problems = winners[winners.loops.isna()]
    kinds = {kind: rows_of(table[table.kind == kind]) for kind in pairs.PAIRS}
    return {
        "settings": view.settings, "step": step, "summary": [*sentences.summary(winners)], "pairs_step": pairs.STEP,
        "chains": [part for part in subjects if part["about"]["unit"] == "m"],
        "problems": [part for part in subjects if part["about"]["unit"] != "m"],
        "lost": [about for about in references if about["own_error"] is None],
        "problem_winners": rows_of(met(problems)), "problems_lost": problems.drop(met(problems).index).implementation.value_counts().to_dict(),
        "forms": kinds[pairs.FORMS], "forms_says": sentences.of_forms(table), "precision": kinds[pairs.PRECISION],
        "precision_says": sentences.of_precision(table), "reuse": sentences.reuse_rows(table), "reuse_says": sentences.of_reuse(table),
        "references": references, "left_out": tables["left_out"].reason.value_counts().to_dict()}
