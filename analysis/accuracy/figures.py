# The figures of accuracy: error against time of each subject, the regions of required errors, pairs of settings.
from analysis.accuracy import pairs, pairs_figure, regions_figure, work_figure
from analysis.core.style import Look


def draw(tables, view):
    look, found = Look(view.registry), {}
    won = tables["winners"][tables["winners"].fill_asked.isna()]
    about = tables["references"].drop_duplicates("subject").set_index("subject")
    for subject, rows in tables["points"].groupby("subject", sort=False):
        one = about.loc[subject]
        natural = rows[rows.fill_asked.isna()]
        found[work_figure.name(subject)] = work_figure.draw(
            natural, won[won.subject == subject], look, "largest of position, m" if one.unit == "m" else "root mean square, relative",
            f"{one.title}, n = {natural.variables.max():.0f}, {one.duration:g} s")
    chains = tables["winners"][tables["winners"].loops.notna()]
    if len(chains):
        found["regions"] = regions_figure.draw(chains, look)
    for kind, title, goal in (
            (pairs.FORMS, "The saddle-point form beside the penalty form", None),
            (pairs.PRECISION, "Lower precision beside double; hollow: another error class, or none", pairs.GAIN)):
        rows = tables["pairs"][(tables["pairs"].kind == kind) & tables["pairs"].ratio.notna()]
        if rows.variables.nunique() > 1:
            found[kind] = pairs_figure.draw(rows, look, title, goal)
    return found
