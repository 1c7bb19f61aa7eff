# The paper's tables, as LaTeX, from tables of the set.
import math
import re
from textwrap import shorten

import pandas
from scipy.stats import gmean

from analysis.core.gather import gather
from analysis.core.text import between, bounded, ends, number
from analysis.engines.equal_error import SIDES, lacking
from analysis.engines.figures import title
from analysis.engines.runs import NATIVE
from analysis.families import bounds
from analysis.families.figures import best_form, fastest_own
from analysis.families.page import cases
from analysis.map import ledger, summary
from study.tools.merge import machine
from study.tools.paper.numbers import GAINED, led, losses, real, real_mechanisms

ESCAPED = {"\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "--": r"-{}-", "#": r"\#", "_": r"\_", "{": r"\{", "}": r"\}", "~": r"\textasciitilde{}",
           "^": r"\textasciicircum{}", "$": r"\$", "<": r"\textless{}", ">": r"\textgreater{}", "/": r"/\allowbreak{}", ":": r":\allowbreak{}", "@": r"@\allowbreak{}", "µ": r"\textmu{}", "÷": r"\(\div\)", "×": r"\(\times\)", "≥": r"\(\ge\)",
           "≤": r"\(\le\)", "→": r"\(\to\)", "≈": r"\(\approx\)", "α": r"\(\alpha\)", "Δ": r"\(\Delta\)", "Φ": r"\(\Phi\)", "λ": r"\(\lambda\)", "·": r"\(\cdot\)",
           "⁻": r"\textsuperscript{\(-\)}"} | {raised: rf"\textsuperscript{{{digit}}}" for digit, raised in enumerate("⁰¹²³⁴⁵⁶⁷⁸⁹")}


def tex(text):
    """A text as LaTeX prints it."""
    escaped = re.sub("|".join(map(re.escape, ESCAPED)), lambda one: ESCAPED[one[0]], str(text))
    return re.sub(r"(?<![\w-])-(?=\d)", r"\(-\)", re.sub("`([^`]+)`", r"\\texttt{\1}", escaped))  # a command; a minus


RANKED = 12     # libraries of the table of ranks
DEFAULTS = 6    # of other tools: the least costly and the two most costly
MOST_FOUND = 110  # letters of what was found; the page of the families has the rest
DIFFERING = 12  # scenes of the table of those that differ by machine
# Functions of Known, which give LaTeX.
TABLES = ("contenders", "decided", "ranking", "machines", "differs", "claims", "leaves", "defaults", "largest", "engines", "mechanisms")


def of_numbers(found):
    """The appendix: an entry a source, with its first record and the numbers that come from it, to which their uses link."""
    entries = []
    for (table, records), names in gather(((one.table, one.records), name) for name, one in found.items()).items():
        first = "".join(f"; {name.removesuffix('.json')}" for name in records[:1]) + (f" +{len(records) - 1}" if len(records) > 1 else "")
        numbers = "; ".join(rf"\hypertarget{{where:{name}}}{{\textbf{{{tex(name)}}}}} {tex(shorten(found[name].text, 20, placeholder=' …'))}"
                            for name in names)
        entries.append(rf"\numberentry{{{tex(table + first)}}}{{{numbers}}}" + "\n")
    return "".join(entries)


def all_numbers(found):
    """Each number with all its records, as CSV."""
    rows = [(name, one.text, one.table, " ".join(one.records)) for name, one in found.items()]
    return pandas.DataFrame(rows, columns=["number", "value", "table", "records"]).to_csv(index=False)


def table(rows, columns, long=False):
    """Rows in the order of `columns`, {head: LaTeX column}. `long`: over several pages."""
    if not rows:
        return tex("Not measured in this set.")
    frame = pandas.DataFrame(rows, columns=list(columns))
    style = frame.style.hide(axis="index").format(tex).format_index(tex, axis=1)
    return style.to_latex(column_format="".join(columns.values()), hrules=True, environment="longtable" if long else None)


def contenders(known):
    """Who takes part, and what was tried for each."""
    registry, tried = known.registry, known.tables("tuning")["alternatives"].loc[lambda rows: rows.status == "ok"]
    rows = [(name, "none: own" if name in registry.own else one["library"], one["description"],
             "yes" if one.get("role") == "paper" else "no", mine.alternative.nunique(),
             f"{(mine.low > 1).sum()} / {(mine.high < 1).sum()} of {len(mine)}" if len(mine) else "–")
            for name, one in registry.variants.items() if name not in registry.examples for mine in [tried[tried.base == name]]]
    return table(rows, {"variant": r"P{30mm}", "library": r"P{26mm}", "form": r"P{74mm}", "2008": "l", "tried": "r", "longer / shorter": "l"})


