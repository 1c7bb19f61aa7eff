# Every number of the paper by name, each a query on a table of the set, with the records behind it.
#
# A query gets Known and gives Number or None: then the paper prints "not measured".
import math
from dataclasses import dataclass

import numpy
import yaml

from analysis.accuracy import sentences as accuracy
from analysis.core import timing
from analysis.core.files import ROOT
from analysis.core.text import number, span
from analysis.families import rule as rules
from analysis.families.figures import best_form, fastest_own
from analysis.map import carry, ledger, sentences as map_sentences, summary
from analysis.map.results import of
from study.tools.merge import agreement, machine

NOT_MEASURED = "not measured"
DENSE, HYBRID = "eigen_dense/llt", "hybrid_dense/llt"  # the same factorization, assembled densely and sparsely
SCALAR, BLOCKS = "csc_ldl/uplooking", "csc_cholmod/supernodal"  # which works number by number; by calls of BLAS


@dataclass(frozen=True)
class Number:
    text: str      # as it is printed
    table: str     # "part/table", or the file that it comes from
    records: tuple = ()  # names of records


def numbers(known):
    """{name: Number}"""
    found = {}
    for query in (_set, _design, _gate, real, _size, _fill, _machines, _claims, _price, _rule, _error, _window, _latency, _own, _limits,
                  _minutes):
        found |= {f"{query.__name__.lstrip('_')}.{name}": one for name, one in query(known).items()}
    return {name: Number(one.text, one.table, tuple(dict.fromkeys(one.records))) if isinstance(one, Number) and one.text not in ("", "–", "nan") else Number(NOT_MEASURED, one.table if one else "")
            for name, one in found.items()}


def of_rows(text, table, rows):
    """A Number of rows of a table, which name their records."""
    names = [name for one in rows.record for name in str(one).split()]
    return Number(str(text), table, tuple(dict.fromkeys(names)))


def percent(value, digits=0):
    return "–" if value is None or math.isnan(value) else f"{100 * value:.{digits}f} %"


def listed(names):
    """"a, b and c" """
    names = list(names)
    return " and ".join([", ".join(names[:-1]), names[-1]]) if len(names) > 1 else "".join(names)


def real_mechanisms(known):
    """Rows of the winners among libraries on mechanisms at their own fill, in the form that each is simulated in."""
    rows = best_form(known.tables("families")["winners"], "libraries")
    return rows[~rows.family.str.contains("filled")]


def led(rows):
    """{library: mechanisms on which it is first or as fast}, most first."""
    return rows.equivalent.str.split().explode().value_counts(sort=True).to_dict()


def losses(known):
    """{library: times over the fastest on real mechanisms, by scene}, those with a time on most mechanisms first, then the least
    mean. Who was only looked at counts with that."""
    scenes, mine = known.tables("families")["scenes"], real_mechanisms(known)
    rows = scenes.merge(mine[["scene", "scheme", "winner"]], on=["scene", "scheme"])
    first = rows[rows.implementation == rows.winner].set_index("scene").look_us
    rough = (rows.look_us / rows.scene.map(first)).where(rows.status == "slower")
    rows = rows.assign(ratio=rows.to_rival.where(rows.status == "ok").fillna(rough).clip(lower=1))
    rows = rows[rows.ratio.notna() & rows.implementation.isin(known.registry.libraries)]
    found = {name: one.set_index("scene").ratio for name, one in rows.groupby("implementation")}
    return dict(sorted(found.items(), key=lambda one: (-len(one[1]), mean(one[1]))))


def mean(ratios):
    """Geometric."""
    return float(numpy.exp(numpy.mean(numpy.log(ratios))))


def _set(known):
    file = f"{known.folder.name}/set.json"
    context = known.context
    return {name: Number(str(text), file) for name, text in (
        ("name", known.folder.name), ("date", known.facts["date"][:10]), ("commit", context["commit"][:10]), ("machine", context["cpu_model"]),
        ("cores", context["num_cpus"]), ("kernel", context["kernel"]), ("compiler", context["compiler"]), ("flags", context["flags"]),
        ("profile", known.facts["profile"]), ("libraries", ", ".join(known.registry.versions)))}


