# Claims about the tangent's fill and the maps: F5, F6, F7.
from analysis.core.gather import gather
from analysis.map import paper
from analysis.map.cells import map_cells
from analysis.map.ledger import CONFIRMED, INCOMPARABLE, REFUTED, UNDECIDED, UNMEASURED, Rule, by_place, judged, row, summed, unmeasured

F5_SIZE = 100        # variables; the nearest size counts that has enough filled scenes
FILLS_NEEDED = 3     # filled scenes that a size needs for Figure 5
LOW_FILL = 30        # %, "low fill" ends; a mechanism's own fill, the lowest that its size has, is low at every size
HIGH_FILL = 50       # %, "high fill" begins
FULL_FILL = 90       # %, LAPACK's region of Figure 7
FIGURE6 = 10, 100    # variables
LARGE = 160          # variables; Figure 7's own range begins behind Figure 4's
CELLS_NEEDED = {"F6": 4, "F7": 2}  # timed cells that a region needs


def standing(results):
    """All who stand for one of the paper's systems, the dense ones on every pair."""
    return list(dict.fromkeys([*(name for system in paper.SYSTEMS for name in paper.members(results, system)), *paper.dense(results)]))


def over_fill(results):
    """F5. Rule: best dense, on any pair that was timed there, ÷ system above 1 at every fill."""
    samples, dense = results.samples(), paper.dense(results)
    samples = samples[samples.implementation.isin(standing(results))]
    filled = samples[samples.fill_asked.notna()].groupby("variables").scene.nunique()
    size = min(filled.index[filled >= FILLS_NEEDED], key=lambda size: abs(size - F5_SIZE), default=None)
    scenes = samples[samples.variables == size].groupby("scene").fill_percent.first().sort_values()
    for system in ("CHOLMOD", "WSMP"):
        names = paper.members(results, system)
        head = "F5", f"at 100 variables {system} is faster than the best dense version at every fill", "> 1×"
        found = [results.best(scene, dense, names) for scene in scenes.index]
        lost = [f"{fill:.0f}" for one, (scene, fill) in zip(found, scenes.items()) if not one and results.fastest(scene, dense)]
        cases = [(f"{one.fill:.0f} %", one[:3], one.record) for one in found if one]
        if size is None:
            yield unmeasured(head, f"No size has {FILLS_NEEDED} filled scenes.", Rule(low=1))
        elif lost or not cases:
            text = f"at fills of {', '.join(lost)} %" if lost else "anywhere"
            yield unmeasured(head, f"At n = {size:g} {system}'s stand-ins were not timed against a dense version {text}.", Rule(low=1))
        else:
            yield judged(head, cases, Rule(low=1), f"n = {size:g}, {', '.join(dict.fromkeys(one.slow for one in found if one))} ÷ {', '.join(names)}")


def regions(results):
    """F6, F7. Rules: the system wins every cell of its region, ranked among the stand-ins of the paper's systems; a cell that one of several may win
    is undecided, one whose winner stands for two systems tells nothing of either. Where some refute it and none confirms it is refuted.
    F6 also: no cell at all is won by a dense version, on any pair that was timed there."""
    asked = {(one["variables"], fill) for one in results.view.settings["columns"] for fill in one["fills"]}
    cells = [cell for cell in map_cells(results, standing(results))  # others crowd where winners change
             if cell.ranking and (cell.variables, cell.fill_asked or "natural") in asked]
    small, large, beyond = ([cell for cell in cells if low <= cell.variables <= high] for low, high in
                            (FIGURE6, (LARGE + 1, float("inf")), (901, float("inf"))))
    low = lambda cell: cell.fill_asked is None or cell.fill_percent <= LOW_FILL
    return [
        _region(results, "F6", "KLU wins at low fill, 10 to 100 variables", filter(low, small), "KLU"),
        _region(results, "F6", "WSMP wins at high fill, 10 to 100 variables",
                [cell for cell in small if not low(cell) and cell.fill_percent >= HIGH_FILL], "WSMP"),
        _region(results, "F6", "dense wins nowhere, 10 to 100 variables", small, None),
        _region(results, "F7", "CHOLMOD wins at low fill above 900 variables", filter(low, beyond), "CHOLMOD"),
        _region(results, "F7", f"WSMP wins at middle fill above {LARGE} variables",
                [cell for cell in large if not low(cell) and cell.fill_percent < FULL_FILL], "WSMP"),
        _region(results, "F7", f"LAPACK (dense) wins near full matrices above {LARGE} variables",
                [cell for cell in large if cell.fill_percent >= FULL_FILL], "optimised dense")]


def _region(results, figure, claim, cells, system):
    """`system`: whose region it is; None: the dense ones are to win nothing."""
    head, rule = (figure, claim, "region" if system else "nowhere"), "every cell" if system else "no cell"
    cells = list(cells)
    names = paper.dense(results) if system in (None, "optimised dense") else paper.members(results, system)
    if len(cells) < CELLS_NEEDED[figure]:
        return row(head, UNMEASURED, f"{len(cells)} cells of this region were timed, {CELLS_NEEDED[figure]} are needed.", rule)
    if not names:
        return row(head, UNMEASURED, "No stand-in of this system was timed.", rule)
    told = gather((_cell(cell, names, system and paper.shared(results, system)), _place(cell)) for cell in cells)
    winners = gather((cell.ranking.winner if cell.decided else "undecided", _place(cell)) for cell in cells)
    listed = "; ".join(f"{name}: {', '.join(found)}" for name, found in winners.items())
    return row(head, REFUTED if REFUTED in told and CONFIRMED not in told else summed(told), by_place(told) if len(told) > 1 else "", rule,
               f"Winners among the paper's systems: {listed}.") | {
        "ours": f"{len(told.get(CONFIRMED, []))} of {len(cells)} cells", "where": f"{', '.join(map(_place, cells))}: {', '.join(names)}",
        "record": " ".join(rows.record[rows.implementation == cell.ranking.winner].iloc[0] for cell in cells for rows in [results.rows(cell.scene)])}


def _cell(cell, names, shared):
    """`shared`: those of `names` that stand for another system too; None: none of `names` is to win."""
    if not set(cell.winners) & set(names):
        return CONFIRMED if shared is None else REFUTED
    if not set(cell.winners) <= set(names):
        return UNDECIDED
    return REFUTED if shared is None else INCOMPARABLE if set(cell.winners) & set(shared) else CONFIRMED


def _place(cell):
    return f"n = {cell.variables:g} and {cell.fill_percent:.0f} %"
