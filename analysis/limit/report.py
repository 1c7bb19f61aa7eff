# limit.html: bounds, the limit code and the implementations; one self-contained page.
from pathlib import Path

from analysis import page
from analysis.limit.figure import LIMIT, ahead, by_phase, over_size, timed
from analysis.limit.must_hold import leads, must_hold, own, own_folders, wanted
from analysis.loader import PHASES, TableError, _json, plain_table


def write(folder):
    """Writes figures/*.svg and .png of what was measured, and limit.html."""
    folder = Path(folder)
    tables = {name: plain_table(folder / f"{name}.csv") if (folder / f"{name}.csv").exists() else None
              for name in ("bounds", "steps", "growth", "scenes", "batches")}
    steps, scenes = tables["steps"], tables["scenes"]
    if steps is not None and ("step_us" not in steps or timed(steps).empty):
        raise TableError(f"{folder / 'steps.csv'}: no size has a time of {LIMIT}")
    registry = _json(folder / "implementations.json")["implementations"]
    drawn = {}
    if steps is not None:
        folders = own_folders(registry)
        drawn |= {"over_size": over_size(tables["bounds"], steps, registry, folders), "by_phase": by_phase(steps, folders)}
    if scenes is not None and own(registry):
        drawn["ahead"] = ahead({folder: leads(scenes, folder, own(registry), "scene")
                                for folder in own_folders(registry)}, scenes, wanted)
    figures = {name: page.embedded(folder, name, figure) for name, figure in drawn.items()}
    page.write(folder / "limit.html", render(tables, registry, _json(folder / "run.json"), figures))


def render(tables, registry, run, figures):
    """The page; `figures`: {name: SVG in base 64}."""
    steps, growth, scenes, batches = (tables[name] for name in ("steps", "growth", "scenes", "batches"))
    return page.template(Path(__file__).parent / "limit.html.j2").render(
        context=next(iter(run["contexts"].values())), figures=figures, limit=LIMIT,
        counted=steps is not None and "instructions" in steps and steps.instructions.notna().any(),
        bounds=[] if steps is None else tables["bounds"].sort_values("loops").to_dict("records"),
        sizes=[] if steps is None else by_size(steps), phases=PHASES,
        held={folder: must_hold(folder, registry, steps, growth, scenes, batches) for folder in own_folders(registry)},
        growth=[] if growth is None else growth[growth.status == "ok"].to_dict("records"),
        batches=[] if batches is None else batches[batches.status == "ok"].to_dict("records"),
        scenes=[] if scenes is None else by_scene(scenes),
        lost=lost([table for table in (steps, growth, scenes, batches) if table is not None]))


def lost(tables):
    """{(implementation, reason): scenes} of what was not timed."""
    found = {}
    for table in tables:
        for row in table[~table.status.isin(["ok", "slower"])].to_dict("records"):
            scene = row.get("scene") or f"four-bar:{row.get('loops')}"
            found.setdefault((row["implementation"], row["reason"]), []).append(
                scene.removeprefix("harness/scenes/").removesuffix(".json"))
    return found


def by_scene(scenes):
    """[(scene, n, dimension, rows)], the fastest first."""
    good = scenes[scenes.status.isin(["ok", "slower"])].sort_values("step_us")
    return [(scene, group.variables.iloc[0], group.dimension.iloc[0], group.to_dict("records"))
            for scene, group in good.groupby("scene", sort=False)]


def by_size(steps):
    """[(n, rows)] with every timed variant, the fastest first; phases in ns and as multiples."""
    rows = timed(steps).sort_values(["loops", "step_us"])
    found = []
    for loops, group in rows.groupby("loops"):
        limit = 1e3 * group[group.implementation == LIMIT].step_us.iloc[0]
        found.append((2 * loops + 2, [
            {"implementation": row.implementation, "ns": 1e3 * row.step_us,
             "multiple": row.multiple, "passes": row.passes,
             "instructions": getattr(row, "instructions", None),
             "phases": [] if row.implementation == LIMIT else [
                 (1e3 * getattr(row, f"{phase}_us"), 1e3 * getattr(row, f"{phase}_us") / limit)
                 for phase in PHASES]} for row in group.itertuples()]))
    return found
