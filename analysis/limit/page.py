# What page.html.j2 shows of the limit; the answer to "How far is each step from code that was written by hand for one mechanism?".
from analysis.core.text import grouped, number, span
from analysis.core.timing import PHASES
from analysis.limit.figures import everyone
from analysis.limit.held import HELD, NOT_HELD, NOT_MEASURED, OPEN, PARTLY
from analysis.limit.tables import KINDS, NODES


def context(tables, view):
    steps = tables["steps"]
    timed = steps[(steps.status == "ok") & steps.step_us.notna()]
    own = timed[timed.implementation.isin(view.registry.own) & (timed.variables >= 100)]
    return {"phases": PHASES, "settings": view.settings,
            "held": tables["held"].to_dict("records"), "bounds": tables["bounds"].sort_values("loops").to_dict("records"),
            "sizes": grouped(timed[timed.form == "penalty"].sort_values(["loops", "step_us"]), "variables"),
            # First the form whose passes do not depend on the size.
            "growth": grouped(own.sort_values("form", ascending=False, kind="stable"), "form"), "scenes": by_scene(tables["scenes"], tables["leads"]),
            "batches": tables["batches"][tables["batches"].status != "unsupported"].sort_values(["variables", "sets"]).to_dict("records"),
            "alone": sorted(set(tables["batches"].implementation[tables["batches"].status == "unsupported"])), "lost": lost(tables),
            "sweeps": tables["sweeps"].to_dict("records"), "nodes": NODES}


def by_scene(scenes, leads):
    """[(scene, kind, n, dimension, libraries that are fastest, rows)], the fastest first; also those that only a first look was taken at."""
    equivalent = dict(zip(leads.scene, leads.equivalent))
    rows = scenes[scenes.status.isin(["ok", "slower"]) & scenes.step_us.notna()].sort_values("step_us")
    found = [(name.removeprefix("harness/scenes/").removesuffix(".json"), *group[["kind", "variables", "dimension"]].iloc[0],
              equivalent.get(name, "").split(), group.to_dict("records")) for name, group in rows.groupby("scene", sort=False)]
    return sorted(found, key=lambda one: (KINDS.index(one[1]), one[3], one[2]))


def lost(tables):
    """[(status, reason, [(implementation, where)])] of what was not timed or is not believed."""
    found = {}
    for name in ("steps", "scenes", "batches"):
        for row in tables[name].to_dict("records"):
            if row["status"] not in ("ok", {"scenes": "slower", "batches": "unsupported"}.get(name)):
                where = row.get("scene") or f"four-bar:{row['loops']:.0f}" + (", saddle-point" if row["form"] != "penalty" else "")
                what = row["status"], row["reason"].partition(" (first ")[0]
                found.setdefault(what, {}).setdefault(row["implementation"], []).append(where.removeprefix("harness/scenes/").removesuffix(".json"))
    return [(*what, list(names.items())) for what, names in found.items()]


def answers(tables, view):
    found = [*_multiples(everyone(tables["steps"]), view), *_leads(tables["leads"]),
             *_many(tables["batches"], tables["sweeps"]), *_held(tables["held"])]
    return found or [{"text": "Not measured: no implementation that could be timed took part.", "anchor": ""}]


def _multiples(rows, view):
    """The fastest library and the fastest of our own, each over the sizes that it was timed at."""
    sides = {"the fastest library": rows[rows.implementation.isin(view.registry.libraries)],
             "the fastest code of our own": rows[rows.implementation.isin(view.registry.own)]}
    said = [f"{who} takes {span(best.multiple, 2)} times as long (n = {span(best.variables, 5)})"
            for who, mine in sides.items() for best in [mine.sort_values("multiple").drop_duplicates("loops")] if len(best)]
    return [{"text": f"Beside code written for the N-four-bar alone, {', '.join(said)}.", "anchor": "sizes"}] if said else []


def _leads(leads):
    rows = leads[(leads.status == "ok") & leads.kind.isin(KINDS)]
    found = [f"{name} is shown to be faster than the fastest library in {(mine.low > 1).sum()} of {len(mine)} scenes that it serves "
             f"and slower in {(mine.high < 1).sum()} ({span(mine.lead)} times as fast)" for name, mine in rows.groupby("implementation", sort=False)]
    return [{"text": f"{'. '.join(found)}.", "anchor": "ahead"}] if found else []


def _many(batches, sweeps):
    """Batches and sweeps, one answer."""
    gains = [f"{span(mine.gain)} times with {sets:.0f} sets (in single processes {span([mine.least.min(), mine.most.max()])})"
             for sets, mine in batches[batches.status == "ok"].groupby("sets")]
    rates = [f"{row.scene}: {number(row.gain)} times as many lanes a second as by one job, a million lanes in {number(row.million_s)} s"
             for row in sweeps[(sweeps.status == "ok") & (sweeps.jobs == 2)].itertuples()]
    said = [f"{what}: {'; '.join(found)}." for what, found in (("Gain of simulations side by side over single ones", gains),
                                                               ("Sweeps by two jobs, projected from fewer lanes", rates)) if found]
    return [{"text": " ".join(said), "anchor": "batches" if gains else "sweeps"}] if said else []


def _held(held):
    by_verdict = {verdict: held[held.verdict == verdict] for verdict in (HELD, PARTLY, OPEN, NOT_HELD, NOT_MEASURED)}
    lost = by_verdict.pop(NOT_MEASURED)
    if len(lost) == len(held):
        return []
    text = f"Code without a library: of {len(held)} bounds {len(held) - len(lost)} were measured: " + ", ".join(
        f"{len(rows)} {verdict}" for verdict, rows in by_verdict.items() if len(rows)) + "."
    if len(by_verdict[NOT_HELD]):
        text += " Not held: " + "; ".join(f"{row.what} ({number(row.worst)} at {row.where}, bound {row.sign} {number(row.bound)})"
                                          for row in by_verdict[NOT_HELD].itertuples()) + "."
    if len(lost):
        text += f" Not measured: {'; '.join(lost.what)}."
    return [{"text": text, "anchor": "held"}]
