# The lab: where a part's plan has its cells run. A plan asks for cells, gets their records, and may ask for more.
#
# What has a record is never run again, so that a plan that was interrupted, begun anew, comes to the same point.
# A plan must therefore ask for the same cells where it gets the same records.
import os
import re
import shutil
import tempfile
import threading
from concurrent.futures import ThreadPoolExecutor

from analysis.core import records
from analysis.core.files import ROOT, StudyError, write_json
from study.core import executor, locks

ROOM = 2**20  # bytes: where less is free, a failure is none of the program
BETWEEN = 0.005  # s that the study itself takes for a cell, about: it writes the record, and plans
NOT_WRITTEN = re.compile(r"cannot write|No space left|Disk quota|Read-only file system")


class Lab:
    """One column of a part in a set. `seconds`: the column's budget."""

    def __init__(self, studyset, part, column, seconds=float("inf")):
        self.set, self.part, self.column, self.budget = studyset, part, column, seconds
        self.base = studyset.folder / "raw" / part
        self.names, self.spent, self.lock = {}, 0.0, threading.Lock()  # of the cells that are done, which may end at once
        self.asked, self.text = set(), ""  # names of all cells that are known of; what is told beside their number
        self.known = set()  # programs that are those of the set's records

    def contender(self, name):
        """The one of a variant; None if it does not take part."""
        return next((one for one in self.contenders if one.name == name), None)

    settings = property(lambda self: self.set.profile.parts[self.part])
    registry = property(lambda self: self.set.registry)
    contenders = property(lambda self: self.set.contenders)

    def one(self, cell):
        return self.run([cell])[0]

    def run(self, cells, drop=False):
        """Records of cells, in their order. Timed ones have the machine for themselves, one after the other; the others run at once on all cores.
        With `drop`, what is left when the budget is spent gets a record that says so: order cells by their worth."""
        cells = [cell.settled() for cell in cells]
        self.asked |= {self._name(cell) for cell in cells}
        self.tell()
        found, todo, known, before = {}, [], set(self.names), self.spent
        for cell in dict.fromkeys(cells):
            if (self.base / self._name(cell)).exists():
                found[cell] = self._keep(cell)
                records.need_same_origin(found[cell], self._asked_of(cell), self.base)
            else:
                todo.append(cell)
        programs = {cell.built for cell in todo}
        self.set.need_programs(sorted(programs - self.known))
        self.known |= programs
        alone, others = ([cell for cell in todo if cell.timed == timed] for timed in (True, False))
        with ThreadPoolExecutor(cores()) as pool:
            found |= zip(others, pool.map(lambda one: self._made(one, drop), others))
        longest = max((record.seconds for record in found.values() if record.name not in known), default=0.0)
        self.spent = max(self.spent, before + longest)  # other cores were idle beside it
        if alone:
            with locks.only_one_timing():
                found |= {cell: self._made(cell, drop) for cell in alone}
        return [found[cell] for cell in cells]

    def skip(self, cell, status, reason):
        cell = cell.settled()
        self.asked.add(self._name(cell))
        self.tell()
        return self._keep(cell, {"cell": cell.document(), "status": status, "reason": reason, "seconds": 0.0,
                                 "command": executor.command_of(cell), "context": self._context(cell, self.set.facts["context"])})

    def scene(self, name, document):
        """Writes a scene of the part's own; its name for cells."""
        path = self.base / "scenes" / f"{name}.json"
        if not path.exists():
            write_json(path, document)
        return os.path.relpath(path, ROOT) if path.is_relative_to(ROOT) else str(path)

    def tell(self, text=None):
        """How many cells are done, and beside it this text from now on."""
        self.text = self.text if text is None else text
        self.show(f"{len(self.names)} of {len(self.asked)} cells", self.text)

    def show(self, cells, text):
        """Leaves what there is to say where the front looks for it."""
        write_json(self.set.progress, {"part": self.part, "column": self.column, "cells": cells, "text": text})

    left = property(lambda self: self.budget - self.spent)  # seconds of the budget, counted by the records: the same in a run that was resumed

    def _made(self, cell, drop):
        program = executor.program_of(*cell.built.split("@"))
        if not cell.own and not (ROOT / program).exists():  # `mbs` is there, or nothing is
            return self.skip(cell, "unavailable", f"{program} is missing: study/setup builds it")
        if drop and self.left <= 0:
            return self.skip(cell, "dropped", f"the budget of {self.budget:.0f} s was spent")
        context = self._asked_of(cell)
        data = executor.run(cell, context if cell.own and cell.contenders else None, self.set.scratch)
        if data["status"] != records.RUN_ENDED and (NOT_WRITTEN.search(data["reason"]) or ROOM > min(
                shutil.disk_usage(folder).free for folder in (tempfile.gettempdir(), self.set.scratch))):
            raise StudyError(f"no space is left on a disk, or it cannot be written to ({program}: {data['reason']}): nothing is kept of "
                             "that run; make room and run it again")
        if not data["context"]:
            data["context"] = self._context(cell, context)
        return self._keep(cell, data)

    def _asked_of(self, cell):
        return self.set.context(cell.contenders[0]) if cell.contenders else self.set.facts["context"]

    @staticmethod
    def _context(cell, context):
        """What is known of a cell that says nothing of it: other programs have compilers and libraries of their own."""
        return context if cell.own else {key: context[key] for key in executor.OF_ALL if key in context}

    def _keep(self, cell, data=None):
        """The cell's record, which counts from now on. `data`: what it says, if there is none yet."""
        path = self.base / self._name(cell)
        if data and not path.exists():  # a node that was given up may be at work still: the first record stays
            records.write(path, data)
        record = records.read(path, self._name(cell))
        if record.name not in self.names:
            taken = BETWEEN + record.seconds / (1 if record.cell["timed"] else cores())
            with self.lock:
                self.names[record.name] = None  # in their order
                self.spent += taken
            self.tell()
        return record

    def _name(self, cell):
        return f"{self.column}/{cell.file_name()}"


def cores():
    return len(os.sched_getaffinity(0))