def _design(known):
    registry, file = known.registry, f"{known.folder.name}/registry.json"
    scenes, tried = known.tables("families")["scenes"], known.tables("tuning")["alternatives"]
    processes, timed = scenes.processes.dropna(), tried[tried.status == "ok"]
    return {"libraries": Number(str(len(registry.libraries)), file), "own": Number(str(len(registry.own)), file),
            "equal": Number(f"{100 * (timing.EQUIVALENT - 1):.0f} %", "analysis/core/timing.py"),
            "confidence": Number(f"{100 * timing.CONFIDENCE:.0f} %", "analysis/core/timing.py"),
            "processes": of_rows(span(processes), "families/scenes", scenes[scenes.processes.notna()]) if len(processes) else None,
            "tried": of_rows(timed.alternative.nunique(), "tuning/alternatives", timed),
            "compared": of_rows(len(timed), "tuning/alternatives", timed),
            "slower": of_rows((timed.low > 1).sum(), "tuning/alternatives", timed[timed.low > 1]),
            "faster": of_rows((timed.high < 1).sum(), "tuning/alternatives", timed[timed.high < 1]),
            "least": of_rows(number(timed.ratio.min()), "tuning/alternatives", timed.nsmallest(1, "ratio")) if len(timed) else None,
            "controls": of_rows(_controls(known), "map/controls", known.tables("map")["controls"]),
            "spread": Number(_spread(known), "map/spread")}


def _controls(known):
    found = carry.judged(known.tables("map")["controls"])
    if not found["pairs"]:
        return "No contender was timed against itself in this set, so how often it decides falsely is not measured."
    return (f"As a control, {found['pairs']} times a contender was timed against itself: {found['false']} were decided, which is false; the ratio "
            f"furthest from one is {number(found['widest'])}." + ("" if found["sound"] else " This is more than chance allows: the set is no evidence."))


def _spread(known):
    rows = known.tables("map")["spread"]
    if rows.empty:
        return "Where the spread of a ratio comes from is not measured in this set."
    return "Of the spread of a ratio, as a standard deviation, " + listed(
        f"{carry.SOURCES.get(row.source, row.source)} alone make {number(row.percent, 2)} %" for row in rows.itertuples()) + "."


def _machines(known):
    """What machines say together, and what makes them differ."""
    if not known.others:
        return dict.fromkeys(("count", "names", "all", "same", "common", "differ", "cells", "decided", "several", "differs", "rate", "latency", "vector",
                              "scalar", "blocks"))
    count = agreement.shares(agreement.mechanisms(known.machines, known.agreed))
    kinds = [one.verdict for one in known.agreed if one.question.part == "map"]
    verdicts = {"cells": len(kinds)} | {verdict: kinds.count(verdict) for verdict in ("decided", "several", "differs")}
    rates, gained = [machine.rates(one) for one in known.machines], machine.gains(known.machines)
    beside = {name: [one[rate] / rates[0][rate] for one in rates[1:] if rate in one and rate in rates[0]]
              for name, rate in (("rate", "flops_per_ns"), ("latency", "add_ns"))}
    steps = {name: gained.get(variant, [])[1:] for name, variant in (("vector", HYBRID), ("scalar", SCALAR), ("blocks", BLOCKS))}
    told = [f"{one.folder.name} is {one.context['cpu_model']}, {one.facts['date'][:10]}" for one in known.machines]
    on = lambda values: listed(f"{number(value, 2)} on {one.folder.name}" for value, one in zip(values, known.others))
    where = "of " + ", ".join(one.folder.name for one in known.machines)
    return {name: Number(text, f"{table} {where}") for table, found in (
        ("set.json", {"count": str(len(told)), "names": "; ".join(told)}),
        ("families/scenes", {name: str(one) for name, one in count.items()} | {name: on(one) for name, one in steps.items()}),
        ("map/tidy", {name: str(one) for name, one in verdicts.items()}),
        ("raw/limit", {name: on(one) for name, one in beside.items()})) for name, text in found.items()}


