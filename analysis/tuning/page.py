# What page.html.j2 shows of settings that were tried.
def context(tables, view):
    rows = tables["alternatives"]
    groups = {}
    for row in rows.to_dict("records"):
        groups.setdefault(row["base"], {}).setdefault((row["alternative"], row["description"]), {})[row["scene"]] = row
    return {"settings": view.settings, "groups": groups, "scenes": {base: list(dict.fromkeys(mine.scene)) for base, mine in rows.groupby("base")},
            "lost": rows[rows.status != "ok"].to_dict("records")}
