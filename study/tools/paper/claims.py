# What the paper claims, and whether the set says so: the build stops at a claim that does not hold (\holds), and chooses the
# sentence that fits where the paper has one for each outcome (\either).
import math
from collections import namedtuple
from operator import eq, itemgetter

from scipy.stats import gmean

from analysis.accuracy import pairs
from analysis.core.text import between, bounded, number, percent, span
from analysis.engines.equal_error import compared
from analysis.families import bounds, rule
from analysis.families.figures import fastest_own
from analysis.limit import held as limits
from study.tools.merge import agreement, machine
from study.tools.paper.numbers import DENSE, GAINED, HYBRID, SCALAR, filled_by_phase, losses, phases, profiled, real_mechanisms

PAPER_PENALTY = 1e8  # the factor of 2008, at 1.25 ms


# text: what is claimed; part: whose run tells; where: its section's label in the paper; found: Known → (whether it holds, None if nothing was
# measured; what a run should give); merged: study/merge tells, from the sets of several machines.
Claim = namedtuple("Claim", "name text part where found merged", defaults=(False,))


def claims():
    return (Claim("agree", "Whoever is ranked on a mechanism agrees with the reference", "families", "method", lambda known: _counted(
            known.tables("families")["scenes"].loc[lambda rows: (rows.status == "ok") & rows.to_rival.notna()].verdict == "agrees",
            eq, "{count} of {total} agree")),
        Claim("sparse", "On most mechanisms at their own fill the fastest library is a sparse one", "families", "real", lambda known: _counted(
            ~real_mechanisms(known).winner.isin(known.registry.dense), lambda count, total: 2 * count > total,
            "more than half; here {count} of {total}")),
        Claim("single", "The best single library is within 1.3 times of the fastest on average over mechanisms", "families", "real", _single),
        Claim("assembly", "Sparse assembly makes dense Cholesky faster in every filled cell", "map", "fill", _assembly),
        Claim("overtakes", "Somewhere a dense factorization is as fast as the fastest library, or it is that one", "map", "fill", _overtakes),
        Claim("phases", "Once assembly is sparse, most of a step with dense Cholesky at the own fill is its factorization", "limit", "fill", _phases),
        Claim("filled", "Once assembly is sparse, most of a step with dense Cholesky is its factorization in filled cells, too",
              "map", "fill", _filled),
        Claim("compared", "Sets of several processors are stored, of one commit and build", "families", "machines", lambda known: (
            True if known.compared else None, f"two or more; here {', '.join(one.folder.name for one in known.compared) or 'one'}"), True),
        Claim("machines", "On nine of ten mechanisms one library is fastest, or not shown to be over 5 % slower, on every processor compared",
              "families", "machines", _machines, True),
        Claim("vector", "On processors whose widest vectors do more, dense kernels gain more than code that works number by number",
              "limit", "machines", _vector, True),
        Claim("rule", "The rule keeps its bounds on families left out, on each machine", "families", "price", _rule),
        Claim("automatic", "The automatic penalty factor is ok in every cell of size and step", "stability", "window", lambda known: _counted(
            known.tables("stability")["maps"].loc[lambda rows: (rows.penalty_asked == "auto") & (rows.precision == "double")
                                                  & (rows.status != "dropped")].status == "ok", eq, "all; here {count} of {total}")),
        Claim("cautious", "The estimated lower end is cautious: somewhere a smaller factor is ok as well", "stability", "window", _cautious),
        Claim("below", "At the largest size and the step of 2008 the factor of 2008 lies below the estimated window", "stability", "window",
              _of_2008(lambda one: PAPER_PENALTY < one.lower, "the window begins above {factor}; here at {lower}")),
        Claim("open", "At the largest size and the step of 2008 the estimated window of the penalty form is open", "stability", "window",
              _of_2008(lambda one: one.lower < one.upper, "its lower end is below its upper one; here {lower} and {upper}")),
        Claim("mixed", "Mixed precision is nowhere shown to gain a fifth at the same error class", "accuracy", "error", _mixed),
        Claim("compiled", "The fastest code of our own is shown to be faster than the fastest library on every mechanism", "families", "own", _compiled),
        Claim("batches", "Batches have the gain that was asked of them", "limit", "own", _batches),
        Claim("engines", "No engine is shown to be faster at equal error than the fastest library", "engines", "own", _engines),
        Claim("quiet", "The machine itself lost no deadline", "realtime", "latency", _quiet))


