# The answer to "Which mechanism keeps its deadlines?", from the tables.
from analysis.core.text import number


def answers(tables, view):
    largest, own = tables["largest"], view.registry.own
    found = []
    for step, rows in largest[largest.scheme == "penalty"].groupby("step", sort=False):
        layers = {"libraries": rows[~rows.implementation.isin(own)], "own code": rows[rows.implementation.isin(own)]}
        said = [_best(name, one) for name, one in layers.items() if len(one)]
        found.append({"anchor": "largest", "text": f"Steps of {number(1e3 * step)} ms: {'; '.join(said)}."})
    observed = tables["steps"][tables["steps"].missed.notna()]
    if len(observed):
        clean = int((observed.missed == 0).sum())
        found.append({"anchor": "steps", "text": f"{clean} of {len(observed)} runs of {number(view.settings['duration'])} s "
                                                 "missed no deadline at all."})
    return found or [{"text": "Not measured: no implementation of this part took part.", "anchor": ""}]


def _best(layer, rows):
    row = rows.loc[rows.largest.idxmax()]
    if not row.largest:
        return f"none of the {layer} keeps up with any size"
    text = (f"of {layer} {row.implementation} keeps up with N = {number(row.largest, 4)} ({number(row.missed, 4)} of "
            f"{number(row.steps, 5)} steps missed, {number(row.null_missed, 4)} lost by the null process")
    if row.next == row.next:
        text += f"; N = {number(row.next, 4)} failed"
    return text + ")"
