# Claims about the tangent's fill and the maps: F5, F6, F7.
from analysis.core.text import number
from analysis.map import paper
from analysis.map.cells import map_cells
from analysis.map.compare import best, extreme
from analysis.map.ledger import at_least, at_most, compared, more_than, tested, unmeasured

F5_SIZE = 100
FILLS_NEEDED = 3     # filled scenes that a size needs for Figure 5
LOW_FILL = 30        # %, "low fill" ends
HIGH_FILL = 50       # %, "high fill" begins
FULL_FILL = 90       # %, LAPACK's region of Figure 7
FIGURE6 = 100        # variables
LARGE = 160          # variables; Figure 7's own range begins behind Figure 4's
CELLS_NEEDED = {"F6": 4, "F7": 2}  # timed cells that a region needs
HALF = 50            # %, a system owns a region if it wins more than this share of its cells


def over_fill(results):
    """F5. Rule: best dense ÷ system above 1 at every fill, taken at the fill where it is least."""
    size = fill_size(results)
    rows = []
    for system in ("CHOLMOD", "WSMP"):
        head = "F5", f"at 100 variables {system} is faster than the best dense version at every fill", "> 1×"
        rows.append(_over_fill(results, head, system, size) if size is not None else
                    unmeasured(head, f"No size has {FILLS_NEEDED} filled scenes.", at_least(1)))
    return rows


def fill_size(results):
    """The size nearest to 100 variables with at least FILLS_NEEDED filled scenes; None without."""
    samples = results.samples()
    filled = samples[samples.fill_asked.notna()].groupby("variables").scene.nunique()
    return min(filled.index[filled >= FILLS_NEEDED], key=lambda size: abs(size - F5_SIZE), default=None)


def _over_fill(results, head, system, size):
    samples = results.samples()
    names, dense = paper.members(results, system), paper.dense(results)
    scenes = samples[samples.variables == size].groupby("scene").fill_percent.first().sort_values()
    found = [best(results, scene, dense, names) for scene in scenes.index]
    lost = [f"{fill:.0f}" for one, (scene, fill) in zip(found, scenes.items()) if not one and results.fastest(scene, dense)]
    found = [one for one in found if one]
    if not found or lost:
        text = f"at fills of {', '.join(lost)} %" if lost else "anywhere"
        return unmeasured(head, f"At n = {size:g} {system}'s stand-ins were not timed against a dense version {text}.", at_least(1))
    worst = extreme(found, min)
    slower = [number(one.fill, 2) for one in found if one.high < 1]
    across = ", ".join(f"{number(one.value)}× at {one.fill:.0f} %" for one in found)
    why = (f"Dense ÷ {system}'s stand-in over fill: {across}. "
           + (f"Dense is faster at {', '.join(slower)} %." if slower else "Dense is faster nowhere.") + _shared(names))
    return compared(head, worst, at_least(1), why, f"n = {size:g}, {worst.fill:.0f} % fill, {worst.slow} ÷ {worst.fast}")


def regions(results):
    """F6, F7. Rules: a system wins more than half of the cells of its region, ranked among the stand-ins of the paper's
    systems (half of them is a draw: undecided); undecided cells count against it for the low bound and for it for the
    high bound. F6 also: no cell at all is won by a dense version."""
    small, large, beyond = (10, FIGURE6), (LARGE + 1, 1e9), (901, 1e9)
    standing = {name for system in paper.SYSTEMS for name in paper.members(results, system)}
    asked = results.view.settings["columns"]
    grid = {(one["variables"], fill) for one in asked for fill in one["fills"]}  # others crowd where winners change
    cells = [cell for cell in map_cells(results, standing) if (cell.variables, cell.fill_asked or "natural") in grid]
    of, dense = lambda system: paper.members(results, system), paper.dense(results)
    return [
        _region(results, cells, "F6", "KLU wins at low fill, 10 to 100 variables", of("KLU"), small, (0, LOW_FILL)),
        _region(results, cells, "F6", "WSMP wins at high fill, 10 to 100 variables", of("WSMP"), small, (HIGH_FILL, 100)),
        _region(results, cells, "F6", "dense wins nowhere, 10 to 100 variables", dense, small, (0, 100), at_most(0), "0 %"),
        _region(results, cells, "F7", "CHOLMOD wins at low fill above 900 variables", of("CHOLMOD"), beyond, (0, LOW_FILL)),
        _region(results, cells, "F7", f"WSMP wins at middle fill above {LARGE} variables", of("WSMP"), large,
                (LOW_FILL + 0.01, FULL_FILL - 0.01)),
        _region(results, cells, "F7", f"LAPACK (dense) wins near full matrices above {LARGE} variables", dense, large,
                (FULL_FILL, 100.1))]


def _region(results, cells, figure, claim, names, sizes, fills, rule=more_than(HALF), quoted="region"):
    head = figure, claim, quoted
    inside = [cell for cell in cells if sizes[0] <= cell.variables <= sizes[1] and fills[0] <= cell.fill_percent <= fills[1]
              and cell.ranking]
    if len(inside) < CELLS_NEEDED[figure]:
        return unmeasured(head, f"{len(inside)} cells of this region were timed, {CELLS_NEEDED[figure]} are needed.", rule, " %")
    if not names:
        return unmeasured(head, "No stand-in of this system was timed.", rule, " %")
    won = [cell for cell in inside if cell.decided and cell.ranking.winner in names]
    doubtful = [cell for cell in inside if not cell.decided and set(cell.winners) & set(names)]
    measured = [100 * value / len(inside) for value in (len(won), len(won), len(won) + len(doubtful))]
    winners = {}
    for cell in inside:
        winner = cell.ranking.winner if cell.decided else "undecided"
        winners[winner] = winners.get(winner, 0) + 1
    listed = ", ".join(f"{name} {count}" for name, count in sorted(winners.items(), key=lambda one: -one[1]))
    return tested(head, measured, rule, f"{_extent(inside)}, {', '.join(names)}: {len(won)} of {len(inside)} cells",
                  f"Cells of the grid by winner among the paper's systems: {listed}. Bounds: undecided cells counted against "
                  f"and for it.{_shared(names)}", " %", " ".join(_record(results, cell) for cell in inside))


def _record(results, cell):
    """One of the winner's in a cell."""
    rows = results.rows(cell.scene)
    return rows.record[rows.implementation == cell.ranking.winner].iloc[0]


def _shared(names):
    """A warning where one implementation stands for more than one of the paper's systems."""
    return " csc_cholmod/supernodal stands for CHOLMOD and for WSMP." if "csc_cholmod/supernodal" in names else ""


def _extent(inside):
    sizes, fills = [cell.variables for cell in inside], [cell.fill_percent for cell in inside]
    return f"n = {min(sizes):g} to {max(sizes):g}, fill {min(fills):.0f} to {max(fills):.0f} %"
