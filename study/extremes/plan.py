# Every implementation at the extremes; is every wrong run told; ways out of what goes wrong there; kept pivots.
from analysis.extremes import battery as table, cells, judge, trials, ways
from study.core.cell import Cell
from study.core.contender import REFERENCE

SETTINGS = {"implementations": dict,  # that differ in kind: for the two forms, for other settings, for trials ...
            "everyone": bool,         # ... and whether all others come after them
            "trials": dict,           # runs of standard problems and of others; 0: all
            "cells": int,             # of the battery, telling ones of an axis at most; 0: these and all others
            "loops": dict,            # sizes: of the region of ways, of their times
            "processes": int,         # of a time
            "limit": float}           # s a run
SHARES = {"battery": 0.82, "ways": 0.14, "pivots": 0.04}
DENSE_LOOPS = 200  # dense implementations run up to this size
PREFERRED = {      # of each folder the first variant that serves a way stands for it
    "eigen_dense": ("eigen_dense/llt",),
    "csc_klu": ("csc_klu/refactor", "csc_klu/guarded", "csc_klu/factor"),
    "eigen_sparse": ("eigen_sparse/ldlt", "eigen_sparse/superlu")}


def columns(settings):
    return {column: share * settings["seconds"] for column, share in SHARES.items()}


def run(lab, column):
    {"battery": battery, "ways": way_out, "pivots": pivots}[column](lab)


def battery(lab):
    """Standard problems, then other trials by lot, implementations in turn. Then cells that are extreme: the most telling ones first, by
    those who differ in kind; other settings and cells, then all other implementations; of equal worth the cheap ones first."""
    turns = _who(lab, "trials")[0]
    chosen, extreme = trials.few(trials.all_trials(), **lab.settings["trials"]), sorted(cells.extremes(), key=lambda cell: cell.work)
    few = lab.settings["cells"] or len(cells.TELLING)
    telling = [cell for cell in extreme if cell.place is not None and cell.place < few]
    rest = [cell for cell in extreme if cell.place is None and not lab.settings["cells"]]
    tried = list(dict.fromkeys(cell for cell, _ in chosen))
    scenes = {cell.name: cell.scene or lab.scene(cell.name, cell.document) for cell in tried + telling + rest}
    lab.run([_reference(lab, cell, scenes[cell.name], factor, *who) for some, who in ((tried, (turns[-1], "mbs")), (telling + rest, ()))
             for cell in some if cell.motion is None for factor in judge.FINER])
    todo = []
    for place, (cell, setting) in enumerate(chosen):
        turn = 0 if cell.axis in trials.STANDARD else place % len(turns)
        todo += _run(lab, cell, scenes[cell.name], setting, *_serving(lab, turns[turn:] + turns[:turn], setting)[:1])
    for rank in (0, 1):
        forms, others = (_who(lab, kind)[rank] for kind in ("forms", "others"))
        for some, settings, who in ((telling, cells.FORMS, forms), (rest, cells.FORMS, forms), (telling, cells.OTHERS, others)):
            for cell, setting in ((cell, setting) for cell in some for setting in settings):
                todo += _run(lab, cell, scenes[cell.name], setting, *_serving(lab, who, setting))
    lab.run(todo, drop=True)


def _serving(lab, who, setting):
    return [one for one in who if lab.registry.serves(one.variant, *setting.needs)]


def _who(lab, kind):
    """(those who differ in kind, the others if they are asked for) of whom takes part."""
    named = lab.settings["implementations"][kind]
    kinds = sorted((one for one in lab.contenders if one.variant in named), key=lambda one: named.index(one.variant)) or lab.contenders
    return kinds, [one for one in lab.contenders if one not in kinds] if lab.settings["everyone"] else []


def _run(lab, cell, scene, setting, *who):
    """[Cell of each], without those that are left out."""
    words, found = setting.words([("step", f"{cell.step:g}"), ("duration", f"{cell.step * cell.steps:g}"), ("penalty", cell.penalty)]), []
    for one in who:
        wanted = Cell("simulate", scene, (one,), words, setting.file_name, seconds=lab.settings["limit"], keep=cell.columns, every=cell.every)
        if one.variant not in lab.registry.dense or cell.loops <= DENSE_LOOPS:
            found.append(wanted)
        else:
            lab.skip(wanted, "excluded", f"dense implementations run up to {DENSE_LOOPS} loops")
    return found


def _reference(lab, cell, scene, factor, one=REFERENCE, program="mbs_reference"):
    return Cell("simulate", scene, (one,), ("--step", f"{cell.step / factor:g}", "--duration", f"{cell.step * cell.steps:g}"),
                table.REFERENCE, program=program, seconds=10 * lab.settings["limit"], keep=cell.columns,
                every=cell.every * factor)


def way_out(lab):
    sizes, limit = lab.settings["loops"], lab.settings["limit"]
    served = []
    for way in ways.WAYS.values():
        for names in PREFERRED.values():
            present = [one for name in names for one in [lab.contender(name)] if one]
            one = next((one for one in present if lab.registry.serves(one.variant, *way.needs)), None)
            if one:
                served.append((way, one))
            elif present:
                lab.skip(Cell("simulate", "", (present[0],), way.words(), way.file_name), "unsupported",
                         f"no variant serves {', '.join(sorted(way.needs))}")
    # What a way costs is told beside the same variant without it.
    plain = {one for way, one in served if way == ways.WAYS[ways.PLAIN]}
    timed = [(f"cost-{way.file_name}", way, one) for way, one in served] + [
        (f"beside-{ways.WAYS[ways.PLAIN].file_name}", ways.WAYS[ways.PLAIN], one)
        for one in dict.fromkeys(one for _, one in served) if one not in plain]
    places = ways.places(sizes["ways"])
    scenes = {place.name: lab.scene(place.name, place.chain.document()) for place in places}
    times = [Cell("simulate", f"four-bar:{loops}", (one,),
                  ("--step", ways.STEP, "--duration", ways.DURATION, "--repeats", 3, *way.words()),
                  role, number=number, timed=True, seconds=limit)
             for number in range(1, lab.settings["processes"] + 1) for loops in sizes["times"] for role, way, one in timed]
    lab.run(times, drop=True)
    lab.run([Cell("simulate", scenes[place.name], (one,),
                  ("--step", f"{place.step:g}", "--duration", f"{place.step * place.steps:g}", *way.words()), way.file_name,
                  seconds=limit, keep=place.chain.columns(ways.POINTS), every=place.every)
             for place in places for way, one in served], drop=True)


def pivots(lab):
    asked = [Cell("", "", (), ("--json",), "pivots", number=number, program="stale_pivots", timed=True, seconds=600)
             for number in range(1, lab.settings["processes"] + 1)]
    if any(one.variant.startswith("csc_klu/") for one in lab.contenders):
        return lab.run(asked, drop=True)
    for cell in asked:
        lab.skip(cell, "excluded", "csc_klu takes no part")
