# paper/ARTIFACT.md: the places that are filled from the set of the paper.
import math
import re

from analysis.core.files import ROOT, digest
from study.tools.fragments import rewritten
from study.tools.paper.claims import claims

FILE = ROOT / "paper" / "ARTIFACT.md"
MARKED = re.compile(r"(<!-- of the paper's set: (\w+) -->\n)(.*?)(<!-- end -->)", re.S)
SAYS = {True: "holds", False: "does not hold", None: "not measured"}


def filled(text, known, claimed):
    made = {"set": lambda: _set(known), "claims": lambda: _claims(known, claimed), "archives": lambda: _archives(known)}
    return MARKED.sub(lambda one: one[1] + made[one[2]]() + one[4], text)


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


def _set(known):
    first, *others = (f"`{one.folder.name}` of {one.facts['date'][:10]}, {one.context['cpu_model']}" for one in known.sets)
    beside = f" Beside it, of the same build, to compare processors: {'; '.join(others)}." if others else ""
    return f"Set {first}, commit `{known.context['commit'][:10]}`.{beside}\n"


def _claims(known, claimed):
    """claim → command → what it should give → minutes → where"""
    sets = " ".join(f"results/{one.folder.name}" for one in known.compared) or "SET SET"
    merge = f"`study/merge {sets}` | {{}} | 1 | its page"
    rows = [f"| {one.text} ({SAYS[claimed[one.name][0]]}) | {(merge if one.merged else _run(known, one)).format(claimed[one.name][1] or '–')}; "
            f"section {one.where} |\n" for one in claims()]
    return "| claim | command | expected | minutes | where |\n|---|---|---|---|---|\n" + "".join(rows)


def _run(known, one):
    minutes = math.ceil(known.view(one.part).settings["seconds"] / 60)
    return f"`study/run --profile {known.facts['profile']} --part {one.part}` | {{}} | {minutes} | `{one.part}.html`"


def _archives(known):
    rows = [f"| `{one.folder.name}/raw/{path.name}` | {path.stat().st_size / 2**20:.2f} | `{digest(path)}` |\n"
            for one in known.sets for path in sorted((one.folder / "raw").glob("*.tar.xz"))]
    return "| archive | MB | SHA-256 |\n|---|---|---|\n" + "".join(rows)
