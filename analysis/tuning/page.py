# What page.html.j2 shows of settings that were tried, and what they gain or cost.
from pathlib import Path

from analysis.core.text import answers as said

HERE = Path(__file__).parent


def context(tables, view):
    rows = named(tables["alternatives"])
    groups, lost = {}, {}
    for row in rows.to_dict("records"):
        if row["status"] != "ok":
            lost.setdefault((row["status"], row["reason"]), {}).setdefault(row["alternative"], []).append(row["where"])
        groups.setdefault(row["base"], {}).setdefault((row["alternative"], row["description"]), {})[row["where"]] = row
    return {"settings": view.settings, "groups": groups, "scenes": {base: list(dict.fromkeys(mine["where"])) for base, mine in rows.groupby("base")},
            "lost": lost}


def named(rows):
    """With the scene and, where it is not the paper's, the form in one word."""
    return rows.assign(where=rows.scene + (rows.scheme != "penalty").map({True: ", saddle-point form", False: ""}))


def answers(tables, view):
    rows = named(tables["alternatives"]).loc[lambda rows: rows.status == "ok"]
    return said(HERE / "answers.j2", "Not measured: nothing that was tried was timed.", rows=rows)
