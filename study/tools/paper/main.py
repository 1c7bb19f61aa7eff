# study/paper [SET]: the paper of a stored set, as PDF; study/paper --audit: is it of this set, and does it say what the set says?
import os
import re
import shutil
import subprocess
from pathlib import Path

from analysis.core.files import ROOT, StudyError, write_json, write_text
from analysis.core.style import save
from study.core.options import Parser, directory
from study.tools.fragments import main_set
from study.tools.paper import artifact, audit, figures, tables
from study.tools.paper.known import Known
from study.tools.paper.numbers import numbers

LATEX = ("latexmk", "biber")
LEAST, MOST = 10, 14  # pages


def paper(arguments):
    parser = Parser(prog="study/paper", description="Builds paper/build/paper.pdf from a stored set. The build fails where the paper types a number, "
                    "names one that is not there, or claims what the set does not say.")
    parser.add_argument("set", nargs="?", type=directory, help="its directory (the one that the rule of `mbs describe` names)")
    one = parser.add_mutually_exclusive_group()
    one.add_argument("--audit", action="store_true", help="only say what is wrong, a line each; needs no LaTeX")
    one.add_argument("--claims", action="store_true", help="only say which claims hold in a set, a line each; also in one that is not stored")
    one.add_argument("--fill", action="store_true", help="only fill paper/ARTIFACT.md anew")
    options = parser.parse_args(arguments)
    known = Known((options.set or main_set()).resolve())
    if not options.claims and known.folder.parent != ROOT / "results":
        raise StudyError(f"{known.folder} is no stored set: the paper is built from one of results/ (study/store)")
    known.need_whole()
    if options.claims:
        print(*artifact.told(known), sep="\n")
        return 0
    claimed = artifact.judged(known)
    if options.fill:
        print("filled anew: paper/ARTIFACT.md" if artifact.refresh(known, claimed) else "paper/ARTIFACT.md is as it was")
        return 0
    if not options.audit:
        if missing := [name for name in LATEX if shutil.which(name) is None]:
            raise StudyError(f"{', '.join(missing)} is missing: run study/setup --paper")
        artifact.refresh(known, claimed)
        shutil.rmtree(audit.BUILD, ignore_errors=True)  # which may be of another set
    found = numbers(known)
    wrong = list(audit.audit(known, audit.source(), found, claimed))
    for line in wrong:
        print(f"paper: {line}")
    if wrong:
        return 1
    if options.audit:
        print(f"paper: of {known.folder.name} at {known.context['commit'][:10]}: {len(found)} numbers, {len(claimed)} claims, nothing wrong")
        return 0
    write_parts(known, found, claimed)
    return build()


def write_parts(known, found, claimed):
    """What paper.tex takes in: numbers, claims, tables and figures of the set, and the stamp that says of which."""
    words = {True: "yes", False: "no", None: "unknown"}
    lines = [rf"\csdef{{number@{name}}}{{{tables.tex(one.text)}}}" for name, one in found.items()]
    lines += [rf"\csdef{{claim@{name}}}{{{words[holds]}}}" for name, (holds, _) in claimed.items()]
    write_text(audit.BUILD / "numbers.tex", Path(__file__).with_name("macros.tex").read_text(encoding="utf-8") + "\n".join(lines) + "\n")
    for name in tables.TABLES:
        write_text(audit.BUILD / f"table-{name}.tex", getattr(tables, name)(known) + "\n")
    write_text(audit.BUILD / "table-numbers.tex", tables.of_numbers(found))
    write_text(audit.BUILD / "numbers.csv", tables.all_numbers(found))
    print("drawing", flush=True)
    for name, (draw, height) in figures.DRAWN.items():
        save(figures.fit(draw(known), height), audit.BUILD / f"figure-{name}.pdf")
    write_json(audit.STAMP, audit.stamp(known))


def build():
    done = subprocess.run(["latexmk", "-pdf", "-interaction=nonstopmode", "-halt-on-error", "-file-line-error", "-outdir=build", "paper.tex"],
                          cwd=audit.PAPER, env={**os.environ, "max_print_line": "1000"}, capture_output=True, text=True, errors="replace")
    if done.returncode:
        said = [line for line in done.stdout.splitlines() if line.startswith("!") or ".tex:" in line]
        raise StudyError("LaTeX failed: " + "; ".join(said[:3] or done.stdout.splitlines()[-3:]) + f" (log: {audit.BUILD / 'paper.log'})")
    log = (audit.BUILD / "paper.log").read_text(encoding="utf-8", errors="replace")
    pages = int(next(iter(re.findall(r"Output written on .*?\((\d+) pages?", log, re.S)), 0))
    wrong = re.findall(r"^LaTeX Warning: ((?:Reference|Citation) .* undefined)", log, re.M)
    wrong += [f"it should have {LEAST} to {MOST} pages"] * (not LEAST <= pages <= MOST)
    print(f"paper: {audit.BUILD / 'paper.pdf'}, {pages} pages", *wrong, sep="\npaper: ")
    return int(bool(wrong))
