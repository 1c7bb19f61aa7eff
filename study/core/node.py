# What a node of a cluster does in a set that several share: it sees whether it is of the set's kind, then runs a column.
# One that is not begins a set of its own beside it, and is not asked again.
import os
import re
import socket
import tempfile
from pathlib import Path

from analysis.core.files import ROOT, StudyError, digest, read_object, write_json, write_text
from analysis.core.records import Record
from study.core import executor, locks, profile as profiles
from study.core.cell import LAYOUT, Cell, control, twin_of
from study.core.studyset import context_of, start, writable

CONTROL_SCENE, CONTROL_WORDS = "four-bar:10", ("--steps", 20, "--benchmark_repetitions=5")
WAIT = 180  # s for another study on the machine: a part of a job's grace (cluster.py)
TRIES = 2  # so often must an A/A control be decided to count as failed: once in twenty it is by chance


def home(folder):
    """Of what a cluster's run keeps besides the set."""
    return Path(folder) / ".cluster"


def name():
    """This node's, as the cluster calls it."""
    return os.environ.get("SLURMD_NODENAME") or socket.gethostname()


def refused(folder):
    """{path of a node that was refused: [why, its own set, the program]}, without what is being written"""
    return {path: [*path.read_text().splitlines(), "", "", ""][:3] for path in sorted((home(folder) / "refused").glob("[!.]*"))}


def refusals(folder):
    """{node: why it is not of the set}"""
    return {path.name: why for path, (why, _, _) in refused(folder).items()}


def own_sets(folder):
    """Folders of the sets that such nodes have begun."""
    return sorted({Path(own) for _, own, _ in refused(folder).values() if own})


def forget(folder):
    """Has nodes asked again that were refused for what may be mended, as a full disk, or with another program."""
    for path, (_, _, program) in refused(folder).items():
        if not program or program != digest(ROOT / executor.program_of()):
            path.unlink()


def begin(folder, **more):
    """The set of what the plan says, of this node's kind, with `more` facts."""
    plan = read_object(home(folder) / "plan.json")
    start(folder, profiles.load(plan["profile"], plan["parts"]), plan["only"], plan["parts"], **more)


def first(studyset):
    """Begins the set; a node on which that fails is not asked again."""
    try:
        begin(studyset.folder)
    except StudyError as error:
        write_text(home(studyset.folder) / "refused" / name(), f"{error}\n\n\n")
        raise


def admit(studyset, held):
    """StudyError unless this node is free, of the set's kind, has room and passes its A/A control; it is not asked again then. `held`: an
    ExitStack, which keeps other studies off the node."""
    folder, own, alone, lasting = studyset.folder, None, False, ""
    try:
        held.enter_context(locks.only_one_study(True, most=WAIT))
        writable(Path(tempfile.gettempdir()))
        context = context_of(control(studyset.registry, studyset.profile.blas))
        only = home(folder) / "only"
        reason = another(studyset, context)
        if only.exists() and only.read_text().strip() != name():
            reason = f"it is that of {only.read_text().strip()} alone, whose A/A control failed"
        elif reason:
            kind = digest(f"{sorted(executor.fingerprint(context).items())} {digest(ROOT / executor.program_of())}")[:6]
            own = _beside(folder, f"{_slug(context['cpu_model'])}-{kind}")
        elif not (home(folder) / "nodes" / name()).exists() and not only.exists():
            reason = uncontrolled(studyset)
            own, alone = _beside(folder, _slug(name())) if reason else None, True
        lasting = digest(ROOT / executor.program_of())
    except (StudyError, OSError) as error:  # neither of this set nor of another one: its disk is full, its program does not run
        reason = str(error)
    if reason:
        if own:
            _begin_beside(folder, own, reason if alone else "")
        write_text(home(folder) / "refused" / name(), f"{reason}\n{own or ''}\n{lasting}\n")
        raise StudyError(f"{name()} is not of this set: {reason}")
    write_text(home(folder) / "nodes" / name(), "admitted\n")


def another(studyset, context):
    """In what this machine, its libraries or its build differ from the set's; "" if in nothing."""
    if other := executor.differing(studyset.facts["context"], context):
        key, mine, its = other
        return f"another machine or build ({key} is '{its}' on {context['cpu_model']}, the set's is '{mine}')"
    known, program = studyset.facts["programs"], ROOT / executor.program_of()
    return "another build (mbs)" if known.get("mbs") not in (None, digest(program)[:16]) else ""


def uncontrolled(studyset):
    """Why the A/A control of this node failed, in which a contender is timed beside itself; "" if it did not. StudyError where it does not run."""
    from analysis.core.timing import processes, ratio  # needs pandas
    from study.core.timing import LAYOUTS
    one = studyset.contenders[0]
    twin = twin_of(one)
    with locks.only_one_timing():
        for _ in range(TRIES):
            cells = [Cell("bench", CONTROL_SCENE, (one, twin), (*CONTROL_WORDS, "--seed", number), "control", number, f"{LAYOUT}{number}",
                          timed=True).settled() for number in range(1, LAYOUTS + 1)]
            rows = processes([Record("control", **executor.run(cell, None, studyset.scratch)) for cell in cells])
            for row in rows[rows.status != "ok"].itertuples():  # its ratio would be none, and none is decided
                raise StudyError(f"its A/A control does not run: {row.status}: {row.reason}")
            seen = ratio(rows, twin.name, one.name)
            if not (seen.low > 1 or seen.high < 1):
                return ""
    return f"its A/A control failed: {one.name} takes {seen.low:.3f} to {seen.high:.3f} times its own time"


def _beside(folder, slug):
    """The folder of another set; None beside one that is itself beside another: that has the kinds which it left."""
    return None if (home(folder) / "beside").exists() else folder.with_name(f"{folder.name}-{slug}")


def _begin_beside(folder, own, failed):
    writable(own)
    if failed:  # no other node is measured with one whose control failed
        write_text(home(own) / "only", f"{name()}\n")
    with locks.only_one(own, 60):
        if not (own / "set.json").exists():
            write_text(home(own) / "beside", f"{folder}\n")
            write_json(home(own) / "plan.json", read_object(home(folder) / "plan.json"))
            begin(own, **({"no_evidence": failed} if failed else {}))  # at once: a kill may leave the set as it is then


def _slug(text):
    return re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-")[:40]
