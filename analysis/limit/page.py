# What page.html.j2 shows of the limit; the answer to "How far is each step from code that was written by hand for one mechanism?".
from pathlib import Path

from analysis.core.text import answers as said, grouped
from analysis.core.timing import PHASES
from analysis.limit.figures import everyone
from analysis.limit.held import HELD, NOT_HELD, NOT_MEASURED, OPEN, PARTLY
from analysis.limit.tables import KINDS, NODES

HERE = Path(__file__).parent


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
    rows, leads, batches, sweeps, held = everyone(tables["steps"]), *(tables[name] for name in ("leads", "batches", "sweeps", "held"))
    sides = {"the fastest library": rows[rows.implementation.isin(view.registry.libraries)],
             "the fastest code of our own": rows[rows.implementation.isin(view.registry.own)]}
    by_verdict = {verdict: held[held.verdict == verdict] for verdict in (HELD, PARTLY, OPEN, NOT_HELD, NOT_MEASURED)}
    return said(HERE / "answers.j2", "Not measured: no implementation that could be timed took part.",
                best={who: mine.sort_values("multiple").drop_duplicates("loops") for who, mine in sides.items() if len(mine)},
                leads=leads[(leads.status == "ok") & leads.kind.isin(KINDS)], batches=batches[batches.status == "ok"],
                sweeps=sweeps[(sweeps.status == "ok") & (sweeps.jobs == 2)], held=held, unmeasured=by_verdict.pop(NOT_MEASURED), by_verdict=by_verdict)
