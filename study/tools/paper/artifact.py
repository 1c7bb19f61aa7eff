# paper/ARTIFACT.md: the places that are filled from the set of the paper.
import re
from pathlib import Path

from analysis.core.files import ROOT, digest
from analysis.core.text import layout
from study.tools.fragments import rewritten
from study.tools.paper.claims import claims

FILE = ROOT / "paper" / "ARTIFACT.md"
MARKED = re.compile(r"(<!-- of the paper's set: (\w+) -->\n)(.*?)(<!-- end -->)", re.S)
SAYS = {True: "holds", False: "does not hold", None: "not measured"}


def places(known, claimed):
    """What stands at each mark: a function of its name."""
    return layout(Path(__file__).with_name("artifact.md.j2")).make_module(
        {"known": known, "claimed": claimed, "listed": claims(), "says": SAYS, "digest": digest})


def filled(text, known, claimed):
    made = places(known, claimed)
    return MARKED.sub(lambda one: one[1] + getattr(made, one[2])() + one[4], text)


def refresh(known, claimed):
    """Whether the file changed."""
    return rewritten(FILE, lambda text: filled(text, known, claimed))


def stale(known, claimed):
    text = FILE.read_text(encoding="utf-8")
    if filled(text, known, claimed) != text:
        yield f"paper/ARTIFACT.md is not of {known.folder.name} as it is now: study/paper --fill"


def judged(known):
    """{claim: (whether it holds, what was found)}"""
    return {one.name: one.found(known) for one in claims()}


def told(known):
    """A line a claim, also of a set that has a few parts."""
    for one in claims():
        holds, found = one.found(known)
        yield f"{SAYS[holds]}: {one.text}" + ("" if holds is None else f" ({found})")
