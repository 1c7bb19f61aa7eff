# The answers to "What happens at the extremes, and what helps there?", from the tables.
from analysis.core.text import number
from analysis.extremes import battery, pivots, trials, verdicts, ways
from analysis.extremes.page import nobody, overhead


def answers(tables, view):
    found = [*_battery(tables["battery"]), *_ways(tables["ways"], tables["ways_cost"]), *_pivots(tables["pivots"])]
    return found or [{"text": "Not measured: nobody that takes part runs at the extremes.", "anchor": ""}]


def _battery(table):
    runs = verdicts.judged(table)
    if runs.empty:
        return
    silent, false = (runs[runs.verdict == verdict] for verdict in (verdicts.SILENT, verdicts.FALSE))
    standard = runs.axis.isin(trials.STANDARD)
    wrongly, others = false[standard[false.index]], false[~standard[false.index]]
    text = (f"Of {len(runs)} runs of {len(runs[['axis', 'value']].drop_duplicates())} mechanisms of {runs.axis.nunique()} kinds {_are(silent)} silently "
            f"wrong, and {_are(false)} called worse than right though nothing is wrong. Bound “no run is silently wrong”: {_held(silent)}.")
    if standard.any():
        text += f" Bound “no false alarm on standard problems at their own steps”: {_held(wrongly)}, in {standard.sum()} runs."
    if len(others):
        text += f" Other false alarms: {_places(others)}."
    yield {"anchor": "battery", "text": text}
    lost = {}
    for axis, value, _ in nobody(battery.extreme(runs)):
        lost.setdefault(axis, []).append(value)
    if lost:
        yield {"anchor": "nobody", "text": "Nobody is right, in any setting tried, at " + "; ".join(
            f"{axis}: {', '.join(values)}" for axis, values in lost.items()) + "."}


def _are(rows):
    return f"{len(rows) or 'none'} {'are' if len(rows) > 1 else 'is'}"


def _held(rows):
    """Whether the bound "none of these" holds."""
    return f"not held, {len(rows)} run{'s' if len(rows) > 1 else ''} ({_places(rows)})" if len(rows) else "held"


def _places(rows):
    return ", ".join(f"{kind}: {count}" for kind, count in rows.axis.value_counts(sort=False).items())


def _ways(table, cost):
    shares = {way: tuple(map(sum, zip(*(ways.share(own) for _, own in rows.groupby("folder")))))
              for way, rows in table[table.axis != ""].groupby("way", sort=False)}
    shares = {way: one for way, one in shares.items() if one[1]}
    if ways.PLAIN not in shares:
        return
    ratios = {way: cost[(cost.way == way) & cost.ratio.notna()].ratio for way in shares}
    best = max(shares, key=lambda way: (shares[way][0] / shares[way][1], -ratios[way].max()))
    times = ratios[best]
    at = f", at {number(times.min(), 2)} to {number(times.max(), 2)} times the time of a step" if len(times) else ""
    yield {"anchor": "ways", "text": f"Of the ways out “{best}” is safe in most cells: {shares[best][0]} of {shares[best][1]}{at}. "
           f"The penalty form with automatic α is so in {shares[ways.PLAIN][0]} of {shares[ways.PLAIN][1]}."}


def _pivots(table):
    table = pivots.timed(table)
    if table.empty or "guarded" not in overhead(table):
        return
    worst = table.groupby("strategy").error_worst.max()
    yield {"anchor": "pivots", "text": f"Solves with pivots that are kept have backward errors of up to {number(worst['refactor'], 1)}, "
           f"with a guard of at most {number(worst['guarded'], 1)}, for {number(overhead(table)['guarded'].median(), 3)} times the time."}


def cases(tables, view):
    """Rows of the front page's table."""
    masses = tables["ways"][tables["ways"].axis == "mass ratio"]
    most = masses[masses.value == masses.value.max()]
    safe = [way for way, rows in most.groupby("way", sort=False) if rows.safe.all()]
    if not safe:
        return []
    return [{"case": f"Masses in your mechanism differ by {number(most.value.iloc[0])}", "link": "extremes.html#ways",
             "take": f"{' or '.join(safe)}, whatever the implementation (tried on the four-bar)"}]
