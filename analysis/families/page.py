# What page.html.j2 shows of families of mechanisms.
def context(tables, view):
    winners, scenes = tables["winners"], tables["scenes"]
    ranked = [(name, rows.set_index("layer").to_dict("index")) for name, rows in winners.groupby("scene", sort=False)]
    times = scenes[scenes.status.isin(["ok", "slower"]) & scenes.step_us.notna()].sort_values("step_us")
    lost = {}
    for row in scenes[~scenes.status.isin(["ok", "slower"])].to_dict("records"):
        lost.setdefault((row["status"], row["reason"]), {}).setdefault(row["implementation"], []).append(row["scene"])
    return {"settings": view.settings, "ranked": ranked, "defaults": tables["defaults"].to_dict("records"), "order": list(dict.fromkeys(scenes.scene)),
            "times": {name: rows.to_dict("records") for name, rows in times.groupby("scene", sort=False)},
            "lost": [(*what, list(names.items())) for what, names in lost.items()]}