def _gate(known):
    found = {}
    for part, name, table in (("families", "scenes", known.tables("families")["scenes"]),
                              ("map", "verification", known.tables("map")["verification"].drop_duplicates(["scene", "implementation"]))):
        asked = table[~table.verdict.isin(["", "dropped"])]
        found |= {f"{part}_asked": of_rows(len(asked), f"{part}/{name}", asked),
                  f"{part}_agree": of_rows((asked.verdict == "agrees").sum(), f"{part}/{name}", asked[asked.verdict == "agrees"])}
    return found


def real(known):
    rows, table = real_mechanisms(known), "families/winners"
    if rows.empty:
        return dict.fromkeys(("mechanisms", "families", "least", "most", "said", "margin", "leader", "leads", "shares", "saddle", "saddle_of", "single", "single_on", "mean", "worst", "where"))
    said = rows[rows.decided.fillna(False).astype(bool) | rows.settled.fillna(False).astype(bool)]
    leaders = led(rows)
    leader = next(iter(leaders))
    winners = known.tables("families")["winners"]
    saddle = winners[(winners.layer == "libraries") & (winners.scheme == "saddle-point") & (winners.winner != "") & ~winners.family.str.contains("filled")]
    lost = losses(known)
    single = next(iter(lost))
    found = {"mechanisms": len(rows), "families": rows.family.nunique(), "least": number(rows.variables.min(), 5),
             "most": number(rows.variables.max(), 5), "said": len(said), "margin": number(rows.margin.median()), "leader": leader, "leads": leaders[leader],
             "shares": listed(f"{name} on {count}" for name, count in leaders.items())}
    found = {name: of_rows(one, table, rows) for name, one in found.items()}
    found |= {"saddle": of_rows(listed(f"{name} on {count}" for name, count in led(saddle).items()), table, saddle),
              "saddle_of": of_rows(len(saddle), table, saddle)}
    ratios = lost[single]
    chosen = known.tables("families")["scenes"]
    chosen = chosen[(chosen.implementation == single) & chosen.scene.isin(ratios.index)]
    return found | {name: of_rows(text, "families/scenes", chosen) for name, text in (
        ("single", single), ("single_on", len(ratios)), ("mean", number(mean(ratios))), ("worst", number(ratios.max())),
        ("where", ratios.idxmax()))}


def _size(known):
    results = of(known.tables("map"), known.view("map"))
    cells = known.tables("map")["cells"]
    own_fill = cells[(cells.layer == "libraries") & cells.fill_asked.isna()]
    groups = summary.by_size(results, results.layer("libraries"))
    return {"outcome": of_rows(" ".join(map_sentences.by_outcome(groups)), "map/cells", own_fill) if groups else None,
            "least": of_rows(number(own_fill.variables.min(), 5), "map/cells", own_fill),
            "most": of_rows(number(own_fill.variables.max(), 5), "map/cells", own_fill)}


def _fill(known):
    results, cells = of(known.tables("map"), known.view("map")), known.tables("map")["cells"]
    rows = cells[(cells.layer == "libraries") & (cells.winner != "")]
    filled = rows[rows.fill_asked.notna()]
    hybrid = filled[filled.equivalent.str.contains(HYBRID.split("/")[0])]
    count = summary.settled(cells, "libraries")
    found = {"cells": of_rows(count["cells"], "map/cells", rows), "decided": of_rows(count["decided"], "map/cells", rows[rows.decided.astype(bool)]),
             "equal": of_rows(count["equivalent"], "map/cells", rows), "open": of_rows(count["open"], "map/cells", rows),
             "holm": _holm(rows), "filled": of_rows(len(filled), "map/cells", filled),
             "hybrid": of_rows(len(hybrid), "map/cells", hybrid)}
    rows = profiled(known)
    for name, variant in (("dense", DENSE), ("hybrid", HYBRID)):
        mine = rows[rows.implementation == variant]
        found |= {f"assembly_{name}": of_rows(percent(phases(mine.iloc[0])["assembly"]), "limit/steps", mine) if len(mine) else None}
    return found | {"profiled": of_rows(number(rows.variables.max()), "limit/steps", rows) if len(rows) else None, "faster": _hybrid(results, filled)}


