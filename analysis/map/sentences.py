# The answer to "Which implementation is fastest at which size and fill?", from the tables.
from analysis.core.controls import said
from analysis.core.gather import gather
from analysis.map import summary
from analysis.map.ledger import told
from analysis.map.results import of


def answers(tables, view):
    results = of(tables, view)
    libraries = results.layer("libraries")
    groups = summary.by_size(results, libraries)
    if all(group["kind"] == "none" for group in groups):
        return [{"text": "Nothing was timed: no library took part or agreed with the reference.", "anchor": "losses"}]
    found = [{"text": f"The four-bar at its own fill. {' '.join(by_outcome(groups))}", "anchor": "answer"}]
    dense = [f"n = {row['variables']:g} from {row['from']:.0f} %" for row in summary.dense_from(results) if row["from"] is not None]
    said = [f"the paper's dense versions overtake the sparse libraries at {', '.join(dense)}"] * bool(dense) + _hybrid(tables["cells"])
    if said:
        found.append({"text": f"As the tangent fills, {'; '.join(said)}.", "anchor": "maps"})
    if whole := [row for row in summary.prices(results, libraries) if not row["failed"] and row["cells"] == row["of"]]:
        first, safest = whole[0], min(whole, key=lambda row: row["worst"])
        found.append({"text": f"The single library that costs least is {_price(first)}, over {first['of']} cells."
                              + (f" The one with the least worst case is {_price(safest)}." if safest != first else ""), "anchor": "regret"})
    if control := said(tables["controls"]):
        found.append({"text": control, "anchor": "carries"})
    found.append({"text": f"Claims of the paper of 2008 (T, F: its tables and figures; C: its text): {told(tables['claims'])}.", "anchor": "claims"})
    return found


def _hybrid(cells):
    filled = cells[(cells.layer == "libraries") & cells.fill_asked.notna() & (cells.winner != "")]
    count = filled.equivalent.str.contains("hybrid_dense/").sum()
    return [f"sparse assembly with a dense solver (hybrid_dense) leads, or is as fast, in {count} of {len(filled)} filled cells"] if count else []


def _price(row):
    return f"{row['implementation']}: {row['mean']:.2f} times the best on average, {row['worst']:.3g} times at worst"


def by_outcome(groups, what="library"):
    """A sentence for each that is shown to be fastest at some sizes, one for sizes of each other kind."""
    told = gather(((group["kind"], group["names"][0] if group["kind"] == "decided" else ""), group) for group in groups)
    for (kind, name), mine in told.items():
        sizes = "n = " + ", ".join(" to ".join(dict.fromkeys(f"{group[end]:g}" for end in ("first", "last"))) for group in mine)
        margins = [value for group in mine for value in group["margins"] if value == value]
        names = ", ".join(dict.fromkeys(one for group in mine for one in group["names"]))
        ahead = " to ".join(dict.fromkeys(f"{value:.2f}" for value in (min(margins), max(margins)))) if margins else ""
        ahead = f", {ahead} times ahead of the second" if ahead else ""
        yield {"decided": f"{name} is the fastest {what} at {sizes}{ahead}.", "equivalent": f"At {sizes} several are as fast as each other: {names}.",
               "open": f"At {sizes} it is not decided; the fastest is among {names}.",
               "few": f"At {sizes} too few processes were timed to tell.", "none": f"At {sizes} nobody was timed."}[kind]
