# The gate: whose motion agrees with the reference's on a scene.
from study.core.cell import Cell
from study.core.contender import by_environment


def verdicts(lab, scene, contenders, role="gate", settings=(), *, each, seconds, drop=False):
    """{contender: (verdict, reason)}. `each`: s that one contender may take; `seconds`: a process. Those of one environment
    share a process, which runs the reference once for all; if it ends early, its contenders are asked one by one, so that
    only who ended it is lost; not where it was out of time with enough for all of them, which is the reference's."""
    cells = [Cell("check", scene, group, (*settings, "--time-limit", f"{each:g}"), role, seconds=seconds)
             for group in by_environment(contenders).values()]
    found = {}
    for cell, record in zip(cells, lab.run(cells, drop)):
        group = cell.contenders
        slow_reference = record.status == "timeout" and seconds >= each * (1 + len(group))
        if record.done or record.status == "dropped" or slow_reference or len(group) == 1:
            found |= {one: record.verdicts[one.name] for one in group}
        else:
            for one in group:
                found |= verdicts(lab, scene, [one], role, settings, each=each, seconds=seconds, drop=drop)
    return found


def agreeing(lab, scene, contenders, *options, **limits):
    """Those of `contenders` with whom the gate agrees, in their order."""
    found = verdicts(lab, scene, contenders, *options, **limits)
    return [one for one in contenders if found[one][0] == "agrees"]
