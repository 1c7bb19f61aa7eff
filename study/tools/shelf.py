# Where a tool keeps its records: a set without parts, so that cells run, resume and are refused as those of parts.
import datetime
from pathlib import Path

from analysis.core.errors import StudyError
from analysis.core.files import write_json
from study.core.executor import need_same
from study.core.front import Display
from study.core.lab import Lab
from study.core.studyset import StudySet, need_own


def open_shelf(folder, tool, context, only, **question):
    """The StudySet in `folder`, new or continued; StudyError if it holds results of something else. `question`:
    what must be equal for the records to be of use."""
    facts = {"profile": tool, "only": only, "parts": [], "context": context,
             "programs": {},
             "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M"), **question}
    need_own(folder)
    found = StudySet(folder)
    if (folder / "set.json").exists():
        need_same(found.facts["context"], context, str(folder))
        for key in facts:
            if key not in ("context", "date", "programs") and found.facts.get(key) != facts[key]:
                raise StudyError(f"{folder} holds results of something else ({key}); results are never merged: name "
                                 "another directory, or move this one away")
    else:
        write_json(folder / "set.json", facts)
    found.need_programs(["mbs"])
    found.clear()
    return StudySet(folder)


def table(rows, name):
    """Rows as the table of that name in schema.yaml."""
    import pandas
    from analysis.core import schema
    return schema.conform(pandas.DataFrame(rows), schema.read(Path(__file__).with_name("schema.yaml"))[name], name)


class ToolLab(Lab):
    """A lab that shows what it does on the terminal. `quiet` shows nothing."""

    def __init__(self, studyset, tool, column, seconds=float("inf"), quiet=False):
        super().__init__(studyset, tool, column, seconds)
        self.progress = _Shown(tool, quiet)


class _Shown:
    """Of Progress what a lab calls."""

    def __init__(self, title, quiet):
        self.title, self.known, self.cells, self.text = title, 0, 0, ""
        self.display, self.quiet = Display(), quiet

    def expect(self, cells):
        self.known += cells

    def done(self):
        self.cells += 1
        self.tell(self.text)

    def tell(self, text):
        self.text = text
        if not self.quiet:
            total = max(self.known, self.cells)
            self.display.show(self.title, f"{self.cells} of {total} cells{'; ' * bool(text)}{text}")

    def end(self):
        if not self.quiet:
            self.display.end()