def decided(known):
    """What the mechanisms were held to, and what was found."""
    rows = [(what, asked, shorten(found, MOST_FOUND, placeholder=" …"), {True: "yes", False: "no", None: "–"}[holds])
            for what, asked, found, holds in bounds.bounds(known.tables("families"))]
    held, holds = known.tables("limit")["held"].dropna(subset=["worst"]), {"held": "yes", "not held": "no"}
    rows += [(row.what, f"{row.sign} {number(row.bound)}", between(row.worst, row.low, row.high), holds.get(row.verdict, row.verdict))
             for row in held.itertuples()]
    return table(rows, {"what": r"P{64mm}", "asked": r"P{36mm}", "found": r"P{52mm}", "holds": r"P{14mm}"})


def ranking(known):
    """Libraries over the mechanisms at their own fill; beside, what it costs to take one always over the cells of the map."""
    mine, lost, results = led(real_mechanisms(known)), losses(known), known.results
    prices = {row["implementation"]: row for row in summary.prices(results, results.layer("libraries"))}
    rows = [(name, mine.get(name, 0), len(one), number(gmean(one)), number(one.max()), one.idxmax(), *(
        (number(price["mean"]), number(price["worst"]), f"{price['cells']} of {price['of']}", price["rough"]) if price else ["–"] * 4))
            for name, one in [*lost.items()][:RANKED] for price in [prices.get(name)]]
    return table(rows, {"library": "l", "first or as fast": "r", "timed on": "r", "mean": "r", "worst": "r", "where": "l"}
                 | dict.fromkeys(("map: mean", "map: worst", "cells", "by pilot"), "r"))


def claims(known):
    """The claims of 2008, with theirs, ours in each set and the verdict; below, those without."""
    ours = lambda row: row["ours"] + (f" ({row['low']} to {row['high']})" if row["low"] else "") if row and row["ours"] else "–"
    rows, without = [], {}  # those without a verdict by id and reason
    for name, claim, paper, found in ledger.beside([one.tables("map")["claims"] for one in known.sets]):
        verdicts = dict.fromkeys(row["verdict"] for row in found if row)
        if {*verdicts} <= {ledger.UNMEASURED, ledger.INCOMPARABLE}:
            without.setdefault((name, next(filter(None, found))["reason"]), []).append(claim)
        else:
            rows.append((name, claim, paper, *map(ours, found), "; ".join(verdicts)))
    heads = {one.folder.name: r"P{%.0fmm}" % (44 / len(known.sets)) for one in known.sets}
    said = (f"{name}: {some[0]}" + (f", and {len(some) - 1} more" if len(some) > 1 else "") + f" ({reason.rstrip('.')})"
            for (name, reason), some in without.items())
    return (table(rows, {"": "l", "claim": r"P{61mm}", "2008": r"P{18mm}"} | heads | {"verdict": r"P{21mm}"}, long=True)
            + ("\n" + tex(f"No verdict: {'; '.join(said)}.") + r"\par" if without else ""))


def machines(known):
    """What was measured on each machine that is compared, a column each."""
    sets = known.compared or [known]
    found, gained = [_machine(one) for one in sets], machine.gains(sets, GAINED)
    rows = [(what, *(mine[what] for mine in found)) for what in found[0]]
    rows += [(f"a step with {name}, times that on {sets[0].folder.name}", *map(number, gained[name]))
             for name in GAINED if name in gained and known.compared]
    return table(rows, {"": r"P{72mm}"} | {one.folder.name: r"P{%.0fmm}" % (96 / len(sets)) for one in sets})


def _machine(one):
    found, cells, control = real(one), summary.settled(one.tables("map")["cells"], "libraries"), machine.controls(one)
    measured = machine.rates(one)
    return {"processor": one.context["cpu_model"], "measured on": one.facts["date"][:10],
            "pairs timed against themselves, of these falsely decided": f"{control['pairs']}, {control['false']}",
            "mechanisms that are settled": f"{found['said'].text} of {found['mechanisms'].text}",
            "library that is fastest or as fast most often": f"{found['leader'].text} on {found['leads'].text}",
            "best single library: mean and worst loss": f"{found['single'].text}: {found['mean'].text}, {found['worst'].text}",
            "cells of the map: decided, several as fast, open": f"{cells['decided']}, {cells['equivalent']}, {cells['open']}"} | {
        text: number(measured.get(name)) for name, text in machine.RATES.items() if name in measured and name not in ("L2", "L3")}


