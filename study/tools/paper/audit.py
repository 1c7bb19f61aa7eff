# study/paper --audit: what is wrong with the paper, its set and what was built, each a line. Needs no LaTeX.
import re

from analysis.core import schema
from analysis.core.files import ROOT, digest, read_json
from study.tools.merge import agreement
from study.tools.paper import artifact
from study.tools.paper.figures import DRAWN
from study.tools.paper.tables import TABLES
from study.tools.store import faults

PAPER = ROOT / "paper"
BUILD = PAPER / "build"
STAMP = BUILD / "set.json"
# What may hold digits that are no number of the text: names (none begins with a digit), lengths, what is marked as given, and the study's year.
NO_TEXT = re.compile(r"\\(?:given|val|holds|cite|label|ref|eqref|tag|input|studyfigure|studytable|longstudytable|includegraphics|texttt(?!\{\W*\d))"
                     r"(?:\[[^]]*\])?\{(?:[^{}]|\{[^{}]*\})*\}|\\(?:setlength|renewcommand)\{[^{}]*\}(?:\{[^{}]*\})?|[\^_]\{?\d\}?|(?<!\d)2008(?!\d)")
EQUATION = re.compile(r"\\begin\{equation\}(.*?)\\end\{equation\}", re.S)  # whose coefficients have one digit
EITHER = re.compile(r"\\either\{([\w.]+)\}")
USED = {"value": re.compile(r"\\val\{([^{}]*)\}"), "holds": re.compile(r"\\holds\{([^{}]*)\}"), "figure": re.compile(r"\\studyfigure\{([^{}]*)\}"),
        "table": re.compile(r"\\(?:long)?studytable(?:\[[^]]*\])?\{([^{}]*)\}"), "cited": re.compile(r"\\cite\{([^{}]*)\}"), "tag": re.compile(r"\\tag\{([^{}]*)\}|Eq\.~\\given\{\((\d+)\)\}")}


def audit(known, text, found, claimed):
    """[what is wrong]; `found`: numbers by name; `claimed`: {claim: (whether it holds, what was found)}."""
    return [*of_sets(known), *of_text(text, found, claimed), *of_references(text, (PAPER / "references.bib").read_text(encoding="utf-8")),
            *built(known), *artifact.stale(known, claimed)]


def source():
    """The paper without comments."""
    return re.sub(r"(?<!\\)%.*", "", (PAPER / "paper.tex").read_text(encoding="utf-8"))


def of_sets(known):
    """What is wrong with the set and those that are compared; other stored sets."""
    for one in known.sets:
        yield from faults(one)
    for one in known.stored:
        if one not in known.sets and one.context["commit"] == known.context["commit"]:  # one of another commit waits for its partner
            what = agreement.unlike(known, one) or f"{one.folder} is of a processor that has a set of this build already"
            yield f"{what}: machines are compared by sets of one build; measure it anew, or remove it"


def of_text(text, found, claimed):
    """Numbers that are typed; names that are unknown or not used; claims that do not hold."""
    body = text = text[text.index(r"\begin{document}"):]
    body = EQUATION.sub(lambda one: re.sub(r"(?<!\d)\d(?!\d)", " ", one[1]), body)
    for line in NO_TEXT.sub(" ", re.sub(r"\\begin\{(\w+)\}(\[[^]]*\])?", " ", EITHER.sub(" ", body))).splitlines():
        for digits in re.findall(r"\S*\d\S*", line):
            yield rf"a number is typed: {digits} (a measured one is a \val, another \given)"
    for digits in re.findall(r"\\given\{([^{}]*)\}", text):
        for name, one in found.items():
            if digits.strip("$") == one.text and one.records and len(re.sub(r"\D", "", digits)) > 2:
                yield rf"\given{{{digits}}} is the measured number {name}"
    held = USED["holds"].findall(text)
    for kind, known in (("value", found), ("table", TABLES), ("figure", DRAWN), ("claim", claimed)):
        used = [*held, *EITHER.findall(text)] if kind == "claim" else USED[kind].findall(text)
        yield from (f"paper.tex uses the {kind} '{name}', which is not defined" for name in dict.fromkeys(used) if name not in known)
        yield from (f"the {kind} '{name}' is defined and not used" for name in known if name not in used)
    yield from (f"the claim '{name}' does not hold: {claimed[name][1] or 'not measured'}" for name in dict.fromkeys(held) if name in claimed and not claimed[name][0])


def of_references(text, bibliography):
    """Who is cited and unknown, or known and not cited, or has no DOI; equations that have no place in paper/."""
    entries = dict(re.findall(r"@\w+\{(\w+),(.*?)\}\}\s*(?=\n|$)", bibliography, re.S))
    cited = {name for group in USED["cited"].findall(text) for name in group.split(",")}
    yield from (f"references.bib has no '{name}'" for name in sorted(cited - set(entries)))
    yield from (f"'{name}' of references.bib is not cited" for name in entries if name not in cited)
    yield from (f"'{name}' of references.bib has no DOI" for name, entry in entries.items() if "doi = {10." not in entry)
    equations = "\n".join((PAPER / name).read_text(encoding="utf-8") for name in ("README.md", "other_schemes.md"))
    yield from (f"paper/README.md has no equation ({number})" for pair in USED["tag"].findall(text) for number in [next(filter(None, pair))]
                if f"    ({number})" not in equations)


def stamp(known):
    """What the built files are of: the set, its commit, its tables and those of the compared sets."""
    kept = {one.folder.name: {part: digest(one.folder / part / schema.DIGESTS) for part in one.facts["parts"]} for one in known.sets}
    return {"set": known.folder.name, "commit": known.context["commit"], "tables": kept}


def built(known):
    """Figures and numbers that lie in paper/build and are of another set."""
    if STAMP.exists() and read_json(STAMP) != stamp(known):
        was = read_json(STAMP)
        yield f"paper/build is of {was.get('set')} at {str(was.get('commit'))[:10]}, not of {known.folder.name} as it is now: run study/paper, or remove it"
