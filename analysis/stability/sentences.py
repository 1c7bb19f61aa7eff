# The answer to "Which penalty factor works at which step?", from the tables.
from analysis.core.text import number


def answers(tables, view):
    maps = tables["maps"]
    automatic = maps[(maps.penalty_asked == "auto") & (maps.precision == "double") & (maps.status != "dropped")]
    found = []
    for scheme, rows in automatic.groupby("scheme", sort=False):
        good = rows[rows.status == "ok"]
        found.append({"anchor": f"{scheme}-double", "text":
                      f"{scheme.capitalize()} form: the automatic factor is ok in {len(good)} of {len(rows)} cells of size and "
                      f"step" + (f", with steps up to {number(1e3 * good.step.max())} ms" if len(good) else "")
                      + f", over {number(view.settings['duration'])} s."})
    whole = tables["whole"]
    if len(asked := whole[whole.must_hold != ""]):
        kept = asked[asked.must_hold == "yes"]
        found.append({"anchor": "whole", "text": f"Whole runs with everything automatic: {len(kept)} of {len(asked)} keep what "
                                                 f"their form must hold, up to N = {number(kept.loops.max(), 4)}."})
    return found or [{"text": "Not measured: no implementation that draws these maps took part.", "anchor": ""}]
