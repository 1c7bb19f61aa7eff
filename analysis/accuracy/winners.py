# Who meets a required error in the least time: on a scene, of the libraries and of all.
import pandas

from analysis.accuracy.points import KEY, LOOK, ROUNDS, label, rounds
from analysis.core import timing
from analysis.core.outcomes import FINISHED

LAYERS = ("libraries", "all")
NOBODY = "nobody"        # meets the error
NOT_TIMED = "not timed"  # somebody meets it, at least at the mechanism's own fill, or would if the budget had lasted
NEAR = 1.25  # times the fastest in a look: who is slower has no rounds, and has lost
COLUMNS = ("error", "time", "time_low", "time_high", "processes", "record")


def of_layer(rows, layer, libraries):
    return rows[rows.implementation.isin(libraries)] if layer == "libraries" else rows


def meeting(table, required):
    """The points that meet an error in a run of their own and have a time by themselves, the fastest first."""
    found = table[table.status.isin(FINISHED) & (table.error <= required) & (table.error_of == table.implementation)
                  & table.time_from.isin((LOOK, ROUNDS)) & table.time.notna()]
    return found.sort_values("time", kind="stable")


def winners(table, measured, errors, libraries):
    """A row for each scene, layer and required error, also where nobody meets it."""
    rows = []
    for scene, points in table.groupby("scene", sort=False):
        samples = timing.Paired(rounds(points, measured))
        for layer in LAYERS:
            mine = of_layer(table, layer, libraries)
            reached, dropped = mine[mine.status.isin(FINISHED)].error.min(), (mine.status == "dropped").any()
            timed = meeting(mine[mine.scene == scene], float("inf")).to_dict("records")
            ends = cut(mine, scene)
            for required in errors:
                none = {"implementation": NOT_TIMED if dropped or reached <= required else NOBODY, "candidates": 0,
                        "decided": None, "settled": None, "equivalent": ""}
                found = [point for point in timed if point["error"] <= required]
                ended = dropped and not any(point["time_from"] == ROUNDS for point in found)  # the budget did not reach who may be faster
                row = none if ended else fastest(found, samples) or none
                if any(not error <= required and time < row.get("time", 0) for *_, error, time in ends):
                    row |= {"decided": False, "settled": False}
                rows.append({"scene": scene, "layer": layer, "required": required} | row)
    return pandas.DataFrame(rows)


def cut(table, scene):
    """[(implementation, setting, least error, time at its finest value)] of a scene's curves that the budget cut, and of those at the own fill, which
    say what is tried at others: with finer values they might meet smaller errors."""
    rows = table[(table.scene == scene) | ~table.scene.str.contains("fill=")].sort_values("step")
    return [(*whose, curve.error[curve.status.isin(FINISHED)].min(), next(iter(curve.time.dropna()), 0.0))
            for (_, *whose), curve in rows.groupby(KEY[:3]) if curve.status.iloc[0] == "dropped"]


def met(rows):
    """Those of `winners` that have a winner."""
    return rows[~rows.implementation.isin((NOBODY, NOT_TIMED))]


def fastest(found, samples):
    """Of points, the fastest first; None if nobody was timed. Each implementation counts with its fastest point: one of the rounds where it has one
    there. Ranked are those that have rounds; the others were slower in a look, or the budget did not reach them."""
    if not found:
        return None
    in_rounds = {point["implementation"]: label(point) for point in reversed(found) if point["time_from"] == ROUNDS}
    ranking = timing.rank(samples, in_rounds.values()) if in_rounds else None
    by_label = {label(point): point for point in found}
    first = by_label[ranking.winner] if ranking else found[0]
    row = {key: first[key] for key in (*KEY[1:], *COLUMNS)} | {
        "candidates": len(found), "timed": len(in_rounds), "decided": False, "settled": False, "equivalent": ""}
    if ranking:
        names = {one: by_label[one]["implementation"] for one in ranking.ratios}
        waiting = any(point["time"] <= NEAR * first["time"] and point["implementation"] not in in_rounds for point in found)
        row |= {"decided": ranking.decided and not waiting, "settled": ranking.settled and not waiting,
                "equivalent": "; ".join(names[one] for one in ranking.equivalent if one != ranking.winner),
                "inside": "; ".join(names[one] for one in ranking.inside if one != ranking.winner)}
        if ranking.second:
            row |= {"second": by_label[ranking.second]["implementation"], "margin": ranking.margin.value}
    return row
