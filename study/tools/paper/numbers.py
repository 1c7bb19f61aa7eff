# Every number of the paper by name, each a query on a table of the set, with the records behind it. A query gets Known and gives Number or
# None: then the paper prints "not measured", as it does for a text that says nothing.
import math
from collections import defaultdict, namedtuple

import numpy
import pandas
from scipy.stats import gmean

from analysis.accuracy import page as accuracy
from analysis.core import timing
from analysis.core.text import number, percent, span
from analysis.engines.equal_error import compared
from analysis.engines.page import medians
from analysis.extremes import page as extremes
from analysis.families import rule as rules
from analysis.families.figures import best_form, fastest_own
from analysis.map import carry, ledger, page as map_page, summary
from analysis.realtime import page as realtime
from study.core import profile as profiles
from study.tools.merge import agreement, machine

NOT_MEASURED = "not measured"
NOTHING = ("", "–", "nan")  # texts of what is not measured
DENSE, HYBRID = "eigen_dense/llt", "hybrid_dense/llt"  # Eigen's Cholesky kernels, assembled densely and sparsely
SCALAR, BLOCKS = "csc_ldl/uplooking", "csc_cholmod/supernodal"  # which works number by number; by calls of BLAS
GAINED = (SCALAR, "csc_klu/refactor", BLOCKS, HYBRID, "compiled_ldl/fronts")  # whose steps are compared between machines, on scenes in common


# text: as it is printed; table: "part/table", or the file that it comes from; records: names of records
Number = namedtuple("Number", "text table records", defaults=((),))


def numbers(known):
    """{name: Number}"""
    found = {}
    for query in (_set, _design, _gate, real, _size, _fill, _machines, _claims, _price, _rule, _error, _window, _latency, _own, _limits, _minutes):
        found |= {f"{query.__name__.lstrip('_')}.{name}": one for name, one in query(known).items()}
    return {name: one if one and one.text not in NOTHING else Number(NOT_MEASURED, one.table if one else "") for name, one in found.items()}


def of_rows(text, table, rows):
    """A Number of rows of a table, which name their records; None if there are no rows. `text` may be a function of the rows."""
    return Number(str(text(rows) if callable(text) else text), table, _records(rows)) if len(rows) else None


def each(table, rows, /, **texts):
    """`of_rows` of each text."""
    return {name: of_rows(text, table, rows) for name, text in texts.items()}


def count(rows, among, table):
    """The Number of rows; None if there are none that they might be `among`."""
    return Number(str(len(rows)), table, _records(rows)) if len(among) else None


def _records(rows):
    return tuple(dict.fromkeys(name for one in rows.record for name in str(one).split()))


def listed(names):
    """"a, b and c" """
    names = list(names)
    return " and ".join([", ".join(names[:-1]), names[-1]]) if len(names) > 1 else "".join(names)


def real_mechanisms(known):
    """Rows of the winners among libraries on mechanisms at their own fill, in the form that each is simulated in."""
    rows = best_form(known.tables("families")["winners"])
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
    return dict(sorted(found.items(), key=lambda one: (-len(one[1]), gmean(one[1]))))


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
    timed, table = tried[tried.status == "ok"], "tuning/alternatives"
    folders = {name.partition("/")[0] for name in registry.libraries}
    return {"libraries": Number(str(len(registry.libraries)), file), "folders": Number(str(len(folders)), file),
            "own": Number(str(len(registry.own)), file), "equal": Number(percent(timing.EQUIVALENT - 1), "analysis/core/timing.py"),
            "confidence": Number(percent(timing.CONFIDENCE), "analysis/core/timing.py"),
            "processes": of_rows(lambda rows: span(rows.processes), "families/scenes", scenes[scenes.processes.notna()]),
            "tried": of_rows(timed.alternative.nunique(), table, timed), "compared": count(timed, timed, table),
            "slower": count(timed[timed.low > 1], timed, table), "faster": count(timed[timed.high < 1], timed, table),
            "least": of_rows(lambda rows: number(rows.ratio.iloc[0]), table, timed.nsmallest(1, "ratio")),
            "controls": Number(_controls(known), ", ".join(f"{part}/controls" for part in machine.CONTROLLED), tuple(
                name for part in machine.CONTROLLED for name in _records(known.tables(part)["controls"]))),
            "spread": Number(_spread(known), "map/spread", _records(known.tables("map")["spread"]))}


def _controls(known):
    found = machine.controls(known)  # of all by which the set is judged
    if not found["pairs"]:
        return "No contender was timed against itself in this set, so how often it decides falsely is not measured."
    return (f"As a control, {found['pairs']} times a contender was timed against itself: {found['false']} were falsely decided; the ratio "
            f"furthest from one is {number(found['widest'])}." + ("" if found["sound"] else " This is more than chance allows: the set is no evidence."))


