# What page.html.j2 shows of settings that were tried.
def context(tables, view):
    rows = tables["alternatives"]
    groups, lost = {}, {}
    for row in rows.to_dict("records"):
        if row["status"] != "ok":
            lost.setdefault((row["status"], row["reason"]), {}).setdefault(row["alternative"], []).append(row["scene"])
        groups.setdefault(row["base"], {}).setdefault((row["alternative"], row["description"]), {})[row["scene"]] = row
    return {"settings": view.settings, "groups": groups, "scenes": {base: list(dict.fromkeys(mine.scene)) for base, mine in rows.groupby("base")},
            "lost": lost}
