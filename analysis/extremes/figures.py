# The figures of the part: trials, the battery, ways out, kept pivots, roundoff.
from analysis.extremes import battery_figure, pivots, pivots_figure, roundoff_figure, told, trials_figure, ways_figure
from analysis.extremes.roundoff import FORMS


def draw(tables, view):
    found = battery_figure.figures(tables["battery"]) if len(tables["battery"]) else {}
    if len(told.judged(tables["trials"])):
        found["trials"] = trials_figure.draw(tables["trials"])
    if len(tables["ways"]):
        found["ways"] = ways_figure.draw(tables["ways"], tables["ways_cost"])
    if len(pivots.timed(tables["pivots"])):
        found["pivots"] = pivots_figure.draw(pivots.timed(tables["pivots"]))
    return found | {f"roundoff-{form}": roundoff_figure.draw(tables["growth"], view.registry, form)
                    for form in FORMS if (tables["growth"].scheme == form).any()}
