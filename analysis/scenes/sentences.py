# The answer to "Do standard problems come out right, and what does each piece of modelling cost?", from the tables.
from analysis.core.outcomes import GOOD
from analysis.core.text import between, number

DROPPED = ("unsupported", "dropped")


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
