# One job of the workflow: the cells of a part or, on a cluster, of a column; a page; the front page.
import contextlib
import importlib
import os
import select
import signal
import sys
import threading
import traceback
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

from analysis.core.files import StudyError
from study.core import child, node
from study.core.lab import Lab, cores
from study.core.profile import plan_of
from study.core.studyset import StudySet, finish, need_records

FRONT = "MBS_STUDY_FRONT"  # the process that everything here belongs to


def main(arguments):
    """Exit status; a StudyError becomes one line "error: …" that the front shows."""
    end_with(os.environ.get(FRONT))
    child.end_on_signals()
    folder, verb, *rest = arguments
    try:
        verbs = {"run": run, "pages": pages, "index": index, "start": node.first, "column": column, "draw": draw}
        verbs[verb](StudySet(Path(folder).resolve()), *rest)
        return 0
    except StudyError as error:
        print(f"error: {error}", file=sys.stderr)
    except OSError as error:
        print(f"error: {error.filename or folder}: {error.strerror}", file=sys.stderr)
    except KeyboardInterrupt:
        return 130
    except Exception as error:  # a fault of the study, or records that are not what they were; the log has it all
        traceback.print_exc()
        print(f"error: {' '.join(rest) or verb}: {type(error).__name__}: {' '.join(str(error).split())[:300]}", file=sys.stderr)
    return 1


def run(studyset, part):
    """The columns of a part that are not done, and its page."""
    for name, seconds in plan_of(part).columns(studyset.profile.parts[part]).items():
        if not studyset.stamp(part, name).exists():
            _measure(studyset, part, name, seconds)
    page(studyset, part)
    index(studyset, part)  # nothing else runs now


def column(studyset, part, name):
    """Of a cluster: one column, on this node."""
    with contextlib.ExitStack() as held:
        node.admit(studyset, held)
        _measure(studyset, part, name, plan_of(part).columns(studyset.profile.parts[part])[name])


def _measure(studyset, part, name, seconds):
    lab = Lab(studyset, part, name, seconds)
    plan_of(part).run(lab, name)
    finish(studyset, part, name, lab.names)


def draw(studyset, part):
    """Of a cluster: the page of what nodes have measured, when all of it is seen here."""
    need_records(studyset)
    page(studyset, part)
    index(studyset)


def page(studyset, part):
    from analysis.core import site  # these need modules that take a second to load
    site.write_part(studyset.folder, part)


def pages(studyset):
    """All pages of a stored set, as many at once as there are cores, and the front page. What draws them takes seconds to load:
    once, in this process, whose copies draw."""
    parts = studyset.facts["parts"]
    for part in parts:
        importlib.import_module(f"analysis.{part}.tables")
    with ProcessPoolExecutor(cores(), get_context("fork"), end_with, (os.getpid(),)) as pool:
        list(pool.map(page, [studyset] * len(parts), parts))
    index(studyset)


def index(studyset, part=None):
    """`part`: all that is new since it was made."""
    from analysis.core import site
    site.write_index(studyset.folder, part)


def end_with(front):
    """Ends this process, and with it its children, when the process `front` ends, however that ends."""
    if not front:
        return
    try:
        watched = os.pidfd_open(int(front))
    except OSError:
        os._exit(1)  # it has ended already

    def watch():
        select.select([watched], [], [])
        os.kill(os.getpid(), signal.SIGKILL)  # children die with their parent: child.py
    threading.Thread(target=watch, daemon=True).start()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
