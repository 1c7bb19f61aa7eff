# Numbers in texts: a README has places between marks that are filled from stored sets, and nowhere else a measured number.
import json
import re
from pathlib import Path
from statistics import median

import numpy

from analysis.core import site
from analysis.core.files import ROOT, RULE, StudyError, as_json, read_json, write_text
from analysis.core.text import layout, number
from analysis.core.view import Folder
from study.tools.merge import agreement, machine

CITATION = ROOT / "CITATION.cff"
SWEEPS = ROOT / "results" / "sweeps"  # records of study/limit/million
FRESH = ROOT / "results" / "fresh"    # of study/merge --fresh
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
    """"cases": the table of the main set, with a row about the processors that are compared; a part's name: its answers as a list;
    "million": the records of large sweeps; "fresh": runs that are held to the stored pair."""
    if what == "million":
        return million([read_json(path) for path in sorted(SWEEPS.glob("*.json"))])
    if what == "fresh":
        return _made("fresh", [read_json(path) for path in sorted(FRESH.glob("*.json"))], agreement.LAYERS)
    main = main_set()
    known = site.answers_of(main)
    if what == "cases":
        others = [Folder(path.parent) for path in sorted(main.parent.glob("*/set.json")) if path.parent != main]
        rows = [case for one in known.values() if one for case in one["cases"]] + _machines(Folder(main), others)
        return _made("cases", rows)
    if known.get(what) is None:
        raise StudyError(f"{main} has no answers of '{what}'")
    return _made("answers", known[what]["answers"])


def gain(part):
    """Of the runs of a part, by one job and by two in turns: how many times as many lanes a second two jobs have, turn by turn."""
    one, two = ([row["wall_s"] for row in part if row["jobs"] == jobs] for jobs in (1, 2))
    ratios = [first / second for first, second in zip(one, two)]
    return {"turns": len(ratios), "median": median(ratios), "least": min(ratios), "most": max(ratios)}


def million(records):
    """The records of large sweeps, a column each: what was run, and what is projected from a part of it."""
    wall = lambda part: {jobs: median(row["wall_s"] for row in part if row["jobs"] == jobs) for jobs in (1, 2)}
    return _made("million", [one | {"gain": gain(one["part"]), "wall": wall(one["part"])} for one in records])


def _made(what, *known):
    return getattr(layout(Path(__file__).with_name("fragments.md.j2")).make_module({"number": number}), what)(*known)


def _machines(main, others):
    """The row that says what holds on several processors; none of one."""
    if not (sets := agreement.compared(main, others)):
        return []
    found = {one.folder.name: [*machine.carried(main, one).values()] for one in sets if one.folder != main.folder}
    losses = {name: (100 * numpy.nanmean(some), 100 * numpy.nanmax(some)) for name, some in found.items()}
    return [{"case": "Your processor is another one", "take": _made("machines", main, sets, agreement.shares(agreement.mechanisms(sets)), losses)}]


def refresh():
    """Fills all texts of the repository anew, the rule, and how it is cited; the paths of those that changed."""
    return [path for path, made in ((RULE, of_set), (CITATION, cited), *((text, filled) for text in texts())) if rewritten(path, made)]


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


def cited(text):
    """CITATION.cff with the commit of the main set."""
    return re.sub(r'^commit: "\w*"', f'commit: "{read_json(main_set() / "set.json")["context"]["commit"]}"', text, flags=re.M)


def texts():
    """All READMEs and the like."""
    return sorted(path for path in ROOT.rglob("*.md") if not {".git", "local", "node_modules"} & set(path.parts)
                  and not path.relative_to(ROOT).parts[0].startswith("build"))
