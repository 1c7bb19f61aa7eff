# The tables of the part, a column's records each.
from analysis.extremes import battery, pivots


def build(records, view):
    of = {column: [record for record in records if record.column == column] for column in ("battery", "pivots")}
    return {"battery": battery.table(of["battery"], view.registry), **pivots.build(of["pivots"])}
