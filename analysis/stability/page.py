# What the page says besides its maps: outcomes counted, valleys, where the automatic factor misses one; which factor works at which step.
from analysis.core.text import number
from analysis.stability import tables as rules

ACCURATE = 1e-2  # m, the largest position error that "ok" allows


def context(tables, view):
    table = tables["maps"][tables["maps"].status != "dropped"]
    parts = [{"scheme": scheme, "precision": precision, "name": f"{scheme}-{precision}", "implementation": rows.implementation.iloc[0],
              "counts": rows.status.value_counts().to_dict(), "valleys": valleys(rows), "automatic": automatic(rows)}
             for (scheme, precision), rows in table.groupby(["scheme", "precision"], sort=False)]
    missed = {}  # {precision: cells of its maps whose automatic penalty factor misses a valley}
    for part in parts:
        missed[part["precision"]] = missed.get(part["precision"], 0) + len(part["automatic"][0])
    scaled = table[table.penalty_asked != "auto"].alpha_dt2_4
    whole = tables["whole"]
    return {"settings": view.settings, "maps": parts, "missed": missed, "limit": ACCURATE, "total": len(table),
            "least": scaled.min(), "most": scaled.max(), "dropped": len(tables["maps"]) - len(table),
            "statuses": list(dict.fromkeys(["ok", "degraded", *sorted(table.status.unique())])),
            "inaccurate": table[(table.status == "ok") & ~(table.position_error_max <= ACCURATE)].to_dict("records"),  # there must be none
            "whole": whole.to_dict("records"), "promised": sorted(rules.MUST_HOLD),
            "must": {"largest": rules.LARGEST, "error": rules.ERROR, "passes": rules.PASSES},
            "sizes": [(*key, [round(one) for one in rows.loops])
                      for key, rows in whole.groupby(["scheme", "implementation"], sort=False)]}


def automatic(rows):
    """(runs whose automatic penalty factor is not ok though another one at their step is; those where none is)"""
    known, lost = valleys(rows), rows[(rows.penalty_asked == "auto") & (rows.status != "ok")].to_dict("records")
    lost = [row | {"valley": known.get(row["loops"], {}).get(row["step"])} for row in lost]
    return [row for row in lost if row["valley"]], [row for row in lost if not row["valley"]]


def valleys(rows):
    """{loops: {step: (least, largest, ok, between)}} of alpha step^2 / 4: the ends of the "ok" cells,
    how many cells are ok and how many there are between the ends; None where none is ok."""
    found = {}
    for (loops, step), group in rows[rows.penalty_asked != "auto"].groupby(["loops", "step"]):
        good = group[group.status == "ok"].alpha_dt2_4
        ends = good.min(), good.max()
        found.setdefault(loops, {})[step] = None if good.empty else (*ends, len(good), int(group.alpha_dt2_4.between(*ends).sum()))
    return found


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
