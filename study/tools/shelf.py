# Where a tool keeps its records: a set without parts, so that cells run, resume and are refused as those of parts.
from pathlib import Path

from analysis.core import schema
from analysis.core.files import write_json
from study.core import profile as profiles
from study.core.cell import control, on_usual_pairs
from study.core.executor import need_same
from study.core.front import Display
from study.core.lab import Lab
from study.core.studyset import StudySet, begun, context_of, need_own, need_question


def open_shelf(folder, tool, known, only, names, quiet=False, **question):
    """(the ToolLab with the set in `folder`, new or continued, the contenders of these names); StudyError if it holds results of something
    else, such as of another `question`."""
    need_own(folder)
    pairs, found = profiles.load("quick", []).blas, StudySet(folder)
    context = context_of(control(known, pairs))
    if (folder / "set.json").exists():
        need_same(found.facts["context"], context, str(folder))
        need_question(found, profile=tool, only=only, parts=[], **question)
    else:
        write_json(folder / "set.json", begun(tool, only, [], context, **question))
    found.need_programs(["mbs"])
    found.clear()
    return ToolLab(StudySet(folder), tool, "runs", quiet=quiet), on_usual_pairs(known, pairs, names)


def table(rows, name):
    """Rows as the table of that name in schema.yaml."""
    return schema.conform(rows, schema.read(Path(__file__).with_name("schema.yaml"))[name], name)


class ToolLab(Lab):
    """A lab that shows what it does on the terminal. `quiet` shows nothing."""

    def __init__(self, studyset, tool, column, seconds=float("inf"), quiet=False):
        super().__init__(studyset, tool, column, seconds)
        self.display, self.quiet = Display(), quiet

    def show(self, cells, text):
        if not self.quiet:
            self.display.show(self.part, f"{cells}{'; ' * bool(text)}{text}")
