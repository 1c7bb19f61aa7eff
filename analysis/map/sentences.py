# The answer to "Which implementation is fastest at which size and fill?", from the tables.
from analysis.map import summary
from analysis.map.cells import map_cells
from analysis.map.ledger import told
from analysis.map.regret import regrets
from analysis.map.results import of


def answers(tables, view):
    results = of(tables, view)
    libraries = results.layer("libraries")
    groups = summary.by_size(results, libraries)
    if not groups:
        return [{"text": "Nothing was timed: no library took part or agreed with the reference.", "anchor": "losses"}]
    found = [{"text": f"At the four-bar's own fill: {' '.join(by_outcome(groups))}", "anchor": "answer"}]
    dense = [f"n = {row['variables']:g} from {row['from']:.0f} %" for row in summary.dense_from(results) if row["from"] is not None]
    if dense:
        found.append({"text": f"As the tangent fills, dense libraries overtake: {', '.join(dense)}.", "anchor": "maps"})
    whole = [row for row in summary.prices(results, libraries) if not row["failed"] and row["cells"] == row["of"]]
    if whole:
        first = whole[0]
        found.append({"text": f"The safest single library is {first['implementation']}: {first['mean']:.2f} times the best on "
                              f"average over {first['of']} cells, {first['worst']:.3g} times at worst.", "anchor": "regret"})
    found.append({"text": f"The paper's claims: {told(tables['claims'])}.", "anchor": "claims"})
    return found


def by_outcome(groups):
    """A sentence for each library that is shown to be fastest at some sizes, one for sizes of each other kind."""
    told = {}
    for group in groups:
        told.setdefault((group["kind"], group["names"][0] if group["kind"] == "decided" else ""), []).append(group)
    for (kind, name), mine in told.items():
        sizes = f"n = {', '.join(summary.span(group) for group in mine)}"
        margins = [value for group in mine for value in group["margins"] if value == value]
        names = ", ".join(dict.fromkeys(one for group in mine for one in group["names"]))
        ahead = " to ".join(dict.fromkeys(f"{value:.2f}" for value in (min(margins), max(margins)))) if margins else ""
        ahead = f", {ahead} times ahead of the second" if ahead else ""
        yield (f"{name} is the fastest library at {sizes}{ahead}." if kind == "decided" else
               f"At {sizes} several are as fast as each other: {names}." if kind == "equivalent" else
               f"At {sizes} it is not decided; the fastest is among {names}.")


FULL = 50  # %, of a tangent that counts as filled


def cases(tables, view):
    """Rows of the front page: the library of least mean loss where the tangent is sparse and where it is filled."""
    results = of(tables, view)
    libraries = results.layer("libraries")
    cells = [cell for cell in map_cells(results, libraries) if cell.ranking]
    found = []
    for words, mine in (("Your tangent is as sparse as the four-bar's", [cell for cell in cells if cell.fill_asked is None]),
                        (f"Your tangent is filled further, to {FULL} % or more", [cell for cell in cells if cell.fill_asked
                                                                        and cell.fill_percent >= FULL])):
        whole = [one for one in regrets(results, mine, libraries) if not one.failed and len(one.ratios) == len(mine) and mine]
        if whole:
            sizes = sorted({cell.variables for cell in mine})
            span = f"{sizes[0]:g} to {sizes[-1]:g} variables" if len(sizes) > 1 else f"{sizes[0]:g} variables"
            found.append({"case": f"{words} ({span})", "link": "map.html#regret",
                          "take": f"{whole[0].name}: {whole[0].mean:.2f} times the fastest library on average, "
                                  f"{whole[0].worst:.2f} at worst; shown to be ahead in {_ahead(mine, whole[0].name)} of "
                                  f"{len(mine)} cells"})
    return found


def _ahead(cells, name):
    """Cells in which it is shown to be faster than each other library."""
    return sum(cell.decided and cell.ranking.winner == name for cell in cells)
