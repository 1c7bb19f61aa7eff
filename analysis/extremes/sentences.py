# The answers to "What happens at the extremes, and what helps there?", from the tables.
from analysis.core.text import number
from analysis.extremes import battery, judge, pivots, told, trials, ways
from analysis.extremes.cells import FORMS
from analysis.extremes.page import nobody, overhead, right, silent


def answers(tables, view):
    found = [*_trials(tables["trials"]), *_battery(tables["battery"]), *_ways(tables["ways"], tables["ways_cost"]), *_pivots(tables["pivots"])]
    return found or [{"text": "Not measured: nobody that takes part runs at the extremes.", "anchor": ""}]


def _trials(table):
    runs = told.judged(table)
    if runs.empty:
        return
    silent, false = (runs[runs.verdict == verdict] for verdict in (judge.SILENT, judge.FALSE))
    standard = runs[runs.axis.isin(trials.STANDARD)]
    held = [f"No run may be silently wrong: {_held(silent)}."]
    if len(standard):
        held.append(f"No standard problem may be called worse than it is: {_held(false[false.axis.isin(trials.STANDARD)])}, of {len(standard)}.")
    others = false[~false.axis.isin(trials.STANDARD)]
    yield {"anchor": "trials", "text": f"Of {len(runs)} runs of {len(runs[['axis', 'value']].drop_duplicates())} mechanisms of {runs.axis.nunique()} kinds "
           f"{len(silent) or 'none'} {'are' if len(silent) > 1 else 'is'} silently wrong; {len(false) or 'none'} {'are' if len(false) > 1 else 'is'} "
           f"called worse than {'they are' if len(false) > 1 else 'it is'}. {' '.join(held)}" + (
               f" Near change points or with light parts: {_places(others)}." if len(others) else "")}


def _held(rows):
    """Whether the bound "none of these" holds."""
    return f"not held, {len(rows)} run{'s' if len(rows) > 1 else ''} ({_places(rows)})" if len(rows) else "held"


def _places(rows):
    return ", ".join(f"{kind}: {count}" for kind, count in rows.axis.value_counts(sort=False).items())


def _battery(table):
    runs = battery.ran(table)
    if runs.empty:
        return
    count, places = int(runs.silent.sum()), "; ".join(f"{one['axis']} {one['value']}" for one in silent(runs))
    yield {"anchor": "battery", "text": f"{right(runs).sum()} of {len(runs)} runs at the extremes are ok or plausible, and right. "
           f"{count or 'None'} {'are' if count > 1 else 'is'} silently wrong{f' ({places})' if places else ''}. "
           "The others say themselves that they failed or are off."}
    forms = runs[runs.setting.isin([form.name for form in FORMS])]
    lost = {}
    for axis, value, _ in nobody(forms):
        lost.setdefault(axis, []).append(value)
    if lost:
        yield {"anchor": "nobody", "text": "Neither form is ok at " + "; ".join(
            f"{axis}: {', '.join(values)}" for axis, values in lost.items()) + "."}


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
