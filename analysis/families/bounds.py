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
KNOWN = {"n": "variables", "per_column": "non-zeros of L per column", "widest": "non-zeros of its fullest column", "block": "columns per supernode",
         "dense": "operations, in % of those of a full L", "height": "columns that wait for each other"}  # that might decide where it is behind
HYBRID, PANELS, DENSE, SUPERNODAL = "hybrid_dense", "hybrid_dense/panels", "eigen_dense/llt", "csc_cholmod/supernodal"
FILLED = "four-bar:49,fill=0.50"  # n = 100
FASTER = 1.9    # times, hybrid_dense there than ...
SMALL, SLOWER = 22, 1.1  # up to so many variables at most so many times as slow as eigen_dense


def bounds(tables):
    """[(what, asked, found, whether it holds; None: open)]"""
    scenes = tables["scenes"]
    return [*_rule(tables["held"]), *_by_hand(tables["by_hand"]), *_agreement(scenes, tables["mechanisms"]), *_hybrid(scenes), *_compiled(tables)]


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
    """Who was not asked, as the budget was spent, has no time."""
    asked = ~scenes.verdict.isin(["", "dropped"])
    wrong = scenes[asked & (scenes.verdict != "agrees")]
    where = ", ".join(f"{row.implementation} on {row.scene} ({row.scheme})" for row in wrong.itertuples())
    warned = int(((wrong.scheme == "penalty") & wrong.scene.isin(mechanisms.scene[mechanisms.saddle == 1])).sum())
    found = (f"{asked.sum() - len(wrong)} of {asked.sum()} checks" + (f"; not: {where}" if where else "")
             + (f"; in {warned} of these `mbs describe` takes the other form" if warned else ""))
    return [("who has a time agrees with the reference, in both forms", "always", found,
             False if len(wrong) else bool(asked.any()) or None)]


def _hybrid(scenes):
    """The fastest variant of hybrid_dense, in the paper's form; on FILLED also the fastest with a library's factorization."""
    found = {scene: rows.set_index("implementation") for scene, rows in scenes[scenes.scheme == "penalty"].groupby("scene", sort=False)}
    for other in (DENSE, SUPERNODAL):
        for without, what in (("", HYBRID), (PANELS, f"{HYBRID} with a library's factorization")):
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


def compiled(tables):
    """The fastest compiled code of each mechanism and form. gain: over the fastest library; over_all: over own code on a dense matrix too, where that is
    faster (rival: who it is then); behind, behind_all: of what is asked; KNOWN numbers of the mechanism."""
    scenes, winners, keys = tables["scenes"], tables["winners"], ["scene", "scheme"]
    timed = scenes[(scenes.status == "ok") & scenes.to_rival.notna()].sort_values("to_rival")
    rows = timed[timed.implementation.str.startswith(COMPILED)].drop_duplicates(keys).set_index(keys)
    panels = timed[timed.implementation == PANELS].set_index(keys).to_rival.reindex(rows.index).fillna(1.0).clip(upper=1.0)
    rival = winners[winners.layer == "libraries"].set_index(keys).winner.reindex(rows.index).where(panels == 1.0, PANELS)
    rows = rows.assign(gain=1 / rows.to_rival, over_all=panels / rows.to_rival, rival=rival)
    asked = (rows.variables <= LARGE).map({True: AHEAD, False: 1 / BEHIND})
    return rows.assign(behind=rows.gain < asked, behind_all=rows.over_all < asked).reset_index().join(
        tables["mechanisms"].set_index("scene")[list(KNOWN)], on="scene")


def decides(rows, behind):
    """Of KNOWN numbers, the one of which a limit tells best where compiled code is behind, as the column `behind` has it: (its meaning, relation, limit,
    behind on this side, all on this side, behind, all); None where it is behind everywhere or nowhere."""
    rows, found = rows.dropna(subset=list(KNOWN)), []
    bad = rows[behind].to_numpy(bool)
    if bad.all() or not bad.any():
        return None
    for name, meaning in KNOWN.items():
        for limit in rows[name].unique():
            for relation, there in (("at least", rows[name] >= limit), ("at most", rows[name] <= limit)):
                there = there.to_numpy()
                found.append((there[bad].mean() - there[~bad].mean(), meaning, relation, float(limit), int(bad[there].sum()), int(there.sum())))
    return (*max(found)[1:], int(bad.sum()), len(rows))


def _compiled(tables):
    rows = compiled(tables)
    for where, what, asked in ((rows.variables <= LARGE, f"up to n = {LARGE}", f"at least {AHEAD:g} times as fast as"),
                               (rows.variables > LARGE, f"above n = {LARGE}", f"at most {BEHIND:g} times as slow as")):
        for rival, gain, behind in (("the fastest library", "gain", "behind"), (f"that and {PANELS}", "over_all", "behind_all")):
            here, bad = rows[where], rows[where & rows[behind]].sort_values(gain)
            found = f"{len(here) - len(bad)} of {len(here)} mechanisms and forms; {here[gain].min():.2f} to {here[gain].max():.2f} times as fast"
            if len(bad):
                named = (f"{one.scene}{'' if one.scheme == 'penalty' else ' (' + one.scheme + ')'} {one.gain:.2f}" for one in bad.itertuples())
                found += f"; not on: {', '.join(named)}" if behind == "behind" else f"; not on {len(bad)}"
            yield f"compiled code, {what}", f"{asked} {rival}", *((found, bad.empty) if len(here) else ("none was timed", None))
