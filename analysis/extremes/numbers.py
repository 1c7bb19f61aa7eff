# The numbers that figures, tables and sentences of extremes.html share.
import numpy

from analysis.accuracy.front import FINISHED

PLAIN = "α auto"
NOT_SERVED = ("unsupported", "refused")
NOT_RUN = (*NOT_SERVED, "not run")
FORMS = ("penalty", "saddle-point")  # settings that every cell runs
NEAR = 0.1          # s on either side of a singular position
FLOOR = 1e-17       # m; differences below it are none
INSTANTS = ("at_1_s", "at_5_s", "at_20_s")


def ran(battery):
    """The rows of battery.csv that are runs: neither refused nor left out."""
    return battery[~battery.status.isin(NOT_RUN)]


def folders(ways):
    """Folders of ways.csv, in its order."""
    return list(dict.fromkeys(ways.implementation.str.split("/").str[0]))


def not_served(rows):
    """Why none of the rows of a way and implementation was run; "" if one was."""
    if len(rows) and not rows.status.isin(NOT_SERVED).all():
        return ""
    return rows.reason.iloc[0] if len(rows) else "not run"


def share(rows):
    """(cells that are safe, cells) of rows of one way and implementation."""
    region = rows[rows.axis.notna()]
    return int(region.safe.astype(bool).sum()), len(region)


def costs(cost, folder, way):
    """[(loops, time of a step over that of plain, least, largest)]: median and range of the ratios within a round, for
    each size that both finished. The rounds are too few for an interval."""
    found = []
    if cost.empty:
        return found
    own = cost[(cost.folder == folder) & cost.status.isin(FINISHED)]
    for loops, rows in own.groupby("loops"):
        pairs = rows[rows.way == way].set_index("round").step_us / rows[rows.way == PLAIN].set_index("round").step_us
        if pairs.notna().any():
            found.append((int(loops), *map(float, (pairs.median(), pairs.min(), pairs.max()))))
    return found


def passes(cost, folder, way):
    """[(loops, passes a step)]"""
    own = cost[(cost.folder == folder) & (cost.way == way)].dropna(subset="passes_per_step") if len(cost) else cost
    return [(int(loops), float(rows.passes_per_step.median())) for loops, rows in (
        own.groupby("loops") if len(own) else [])]


def later(lines, singular):
    """What follows the first turn: in that the difference leaves zero, by as many decades as FLOOR is low."""
    turn = singular[2] - singular[0]  # two of them a turn
    return lines[lines.t >= turn]


def growth(lines, singular):
    """Of the growth of log10(difference) from the first sample to the last, the decades that lie within NEAR of
    a singular position, those in between, and the share of time that is near: one line's `t`, `difference`."""
    t = lines.t.to_numpy()
    logs = numpy.log10(numpy.maximum(lines.difference.to_numpy(), FLOOR))
    logs = numpy.maximum.accumulate(logs)  # how far it has ever been: oscillation is no growth
    near = numpy.array([bool((abs(singular - middle) <= NEAR).any()) for middle in (t[1:] + t[:-1]) / 2])
    steps = numpy.diff(logs)
    return steps[near].sum(), steps[~near].sum(), near.mean()


def with_speed(lines):
    """Correlation of log(difference) with log(speed) over one line's second half, both without their trend over
    log(t). Near 1, one motion is late: it is on the same path, and off by its speed times the lag."""
    late = lines[(lines.t >= lines.t.max() / 2) & (lines.difference > FLOOR)]
    if len(late) < 3:
        return float("nan")
    rests = []
    for values in (late.difference, late.speed):
        logs = numpy.log(values.to_numpy())
        rests.append(logs - numpy.polyval(numpy.polyfit(numpy.log(late.t), logs, 1), numpy.log(late.t)))
    return float(numpy.corrcoef(*rests)[0, 1]) if min(rest.std() for rest in rests) > 1e-9 else float("nan")
