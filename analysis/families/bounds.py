# What the part is held to, each with what was found in this set.
from analysis.families.rule import MISSED, WITHIN, summary

LOSS = {"mean_loss": 0.05, "worst_loss": 0.30}  # of the rule, on families left out
SHARE = 0.9     # of the step times within WITHIN
AHEAD = 1.5     # times faster than the fastest library: compiled code, up to ...
LARGE = 2000    # ... so many variables
BEHIND = 1.1    # times as slow at most: above
COMPILED = "compiled_"


def bounds(tables, registry):
    """[(what, asked, found, whether it holds; None: not measured)]"""
    return [*_rule(tables["held"]), *_agreement(tables["scenes"]), *_compiled(tables["scenes"], registry)]


def _rule(held):
    if not len(held):
        return [("the rule, on families left out", "", "too few mechanisms", None)]
    found = summary(held)
    return [("mean loss of the rule, on families left out", f"at most {LOSS['mean_loss']:.0%}", f"{found['mean_loss']:.1%}", found["mean_loss"] <= LOSS["mean_loss"]),
            ("its worst loss", f"at most {LOSS['worst_loss']:.0%}", "it chose one that has no time" if found["worst_loss"] >= MISSED else
             f"{found['worst_loss']:.0%}", found["worst_loss"] <= LOSS["worst_loss"]),
            (f"step times predicted within {WITHIN:g} times", f"at least {SHARE:.0%}", f"{found['within']:.0%}", found["within"] >= SHARE)]


def _agreement(scenes):
    asked = scenes[(scenes.verdict != "") & (scenes.verdict != "dropped")]
    wrong = asked[asked.verdict != "agrees"]
    where = ", ".join(f"{row.implementation} on {row.scene} ({row.scheme})" for row in wrong.itertuples())
    return [("who is timed agrees with the reference, in both forms", "always", f"{len(asked) - len(wrong)} of {len(asked)} checks"
             + (f"; not: {where}" if where else ""), None if asked.empty else wrong.empty)]


def _compiled(scenes, registry):
    """The fastest compiled code of each mechanism and form."""
    own = scenes[scenes.implementation.str.startswith(COMPILED) & (scenes.status == "ok") & scenes.to_rival.notna()]
    fastest = own.sort_values("to_rival").drop_duplicates(["scene", "scheme"])
    small, large = fastest[fastest.variables <= LARGE], fastest[fastest.variables > LARGE]
    for rows, what, asked, bad in ((small, f"compiled code, up to n = {LARGE}", f"at least {AHEAD:g} times as fast as the fastest library",
                                    small[1 / small.to_rival < AHEAD]),
                                   (large, f"compiled code, above n = {LARGE}", f"at most {BEHIND:g} times as slow", large[large.to_rival > BEHIND])):
        if rows.empty:
            yield what, asked, "none was timed", None
            continue
        least = f"{len(rows) - len(bad)} of {len(rows)} mechanisms and forms; {1 / rows.to_rival.max():.2f} to {1 / rows.to_rival.min():.2f} times as fast"
        where = ", ".join(f"{row.scene}{'' if row.scheme == 'penalty' else ' (' + row.scheme + ')'} {1 / row.to_rival:.2f}" for row in bad.itertuples())
        yield what, asked, least + (f"; not on: {where}" if where else ""), bad.empty
