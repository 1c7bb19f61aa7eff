# The answer to "Which implementation is fastest at which size and fill?", from the tables.
from collections import Counter

from analysis.map import summary
from analysis.map.results import of


def answers(tables, view):
    results = of(tables, view)
    libraries = results.layer("libraries")
    groups = summary.by_size(results, libraries)
    if not groups:
        return [{"text": "Nothing was timed: no library took part or agreed with the reference.", "anchor": "losses"}]
    listed = "; ".join(": ".join(summary.outcome(group)) for group in groups)
    found = [{"text": f"Fastest library at the four-bar's own fill: {listed}.", "anchor": "answer"}]
    dense = [f"n = {row['variables']:g} from {row['from']:.0f} %" for row in summary.dense_from(results) if row["from"] is not None]
    if dense:
        found.append({"text": f"As the tangent fills, dense libraries overtake: {', '.join(dense)}.", "anchor": "maps"})
    whole = [row for row in summary.prices(results, libraries) if not row["failed"] and row["cells"] == row["of"]]
    if whole:
        first = whole[0]
        found.append({"text": f"The safest single library is {first['implementation']}: {first['mean']:.2f} times the best on "
                              f"average over {first['of']} cells, {first['worst']:.3g} times at worst.", "anchor": "regret"})
    verdicts = Counter(tables["claims"].verdict)
    found.append({"text": "Of the paper's claims " + ", ".join(f"{count} {verdict}" for verdict, count in verdicts.items()) + ".",
                  "anchor": "claims"})
    return found