def _counted(good, wanted, text):
    """(whether as many rows are good as is wanted, None without rows; the text with both numbers)"""
    count, total = int(good.sum()), len(good)
    return (wanted(count, total) if total else None), text.format(count=count, total=total)


def extreme(ratios, most=False):
    """Of [(value, low, high)] the one with the least lower end, or the largest upper one; and how many have no interval."""
    known = [one for one in ratios if bounded(*one[1:])]
    said = [between(*(max(known, key=itemgetter(2)) if most else min(known, key=itemgetter(1))))] if known else []
    return "; ".join(said + [f"{len(ratios) - len(known)} not bounded"] * (len(known) < len(ratios)))


def _single(known):
    name, ratios = next(iter(losses(known).items()), ("", None))
    if not name:
        return None, ""
    rows = known.tables("families")["scenes"].loc[lambda rows: rows.implementation == name].merge(real_mechanisms(known)[["scene", "scheme"]])
    rows = rows.set_index("scene").reindex(ratios.index).replace([0, math.inf], math.nan)
    ends = (gmean(rows[end].fillna(ratios)) for end in ("to_rival_low", "to_rival_high"))
    return gmean(ratios) <= 1.3, f"at most 1.3; here {name} {between(gmean(ratios), *ends, more=', of all ends')}"


def _assembly(known):
    cells = known.tables("map")["cells"]
    scenes = cells[(cells.layer == "libraries") & cells.fill_asked.notna()].scene
    found = [one[:3] for one in (known.results.versus(scene, DENSE, HYBRID) for scene in scenes) if one]
    return (min(low for _, low, _ in found) > 1, f"above 1; here at least {extreme(found)}") if found else (None, "")


def _overtakes(known):
    cells = known.tables("map")["cells"]
    equivalent = cells[(cells.layer == "libraries") & (cells.winner != "")].equivalent
    dense = equivalent.str.split().map(lambda names: not known.registry.dense.isdisjoint(names)).astype(bool)
    return _counted(dense, lambda count, _: count > 0, "at least one cell; here {count} of {total}")


def _phases(known):
    rows = profiled(known).loc[lambda rows: rows.implementation == HYBRID]
    share = phases(rows.iloc[0])["factorization"] if len(rows) else None
    return (None, "") if share is None else (share > 0.5, f"more than half; here {percent(share)}")


def _filled(known):
    rows = filled_by_phase(known).loc[lambda rows: rows.implementation == HYBRID]
    shares = [phases(row)["factorization"] for _, row in rows.iterrows()]
    return (min(shares) > 0.5, f"more than half; here {percent(min(shares))} or more") if shares else (None, "")


def _machines(known):
    count = agreement.shares(agreement.mechanisms(known.compared, known.agreed))
    kept = count["same"] + count["common"]
    return (10 * kept >= 9 * count["all"] if count["all"] else None), f"nine of ten; here {kept} of {count['all']}" if known.compared else ""


def _vector(known):
    """Of each other machine: whether the one with the higher rate is the one where the dense step gained more than the scalar one."""
    if not known.compared:
        return None, ""
    gained, rates = machine.gains(known.compared, GAINED), [machine.rates(one).get("flops_per_ns") for one in known.compared]
    if None in rates or HYBRID not in gained or SCALAR not in gained:
        return None, ""
    dense = [vector / scalar for vector, scalar in zip(gained[HYBRID][1:], gained[SCALAR][1:])]
    return (all((one < 1) == (rate > rates[0]) for one, rate in zip(dense, rates[1:])),
            f"time of the dense step over the other's falls where the rate rises; here {span(dense)} times, rates {span(rates)} operations a ns")


