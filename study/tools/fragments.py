# Numbers in texts: a README has places between marks that are filled from stored sets, and nowhere else a measured number.
import json
import re

import numpy

from analysis.core import site
from analysis.core.files import ROOT, RULE, StudyError, as_json, read_json, write_text
from analysis.core.view import Folder
from study.tools.merge import agreement, machine

MARKED = re.compile(r"(<!-- from the stored sets: (\S+) -->\n)(.*?)(<!-- end -->)", re.S)


def main_set():
    """The stored set that the rule of `mbs describe` names: README and paper are of it, too."""
    name = read_json(RULE).get("set")
    if not name or not (ROOT / "results" / name / "set.json").exists():
        raise StudyError(f"{RULE.relative_to(ROOT)} names no stored set (set is {name!r}): name the one that rule, README and paper are of")
    return ROOT / "results" / name


def filled(text):
    """A text with its marked places as the stored sets say them now."""
    return MARKED.sub(lambda one: one[1] + fragment(one[2]) + one[4], text)


def fragment(what):
    """"cases": the table of the main set, with a row about the processors that are compared; a part's name: its answers as a list."""
    main = main_set()
    known = site.answers_of(main)
    if what == "cases":
        others = [Folder(path.parent) for path in sorted(main.parent.glob("*/set.json")) if path.parent != main]
        rows = [case for one in known.values() if one for case in one["cases"]] + _machines(Folder(main), others)
        return "".join(["| your case | take this |\n|---|---|\n", *(f"| {row['case']} | {row['take']} |\n" for row in rows)])
    if known.get(what) is None:
        raise StudyError(f"{main} has no answers of '{what}'")
    return "".join(f"- {one['text']}\n" for one in known[what]["answers"])


def _machines(main, others):
    """The row that says what holds on several processors; none of one."""
    if not (sets := agreement.compared(main, others)):
        return []
    count = agreement.shares(agreement.mechanisms(sets))
    names = ", ".join(one.folder.name for one in sets)
    found = {one.folder.name: [*machine.carried(main, one).values()] for one in sets if one.folder != main.folder}
    rules = "".join(f"; the rule of {main.folder.name}, on what was measured for {name}: {100 * numpy.nanmean(losses):.1f} % slower than the "
                    f"fastest on average, {100 * numpy.nanmax(losses):.0f} % at worst" for name, losses in found.items())
    where = f" (sets {names}, commit {main.facts['context']['commit'][:10]})"
    return [{"case": "Your processor is another one",
             "take": f"what `build/mbs bench` names there; on {len(sets)} processors{where} the same library is fastest on {count['same']} of "
                     f"{count['all']} mechanisms at their own fill; on {count['common']} more, one library is nowhere shown to be over 5 % slower "
                     f"than the fastest; on {count['differ']} it depends on the processor{rules}"}]


def refresh():
    """Fills all texts of the repository anew, and the rule; the paths of those that changed."""
    return [path for path, made in ((RULE, of_set), *((text, filled) for text in texts())) if rewritten(path, made)]


def rewritten(path, made):
    """Whether a file has changed to what is made of its text."""
    before = path.read_text(encoding="utf-8")
    after = made(before)
    if after != before:
        write_text(path, after)
    return after != before


def of_set(rule):
    """The rule of the stored set that the text of one names; of none, {}, itself."""
    name = json.loads(rule).get("set")
    return as_json({"set": name} | read_json(ROOT / "results" / name / "families" / RULE.name)) if name else rule


def texts():
    """All READMEs and the like."""
    return sorted(path for path in ROOT.rglob("*.md") if not {".git", "local", "node_modules"} & set(path.parts)
                  and not path.relative_to(ROOT).parts[0].startswith("build"))