def _spread(known):
    rows = known.tables("map")["spread"]
    if rows.empty:
        return "Where the spread of a ratio comes from is not measured in this set."
    return "Of the spread of a ratio, as a standard deviation, " + listed(
        f"{carry.SOURCES.get(row.source, row.source)} alone make {number(row.percent, 2)} %" for row in rows.itertuples()) + "."


def _machines(known):
    """What the compared sets say together, and what makes their machines differ."""
    sets = known.compared or [known]
    shares = agreement.shares(agreement.mechanisms(sets, known.agreed))
    kinds = [*known.on_the_map.values()]
    verdicts = {"cells": len(kinds)} | {verdict: kinds.count(verdict) for verdict in ("decided", "several", "differs")}
    rates, gained = [machine.rates(one) for one in sets], machine.gains(sets, GAINED)
    beside = {name: [one[rate] / rates[0][rate] for one in rates[1:] if rate in one and rate in rates[0]]
              for name, rate in (("rate", "flops_per_ns"), ("latency", "add_ns"))}
    steps = {name: gained.get(variant, [])[1:] for name, variant in (("vector", HYBRID), ("scalar", SCALAR), ("blocks", BLOCKS))}
    told = [f"{one.folder.name} is {one.context['cpu_model']}, {one.facts['date'][:10]}" for one in sets]
    on = lambda values: listed(f"{number(value, 2)} on {one.folder.name}" for value, one in zip(values, sets[1:]))
    where, asked = "of " + ", ".join(one.folder.name for one in sets), {one.question.scene for one in known.agreed}
    told_by = lambda part, table: [f"{one.folder.name}/{name}" for one in sets for rows in [one.tables(part)[table]]
                                   for name in _records(rows[rows.scene.isin(asked)])]
    bounds = [f"{one.folder.name}/{record.name}" for one in sets for record in [machine.rated(one)] if record]
    found = {name: Number(text, f"{table} {where}", tuple(records)) for table, records, texts in (
        ("set.json", (), {"count": str(len(told)), "names": "; ".join(told), "first": sets[0].folder.name, "commit": sets[0].context["commit"][:10]}),
        ("families/scenes", told_by("families", "scenes"),
         {name: str(one) for name, one in shares.items()} | {name: on(one) for name, one in steps.items()}),
        ("map/tidy", told_by("map", "tidy"), {name: str(one) for name, one in verdicts.items()}),
        ("raw/limit", bounds, {name: on(one) for name, one in beside.items()})) for name, text in texts.items()}
    return found if known.compared else dict.fromkeys(found)


def _gate(known):
    found = {}
    for part, name, table in (("families", "scenes", known.tables("families")["scenes"]),
                              ("map", "verification", known.tables("map")["verification"].drop_duplicates(["scene", "implementation"]))):
        asked = table[~table.verdict.isin(["", "dropped"])]
        found |= {f"{part}_asked": count(asked, asked, f"{part}/{name}"),
                  f"{part}_agree": count(asked[asked.verdict == "agrees"], asked, f"{part}/{name}")}
    return found


def real(known):
    rows, lost = real_mechanisms(known), losses(known)
    winners, scenes = (known.tables("families")[name] for name in ("winners", "scenes"))
    saddle = winners[(winners.layer == "libraries") & (winners.scheme == "saddle-point") & (winners.winner != "") & ~winners.family.str.contains("filled")]
    leaders = led(rows)
    leader, single = next(iter(leaders), ""), next(iter(lost), "")
    taken = scenes[(scenes.implementation == single) & scenes.scene.isin([*lost.get(single, {}).keys()])]
    return (each("families/winners", rows, mechanisms=len(rows), families=rows.family.nunique(), least=number(rows.variables.min(), 5),
                 most=number(rows.variables.max(), 5), said=rows.settled.fillna(False).sum(), margin=number(rows.margin.median()), leader=leader,
                 leads=leaders.get(leader), shares=shares(leaders))
            | each("families/winners", saddle, saddle=shares(led(saddle)), saddle_of=len(saddle))
            | each("families/scenes", taken, single=single, single_on=lambda _: len(lost[single]), mean=lambda _: number(gmean(lost[single])),
                   worst=lambda _: number(lost[single].max()), where=lambda _: lost[single].idxmax()))


def shares(counts):
    """"a on 12 and b on 3" """
    return listed(f"{name} on {count}" for name, count in counts.items())


def _size(known):
    rows = known.tables("map")["cells"].loc[lambda rows: (rows.layer == "libraries") & rows.fill_asked.isna()]
    groups = summary.by_size(known.results, known.results.layer("libraries"))
    return each("map/cells", rows, outcome=" ".join(map_page.by_outcome(groups)), least=number(rows.variables.min(), 5),
                most=number(rows.variables.max(), 5))


