# Who meets a required error in the least time in each cell of the regions: winners.csv from regions.csv.
import pandas

from analysis.accuracy.front import FINISHED


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


def _winner(cell):
    """The fastest whose timed run meets the error, too; undecided if the spread of the best of another
    implementation reaches its own."""
    done = cell[cell.status.isin(FINISHED) & (cell.measured_error <= cell.required)
                & cell.time.notna()].sort_values("time", kind="stable")
    if done.empty:
        return {"implementation": "nobody", "candidates": len(cell), "measured": 0}
    first = done.iloc[0]
    others = done[done.implementation != first.implementation]
    found = {key: first[key] for key in ("implementation", "setting", "step", "error", "error_of",
                                         "time", "time_low", "time_high", "duration", "rounds",
                                         "raw_file", "command")}
    found |= {"candidates": len(cell), "measured": len(done), "decided": True}
    if not others.empty:
        second = others.iloc[0]
        found |= {"second": second.implementation, "second_setting": second.setting,
                  "second_step": second.step, "margin": second.time / first.time,
                  "decided": bool(second.time_low > first.time_high)}
    mine = done[(done.implementation == first.implementation) & (done.setting != first.setting)]
    found["as_fast"] = "; ".join(mine[mine.time_low <= first.time_high].setting)
    return found
