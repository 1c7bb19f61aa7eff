# The gate: whose motion agrees with the reference's on a scene.
from dataclasses import dataclass, replace

from study.core.cell import Cell, by_environment


@dataclass(frozen=True, eq=False)
class Asked:
    """Contenders on a scene. `settings`: of the step."""
    scene: str
    contenders: list
    role: str = "gate"
    settings: tuple = ()


def verdicts(lab, asked, *, each, seconds=None, drop=False):
    """[{contender: (verdict, reason)}] of each of `asked`, all at once. `each`: s that one contender may take; `seconds`: a process,
    else enough for all of it and the reference. Those of one environment share a process, which runs the reference once for all; if it
    ends early, its contenders are asked one by one, so that only who ended it is lost; not where it was out of time with enough for
    all of them, which is the reference's."""
    cells = [(one, Cell("check", one.scene, group, (*one.settings, "--time-limit", f"{each:g}"), one.role,
                        seconds=seconds or each * (1 + len(one.contenders))))
             for one in asked for group in by_environment(one.contenders).values()]
    found = {one: {} for one in asked}
    for (one, cell), record in zip(cells, lab.run([cell for _, cell in cells], drop)):
        group = cell.contenders
        slow_reference = record.status == "timeout" and cell.seconds >= each * (1 + len(group))
        if record.done or record.status == "dropped" or slow_reference or len(group) == 1:
            found[one] |= {who: record.verdicts[who.name] for who in group}
        else:
            for said in verdicts(lab, [replace(one, contenders=[who]) for who in group], each=each, seconds=seconds, drop=drop):
                found[one] |= said
    return list(found.values())


def agreeing(lab, asked, **limits):
    """[those with whom the gate agrees, in their order] of each of `asked`."""
    return [[who for who in one.contenders if said[who][0] == "agrees"] for one, said in zip(asked, verdicts(lab, asked, **limits))]
