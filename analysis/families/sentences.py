# The answer to "Which implementation is fastest on real mechanisms, at their own fill?", from the tables.
from analysis.core.text import number


def answers(tables, view):
    winners, scenes = tables["winners"], tables["scenes"]
    mine = _libraries(winners)
    if mine.empty:
        return [{"text": "Not measured: no library was timed that the gate agrees with.", "anchor": ""}]
    found = [{"anchor": "map", "text": f"On {len(mine)} mechanisms of {mine.family.nunique()} families (n = {number(mine.variables.min(), 5)} to "
              f"{number(mine.variables.max(), 5)}), in front among libraries, or as fast to 5 %: {_shares(mine)}. Of {_said(mine)} of the "
              f"{len(mine)} this run says who is fastest."}]
    own = scenes[scenes.implementation.isin(view.registry.own) & (scenes.status == "ok") & scenes.to_rival.notna()]
    for name, rows in own.groupby("implementation", sort=False):
        ahead, behind = rows[rows.to_rival_high < 1], rows[rows.to_rival_low > 1]
        found.append({"anchor": "map", "text": f"{name}, which stands on no library, is shown to be faster than the fastest library on {len(ahead)} of "
                      f"{len(rows)} mechanisms that it serves, slower on {len(behind)} (time over the library's: {number(rows.to_rival.min())} to "
                      f"{number(rows.to_rival.max())})."})
    return found + _defaults(tables["defaults"])


def _defaults(rows):
    """What the defaults of other tools cost, the least and the largest mean."""
    rows = rows[rows["mean"].notna()].sort_values("mean")
    if rows.empty:
        return []
    told = lambda row: (f"that of {row['rule']} ({'about ' if row['rough'] else ''}{number(row['mean'])} times the fastest library's time on "
                        f"average, {number(row['worst'])} at worst)")
    return [{"anchor": "defaults", "text": f"Of the defaults of other tools, followed on {number(rows.scenes.max())} mechanisms, the least costly is "
             f"{told(rows.iloc[0])}, the most costly {told(rows.iloc[-1])}."}]


def cases(tables, view):
    """Row of the front page's table: who leads most mechanisms, and what that costs on the others."""
    mine, scenes = _libraries(tables["winners"]), tables["scenes"]
    if mine.empty:
        return []
    names = _led(mine)
    name = max(names, key=names.get)
    others = scenes[(scenes.implementation == name) & (scenes.status == "ok") & scenes.scene.isin(mine.scene)]
    return [{"case": f"Your mechanism is like one of {mine.family.nunique()} families, at its own fill", "link": "families.html#map",
             "take": f"{name}: in front among libraries, or as fast to 5 %, on {names[name]} of {len(mine)} mechanisms ({_said(mine)} decided); at "
                     f"most {number(others.to_rival.max())} times the fastest where it was timed ({len(others)})"}]


def _libraries(winners):
    return winners[(winners.layer == "libraries") & (winners.winner != "")]


def _said(rows):
    """Of how many the fastest, or all that are as fast, are known."""
    return int((rows.decided.astype(bool) | rows.settled.astype(bool)).sum())


def _led(rows):
    """{library: scenes on which it is the winner or in the equivalence set}, most first."""
    counts = {}
    for row in rows.itertuples():
        for name in row.equivalent.split():  # the winner among them
            counts[name] = counts.get(name, 0) + 1
    return dict(sorted(counts.items(), key=lambda one: (-one[1], one[0])))


def _shares(rows):
    return ", ".join(f"{name} on {count}" for name, count in _led(rows).items())
