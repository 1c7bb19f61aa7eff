# Claims about the tangent's fill and the maps: F5, F6, F7.
from analysis import paper
from analysis.compare import best_ratio, fastest
from analysis.ledger import at_least, at_most, more_than, of, tested, untested
from analysis.loader import FAILURES
from analysis.maps import paired_rank
from analysis.text import number

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
        head = ("F5", f"at 100 variables {system} is faster than the best dense version at every "
                      "fill", "> 1×")
        if size is None:
            rows.append(untested(*head, f"No size has {FILLS_NEEDED} filled scenes.", at_least(1)))
        else:
            rows.append(_over_fill(results, head, system, size))
    return rows


def fill_size(results):
    """The size nearest to 100 variables with at least FILLS_NEEDED filled scenes; None without."""
    samples = results.samples()
    filled = samples[samples.fill_asked.notna()].groupby("variables").scene.nunique()
    sizes = filled.index[filled >= FILLS_NEEDED]
    return min(sizes, key=lambda size: abs(size - F5_SIZE), default=None)


def _over_fill(results, head, system, size):
    samples = results.samples()
    names, dense = paper.members(results, system), paper.dense(results)
    found, lost = [], []
    for _, scene in samples[samples.variables == size].groupby("scene"):
        fill = scene.fill_percent.iloc[0]
        ratio = best_ratio(scene, dense, names)
        if ratio:
            found.append((fill, ratio))
        elif fastest(scene, dense):
            lost.append(fill)
    if not found or lost:
        text = f"at fills of {', '.join(f'{fill:.0f}' for fill in lost)} %" if lost else "anywhere"
        return untested(*head, f"At n = {size:g} {system}'s stand-ins were not timed against a "
                        f"dense version {text}.", at_least(1))
    found.sort(key=lambda entry: entry[0])
    fill, worst = min(found, key=lambda entry: entry[1].value)
    slower = [number(fill, 2) for fill, ratio in found if ratio.high < 1]
    across = ", ".join(f"{number(ratio.value)}× at {fill:.0f} %" for fill, ratio in found)
    why = (f"Dense ÷ {system}'s stand-in over fill: {across}. "
           + (f"Dense is faster at {', '.join(slower)} %." if slower else
              "Dense is faster nowhere.") + _shared(names))
    return tested(*head, of(worst), at_least(1),
                  f"n = {size:g}, {fill:.0f} % fill, {worst.slow} ÷ {worst.fast}", why)


def regions(results):
    """F6, F7. Rules: a system wins more than half of the cells of its region, ranked among
    the stand-ins of the paper's systems (half of them is a draw: undecided); undecided cells count against it for the low bound and
    for it for the high bound. F6 also: no cell at all is won by a dense version."""
    small, large = (10, FIGURE6), (LARGE + 1, 1e9)
    beyond = (901, 1e9)
    dense = paper.dense(results)
    return [
        _region(results, "F6", "KLU wins at low fill, 10 to 100 variables",
                paper.members(results, "KLU"), small, (0, LOW_FILL)),
        _region(results, "F6", "WSMP wins at high fill, 10 to 100 variables",
                paper.members(results, "WSMP"), small, (HIGH_FILL, 100)),
        _region(results, "F6", "dense wins nowhere, 10 to 100 variables", dense, small, (0, 100),
                at_most(0), "0 %"),
        _region(results, "F7", "CHOLMOD wins at low fill above 900 variables",
                paper.members(results, "CHOLMOD"), beyond, (0, LOW_FILL)),
        _region(results, "F7", f"WSMP wins at middle fill above {LARGE} variables",
                paper.members(results, "WSMP"), large, (LOW_FILL + 0.01, FULL_FILL - 0.01)),
        _region(results, "F7", f"LAPACK (dense) wins near full matrices above {LARGE} variables",
                dense, large, (FULL_FILL, 100.1))]


def _region(results, figure, claim, names, sizes, fills, rule=more_than(HALF), quoted="region"):
    samples = results.samples()
    samples = samples[samples.stage != "refined"]  # refined cells crowd where winners change
    standing = {name for system in paper.SYSTEMS for name in paper.members(results, system)}
    inside = samples[samples.variables.between(*sizes) & samples.fill_percent.between(*fills)
                     & samples.implementation.isin(standing)]
    names = [name for name in names if name in standing]
    head = figure, claim, quoted
    tidy = results.tidy
    failed = set(tidy[tidy.status.isin(FAILURES) & tidy.implementation.isin(standing)].scene)
    rankings = [paired_rank(scene, name in failed) for name, scene in inside.groupby("scene")]
    if len(rankings) < CELLS_NEEDED[figure]:
        return untested(*head, f"{len(rankings)} cells of this region were timed, "
                        f"{CELLS_NEEDED[figure]} are needed.", rule, " %")
    if not names:
        return untested(*head, "No stand-in of this system was timed.", rule, " %")
    won = [ranking for ranking in rankings if ranking.decided and ranking.winner in names]
    doubtful = [ranking for ranking in rankings if not ranking.decided
                and {ranking.winner, ranking.second} & set(names)]
    count = len(rankings)
    measured = [100 * value / count for value in (len(won), len(won), len(won) + len(doubtful))]
    winners = {}
    for ranking in rankings:
        winners.setdefault(ranking.winner if ranking.decided else "undecided", []).append(ranking)
    listed = ", ".join(f"{name} {len(cells)}" for name, cells in
                       sorted(winners.items(), key=lambda entry: -len(entry[1])))
    share = f"{', '.join(names)}: {len(won)} of {count} cells"
    return tested(*head, measured, rule, f"{_extent(inside)}, {share}",
                  f"Cells of the grid by winner among the paper's systems: {listed}. Bounds: "
                  f"undecided cells counted against and for it.{_shared(names)}", " %")


def _shared(names):
    """A warning where one implementation stands for more than one of the paper's systems."""
    both = [name for name in names if "csc_cholmod/supernodal" == name]
    return f" {both[0]} stands for CHOLMOD and for WSMP." if both else ""


def _extent(inside):
    return (f"n = {inside.variables.min():g} to {inside.variables.max():g}, fill "
            f"{inside.fill_percent.min():.0f} to {inside.fill_percent.max():.0f} %")
