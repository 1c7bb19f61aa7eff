# Numbers in texts: a README has places between marks that are filled from a stored set, and nowhere else a measured
# number.
#
#   <!-- from SET: cases -->
#   …
#   <!-- end -->
import json
import re

from analysis.core import site
from analysis.core.errors import StudyError
from analysis.core.files import ROOT, as_json, read_json, write_text

RULE = ROOT / "harness" / "src" / "describe" / "rule.json"  # what `mbs describe` applies: that of the set it names
MARKED = re.compile(r"(<!-- from (\S+): (\S+) -->\n)(.*?)(<!-- end -->)", re.S)


def filled(text):
    """A text with its marked places as their sets say them now."""
    return MARKED.sub(lambda one: one[1] + fragment(one[2], one[3]) + one[5], text)


def fragment(name, what):
    """"cases": the table of results/NAME; a part's name: its answers as a list."""
    folder = ROOT / "results" / name
    known = site.answers_of(folder)
    if what == "cases":
        rows = [case for one in known.values() if one for case in one["cases"]]
        return "".join(["| your case | take this |\n|---|---|\n", *(f"| {row['case']} | {row['take']} |\n" for row in rows)])
    if known.get(what) is None:
        raise StudyError(f"{folder} has no answers of '{what}'")
    return "".join(f"- {one['text']}\n" for one in known[what]["answers"])


def refresh():
    """Fills all texts of the repository anew, and the rule; the paths of those that changed."""
    changed = []
    for path, made in ((RULE, of_set), *((text, filled) for text in texts())):
        before = path.read_text(encoding="utf-8")
        if made(before) != before:
            write_text(path, made(before))
            changed.append(path)
    return changed


def of_set(rule):
    """The rule of the stored set that the text of one names; of none, {}, itself."""
    name = json.loads(rule).get("set")
    return as_json({"set": name} | read_json(ROOT / "results" / name / "families" / RULE.name)) if name else rule


def texts():
    """All READMEs and the like."""
    return sorted(path for path in ROOT.rglob("*.md") if not {".git", "local", "node_modules"} & set(path.parts)
                  and not path.relative_to(ROOT).parts[0].startswith("build"))
