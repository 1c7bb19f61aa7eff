# What page.html.j2 shows of the standard problems and of modelling; whether they come out right, and what each piece of modelling costs.
import base64
import math
from pathlib import Path

from analysis.core.files import ROOT
from analysis.core.outcomes import GOOD
from analysis.core.text import answers as said, grouped

HERE = Path(__file__).parent
SHEETS = ROOT / "harness" / "scenes" / "pictures"
CONSERVED = 1e-3  # share of the energy's scale
DROPPED = ("unsupported", "dropped")


def context(tables, view):
    problems, convergence = tables["problems"], tables["convergence"]
    rows = finest(problems)
    return {"compared": list(dict.fromkeys(rows.implementation)), "finest": grouped(rows, "title"), "gate": gate(tables["gate"]),
            "everyone": everyone(problems), "conserved_limit": CONSERVED, "convergence": grouped(convergence, "problem"), "digits": digits,
            "published": set(convergence.problem[convergence.published.notna()]), "good": GOOD, "settings": view.settings,
            "modelling": grouped(tables["modelling"], ["implementation", "loops"]),
            "sheets": {path.stem.replace("_", " "): base64.b64encode(path.read_bytes()).decode() for path in sorted(SHEETS.glob("*.png"))}}


def gate(table):
    """[(problem, how many agree, how many were asked, [(verdict, reason, implementations) of the others])]"""
    return [(name, int((group.verdict == "agrees").sum()), len(group),
             [(*what, list(others.implementation)) for what, others in
              group[group.verdict != "agrees"].groupby(["verdict", "reason"], sort=False)])
            for name, group in table.groupby("problem", sort=False)]


def everyone(problems):
    """[(title, step, rows)] of the problems that more than the two ran, at the first step."""
    first = problems[problems.step == problems.groupby("title").step.transform("max")]
    return [(title, rows.step.iloc[0], rows.to_dict("records")) for title, rows in first.groupby("title", sort=False)
            if not rows.compared.fillna(False).all()]


def digits(value, count=8):
    """`value` with `count` significant digits, never in powers of ten for positions."""
    if not value or not math.isfinite(value):
        return "0" if value == 0 else "–"
    return f"{value:.{max(0, count - 1 - math.floor(math.log10(abs(value))))}f}"


def finest(problems):
    """The rows of the two that are compared, at the finest step that each ran."""
    rows = problems[problems.compared.fillna(False).astype(bool)]
    return rows[rows.step == rows.groupby(["problem", "implementation"]).step.transform("min")]


def answers(tables, view):
    gate = tables["gate"]
    return said(HERE / "answers.j2", "Not measured: no implementation that runs them took part.", rows=finest(tables["problems"]), good=GOOD,
                asked=gate[~gate.verdict.isin(DROPPED)], left=(gate.verdict == "dropped").sum(), costs=_costs(tables["modelling"]))


def _costs(modelling):
    """(size, rows of the implementation that is fastest there on the plain model)"""
    for loops, group in modelling[modelling.ratio.notna()].groupby("loops"):
        plain = group[(group.case == group.base) & group.step_us.notna()]
        rows = group[group.status.isin(GOOD) & (group.case != group.base)]
        if len(plain):
            yield loops, rows[rows.implementation == plain.implementation[plain.step_us.idxmin()]]
