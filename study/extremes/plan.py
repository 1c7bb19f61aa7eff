# Every implementation at the extremes; is every wrong run told; kept pivots.
from itertools import product

from analysis.extremes import battery as table, cells, judge, trials
from study.core.cell import REFERENCE, Cell
from study.core.profile import by_share

SETTINGS = {"implementations": {"forms": [str], "others": [str], "trials": [str]}, "everyone": bool, "trials": {"standard": int, "others": int},
            "cells": int, "processes": int, "limit": float}
DENSE_LOOPS = 200  # dense implementations run up to this size


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
    lab.run([Cell("simulate", scenes[cell.name], (one,), ("--step", f"{cell.step / factor:g}", "--duration", f"{cell.step * cell.steps:g}"),
                  table.REFERENCE, program=program, seconds=10 * lab.settings["limit"], keep=cell.columns, every=cell.every * factor)
             for some, one, program in ((tried, turns[-1], "mbs"), (telling + rest, REFERENCE, "mbs_reference"))
             for cell in some if cell.motion is None for factor in judge.FINER])
    todo = []
    for place, (cell, setting) in enumerate(chosen):
        turn = 0 if cell.axis in trials.STANDARD else place % len(turns)
        todo += _run(lab, cell, scenes[cell.name], setting, turns[turn:] + turns[:turn], 1)
    for rank in (0, 1):
        forms, others = (_who(lab, kind)[rank] for kind in ("forms", "others"))
        for some, settings, who in ((telling, cells.FORMS, forms), (rest, cells.FORMS, forms), (telling, cells.OTHERS, others)):
            for cell, setting in product(some, settings):
                todo += _run(lab, cell, scenes[cell.name], setting, who)
    lab.run(todo, drop=True)


def _who(lab, kind):
    """(those who differ in kind, the others if they are asked for) of whom takes part."""
    named = lab.settings["implementations"][kind]
    kinds = sorted((one for one in lab.contenders if one.variant in named), key=lambda one: named.index(one.variant)) or lab.contenders
    return kinds, [one for one in lab.contenders if one not in kinds] if lab.settings["everyone"] else []


def _run(lab, cell, scene, setting, who, most=None):
    """[Cell of each, or of so many at `most`, who serves the setting], without those that are left out."""
    words = setting.words([("step", f"{cell.step:g}"), ("duration", f"{cell.step * cell.steps:g}"), ("penalty", cell.penalty)])
    for one in [one for one in who if lab.registry.serves(one.variant, *setting.needs)][:most]:
        wanted = Cell("simulate", scene, (one,), words, setting.file_name, seconds=lab.settings["limit"], keep=cell.columns, every=cell.every)
        if one.variant not in lab.registry.dense or cell.loops <= DENSE_LOOPS:
            yield wanted
        else:
            lab.skip(wanted, "excluded", f"dense implementations run up to {DENSE_LOOPS} loops")


def pivots(lab):
    asked = [Cell("", "", (), ("--json",), "pivots", number=number, program="stale_pivots", timed=True, seconds=600)
             for number in range(1, lab.settings["processes"] + 1)]
    if any(one.variant.startswith("csc_klu/") for one in lab.contenders):
        return lab.run(asked, drop=True)
    for cell in asked:
        lab.skip(cell, "excluded", "csc_klu takes no part")


columns, run = by_share({"battery": (0.96, battery), "pivots": (0.04, pivots)})
