# What page.html.j2 shows of families of mechanisms.
from analysis.core.text import number
from analysis.families.bounds import bounds
from analysis.families.rule import missed, summary
from analysis.families.sentences import meanings, where
from analysis.families.times import features_of


def context(tables, view):
    winners, scenes, mechanisms = tables["winners"], tables["scenes"], tables["mechanisms"]
    known = mechanisms.set_index("scene").to_dict("index")
    ranked = [(name, known.get(name, {}), {(row["scheme"], row["layer"]): row for row in rows.to_dict("records")})
              for name, rows in winners.groupby("scene", sort=False)]
    times = scenes[scenes.status.isin(["ok", "slower"]) & scenes.step_us.notna()]
    lost = scenes[~scenes.status.isin(["ok", "slower"])].assign(where=lambda rows: rows.scene + ", " + rows.scheme)
    held, decided = tables["held"], winners[(winners.layer == "libraries") & winners.decided.fillna(False).astype(bool)]
    return {"settings": view.settings, "ranked": ranked, "bounds": bounds(tables),
            "times": {name: rows.sort_values("step_us").to_dict("records") for name, rows in times.groupby(["scene", "scheme"], sort=False)},
            "lost": [(*what, [(name, list(mine["where"])) for name, mine in rows.groupby("implementation", sort=False)])
                     for what, rows in lost.groupby(["status", "reason"], sort=False)],
            "holm": [(scheme, int(rows.holm.astype(bool).sum()), len(rows)) for scheme, rows in decided.groupby("scheme", sort=False)],
            "formulas": _formulas(tables["steps"]), "judged": summary(held) if len(held) else None, "missed": missed(held).to_dict("records") if len(held) else [],
            "by_family": [(family, summary(rows)) for family, rows in held.groupby("family", sort=False)],
            **{name: tables[name].to_dict("records") for name in ("by_hand", "alone", "defaults", "growth")}, "where": where,
            "meanings": [(scheme, meanings(rows)) for scheme, rows in tables["by_hand"].groupby("scheme", sort=False)] if len(tables["by_hand"]) else [],
            "orderings": [(scene, rows.n.iloc[0], {row["ordering"]: row for row in rows.to_dict("records")})
                          for scene, rows in tables["orderings"].groupby("scene", sort=False)]}


def _formulas(steps):
    """(form, library, its step in µs as text) of those that the rule compares."""
    if steps.empty:
        return []
    compared = steps[steps.candidate.astype(bool)]
    products = lambda rows: (" ".join([number(us), *features_of(term)[1:]]) for us, term in zip(rows.us, rows.term))  # without passes
    return [(scheme, name, f"passes × ({' + '.join(products(rows))})")
            for (scheme, name), rows in compared.groupby(["scheme", "implementation"], sort=False)]
