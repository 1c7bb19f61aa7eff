# Who meets a required error in the least time in each cell of the regions: winners.csv from regions.csv.
import numpy
import pandas

from analysis.accuracy.front import FINISHED
from analysis.statistics import ratio_interval


def winners(regions):
    """DataFrame, a row for each size, fill and required error, also where nobody meets it."""
    rows = []
    cells = regions.assign(fill_asked=regions.fill_asked.fillna(-1))
    for (loops, fill), cell in cells.groupby(["loops", "fill_asked"], sort=True):
        measured = cell.fill.dropna()
        for required in sorted(regions.required.unique(), reverse=True):
            found = {"required": required, "loops": loops, "variables": 2 * loops + 2,
                     "fill_asked": None if fill < 0 else fill,
                     "fill": measured.median() if len(measured) else (
                         cell.natural_fill.iloc[0] if fill < 0 else fill)}
            rows.append(found | _winner(cell[cell.required == required]))
    return pandas.DataFrame(rows)


def leaders(cell):
    """Index of the fastest that meets the error, also in its timed run, and of the fastest of another
    implementation, not only of another variant; less where there is none. `cell`: rows of one required error.
    Who has more rounds comes first: these were the fastest when all had as many."""
    done = _done(cell)
    first = done.index[:1]
    folders = done.implementation.str.split("/").str[0]
    others = done[folders != folders[first[0]]] if len(first) else done
    return [*first, *others.index[:1]]


def _done(cell):
    done = cell[cell.status.isin(FINISHED) & (cell.measured_error <= cell.required) & cell.time.notna()]
    most = done["rounds"] if "rounds" in done else 0
    return done.assign(fewer=-most).sort_values(["fewer", "time"], kind="stable")


def _winner(cell):
    """The fastest whose timed run meets the error, too; decided if the interval of the ratio of the best of
    another implementation to it excludes 1, over the rounds that both have."""
    places = leaders(cell)
    if not places:
        return {"implementation": "nobody", "candidates": len(cell), "measured": 0}
    done, first = _done(cell), cell.loc[places[0]]
    found = {key: first[key] for key in ("implementation", "setting", "step", "error", "error_of",
                                         "time", "time_low", "time_high", "duration", "rounds",
                                         "raw_file", "command")}
    found |= {"candidates": len(cell), "measured": len(done), "decided": True}
    if len(places) > 1:
        second = cell.loc[places[1]]
        margin, low, high = ratio_interval(_samples(second), _samples(first))
        found |= {"second": second.implementation, "second_setting": second.setting,
                  "second_step": second.step, "margin": margin, "margin_low": low, "margin_high": high,
                  "decided": bool(low > 1)}
    mine = done[(done.implementation == first.implementation) & (done.setting != first.setting)]
    found["as_fast"] = "; ".join(mine[mine.time_low <= first.time_high].setting)
    return found


def _samples(row):
    """{round: samples} of the column "times"."""
    return {number: numpy.array([float(time)]) for number, time in enumerate(str(row.times).split())}