def _rule(known):
    """Also of the rules that the sets of other processors give."""
    held = [one.tables("families")["held"] for one in known.sets]
    if any(map(len, held)) and all(map(len, held)):
        found = [rule.summary(one) for one in held]
        kept = all(one["mean_loss"] <= bounds.MEAN and one["worst_loss"] <= rule.MUCH and one["within"] >= bounds.SHARE for one in found)
        said = " and ".join(f"{percent(one['mean_loss'])}, {percent(one['worst_loss'])}, {percent(one['within'])}" for one in found)
        return kept, f"mean loss at most {percent(bounds.MEAN)}, worst {percent(rule.MUCH)}, {percent(bounds.SHARE)} of the times; here {said}"
    return None, ""


def _of_2008(holds, text):
    """Of the estimated window of the largest size at the step of 2008."""
    def found(known):
        rows = known.tables("stability")["windows"].loc[
            lambda rows: (rows.precision == "double") & (abs(rows.step - 1.25e-3) < 1e-9) & rows.lower.notna()]
        for one in rows.nlargest(1, "loops").itertuples():
            return bool(holds(one)), text.format(factor=number(PAPER_PENALTY), lower=number(one.lower), upper=number(one.upper))
        return None, ""
    return found


def _cautious(known):
    tables = known.tables("stability")
    rows = tables["maps"].merge(tables["windows"][["loops", "step", "precision", "lower"]], on=["loops", "step", "precision"])
    rows = rows[(rows.scheme == "penalty") & (rows.precision == "double") & (rows.penalty_asked != "auto") & (rows.status != "dropped")]
    below = rows[rows.penalty_asked.astype(float) < rows.lower]
    return _counted(below.status == "ok", lambda count, _: count > 0, "at least one run; here {count} of {total} below")


def _mixed(known):
    rows = pairs.shown(known.tables("accuracy")["pairs"].loc[lambda rows: (rows.kind == pairs.PRECISION) & rows.second.str.contains("mixed")])
    return _counted(rows.index.isin(pairs.gains(rows).index), lambda count, _: count == 0,
                    "none; here {count} of {total} of the same class that have an interval" + _least(rows))


def _least(rows):
    return f", the least time over the other's {extreme([*zip(rows.ratio, rows.low, rows.high)])}" if len(rows) else ""


def _compiled(known):
    rows = fastest_own(known.tables("families")["scenes"], known.registry)
    found = [*zip(rows.to_rival, rows.to_rival_low, rows.to_rival_high)]
    said = f"time over the library's below 1; here up to {extreme(found, most=True)}, {{count}} of {{total}} shown" if found else ""
    return _counted(rows.to_rival_high < 1, eq, said)


def _batches(known):
    rows = known.tables("limit")["held"].loc[lambda rows: rows.what.str.contains("batches") & (rows.verdict != limits.NOT_MEASURED)]
    verdicts = set(rows.verdict)  # what is held where it was measured is not known of all
    return (True if verdicts == {limits.HELD} else None if verdicts <= {limits.HELD, limits.PARTLY} else False), "; ".join(
        f"{row.sign} {number(row.bound)}; here {between(row.worst, row.low, row.high)}" for row in rows.itertuples())


def _engines(known):
    rows = compared(known.tables("engines")["equal_error"], "library").loc[lambda rows: rows.high < math.inf]
    return _counted(rows.high < 1, lambda count, _: count == 0,
                    "none; here {count} of {total} comparisons that have an interval" + _least(rows))


def _quiet(known):
    rows = known.tables("realtime")["machine"].loc[lambda rows: rows.status == "done"]
    return (bool(rows.lost.sum() == 0) if len(rows) else None), f"0; here {number(rows.lost.sum(), 5)} in {number(rows.seconds.sum())} s"
