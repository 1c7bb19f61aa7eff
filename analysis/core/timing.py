# All statistics. Of timed cells: ratios within a process, intervals over processes, who is fastest and who is as fast. study/README.md says why.
#
# In a process all contenders take turns: the ratio of two is the median over samples of their quotient. In all it is the mean of its logarithm over
# layouts of the program (LAYOUTS), of each the mean over its processes, with Student's interval over layouts [Kalibera and Jones 2013]: what a new
# build on a machine of this kind will show. Times are those of the processor: a turn takes a few milliseconds, and whoever is interrupted in one
# would lose by the clock what others did meanwhile. `clock_us` beside them tells how much that was.
import math
import statistics
from collections import Counter, namedtuple
from dataclasses import replace

import numpy
import pandas
from scipy import special  # scipy.stats has the same functions, a hundred times slower

from analysis.core.gather import gather
from analysis.core.registry import ANCHOR, NULL, TWIN

CONFIDENCE = 0.95
PHASES = ("evaluation", "assembly", "factorization", "solve", "projection", "other")  # of a step: counters phase_…
EQUIVALENT = 1.05  # who is shown to take at most so many times the fastest's time is as fast
LEFT_OUT, ALONE = "-left-out", "-alone"  # ends of roles of study.core.timing.measure
DISTURBED = 1.1  # the clock over the processor's time, from which a process counts as disturbed
STARTING = 0.02  # s that a process may wait for its files
COLUMNS = ("scene", "implementation", "environment", "process", "layout", "status", "reason", "step_us", "low_us", "high_us",
           "clock_us", "samples", "record")


def processes(records):
    """One row for each contender of each process of timed cells (records of `study.core.timing.measure`): COLUMNS, and every counter of
    `mbs bench` by its name. process: its number; layout: the program's, if it had one; step_us: median over samples, with the least and
    the largest; samples: µs a step; clock_us: the median by the clock."""
    found = pandas.DataFrame([row for record in records for row in _rows(record)])
    return found.reindex(columns=[*COLUMNS, *(name for name in found if name not in COLUMNS)])


def counted(records):
    """The records of timed cells that count. Who ended a process or differed was left out, and the others were measured
    again. So a process that failed speaks for nobody who has a record of being left out of it or was measured beside
    one; a process that ended well gives way to the one of the same number without those who were left out. Trials of
    one alone do not count, nor do disturbed processes where most of their kind are not. Roles come without "-left-out"."""
    records = [one for one in records if not one.role.endswith(ALONE)]
    kinds = gather(((*_asked(one), one.role, *one.cell["contenders"]), (disturbed(one), one)) for one in records)
    noisy = {id(one) for group in kinds.values() if 2 * sum(found for found, _ in group) < len(group) for found, one in group if found}
    records = [one for one in records if id(one) not in noisy]
    out, groups = (gather((_asked(one), one) for one in records if one.role.endswith(LEFT_OUT) == left) for left in (True, False))
    found = []
    for one in records:
        lost = {name for other in out.get(_asked(one), []) for name in other.cell["contenders"]}
        if one.role.endswith(LEFT_OUT):
            found.append(replace(one, cell=one.cell | {"role": one.role.removesuffix(LEFT_OUT)}))
        elif not _replaced(one, groups[_asked(one)], lost):
            found.append(one)
    return found


def disturbed(record):
    """Whether others ran on its processor: by the clock its turns, or all of a process without turns, took clearly longer than by
    the processor's time."""
    if record.cell.get("kind", "bench") != "bench":
        return record.done and record.seconds - STARTING > DISTURBED * record.machine.get("cpu_s", math.inf)
    rows = [row for row in record.output.get("rows", {}).values() if row.get("cpu_us") and row.get("stretch_us")]
    return bool(rows) and sum(sum(row["stretch_us"]) for row in rows) > DISTURBED * sum(sum(row["cpu_us"]) for row in rows)


def _asked(record):
    """What records of one group and of its smaller ones have in common."""
    return record.cell["scene"], record.cell["environment"], record.role.removesuffix(LEFT_OUT), str(record.option("--step"))


def _replaced(record, group, lost):
    """Whether a process is stood for by others. `group`: what was asked alike; `lost`: who was left out of it."""
    names = set(record.cell["contenders"])
    if not names & lost or record.status == "dropped":
        return False
    return not record.done or any(other.done and other.cell["number"] == record.cell["number"]
                                  and names - lost <= set(other.cell["contenders"]) < names for other in group)