def profiled(known):
    """Rows of steps of the four-bar at its own fill that were timed phase by phase, at the largest size at which both of the same
    factorization were."""
    rows = known.tables("limit")["steps"]
    rows = rows[(rows.form == "penalty") & (rows.status == "ok") & rows.assembly_us.notna()]
    sizes = [size for size, mine in rows.groupby("variables") if {DENSE, HYBRID} <= set(mine.implementation)]
    return rows[rows.variables == max(sizes)] if sizes else rows[:0]


def phases(row):
    """{phase: share of the step}"""
    times = {phase: row[f"{phase}_us"] for phase in timing.PHASES}
    return {phase: one / sum(times.values()) for phase, one in times.items()}


def _holm(rows):
    if rows.chance.isna().all():
        return None
    kept = rows[rows.holm.fillna(False).astype(bool)]
    return of_rows(len(kept), "map/cells", kept)


def _hybrid(results, filled):
    """How many times as fast as with a dense assembly, over filled scenes that both were timed on."""
    found = {scene: one for scene in filled.scene for one in [results.ratio(scene, DENSE, HYBRID)] if one}
    rows = filled[filled.scene.isin(found)]
    return of_rows(span([one.value for one in found.values()]), "map/tidy", rows) if found else None


def _claims(known):
    table = known.tables("map")["claims"]
    by_id = ledger.by_id(table)
    found = {verdict: [name for name, (one, _) in by_id.items() if one == verdict] for verdict in ledger.VERDICTS}
    return {"all": of_rows(len(by_id), "map/claims", table), "rows": of_rows(len(table), "map/claims", table),
            "counts": of_rows(", ".join(f"{len(names)} {'are' if len(names) > 1 else 'is'} {verdict}" for verdict, names in found.items() if names),
                              "map/claims", table),
            "told": of_rows(ledger.told(table), "map/claims", table)}


def _price(known):
    results = of(known.tables("map"), known.view("map"))
    whole = [row for row in summary.prices(results, results.layer("libraries")) if not row["failed"] and row["cells"] == row["of"]]
    if not whole:
        return dict.fromkeys(("single", "mean", "worst", "cells"))
    first = whole[0]
    rows = known.tables("map")["cells"]
    rows = rows[(rows.layer == "libraries") & (rows.winner != "")]
    return {name: of_rows(text, "map/tidy", rows) for name, text in (("single", first["implementation"]), ("mean", number(first["mean"])),
                                                                     ("worst", number(first["worst"])), ("cells", first["of"]))}


def _rule(known):
    held, defaults = known.tables("families")["held"], known.tables("families")["defaults"]
    names = ("mean", "worst", "within", "families", "scenes")
    if held.empty:
        found = dict.fromkeys(names)
    else:
        one = rules.summary(held)
        worst = percent(one["worst_loss"]) + (f" ({one['unknown']} choices were not timed and do not count)" if one["unknown"] else "")
        found = {name: of_rows(text, "families/held", held) for name, text in zip(names, (
            percent(one["mean_loss"], 1), worst, percent(one["within"]), one["families"], one["scenes"]))}
    rows = defaults[defaults["mean"].notna()].sort_values("mean")
    ends = {"least": rows.head(1), "most": rows.tail(1)}
    return found | {"factor": Number(number(rules.WITHIN), "analysis/families/rule.py")} | {f"defaults_{name}": of_rows(
        f"{one.rule.iloc[0]}: {number(one['mean'].iloc[0])} times on average, {number(one.worst.iloc[0])} at worst", "families/defaults", one)
        if len(one) else None for name, one in ends.items()}