def _fill(known):
    cells = known.tables("map")["cells"]
    rows = cells[(cells.layer == "libraries") & (cells.winner != "")]
    filled = rows[rows.fill_asked.notna()]
    hybrid = filled[filled.equivalent.str.contains(HYBRID.split("/")[0])]
    said, table = summary.settled(cells, "libraries"), "map/cells"
    found = {"cells": of_rows(said["cells"], table, rows), "decided": count(rows[rows.decided.astype(bool)], rows, table),
             "equal": of_rows(said["equivalent"], table, rows), "open": of_rows(said["open"], table, rows),
             "holm": count(rows[rows.holm.fillna(False).astype(bool)], rows[rows.chance.notna()], table), "filled": count(filled, rows, table),
             "hybrid": count(hybrid, filled, table)}
    timed = profiled(known)
    for name, variant in (("dense", DENSE), ("hybrid", HYBRID)):
        mine = timed[timed.implementation == variant]
        found[f"assembly_{name}"] = of_rows(lambda rows: percent(phases(rows.iloc[0])["assembly"]), "limit/steps", mine)
    both = {scene: one.value for scene in filled.scene for one in [known.results.versus(scene, DENSE, HYBRID)] if one}
    return found | {"profiled": of_rows(number(timed.variables.max()), "limit/steps", timed),
                    "faster": of_rows(lambda _: span(both.values()), "map/tidy", filled[filled.scene.isin(both)])}


def profiled(known):
    """Steps of the four-bar at its own fill that were timed phase by phase, at the largest size at which both of these were."""
    rows = known.tables("limit")["steps"].loc[lambda rows: (rows.form == "penalty") & (rows.status == "ok") & rows.assembly_us.notna()]
    sizes = [size for size, mine in rows.groupby("variables") if {DENSE, HYBRID} <= set(mine.implementation)]
    return rows[rows.variables == max(sizes)] if sizes else rows[:0]


def filled_by_phase(known):
    """Medians of the steps of filled four-bars that were timed phase by phase: a row a scene and implementation, times in µs."""
    rows = known.tables("map")["tidy"].loc[lambda rows: (rows.kind == "phases") & (rows.status == "ok") & rows.fill_asked.notna()]
    times = {f"{phase}_us": rows[f"phase_{phase}"] * rows.step_us for phase in timing.PHASES}
    by = ["scene", "variables", "fill_asked", "implementation"]
    return rows.assign(**times).groupby(by, as_index=False)[["step_us", *times]].median()


def phases(row):
    """{phase: share of the step}"""
    times = {phase: row[f"{phase}_us"] for phase in timing.PHASES}
    return {phase: one / sum(times.values()) for phase, one in times.items()}


def _claims(known):
    table = known.tables("map")["claims"]
    by_id = ledger.by_id(table)
    found = {verdict: [name for name, (one, _) in by_id.items() if one == verdict] for verdict in ledger.VERDICTS}
    counts = (f"{len(names)} {'are' if len(names) > 1 else 'is'} {verdict}" for verdict, names in found.items() if names)
    return each("map/claims", table, all=len(by_id), rows=len(table), counts=", ".join(counts), told=ledger.told(table))


def _price(known):
    whole = [row for row in summary.prices(known.results, known.results.layer("libraries")) if not row["failed"] and row["cells"] == row["of"]]
    first = whole[0] if whole else defaultdict(str)
    rows = known.tables("map")["cells"].loc[lambda rows: (rows.layer == "libraries") & (rows.winner != "")]
    return each("map/tidy", rows, single=first["implementation"], mean=number(first["mean"]), worst=number(first["worst"]), cells=first["of"])


def _rule(known):
    held, defaults = known.tables("families")["held"], known.tables("families")["defaults"]
    one = rules.summary(held) if len(held) else defaultdict(float)
    unknown = f" ({one['unknown']} choices were not timed and do not count)" if one["unknown"] else ""
    rows = defaults[defaults["mean"].notna()].sort_values("mean")
    elsewhere = pandas.concat([held[:0], *(other.tables("families")["held"] for other in known.compared[1:])]).nlargest(1, "loss")
    return each("families/held", held, mean=percent(one["mean_loss"], 1), worst=percent(one["worst_loss"]) + unknown, within=percent(one["within"]),
                families=one["families"], scenes=one["scenes"]) | {
        "elsewhere": of_rows(percent(elsewhere.loss.max()), "families/held", elsewhere), "carried": _carried(known, known.compared[1:]),
        "factor": Number(number(rules.WITHIN), "analysis/families/rule.py"),
        "defaults_least": of_rows(_default, "families/defaults", rows.head(1)), "defaults_most": of_rows(_default, "families/defaults", rows.tail(1))}