def _rows(record):
    cell = record.cell
    for name in cell["contenders"]:
        found = record.output.get("rows", {}).get(f"{name if name.endswith(TWIN) else name.partition('+')[0]}/{cell['scene']}")
        status, reason = outcome(record, found)
        row = {"scene": cell["scene"], "implementation": name, "environment": cell["environment"], "process": cell["number"],
               "layout": cell.get("program", ""), "status": status, "reason": reason, "record": record.name}
        if status == "ok":
            samples = [one / found["steps"] for one in found["cpu_us"]]
            counters = {key: value for key, value in found.items() if isinstance(value, (int, float)) and key not in ("step_us", "iterations")}
            row = counters | row | {"step_us": median(samples), "low_us": min(samples), "high_us": max(samples),
                                    "samples": tuple(samples), "clock_us": median(found["stretch_us"]) / found["steps"]}
        yield row


def outcome(record, row):
    """(status, reason) of a contender: by its row of `mbs bench`, None if there is none, or by how the process ended."""
    if not record.done:
        return record.status, record.reason
    if row is not None and not row.get("error_occurred"):
        return "ok", ""
    message = "crashed: mbs bench gave no row of it" if row is None else row.get("error_message", "")
    kind, _, reason = message.partition(": ")
    return kind if kind in ("unsupported", "out-of-memory", "slower", "diverged", "crashed") else "failed", reason or message


def apart(rows, column="step_us"):
    """`rows` for ratios of processes that follow each other: their samples are of no common turns, so that `column`
    (of a process, its median) is compared. Processes of one number belong together."""
    return rows.assign(environment="", samples=[(one,) for one in rows[column]])


class Ratio(namedtuple("Ratio", "value low high chance freedom", defaults=(math.nan, math.nan))):
    """With its interval. `chance`: to find it so far from 1, or farther, where it is 1 (Student's, two-sided: nobody knows before who leads).
    `freedom`: degrees of it."""
    def columns(self, name="ratio", ends=""):
        return {name: self.value, f"{ends}low": self.low, f"{ends}high": self.high}


NONE = Ratio(math.nan, math.nan, math.nan)
NO_VARIANCE = (0.0, 1)


class Paired:
    """Samples of one scene's rows, by contender and process: what ratios are taken of. Whoever asks for many keeps it; `ratio` and `rank` take the
    rows themselves as well. `beyond`: a variance of the logarithm of a ratio that more processes do not lessen, and its degrees of freedom."""

    def __init__(self, rows, beyond=NO_VARIANCE):
        self.beyond = beyond
        self.logs = {}  # {name: {(environment, process): logarithms of samples}}
        good = rows[rows.status == "ok"]
        self.layouts = layouts_of(good)
        for name, environment, process, samples in zip(good.implementation, good.environment, good.process, good.samples):
            self.logs.setdefault(name, {})[environment, process] = numpy.log(samples)
        self.lost = set(rows[~rows.status.isin(["ok", "dropped"])].implementation)


def layouts_of(rows):
    """{process: its layout}; in sets without layouts each process stands for itself."""
    return {number: layout for number, layout in zip(rows.process, rows.layout) if str(layout).startswith("layouts/")} if "layout" in rows else {}


def paired(rows):
    return rows if isinstance(rows, Paired) else Paired(rows)


def ratio(rows, first, second):
    """Time of `first` over that of `second` in `rows` of one scene; NaN where they share no process. Of one
    layout, or process, there is no interval: it reaches from 0 to infinity."""
    rows = paired(rows)
    if not (logs := [numpy.mean(one) for one in by_layout(rows, log_ratios(rows, first, second))]):
        return NONE
    if len(logs) == 1:
        return Ratio(math.exp(logs[0]), 0.0, math.inf)
    middle, half, error, freedom = student(logs, *rows.beyond)
    chance = 2 * float(special.stdtr(freedom, -abs(middle) / error)) if error else float(middle == 0)
    return Ratio(*(math.exp(middle + shift) for shift in (0.0, -half, half)), chance, freedom)


def by_layout(rows, logs):
    """Of `log_ratios` those of each layout's processes."""
    return list(gather((rows.layouts.get(number, number), value) for number, value in logs.items()).values())


def student(values, more=0.0, of=1):
    """(mean, half of Student's interval, standard error, degrees of freedom) of two values or more, independent of each other. `more`: a
    further variance of the mean, which was found with `of` degrees of freedom; those of both together are Welch's and Satterthwaite's."""
    error, freedom = float(numpy.std(values, ddof=1)) / math.sqrt(len(values)), len(values) - 1
    if more:
        own, error = error, math.hypot(error, math.sqrt(more))
        freedom = int(error**4 / (own**4 / freedom + more**2 / of) + 1e-9)  # whole, for tables
    return float(numpy.mean(values)), special.stdtrit(freedom, (1 + CONFIDENCE) / 2) * error, error, freedom


