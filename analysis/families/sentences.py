# The answer to "Which implementation is fastest on real mechanisms, at their own fill?", from the tables.
from analysis.core.text import number
from analysis.families.figures import DECIDES, best_form, fastest_own
from analysis.families.rule import document, summary


def answers(tables, view):
    scenes, mine = tables["scenes"], best_form(tables["winners"], "libraries")
    if mine.empty:
        return [{"text": "Not measured: no library was timed that the gate agrees with.", "anchor": ""}]
    real = _real(mine)
    found = [{"anchor": "map", "text": f"On {len(real)} mechanisms of {real.family.nunique()} families (n = {number(real.variables.min(), 5)} to "
              f"{number(real.variables.max(), 5)}), in front among libraries, or as fast to 5 %: {_shares(real)}. Of {_said(real)} of the "
              f"{len(real)} this run says who is fastest."}]
    if len(tables["held"]):
        held = summary(tables["held"])
        found.append({"anchor": "rule", "text": f"A rule that compares the predicted times of at most three libraries in a form of the step, five in all, chooses one that takes {100 * held['mean_loss']:.1f} % longer "
                      f"than the fastest on average, {100 * held['worst_loss']:.0f} % at worst, on families that it was not fitted on"
                      f"{_unknown(held['unknown'], ' ({})')}; {100 * held['within']:.0f} % of "
                      "the step times are within 1.5 times of the predicted."})
    own = scenes[scenes.implementation.isin(view.registry.own) & (scenes.status == "ok") & scenes.to_rival.notna() & (scenes.scheme == "penalty")]
    for name, rows in own.groupby("implementation", sort=False):
        ahead, behind = rows[rows.to_rival_high < 1], rows[rows.to_rival_low > 1]
        found.append({"anchor": "map", "text": f"{name}, which stands on no library, is shown to be faster than the fastest library on {len(ahead)} of "
                      f"{len(rows)} mechanisms that it serves, slower on {len(behind)} (time over the library's: {number(rows.to_rival.min())} to "
                      f"{number(rows.to_rival.max())})."})
    return found + _defaults(tables["defaults"])


def _unknown(count, form):
    return form.format(f"{count} choices that have no time there are left out") if count else ""


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
    """Rows of the front page's table: whom the rule takes, and what its choices there cost on families left out."""
    found, held = [], tables["held"]
    if len(held):
        held = held.merge(tables["mechanisms"][["scene", DECIDES]], on="scene")
        for (scheme, name), rows in held.sort_values("scheme", kind="stable").groupby(["scheme", "taken"], sort=False):
            low, high = (number(value) for value in (rows[DECIDES].min(), rows[DECIDES].max()))
            found.append({"case": f"{scheme.capitalize()} form, and `mbs describe` expects {name} to be the fastest (here with {low} to {high} non-zeros a "
                                  "column of the factor)", "link": "families.html#rule",
                          "take": f"{name}; on families left out the rule's choice takes {100 * rows.loss.mean():.1f} % longer than the fastest library "
                                  f"on average, {100 * rows.loss.max():.0f} % at worst ({len(rows)} cases{_unknown(rows.loss.isna().sum(), '; {}')})"})
    ahead = fastest_own(tables["scenes"], view.registry)
    if len(ahead):
        names = ", ".join(f"{name} on {count}" for name, count in ahead.implementation.value_counts().items())
        found.append({"case": "You may take code that is no library", "link": "families.html#map",
                      "take": f"fastest: {names}; {number(1 / ahead.to_rival.max())} to {number(1 / ahead.to_rival.min())} times as fast as the fastest "
                              f"library, {number(1 / ahead.to_rival.median())} in the middle"})
    return found


def files(tables, view):
    """rule.json, which `mbs describe` applies: harness/src/describe/README.md."""
    found = document(tables)
    return {"rule.json": {key: view.context[name] for key, name in (("machine", "cpu_model"), ("commit", "commit"))} | found} if found else {}


def _real(rows):
    """Without the four-bar with artificial fill."""
    return rows[~rows.family.str.contains("filled")]


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
