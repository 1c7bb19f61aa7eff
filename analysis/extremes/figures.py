# The figures of the part: trials, the battery, kept pivots.
from analysis.extremes import battery, battery_figure, pivots, pivots_figure, trials_figure


def draw(tables, view):
    found, extreme = {}, battery.extreme(tables["battery"])
    if tables["battery"].near.notna().any():
        found["trials"] = trials_figure.draw(tables["battery"])
    if len(battery.ran(extreme)):
        found["battery"] = battery_figure.draw(extreme)
    if len(pivots.timed(tables["pivots"])):
        found["pivots"] = pivots_figure.draw(pivots.timed(tables["pivots"]))
    return found
