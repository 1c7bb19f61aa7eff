# stability.html: the maps, how to read them, the outcomes counted; one self-contained page.
from pathlib import Path

from analysis import page
from analysis.loader import _json, plain_table
from analysis.stability.figure import draw

ACCURATE = 1e-2  # m, the largest position error that "ok" allows


def write(folder):
    """Writes figures/SCHEME-PRECISION.svg and .png, and stability.html, from the tables in `folder`."""
    folder = Path(folder)
    table, windows = (plain_table(folder / f"{name}.csv") for name in ("stability", "windows"))
    series = list(dict.fromkeys(zip(table.scheme, table.precision)))
    figures = {}
    for scheme, precision in series:
        figures[scheme, precision] = page.embedded(folder, f"{scheme}-{precision}",
                                                   draw(table, windows, scheme, precision))
    long = plain_table(folder / "long.csv") if (folder / "long.csv").exists() else None
    page.write(folder / "stability.html", render(table, _json(folder / "run.json"), figures, long))


def render(table, run, figures, long=None):
    """The page; `figures`: {(scheme, precision): SVG in base 64}; `long`: long.csv if it is there."""
    parts = [{"scheme": scheme, "precision": precision, "figure": figure,
              "rows": table[(table.scheme == scheme) & (table.precision == precision)]}
             for (scheme, precision), figure in figures.items()]
    for part in parts:
        rows = part["rows"]
        part |= {"implementation": rows.implementation.iloc[0],
                 "counts": rows.status.value_counts().to_dict(), "valleys": valleys(rows),
                 "automatic": automatic(rows)}
    missed = {}  # {precision: cells of its maps whose automatic penalty factor misses a valley}
    for part in parts:
        missed[part["precision"]] = missed.get(part["precision"], 0) + len(part["automatic"][0])
    scaled = table[table.penalty_asked != "auto"].alpha_dt2_4
    return page.template(Path(__file__).parent / "stability.html.j2").render(
        context=next(iter(run["contexts"].values())), inputs=run["inputs"], parts=parts,
        least=scaled.min(), most=scaled.max(),
        statuses=list(dict.fromkeys(["ok", "degraded", *sorted(table.status.unique())])),
        missed=missed, whole=[] if long is None else [
            (*key, list(rows.loops)) for key, rows in long.groupby(["scheme", "implementation"], sort=False)],
        long=[] if long is None else long.fillna({"must_hold": ""}).to_dict("records"),
        limit=ACCURATE, total=len(table), inaccurate=inaccurate(table).to_dict("records"))


def automatic(rows):
    """(runs whose automatic penalty factor is not ok though another one at their step is; those where none is)"""
    known, missed, none = valleys(rows), [], []
    for row in rows[(rows.penalty_asked == "auto") & (rows.status != "ok")].to_dict("records"):
        valley = known.get(row["loops"], {}).get(row["step"])
        (missed if valley else none).append(row | {"valley": valley})
    return missed, none


def inaccurate(table):
    """Rows that are "ok" without a position error of at most ACCURATE: there must be none."""
    return table[(table.status == "ok") & ~(table.position_error_max <= ACCURATE)]


def valleys(rows):
    """{loops: {step: (least, largest, ok, between)}} of alpha step^2 / 4: the ends of the "ok" cells,
    how many cells are ok and how many there are between the ends; None where none is ok."""
    found = {}
    grid = rows[rows.penalty_asked != "auto"]
    for (loops, step), group in grid.groupby(["loops", "step"]):
        good = group[group.status == "ok"].alpha_dt2_4
        found.setdefault(loops, {})[step] = None if good.empty else (
            good.min(), good.max(), len(good), int(group.alpha_dt2_4.between(good.min(),
                                                                             good.max()).sum()))
    return found
