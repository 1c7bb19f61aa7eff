# The figures of the part: trials and the battery.
from analysis.extremes import battery, battery_figure, trials_figure


def draw(tables, view):
    found, extreme = {}, battery.extreme(tables["battery"])
    if tables["battery"].near.notna().any():
        found["trials"] = trials_figure.draw(tables["battery"])
    if len(battery.ran(extreme)):
        found["battery"] = battery_figure.draw(extreme)
    return found
