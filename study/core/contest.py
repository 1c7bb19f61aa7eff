# A contest on one scene: a look at everyone, the gate for those who are near the fastest, and the times of those who agree.
from collections import Counter
from dataclasses import replace

from analysis.core.timing import LEFT_OUT, processes as rows_of
from study.core.cell import Cell
from study.core.contender import twin_of
from study.core.gate import agreeing
from study.core.timing import measure

NEAR = 2.0  # times the fastest library: who takes longer has no further times
WIDE = 4.0  # the same, of those that are named
STEPS = 40  # of a look
CHECK_S = 60  # of a contender, in the gate


def contest(lab, scene, contenders, role, settings=(), *, own, always=False, wide=(), processes, samples, patience=1.0, stretch=(),
            look=STEPS, control=False):
    """Rows of the look. Roles of the records: `role`-look, `role`-gate and `role`. `own`: names of those that are no libraries;
    `always`: they are gated and timed whatever they take; `wide`: names of those that are up to WIDE; `settings`: of the step; `stretch`: that is timed, else the scene's; `look`: steps of the look; `control`: the fastest library is timed beside itself."""
    rows = rows_of(measure(lab, scene, contenders, processes=1, repetitions=1, role=f"{role}-look",
                           settings=("--steps", look, "--patience", patience, *settings)))
    asked = near(rows, contenders, own, always, wide)
    here = agreeing(lab, scene, asked, f"{role}-gate", settings, each=CHECK_S, seconds=CHECK_S * (1 + len(asked)), drop=True)
    if control:
        times = rows[rows.status == "ok"].groupby("implementation").step_us.median()
        here += [twin_of(one) for one in sorted((one for one in here if one.name not in own), key=lambda one: times[one.name])[:1]]
    measure(lab, scene, here, processes=processes, repetitions=samples, settings=(*settings, *stretch), role=role)
    return rows


def near(rows, contenders, own, always=False, wide=()):
    """Those on whom an answer may stand: who takes at most NEAR times as long as the fastest library (of those in `wide`, WIDE
    times), and with `always` all that are no libraries."""
    times = rows[rows.status == "ok"].groupby("implementation").step_us.median()
    best = min((time for name, time in times.items() if name not in own), default=0.0 if always else min(times, default=0.0))
    return [one for one in contenders if one.name in times
            and (always and one.name in own or times[one.name] <= (WIDE if one.name in wide else NEAR) * best)]


def usual(lab):
    """Contenders of the environment that most have: they share processes."""
    found = Counter(one.environment for one in lab.contenders).most_common(1)
    return [one for one in lab.contenders if one.environment == found[0][0]] if found else []


def elsewhere(lab, cell):
    """Records of those who take no part in a cell, as they have processes of their own."""
    here = usual(lab)
    for one in lab.contenders:
        if one not in here:
            lab.skip(replace(cell, contenders=(one,), role=f"{cell.role}{LEFT_OUT}"), "excluded",
                     "on another BLAS pair: timed with the sizes alone")


def about(lab, scene):
    """Has the program describe a scene."""
    return lab.one(Cell("describe", scene, role="about"))
