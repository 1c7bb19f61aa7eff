# What page.html.j2 shows of settings that were tried, and what they gain or cost.
from analysis.core.text import number


def context(tables, view):
    rows = tables["alternatives"]
    groups, lost = {}, {}
    for row in rows.to_dict("records"):
        if row["status"] != "ok":
            lost.setdefault((row["status"], row["reason"]), {}).setdefault(row["alternative"], []).append(row["scene"])
        groups.setdefault(row["base"], {}).setdefault((row["alternative"], row["description"]), {})[row["scene"]] = row
    return {"settings": view.settings, "groups": groups, "scenes": {base: list(dict.fromkeys(mine.scene)) for base, mine in rows.groupby("base")},
            "lost": lost}


def answers(tables, view):
    rows = tables["alternatives"].loc[lambda rows: rows.status == "ok"]
    if rows.empty:
        return [{"text": "Not measured: nothing that was tried was timed.", "anchor": ""}]
    slower, faster = rows[rows.low > 1], rows[rows.high < 1]
    most = rows.loc[rows.ratio.idxmax()]
    text = (f"{rows.alternative.nunique()} other settings of {rows.base.nunique()} variants were timed on {rows.scene.nunique()} scenes. Of {len(rows)} times "
            f"{len(slower)} are shown to be longer than with the variant's own, {len(faster)} shorter; the longest is {most.alternative} on {most.scene}, "
            f"{number(most.ratio)} times the time")
    if len(faster):
        least = faster.loc[faster.ratio.idxmin()]
        text += f"; the shortest is {least.alternative} on {least.scene}, {number(least.ratio)} times"
    return [{"anchor": most.base.replace("/", "-"), "text": text + "."}]