def log_ratios(rows, first, second):
    """{process: logarithm of the ratio}. Contenders of different environments are compared through the ANCHOR, whose time does not depend on
    the environment. Where it was left out: through another variant that both have, never one of the two, as these may."""
    logs = paired(rows).logs
    mine, other = (logs.get(name, {}) for name in (first, second))
    direct = {key[1]: _median(mine[key], other[key]) for key in sorted(set(mine) & set(other))}
    if direct or not (mine and other):
        return direct
    environments = [next(iter(one))[0] for one in (mine, other)]
    there = [{name.partition("+")[0]: found for name, found in logs.items() if not name.endswith(TWIN) and any(key[0] == one for key in found)}
             for one in environments]
    shared = there[0].keys() & there[1].keys()
    anchor = ANCHOR if ANCHOR in shared else min(shared - {name.partition("+")[0] for name in (first, second)}, default=None)
    first, second = ({key[1]: _median(samples, known[anchor][key]) for key, samples in one.items() if key in known.get(anchor, ())}
                     for one, known in zip((mine, other), there))
    return {number: first[number] - second[number] for number in sorted(first.keys() & second.keys())}


def _median(first, second):
    """Of the logarithm of the ratio over the turns of a process: samples of one turn belong together."""
    count = min(len(first), len(second))
    ordered = numpy.sort(first[:count] - second[:count])  # numpy.median does the same, six times slower
    return float(ordered[(count - 1) // 2] + ordered[count // 2]) / 2


class Ranking(namedtuple("Ranking", "winner ratios untimed", defaults=((),))):
    """Who is fastest in a scene. `ratios`: {name: Ratio to the winner}, the fastest first. `untimed`: of whom it is not known how long they take."""
    second = property(lambda self: next((name for name in self.ratios if name != self.winner), None))
    margin = property(lambda self: self.ratios.get(self.second, NONE))
    # Whether the winner is shown to be faster than each other one.
    decided = property(lambda self: all(one.low > 1 for name, one in self.ratios.items() if name != self.winner))
    # To find the winner so far ahead where one of the others is as fast; NaN if there is no other.
    chance = property(lambda self: max((one.chance for name, one in self.ratios.items() if name != self.winner), default=math.nan))
    # The winner and all that are shown to take at most EQUIVALENT times its time.
    equivalent = property(lambda self: tuple(name for name, one in self.ratios.items() if name == self.winner or one.high <= EQUIVALENT))
    # Those of whom neither is shown: not that they are slower, not that they are as fast.
    open = property(lambda self: tuple(name for name, one in self.ratios.items() if name != self.winner and one.low <= 1 and one.high > EQUIVALENT))
    settled = property(lambda self: not self.open)  # whether it is said of each whether it is as fast as the winner
    # The equivalence set: the winner and all that are not shown to take more than EQUIVALENT times its time.
    inside = property(lambda self: tuple(name for name, chance in outside([self])[0].items() if chance > 1 - CONFIDENCE))


def error(ratio):
    """Standard error of a ratio's logarithm."""
    return math.log(ratio.high / ratio.low) / 2 / float(special.stdtrit(ratio.freedom, (1 + CONFIDENCE) / 2)) if ratio.high > ratio.low else 0.0


def behind(ratio, variance):
    """The chance to find it so far over EQUIVALENT, or farther, where it is not over it (Student's, one-sided). `variance`: beyond its interval,
    of its logarithm; that the intervals' degrees of freedom stay makes the chance larger."""
    if not (0 < ratio.low <= ratio.high < math.inf and ratio.value > EQUIVALENT):
        return 1.0
    own = math.hypot(error(ratio), math.sqrt(variance)) or 1e-9
    return float(special.stdtr(ratio.freedom, math.log(EQUIVALENT / ratio.value) / own))


def outside(rankings, variance=0.0):
    """Of each Ranking {contender: `behind`, where all that these say of a scene is asked at once [Holm]}. Twice, as nobody knows before who leads."""
    found, least = [dict.fromkeys(one.ratios, 1.0) for one in rankings], 0.0
    asked = sorted((behind(one, variance), place, name) for place, ranking in enumerate(rankings)
                   for name, one in ranking.ratios.items() if name != ranking.winner)
    for left, (chance, place, name) in zip(range(len(asked), 0, -1), asked):
        found[place][name] = least = max(least, 2 * left * chance)
    return found


def by_time(winner, ratios):
    """Ratios to the winner, which comes first; those that share no process with it last."""
    return dict(sorted(ratios.items(), key=lambda one: (one[0] != winner, one[1].value if one[1].value > 0 else math.inf)))


def rank(rows, names=None):
    """The Ranking of one scene's rows among `names` (all of their names); None if none of them was timed."""
    rows = paired(rows)
    if not (chosen := [name for name in rows.logs if (names is None or name in names) and name not in rows.lost]):
        return None
    to_first = {name: ratio(rows, name, chosen[0]).value for name in chosen}
    order = sorted((name for name in chosen if not math.isnan(to_first[name])), key=to_first.get)
    winner, tried = order[0], set()
    while True:  # they may share other processes with the winner than with the first
        ratios = {name: Ratio(1.0, 1.0, 1.0) if name == winner else ratio(rows, name, winner) for name in order}
        # Who shares no process with the winner is compared through the first, and nothing is claimed of it.
        ratios = {name: Ratio(to_first[name] / to_first[winner], 0.0, math.inf) if math.isnan(one.value) else one for name, one in ratios.items()}
        tried.add(winner)
        faster = min((name for name in order if name not in tried and ratios[name].value < 1), key=lambda name: ratios[name].value, default=None)
        if faster is None:
            return Ranking(winner, by_time(winner, ratios))
        winner = faster


def within(paired, first, second):
    """(low, high) of the ratio in these very layouts of the program, at this place of the fill: by what processes of one layout differ
    by, or, where each has one process, by its rounds. (NaN, NaN) where neither tells it."""
    groups = by_layout(paired, log_ratios(paired, first, second))
    if freedom := sum(map(len, groups)) - len(groups):
        variance = sum(float(numpy.var(one)) * len(one) for one in groups) / freedom
    else:
        _, variance = rounds(paired, first, second)
        freedom = 2 * len(groups)  # at least: a process tells it with three rounds or more
    if not variance:
        return math.nan, math.nan
    error = math.sqrt(variance * sum(1 / len(one) for one in groups)) / len(groups)
    middle = float(numpy.mean([numpy.mean(one) for one in groups]))
    half = float(special.stdtrit(freedom, (1 + CONFIDENCE) / 2)) * error
    return math.exp(middle - half), math.exp(middle + half)


def rounds(paired, first, second):
    """(variance of a round's logarithm of the ratio, variance of the median over a process's rounds), means over processes."""
    found = []
    for key in sorted(paired.logs[first].keys() & paired.logs[second].keys()):  # in one order: sums are the same to the last digit
        count = min(len(paired.logs[first][key]), len(paired.logs[second][key]))
        if count > 2:
            one = float(numpy.var(paired.logs[first][key][:count] - paired.logs[second][key][:count], ddof=1))
            found.append((one, math.pi / 2 * one / count))
    return tuple(map(float, numpy.mean(found, axis=0))) if found else (0.0, 0.0)


def holm(rows, *by):
    """Marks which rows stay decided when all that are alike in the columns `by` are asked at once [Holm 1979]: the chance of one false winner or
    more among them stays below 5 %."""
    for asked in gather((tuple(row[key] for key in by), row) for row in rows if not math.isnan(row.get("chance", math.nan))).values():
        for place, row in enumerate(sorted(asked, key=lambda row: row["chance"])):
            if row["chance"] > 0.05 / (len(asked) - place):
                break
            row["holm"] = row["decided"]
    return rows


def differing(rows):
    """{name: reason} of one scene: the passes over its stretch must be equal. The most common number among ranked
    contenders (others are copies of one code) stands; without one nobody can be trusted."""
    good = rows[(rows.status == "ok") & (rows.implementation != NULL)]
    totals = {name: set(values) for name, values in gather((row.implementation, row.passes) for row in good.itertuples()).items()}
    ranked = Counter(min(values) for name, values in totals.items() if len(values) == 1 and "+" not in name).most_common(2)
    right = None if not ranked or len(ranked) > 1 and ranked[0][1] == ranked[1][1] else ranked[0][0]
    text = lambda values: "/".join(f"{value:.0f}" for value in sorted(values))
    most = "and no number is that of most" if right is None else f"most others {text({right})}"
    return {name: f"{text(values)} passes over the stretch, {most}" for name, values in totals.items() if values != {right}}


def median(values):
    """Median of finite values; NaN if there is none or one is not finite. Of few numpy.median takes ten times as long."""
    known = [math.nan if value is None else float(value) for value in values]
    return statistics.median(known) if known and all(map(math.isfinite, known)) else math.nan


def power_law(sizes, times):
    """(exponent, low, high): slope of log(time) over log(size) by least squares, with Student's interval, whose width also says how far
    the times are from a power law; two sizes have no interval, one has nothing: NaN."""
    if len(sizes) < 2:
        return (numpy.nan,) * 3
    exponent = float(numpy.polyfit(numpy.log(sizes), numpy.log(times), 1)[0])
    if len(sizes) == 2:
        return exponent, numpy.nan, numpy.nan
    from scipy.stats import linregress
    half = special.stdtrit(len(sizes) - 2, (1 + CONFIDENCE) / 2) * linregress(numpy.log(sizes), numpy.log(times)).stderr
    return exponent, exponent - half, exponent + half
