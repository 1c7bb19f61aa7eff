# What the page says besides its maps: outcomes counted, valleys, where the automatic factor misses one; which factor works at which step.
from pathlib import Path

from analysis.core.text import answers as said
from analysis.stability import tables as rules

HERE = Path(__file__).parent
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
    maps, whole = tables["maps"], tables["whole"]
    automatic = maps[(maps.penalty_asked == "auto") & (maps.precision == "double") & (maps.status != "dropped")]
    return said(HERE / "answers.j2", "Not measured: no implementation that draws these maps took part.", automatic=automatic,
                asked=whole[whole.must_hold != ""], duration=view.settings["duration"])