def differs(known):
    """Where no library is among the best on all machines: on each who is fastest, and what those take who are so elsewhere."""
    rows, differ = [], sorted((one for one in known.agreed if one.verdict == "differs"), key=lambda one: -one.worst.get(one.robust, math.inf))
    for one in differ[:DIFFERING]:
        found = ["; ".join([ranking.winner, *(f"{name} {between(*ranking.ratios[name][:3])}" for name in dict.fromkeys(one.winners)
                                              if name != ranking.winner and name in ranking.ratios)]) for ranking in one.machines]
        rows.append((one.question.scene, one.question.form.partition("-")[0], number(one.question.variables, 5), *found,
                     f"{one.robust} {number(one.worst.get(one.robust))}"))
    heads = {there.folder.name: r"P{%.0fmm}" % (88 / len(known.compared)) for there in known.compared}
    return table(rows, {"scene": r"P{27mm}", "form": "l", "n": "r"} | heads | {"robust": r"P{30mm}"}) if rows else tex(
        "None." if known.compared else "Not measured in this set.")


def leaves(known):
    """The rule by hand, with what it costs on families that were left out."""
    rows = [(row["case"], take, lost.replace(" slower than the fastest library", ""))
            for row in cases(known.tables("families"), known.view("families")) if row["link"].endswith("#by-hand")
            for take, _, lost in [row["take"].partition("; on families left out ")]]
    return table(rows, {"case": r"P{22mm}", "take": r"P{94mm}", "slower than the fastest": r"P{52mm}"})


def defaults(known):
    """Defaults of other tools, as rules for our contenders."""
    found = known.tables("families")["defaults"].dropna(subset=["mean"]).sort_values("mean").to_dict("records")
    rows = [(row["rule"], row["chooses"], ("at least " if row["smaller"] > 0 else "about " if row["rough"] else "") + number(row["mean"]), number(row["worst"])) for row in found]
    rows = rows[:DEFAULTS - 2] + rows[-2:] if len(rows) > DEFAULTS else rows
    return table(rows, {"default": r"P{40mm}", "chooses": r"P{92mm}", "mean": "r", "worst": "r"})


def largest(known):
    """Who keeps up with which size: a row an implementation, a column a form and deadline; those that keep up with most."""
    rows = known.tables("realtime")["largest"].dropna(subset=["largest"]).sort_values(["scheme", "step"])
    most = rows.groupby("implementation", sort=False).largest.max().nlargest(RANKED)
    rows = rows.assign(head=[f"{row.scheme}, {1e3 * row.step:g} ms" for row in rows.itertuples()], said=[
        f"{number(row.largest, 5)} ({number(row.max_us)} µs)" + (f"; not {number(row.next, 5)}" if row.next == row.next else "")
        for row in rows.itertuples()])
    found = rows.pivot(index="implementation", columns="head", values="said").reindex(most.index)[rows["head"].unique()].fillna("–").reset_index()
    return table(found.values.tolist(), dict.fromkeys(found, "l"))


def engines(known):
    """Each engine's time over that of each side of ours, at equal error."""
    found = known.tables("engines")["equal_error"].loc[lambda rows: ~rows.engine.str.endswith(NATIVE)]
    rows = [(title(engine), *(_times(mine[mine.side == side]) for side in SIDES)) for engine, mine in found.groupby("engine", sort=False)]
    return table(rows, {"": "l"} | dict.fromkeys(SIDES.values(), r"P{32mm}"))


def _times(rows):
    known = rows[rows.ratio.notna()]
    if known.empty:
        return "–"
    single = f", {one} of a single round" if (one := (known.high == math.inf).sum()) else ""
    return "; ".join([f"{number(known.ratio.median())} ({number(known.ratio.min())} to {number(known.ratio.max())}), slower in {(known.low > 1).sum()} "
                      f"of {len(known)}{single}", *lacking(rows)])


def mechanisms(known):
    """Each mechanism, in the form that it is simulated in: the fastest library, how far the next is behind, who is as fast, our own code."""
    tables_, own = known.tables("families"), fastest_own(known.tables("families")["scenes"], known.registry).set_index("scene")
    about = tables_["mechanisms"].set_index("scene")
    rows = []
    for row in best_form(tables_["winners"]).sort_values("variables").itertuples():
        others = [name for name in row.equivalent.split() if name != row.winner]
        mine = own.loc[row.scene] if row.scene in own.index and own.scheme[row.scene] == row.scheme else None
        rows.append((row.scene, row.scheme.partition("-")[0], number(row.variables, 5), number(about.per_column.get(row.scene, math.nan), 2),
                     row.winner, number(row.step_us), between(row.margin, row.low, row.high), ", ".join(others) or ("" if row.decided else "open"),
                     "" if mine is None else number(1 / mine.to_rival) + (f" ({ends(1 / mine.to_rival_high, 1 / mine.to_rival_low)})"
                                                                          if bounded(mine.to_rival_low, mine.to_rival_high) else "")))
    return table(rows, {"mechanism": r"P{28mm}", "form": "l", "n": "r", "nz/col": "r", "fastest library": r"P{30mm}", "step, µs": "r",
                        "next ÷ it": "l", "as fast": r"P{26mm}", "own": "l"}, long=True)
