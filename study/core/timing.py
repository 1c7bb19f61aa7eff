# A timed cell is a scene: its contenders take turns in one process (`mbs bench`), and several processes, each with
# another layout of memory and of the program's functions, say how far that matters. analysis/core/timing.py has the statistics.
from dataclasses import replace

from analysis.core.registry import ANCHOR
from analysis.core.timing import ALONE, LEFT_OUT, disturbed
from study.core.cell import LAYOUT, Cell, by_environment

LAYOUTS = 8  # of the program, which processes take in turn: harness/mbs/CMakeLists.txt


def measure(lab, scene, contenders, *, processes, repetitions, settings=(), role="time", seconds=120.0):
    """Records of a scene, as long as the budget lasts: a process a number and environment. Those on another BLAS pair
    have processes of their own, with the ANCHOR in common. Who ends a process is left out with a record that says
    how, and the environment is measured again without it. Several scenes: call for each."""
    groups = by_environment(contenders)
    words = (*settings, f"--benchmark_repetitions={repetitions}")
    main = max(groups, key=lambda name: len(groups[name]), default=None)
    common = next((one for one in groups.get(main, []) if one.variant == ANCHOR), None) or next(iter(groups.get(main, [])), None)
    found = []
    for name, group in groups.items():
        if name != main and common.variant not in [one.variant for one in group]:
            group = (replace(common, name=f"{common.variant}+{group[0].blas}", blas=group[0].blas), *group)
        found += _environment(lab, Cell("bench", scene, group, words, role, timed=True, seconds=seconds), processes)
    return found


def _environment(lab, cell, processes):
    """All processes of one environment, without those who end them."""
    lost = []
    while cell.contenders:
        found, number = [], 0
        # A further process takes the place of one in which others ran: at most a quarter more in all.
        while number < processes + processes // 4 and number - sum(map(disturbed, found)) < processes:
            number += 1
            program = f"{LAYOUT}{(number - 1) % LAYOUTS + 1}"
            record = lab.run([replace(cell, number=number, program=program, settings=(*cell.settings, "--seed", number))], drop=True)[0]
            found.append(record)
            if record.status == "dropped":
                return [*lost, *found]
            if not record.done:
                break
        else:
            return [*lost, *found]
        culprits = _culprits(lab, cell, record)
        lost += [lab.skip(replace(cell, contenders=(one,), role=f"{cell.role}{LEFT_OUT}"), status, reason) for one, status, reason in culprits]
        names = {one.name for one, _, _ in culprits}
        cell = replace(cell, contenders=tuple(one for one in cell.contenders if one.name not in names))
    return lost


def _culprits(lab, cell, record):
    """[(contender, status, reason)] of those who ended a process: the one that it named, or else each that ends one
    when it is alone there; all, where none does."""
    chosen = [one for one in cell.contenders if record.output.get("culprit") == f"{one.variant}/{cell.scene}"]
    if chosen or len(cell.contenders) == 1:
        return [(one, record.status, record.reason) for one in chosen or cell.contenders]
    alone = [(one, lab.one(replace(cell, contenders=(one,), role=f"{cell.role}{ALONE}"))) for one in cell.contenders]
    return [(one, found.status, found.reason) for one, found in alone if not found.done] or [
        (one, record.status, f"a process of all: {record.reason}") for one in cell.contenders]