def _error(known):
    won = accuracy.met(accuracy.own_fill(known.tables("accuracy")["winners"]))
    mine, pairs = won[won.layer == "libraries"], known.tables("accuracy")["pairs"]
    precision = accuracy.of_precision(pairs)
    return {"libraries": of_rows(accuracy.of_layer(mine, "libraries"), "accuracy/winners", mine) if len(mine) else None,
            "precision": of_rows(precision[0], "accuracy/pairs", pairs[pairs.kind == "precision"]) if precision else None}


def _window(known):
    rows, maps = known.tables("stability")["windows"], known.tables("stability")["maps"]
    rows = rows[(rows.precision == "double") & (abs(rows.step - 1.25e-3) < 1e-9) & (rows.status == "ok")]
    largest = rows.nlargest(1, "loops")
    found = {name: of_rows(number(largest[name].iloc[0]), "stability/windows", largest) if len(largest) else None
             for name in ("loops", "lower", "upper")}
    automatic = maps[(maps.penalty_asked == "auto") & (maps.precision == "double") & (maps.status != "dropped")]
    for scheme, mine in (("penalty", automatic[automatic.scheme == "penalty"]), ("saddle", automatic[automatic.scheme == "saddle-point"])):
        found |= {f"{scheme}_ok": of_rows((mine.status == "ok").sum(), "stability/maps", mine[mine.status == "ok"]),
                  f"{scheme}_of": of_rows(len(mine), "stability/maps", mine)}
    return found


def _latency(known):
    tables = known.tables("realtime")
    null = tables["machine"][tables["machine"].status == "done"]
    found = {"lost": of_rows(number(null.lost.sum(), 5), "realtime/machine", null), "gap": of_rows(
        number(null.largest_us.max()), "realtime/machine", null), "watched": of_rows(number(null.seconds.sum()), "realtime/machine", null)}
    return found | {"said": of_rows(" ".join(one for one in known.said("realtime") if one.startswith("Steps of")), "realtime/largest", tables["largest"])}


def _own(known):
    ahead = fastest_own(known.tables("families")["scenes"], known.registry)
    found = {"mechanisms": of_rows(len(ahead), "families/scenes", ahead),
             "least": of_rows(number(1 / ahead.to_rival.max()), "families/scenes", ahead),
             "most": of_rows(number(1 / ahead.to_rival.min()), "families/scenes", ahead),
             "middle": of_rows(number(1 / ahead.to_rival.median()), "families/scenes", ahead),
             "names": of_rows(listed(f"{name} on {count}" for name, count in ahead.implementation.value_counts().items()), "families/scenes", ahead)}
    batches = known.tables("limit")["batches"]
    batches = batches[batches.status == "ok"]
    for name, chosen in (("few", batches.sets.min()), ("many", batches.sets.max())):
        mine = batches[batches.sets == chosen]
        found |= {f"{name}_sets": of_rows(number(chosen), "limit/batches", mine) if len(mine) else None,
                  f"{name}_gain": of_rows(span(mine.gain), "limit/batches", mine) if len(mine) else None}
    equal = known.tables("engines")["equal_error"]
    equal = equal[(equal.side == "library") & equal.ratio.notna()]
    return found | {"engines": of_rows(len(equal), "engines/equal_error", equal), "engines_ahead": of_rows(
        (equal.low > 1).sum(), "engines/equal_error", equal[equal.low > 1]), "engines_middle": of_rows(
        number(equal.ratio.median(), 2), "engines/equal_error", equal)}


def _limits(known):
    battery = known.tables("extremes")["battery"]
    said = " ".join(known.said("extremes")[:1]).partition(" Other false alarms:")[0]  # which the part's page names, run by run
    return {"extremes": of_rows(said.partition(" Silent wrongs:")[0], "extremes/battery", battery)}


def _minutes(known):
    """Budgets, which a run does not exceed by much; set-up and build come to it."""
    found = {}
    for name in ("quick", "full"):
        path = ROOT / "study" / "profiles" / f"{name}.yaml"
        parts = yaml.safe_load(path.read_text(encoding="utf-8"))["parts"]
        found[name] = Number(f"{math.ceil(sum(part['seconds'] for part in parts.values()) / 60):d}", f"study/profiles/{name}.yaml")
    return found