def _carried(known, others):
    """What the rule of the set costs on the other ones."""
    losses = {(one, *case): loss for one in others for case, loss in machine.carried(known, one).items() if loss == loss}
    if not losses:
        return None
    one, scheme, scene = max(losses, key=losses.get)
    rows = one.tables("families")["winners"].loc[lambda rows: (rows.scene == scene) & (rows.scheme == scheme) & (rows.layer == "libraries")]
    return of_rows(f"{percent(numpy.mean([*losses.values()]), 1)} longer than the fastest on average, {percent(max(losses.values()))} at worst",
                   "families/winners", rows)


def _default(rows):
    least = "at least " if rows.smaller.iloc[0] > 0 else ""
    return f"“{rows.rule.iloc[0]}” ({least}{number(rows['mean'].iloc[0])} times on average, {number(rows.worst.iloc[0])} at worst)"


def _error(known):
    won, pairs = accuracy.met(accuracy.own_fill(known.tables("accuracy")["winners"])), known.tables("accuracy")["pairs"]
    precision = accuracy.of_precision(pairs)
    return {"libraries": of_rows(lambda rows: accuracy.of_layer(rows, "libraries"), "accuracy/winners", won[won.layer == "libraries"]),
            "precision": of_rows(precision[0], "accuracy/pairs", pairs[pairs.kind == "precision"]) if precision else None}


def _window(known):
    rows, maps = known.tables("stability")["windows"], known.tables("stability")["maps"]
    rows = rows[(rows.precision == "double") & (abs(rows.step - 1.25e-3) < 1e-9) & (rows.status == "ok")]
    largest = rows.nlargest(1, "loops")
    found = each("stability/windows", largest, **{name: number(largest[name].max()) for name in ("loops", "lower", "upper")})
    tried = maps[(maps.penalty_asked != "auto") & (maps.precision == "double") & (maps.scheme == "penalty") & (maps.status != "dropped")]
    cells = tried.assign(good=tried.status == "ok").groupby(["loops", "step"]).good.agg(["count", "sum"])
    good = cells["sum"][cells["count"] == cells["count"].max()]  # of the largest size the budget may leave out some
    found |= each("stability/maps", tried, tried=cells["count"].max(), good_least=good.min(), good_most=good.max())
    automatic = maps[(maps.penalty_asked == "auto") & (maps.precision == "double") & (maps.status != "dropped")]
    for name, scheme in (("penalty", "penalty"), ("saddle", "saddle-point")):
        mine = automatic[automatic.scheme == scheme]
        found |= {f"{name}_ok": count(mine[mine.status == "ok"], mine, "stability/maps"), f"{name}_of": count(mine, mine, "stability/maps")}
    return found


def _latency(known):
    null = known.tables("realtime")["machine"].loc[lambda rows: rows.status == "done"]
    answers = realtime.answers(known.tables("realtime"), known.view("realtime"))
    said = " ".join(one["text"] for one in answers if one["text"].startswith("Steps of"))
    return each("realtime/machine", null, lost=number(null.lost.sum(), 5), gap=number(null.largest_us.max()), watched=number(null.seconds.sum())) | {
        "said": of_rows(said, "realtime/largest", known.tables("realtime")["largest"])}


def _own(known):
    ahead = fastest_own(known.tables("families")["scenes"], known.registry)
    equal = compared(known.tables("engines")["equal_error"], "library")
    batches = known.tables("limit")["batches"].loc[lambda rows: rows.status == "ok"]
    found = each("families/scenes", ahead, mechanisms=len(ahead), least=number(1 / ahead.to_rival.max()), most=number(1 / ahead.to_rival.min()),
                 middle=number(1 / ahead.to_rival.median()), names=shares(ahead.implementation.value_counts()))
    for name, chosen in (("few", batches.sets.min()), ("many", batches.sets.max())):
        mine = batches[batches.sets == chosen]
        found |= {f"{name}_sets": of_rows(number(chosen), "limit/batches", mine),
                  f"{name}_gain": of_rows(lambda rows: span(rows.gain), "limit/batches", mine)}
    return found | {"engines": count(equal, equal, "engines/equal_error"), "engines_ahead": count(equal[equal.low > 1], equal, "engines/equal_error"),
                    "engines_middle": of_rows(medians, "engines/equal_error", equal)}


def _limits(known):
    first, *_ = extremes.answers(known.tables("extremes"), known.view("extremes"))
    said = first["text"].partition(" Other false alarms:")[0]  # which the part's page names, run by run
    return {"extremes": of_rows(said.partition(" Silent wrongs:")[0], "extremes/battery", known.tables("extremes")["battery"])}


def _minutes(known):
    """Budgets, which a run does not exceed by much; set-up and build come to it."""
    seconds = {name: sum(part["seconds"] for part in profiles.load(name, []).parts.values()) for name in ("quick", "full")}
    return {name: Number(str(math.ceil(one / 60)), f"study/profiles/{name}.yaml") for name, one in seconds.items()}
