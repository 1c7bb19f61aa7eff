# What the part is held to, each with what was found in this set.
from analysis.core.text import percent
from analysis.families import by_hand
from analysis.families.rule import MUCH, WITHIN, summary

MEAN = 0.05     # loss of a rule, on families left out; at worst: MUCH
SHARE = 0.9     # of the step times within WITHIN, and of them inside their range
AHEAD = 1.5     # times faster than the fastest library: compiled code, up to ...
LARGE = 2000    # ... so many variables
BEHIND = 1.1    # times as slow at most: above
COMPILED = "compiled_"
HYBRID, DENSE, SUPERNODAL = "hybrid_dense", "eigen_dense/llt", "csc_cholmod/supernodal"
FILLED = "four-bar:49,fill=0.50"  # n = 100
FASTER = 1.9    # times, hybrid_dense there than ...
SMALL, SLOWER = 22, 1.1  # up to so many variables at most so many times as slow as eigen_dense


def bounds(tables):
    """[(what, asked, found, whether it holds; None: open)]"""
    scenes = tables["scenes"]
    return [*_rule(tables["held"]), *_by_hand(tables["by_hand"]), *_agreement(scenes, tables["mechanisms"]), *_hybrid(scenes), *_compiled(scenes)]


def _rule(held):
    if not len(held):
        return [("the rule, on families left out", "", "too few mechanisms", None)]
    found = summary(held)
    shares = ((f"its step times are within {WITHIN:g} times of the predicted", "within"), ("they are inside the range that is given", "inside"))
    return [*_losses("the rule of `mbs describe`", found, len(held)),
            *((what, f"at least {percent(SHARE)}", f"{percent(found[share])} of {found['timed']}", found[share] >= SHARE) for what, share in shares)]


def _by_hand(cases):
    return _losses("the rule by hand", by_hand.summary(cases), int(cases.scenes.sum())) if len(cases) else []


def _losses(rule, found, count):
    known = f", of {count - found['unknown']} of {count} choices: the others have no time" if found["unknown"] else ""
    return [(f"{what} loss of {rule}, on families left out", f"at most {percent(most)}", f"{percent(loss, 1)}{known}", False if loss > most else None if known else True)
            for what, most, loss in (("mean", MEAN, found["mean_loss"]), ("worst", MUCH, found["worst_loss"]))]


def _agreement(scenes, mechanisms):
    """Of who was not asked, as the budget was spent, nothing is known."""
    asked = ~scenes.verdict.isin(["", "dropped"])
    wrong = scenes[asked & (scenes.verdict != "agrees")]
    unasked = int((~asked & (scenes.step_us.notna() | scenes.look_us.notna())).sum())
    where = ", ".join(f"{row.implementation} on {row.scene} ({row.scheme})" for row in wrong.itertuples())
    warned = int(((wrong.scheme == "penalty") & wrong.scene.isin(mechanisms.scene[mechanisms.saddle == 1])).sum())
    found = (f"{asked.sum() - len(wrong)} of {asked.sum()} checks" + (f"; not: {where}" if where else "")
             + (f"; in {warned} of these `mbs describe` takes the other form" if warned else "")
             + (f"; {unasked} that have a time were not asked" if unasked else ""))
    return [("who has a time agrees with the reference, in both forms", "always", found,
             False if len(wrong) else None if unasked or not asked.any() else True)]


def _hybrid(scenes):
    """The fastest variant of hybrid_dense, in the paper's form; on FILLED also the fastest with a library's factorization."""
    found = {scene: rows.set_index("implementation") for scene, rows in scenes[scenes.scheme == "penalty"].groupby("scene", sort=False)}
    for other in (DENSE, SUPERNODAL):
        for without, what in (("", HYBRID), (f"{HYBRID}/panels", f"{HYBRID} with a library's factorization")):
            ratio, name = _over(found[FILLED], other, without) if FILLED in found else (None, "")
            yield (f"{what} on {FILLED}, beside {other}", f"at least {FASTER:g} times as fast",
                   *((f"{ratio:.2f} times ({name})", ratio >= FASTER) if ratio else ("not measured", None)))
    small = {scene: 1 / ratio for scene, rows in found.items() if rows.variables.iloc[0] <= SMALL and (ratio := _over(rows, DENSE)[0])}
    bad = ", ".join(f"{scene} {ratio:.2f}" for scene, ratio in small.items() if ratio > SLOWER)
    yield (f"hybrid_dense, up to n = {SMALL}, beside {DENSE}", f"at most {SLOWER:g} times as slow",
           *((f"at most {max(small.values()):.2f} times, on {len(small)} mechanisms" + (f"; not on: {bad}" if bad else ""), not bad)
             if small else ("not measured", None)))


def _over(rows, other, without=""):
    """Time of `other` over that of the fastest hybrid_dense, and which that is: timed in turns, where both were, else of the look."""
    for column in ("to_rival", "look_us"):
        mine = rows[rows.index.str.startswith(f"{HYBRID}/") & (rows.index != without)][column].dropna()
        if other in rows.index and len(mine) and rows[column][other] > 0:
            return rows[column][other] / mine.min(), mine.idxmin()
    return None, ""


def _compiled(scenes):
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
