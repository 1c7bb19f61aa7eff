# A contest on one scene: a look at everyone, the gate, and the times of those who agree and are near the fastest.
from collections import namedtuple
from dataclasses import replace

from analysis.core.timing import LEFT_OUT, processes as rows_of
from study.core.cell import Cell, by_environment, twin_of
from study.core.timing import measure

NEAR = 2.0  # times the fastest library: who takes longer has no further times
WIDE = 4.0  # the same, of those that are named
STEPS = 40  # of a look
CHECK_S = 60  # of a contender, in the gate
CONTROLS = 3  # scenes of a part on which the fastest library is timed beside itself
SHORT = ("--steps", 16)  # of the gate for those who are too slow to be timed further: the fewest that it judges by


# Of the gate: whose motion agrees with the reference's on a scene. settings: of the step.
Asked = namedtuple("Asked", "scene contenders role settings", defaults=("gate", ()))


def verdicts(lab, asked, *, each, seconds=None, drop=False):
    """[{contender: (verdict, reason)}] of each of `asked`, all at once. `each`: s that one contender may take; `seconds`: a process, else enough for
    all of it and the reference. Those of one environment share a process, which runs the reference once for all; if it ends early, its contenders are
    asked one by one, so that only who ended it is lost; not where it was out of time with enough for all of them, which is the reference's."""
    cells = [(place, Cell("check", one.scene, group, (*one.settings, "--time-limit", f"{each:g}"), one.role,
                          seconds=seconds or each * (1 + len(one.contenders))))
             for place, one in enumerate(asked) for group in by_environment(one.contenders).values()]
    found = [{} for _ in asked]
    for (place, cell), record in zip(cells, lab.run([cell for _, cell in cells], drop)):
        group = cell.contenders
        slow_reference = record.status == "timeout" and cell.seconds >= each * (1 + len(group))
        if record.done or record.status == "dropped" or slow_reference or len(group) == 1:
            found[place] |= {who: record.verdicts[who.name] for who in group}
        else:
            for said in verdicts(lab, [asked[place]._replace(contenders=[who]) for who in group], each=each, seconds=seconds, drop=drop):
                found[place] |= said
    return found


def agreeing(lab, asked, **limits):
    """[those with whom the gate agrees, in their order] of each of `asked`."""
    return [[who for who in one.contenders if said[who][0] == "agrees"] for one, said in zip(asked, verdicts(lab, asked, **limits))]


# A form of the step in which a scene is a contest. Roles of the records: `role`-look, `role`-gate and `role`. settings: of the step; wide: names of
# those that are up to WIDE; stretch: that is timed, else the scene's; look: steps of the look.
Form = namedtuple("Form", "role contenders processes samples settings wide stretch look patience", defaults=((), (), (), STEPS, 1.0))


def contests(lab, scene, forms, *, own, always=False, control=False):
    """[rows of the look] of each form; the gate is asked of all who have a time, of all forms at once. `own`: names of those that are no libraries;
    `always`: they are gated and timed whatever they take; `control`: the fastest library is timed beside itself."""
    looks = [rows_of(measure(lab, scene, form.contenders, processes=1, repetitions=1, role=f"{form.role}-look",
                             settings=("--steps", form.look, "--patience", form.patience, *form.settings))) for form in forms]
    chosen = [near(rows, form.contenders, own, always, form.wide) for form, rows in zip(forms, looks)]
    asked = [Asked(scene, timed, f"{form.role}-gate", form.settings) for form, timed in zip(forms, chosen)]
    slow = [one._replace(contenders=[who for who in form.contenders if who.name in known and who not in one.contenders],
                         settings=(*one.settings, *SHORT)) for form, known, one in zip(forms, map(times_of, looks), asked)]
    for form, rows, here in zip(forms, looks, agreeing(lab, asked + slow, each=CHECK_S, drop=True)):
        if control:
            times = times_of(rows)
            here += [twin_of(one) for one in sorted((one for one in here if one.name not in own), key=lambda one: times[one.name])[:1]]
        measure(lab, scene, here, processes=form.processes, repetitions=form.samples, settings=(*form.settings, *form.stretch), role=form.role)
    return looks


def controls_of(scenes):
    """Those with a control, from small to large."""
    return {scenes[len(scenes) * place // CONTROLS] for place in range(CONTROLS) if scenes}


def near(rows, contenders, own, always=False, wide=()):
    """Those on whom an answer may stand: who takes at most NEAR times as long as the fastest library (of those in `wide`, WIDE
    times), and with `always` all that are no libraries."""
    times = times_of(rows)
    best = min((time for name, time in times.items() if name not in own), default=0.0 if always else min(times, default=0.0))
    return [one for one in contenders if one.name in times
            and (always and one.name in own or times[one.name] <= (WIDE if one.name in wide else NEAR) * best)]


def times_of(rows):
    """µs a step, by name."""
    return rows[rows.status == "ok"].groupby("implementation").step_us.median()


def usual(lab):
    """Contenders of the environment that most have: they share processes."""
    return list(max(by_environment(lab.contenders).values(), key=len, default=()))


def elsewhere(lab, cell):
    """Records of those who take no part in a cell, as they have processes of their own."""
    here = usual(lab)
    for one in [one for one in lab.contenders if one not in here]:
        lab.skip(replace(cell, contenders=(one,), role=f"{cell.role}{LEFT_OUT}"), "excluded", "on another BLAS pair: timed in the parts map and limit only")


def about(lab, scenes):
    return lab.run([Cell("describe", scene, role="about") for scene in scenes])
