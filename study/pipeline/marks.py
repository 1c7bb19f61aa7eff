# Marks timed samples that may not be ranked after all, because of other samples.
import math
from collections import Counter

from study.pipeline.layout import NULL


def mark_lost_cells(rows):
    """A cell of which one process died may not be ranked by its other processes' samples."""
    dead = {}
    for row in rows:
        if row["kind"] == "timing" and row["status"] not in ("ok", "not-reached"):
            dead.setdefault((row["scene"], row["implementation"]), row)
    for row in rows:
        cause = dead.get((row["scene"], row.get("implementation")))
        if cause and row["status"] == "ok" and row["kind"] != "operations":
            row |= {"status": cause["status"], "reason": cause["reason"]}


def mark_differing_passes(rows):
    """Pass totals of a scene's stretch must be equal: the most common one among ranked ones (others
    are copies of one code) stands, every other cell is marked. Without a most common one (a tie) the whole scene is: nobody can be trusted."""
    timed = [row for row in rows if row["status"] == "ok" and row["implementation"] != NULL
             and row["kind"] != "operations"]
    for scene in {row["scene"] for row in timed}:
        mine = [row for row in timed if row["scene"] == scene]
        passes = {}  # implementation -> set of totals over its samples
        for row in mine:
            passes.setdefault(row["implementation"], set()).add(row["passes"])
        votes = Counter(min(values) for name, values in passes.items()
                        if len(values) == 1 and "+" not in name)
        ranked = votes.most_common(2)
        tie = not ranked or (len(ranked) > 1 and ranked[0][1] == ranked[1][1])
        accepted = math.nan if tie else ranked[0][0]
        for row in mine:
            if passes[row["implementation"]] != {accepted}:
                row["status"] = "passes-differ"
                row["reason"] = _passes_text(passes, row["implementation"], tie)


def _passes_text(passes, name, tie):
    def text(key):
        return "/".join(f"{value:.0f}" for value in sorted(passes[key]))
    others = ", ".join(f"{key} {text(key)}" for key in passes if key != name)
    return f"{text(name)} passes over the stretch; {others}" + (" (no majority)" if tie else "")
