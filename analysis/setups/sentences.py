# The answer to "What does setting up cost?".
from analysis.core.text import number


def answers(tables, view):
    rows = tables["setups"].dropna(subset=["setup_us"])
    if rows.empty:
        return [{"text": "Nobody could be set up.", "anchor": "times"}]
    best = rows.loc[rows.setup_us.idxmin()]
    return [{"text": f"{best.implementation} is set up in {number(best.setup_us)} µs for {best.scene}.", "anchor": "times"}]
