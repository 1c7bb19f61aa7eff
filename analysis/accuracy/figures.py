# The figures of accuracy: error against time of each subject, the regions of required errors.
from analysis.accuracy import regions_figure, work_figure
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
    return found
