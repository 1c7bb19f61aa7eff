# study/compare A B: do two sets give the same map? The libraries and all, own code included, apart.
from analysis.core import schema
from analysis.core.errors import StudyError
from study.core.options import Parser, directory
from study.core.studyset import opened

LAYERS = {"libraries": "Libraries", "all": "All, own code included"}


def compare(arguments):
    parser = Parser(prog="study/compare", description="Compares the maps of two sets: how many cells each decides or gives an "
                    "equivalence set for, and how many of these are alike.")
    for name in ("first", "second"):
        parser.add_argument(name, type=directory, metavar=name[0].upper() + name[1:], help="directory of a set")
    options = parser.parse_args(arguments)
    sets = [opened(folder) for folder in (options.first, options.second)]
    tables = [cells_of(studyset.folder) for studyset in sets]
    print("\n".join(line for layer in LAYERS for line in report(layer, *tables)))
    for what in ("machine", "commit"):
        values = [str(studyset.facts["context"].get(what)) for studyset in sets]
        if values[0] != values[1]:
            print(f"the sets are of different {what}s: {values[0]} and {values[1]}")
    return 0


def cells_of(folder):
    if not (folder / "map" / "cells.csv").exists():
        raise StudyError(f"{folder} has no map: add it with study/run --part map --results {folder}")
    return schema.read_table(folder, "map", "cells")


def report(layer, first, second):
    """Lines about one layer of two tables of cells."""
    rows = [{row.scene: row for row in table[(table.layer == layer) & (table.winner != "")].itertuples()}
            for table in (first, second)]
    common = [scene for scene in rows[0] if scene in rows[1]]
    both = [scene for scene in common if all(said(one[scene]) for one in rows)]
    same = [scene for scene in both if alike(rows[0][scene], rows[1][scene])]
    lines = [f"{LAYERS[layer]}: {len(common)} common cells" + "".join(
        f", {len(set(mine) - set(common))} more in the {place}" for mine, place in zip(rows, ("first", "second"))
        if len(mine) > len(common))]
    for place, mine in zip(("first ", "second"), rows):
        decided = sum(bool(mine[scene].decided) for scene in common)
        settled = sum(said(mine[scene]) for scene in common) - decided
        lines.append(f"  {place}: {decided} decided, {settled} with several that are as fast, {len(common) - decided - settled} open"
                     + _share(decided + settled, len(common), "said"))
    lines.append(f"  {len(both)} said in both, {len(same)} of them alike" + _share(len(same), len(both), "alike"))
    return lines + [f"  {scene}: {_text(rows[0][scene])} | {_text(rows[1][scene])}" for scene in both if scene not in same]


def said(row):
    """Whether a cell is decided or has an equivalence set."""
    return bool(row.decided) or bool(row.settled)


def alike(first, second):
    """The same winner, or each winner in the other's equivalence set."""
    return first.winner == second.winner or (first.winner in second.equivalent.split()
                                             and second.winner in first.equivalent.split())


def _share(count, total, word):
    return f" ({100 * count / total:.0f} % {word})" if total else ""


def _text(row):
    if not row.second:
        return f"{row.winner} alone"
    return f"{row.winner} {row.margin:.3f} ({row.low:.3f} to {row.high:.3f}) ahead of {row.second}"
