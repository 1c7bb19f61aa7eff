# What page.html.j2 shows of the standard problems and of modelling; whether they come out right, and what each piece of modelling costs.
import base64
import math

from analysis.core.files import ROOT
from analysis.core.outcomes import GOOD
from analysis.core.text import between, grouped, number

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
    found = [*_errors(finest(tables["problems"])), *_gate(tables["gate"]), *_costs(tables["modelling"])]
    return found or [{"text": "Not measured: no implementation that runs them took part.", "anchor": ""}]


def _errors(rows):
    if rows.empty:
        return
    judged = rows[rows.precision != "not judged"]
    high = judged[judged.status.isin(GOOD) & (judged.precision == "high")]
    text = (f"{rows.problem.nunique()} standard problems, {rows.implementation.nunique()} implementation"
            f"{'s' if rows.implementation.nunique() > 1 else ''}: {len(high)} of {len(rows)} runs are of high precision")
    if len(high):
        worst = high.loc[high.error_rms.idxmax()]
        text += f", with an error of {number(worst.error_rms, 2)} at most ({worst.title})"
    yield {"text": f"{text}.", "anchor": "problems"}


def _gate(gate):
    asked = gate[~gate.verdict.isin(DROPPED)]
    good, left = (asked.verdict == "agrees").sum(), (gate.verdict == "dropped").sum()
    if len(asked):
        yield {"text": f"The gate: {good} of {len(asked)} pairs of problem and implementation agree with the reference"
                       + (f"; {left} more were left out." if left else "."), "anchor": "gate"}


def _costs(modelling):
    """A sentence a size, of the implementation that is fastest on the plain model."""
    for loops, group in modelling[modelling.ratio.notna()].groupby("loops"):
        plain = group[(group.case == group.base) & group.step_us.notna()]
        rows = group[group.status.isin(GOOD) & (group.case != group.base)]
        rows = rows[rows.implementation == plain.implementation[plain.step_us.idxmin()]] if len(plain) else rows[:0]
        if len(rows):
            yield {"anchor": "modelling", "text": f"The four-bar of N = {loops:.0f}, modelled in other ways with {rows.implementation.iloc[0]}: "
                                                  f"{_cost(rows.loc[rows.ratio.idxmax()])}; {_cost(rows.loc[rows.ratio.idxmin()])}."}


def _cost(row):
    return f"{row.case} takes {between(row.ratio, row.ratio_low, row.ratio_high)} times the plain step"
