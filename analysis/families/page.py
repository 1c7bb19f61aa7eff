# What page.html.j2 shows of families of mechanisms; the answer to "Which implementation is fastest on real mechanisms, at their own fill?".
from pathlib import Path

import pandas

from analysis.core.text import answers as said, number
from analysis.families import by_hand
from analysis.families.bounds import KNOWN, PANELS, bounds, compiled, decides
from analysis.families.figures import best_form, fastest_own
from analysis.families.rule import document, missed, summary
from analysis.families.times import features_of

# Of compiled code: who else there is, and the column of `compiled` that says where it is behind.
RIVALS = (("the fastest library", "behind"), (f"the fastest library or {PANELS}", "behind_all"))
# Numbers of the rule by hand: letter, meaning.
SIGNS = {"dense": ("p", "operations to factorize the tangent, in % of those of a full one"), "per_column": ("c", "non-zeros of L per column"),
         "saddle_dense": ("p", "operations to factorize the saddle-point matrix, in % of those of a dense solver"),
         "saddle_per_column": ("c", "non-zeros of its L per column")}


def context(tables, view):
    winners, scenes, mechanisms = tables["winners"], tables["scenes"], tables["mechanisms"]
    known = mechanisms.set_index("scene").to_dict("index")
    ranked = [(name, known.get(name, {}), {(row["scheme"], row["layer"]): row for row in rows.to_dict("records")})
              for name, rows in winners.groupby("scene", sort=False)]
    times = scenes[scenes.status.isin(["ok", "slower"]) & scenes.step_us.notna()]
    lost = scenes[~scenes.status.isin(["ok", "slower"])].assign(where=lambda rows: rows.scene + ", " + rows.scheme)
    own = compiled(tables)
    held, decided = tables["held"], winners[(winners.layer == "libraries") & winners.decided.fillna(False).astype(bool)]
    return {"settings": view.settings, "ranked": ranked, "bounds": bounds(tables), "known": KNOWN,
            "behind": own[own.behind_all].sort_values("over_all").to_dict("records"),
            "decides": [(rival, found) for rival, which in RIVALS if (found := decides(own, which))],
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


def answers(tables, view):
    scenes, held, defaults, mine = tables["scenes"], tables["held"], tables["defaults"], best_form(tables["winners"])
    real = mine[~mine.family.str.contains("filled")]  # without the four-bar with artificial fill
    first = real.equivalent.str.split().explode().value_counts()  # of each library, the scenes on which it is first or as fast
    own = scenes[scenes.implementation.isin(view.registry.own) & (scenes.status == "ok") & scenes.to_rival.notna() & (scenes.scheme == "penalty")]
    known = {"real": real, "first": sorted(first.items(), key=lambda one: (-one[1], one[0])), "held": summary(held) if len(held) else None, "own": own,
             "defaults": defaults[defaults["mean"].notna()].sort_values("mean")}
    return said(Path(__file__).with_name("answers.j2"), "Not measured: no library was timed that the gate agrees with.", **known if len(mine) else {})


def cases(tables, view):
    """Rows of the front page's table: the rule of `mbs describe`, that by hand, and what code without a library gains."""
    found, held = [], tables["held"]
    if len(held):
        found.append({"case": "You have a scene file", "link": "families.html#rule",
                      "take": f"what `build/mbs describe` names, by predicted times{_lost(summary(held), len(held))}"})
    for scheme, rows in tables["by_hand"].groupby("scheme", sort=False) if len(tables["by_hand"]) else ():
        found.append({"case": f"By hand, {scheme} form", "link": "families.html#by-hand",
                      "take": _taken(rows) + _lost(by_hand.summary(rows), int(rows.scenes.sum()))})
    if len(ahead := fastest_own(tables["scenes"], view.registry)):
        names = ", ".join(f"{name} on {count}" for name, count in ahead.implementation.value_counts().items()) + f" of {len(ahead)} scenes"
        found.append({"case": "You may take code that is no library", "link": "families.html#map",
                      "take": f"fastest: {names}; {number(1 / ahead.to_rival.max())} to {number(1 / ahead.to_rival.min())} times as fast as the fastest "
                              f"library, median {number(1 / ahead.to_rival.median())}"})
    return found


def where(row):
    """The limits of a case of the rule by hand: "p < 26, c ≥ 8"."""
    return ", ".join(f"{sign} {relation} {number(row[column])}" for name, (sign, _) in SIGNS.items()
                     for end, relation in (("least", "≥"), ("below", "<")) if not pandas.isna(row[column := f"{end}_{name}"]))


def meanings(rows):
    """Of the letters in these cases: "p: ...; c: ..."."""
    return "; ".join(f"{sign}: {meaning}" for name, (sign, meaning) in SIGNS.items() if rows[[f"least_{name}", f"below_{name}"]].notna().any(axis=None))


def _taken(rows):
    """The cases of a form in words: first those that differ from most."""
    usual = rows.groupby("library").scenes.sum().idxmax()
    others = rows[rows.library != usual]
    if others.empty:
        return usual
    return "; ".join(f"{row['library']} if {where(row).replace(', ', ' and ')}" for row in others.to_dict("records")) + f"; else {usual} ({meanings(others)})"


def _lost(found, count):
    if pandas.isna(found["mean_loss"]):
        return ""
    unknown = f"; {found['unknown']} choices that have no time there are left out" if found["unknown"] else ""
    return (f"; on families left out {100 * found['mean_loss']:.1f} % slower than the fastest library on average, {100 * found['worst_loss']:.0f} % "
            f"at worst ({count} cases{unknown})")


def files(tables, view):
    """rule.json, which `mbs describe` applies: harness/src/describe/README.md."""
    found = document(tables)
    return {"rule.json": {key: view.context[name] for key, name in (("machine", "cpu_model"), ("commit", "commit"))} | found} if found else {}
