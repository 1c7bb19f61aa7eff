# Table 1: share of a step's time by phase, beside the paper's; below, all phases of every variant.
from textwrap import shorten

import matplotlib.pyplot as plt

from analysis.core.statistics import phase_shares
from analysis.core.style import GREY, missing
from analysis.map import paper
from analysis.map.compare import group_shares, profiled
from analysis.map.tidy import PHASES

SIZES = (22, 82)
WHOLE = 0.99  # of a step in "other": it has no phases
GROUP_FILLS = dict(zip(paper.GROUPS, ("#6baed6", "#f6dcae", "#08519c", "#e4e4e4")))
# Light to dark and back, so that neighbours stay apart in black and white.
FILLS = {"evaluation": "#cfe3f2", "assembly": "#6baed6", "factorization": "#08519c",
         "solve": "#e6a141", "projection": "#f6dcae", "other": "#e4e4e4"}
LABELS = {"evaluation": "evaluation (Φ, Φq, f)", "assembly": "tangent assembly",
          "factorization": "factorization", "solve": "solves", "projection": "projections (rhs)",
          "other": "other"}


def table(results):
    """Rows of Table 1: [{"variables", "label", "shares": {group: %}, "paper"}]; no shares if the
    implementation has none at that size, but "why"."""
    rows = []
    for size in SIZES:
        for kind, name in paper.STARTING.items():
            if (kind, size) in paper.TABLE1:
                shares = dict(zip(paper.GROUPS, paper.TABLE1[kind, size]))
                rows.append({"variables": size, "label": f"paper: starting {kind}",
                             "shares": shares, "paper": True})
            rows.append(_row(results, size, name, name))
        name = results.fastest(results.natural(size), [*paper.members(results, "optimised dense"), *paper.sparse(results, others=True)])
        rows.append(_row(results, size, name, f"fastest library today: {name}" if name else "fastest library"))
    return rows


def _row(results, size, name, label):
    cell = profiled(results, name or "", size)
    shares = group_shares(cell, paper.GROUPS) if len(cell) else {}
    return {"variables": size, "label": label, "paper": False,
            "why": "" if shares else why_not(results, name, size),
            "shares": {group: 100 * share for group, share in shares.items()}}


def why_not(results, name, size):
    """Why a cell has no shares: the status and reason of its profiled or its timed rows."""
    tidy = results.tidy
    cell = tidy[(tidy.implementation == name) & (tidy.variables == size) & tidy.fill_asked.isna()
                & (tidy.status != "ok")].sort_values("kind", kind="stable")
    if cell.empty:
        return "not profiled at this size"
    return shorten(f"{cell.status.iloc[0]}: {cell.reason.iloc[0]}", 60, placeholder=" …")


def panel_sizes(results):
    """The two sizes of the paper if one of them was profiled, else the two largest that were."""
    there = sorted(profiled(results).variables.unique())
    return SIZES if not there or set(there) & set(SIZES) else there[-2:]


def draw(results):
    names = results.implementations
    low = 0.6 + 0.2 * max(4, len(names))
    figure = plt.figure(figsize=(9.6, 3.6 + low))
    grid = figure.add_gridspec(2, 2, height_ratios=[2.5, low], hspace=0.52, wspace=0.06)
    _paper_panel(figure.add_subplot(grid[0, :]), table(results))
    left = None
    for column, size in enumerate(panel_sizes(results)):
        left = figure.add_subplot(grid[1, column], sharey=left)
        all_panel(left, results, size, names, column == 0)
    return figure


def _paper_panel(axes, rows):
    places, place = [], 0.0
    for row, before in zip(rows, [None, *rows]):
        place += 1.0 if before is None or before["variables"] == row["variables"] else 1.6
        places.append(place)
        bar(axes, place, list(row["shares"].items()), GROUP_FILLS, row["paper"])
        if not row["shares"]:
            axes.text(1, place, row["why"], va="center", fontsize=8, color=GREY)
    axes.set_yticks(places, [f"n = {row['variables']}   {row['label']}" for row in rows],
                    fontsize=8.5)
    for text, row in zip(axes.get_yticklabels(), rows):
        text.set_fontweight("bold" if row["paper"] else "normal")
    axes.set(xlim=(0, 100), ylim=(place + 0.6, 0.4), xlabel="share of the time of a step, %")
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    legend(axes, GROUP_FILLS, {group: group for group in GROUP_FILLS})
    axes.set_title("Table 1: share of CPU time by phase, the paper's groups", pad=26)


def all_panel(axes, results, size, names, first):
    """A bar of all phases for each of `names`; `first`: with names, legend and title."""
    if not len(profiled(results, size=size)):
        missing(axes, f"no profiled runs at n = {size:g}")
        return
    for place, name in enumerate(names):
        rows = profiled(results, name, size)
        shares = phase_shares(rows, PHASES) if len(rows) else {}
        whole = shares.get("other", 0) > WHOLE
        bar(axes, place, [(phase, 100 * share) for phase, share in shares.items() if not whole], FILLS, False)
        if whole:
            axes.text(1, place, "all in the same sweeps", va="center", fontsize=7.5)
        elif not shares:
            axes.text(1, place, why_not(results, name, size), va="center", fontsize=7.5,
                      color=GREY)
    axes.set_yticks(range(len(names)), names, fontsize=8.5)
    axes.set(xlim=(0, 100), ylim=(len(names) - 0.4, -0.6),
             xlabel=f"n = {size:g}: share of the time of a step, %")
    axes.tick_params(axis="y", length=0, labelleft=first)
    axes.spines["left"].set_visible(False)
    if first:
        legend(axes, FILLS, LABELS)
        axes.set_title("All phases, every variant", pad=26)


def bar(axes, place, shares, fills, outlined):
    left = 0.0
    for key, share in shares:
        axes.barh(place, share, left=left, height=0.8, color=fills[key],
                  edgecolor="black" if outlined else "white", linewidth=0.8 if outlined else 0.5)
        if share >= 3.5:
            axes.text(left + share / 2, place, f"{share:.0f}", ha="center", va="center",
                      fontsize=7.5, color="white" if fills[key] == "#08519c" else "#222222")
        left += share


def legend(axes, fills, labels):
    handles = [plt.Rectangle((0, 0), 1, 1, facecolor=colour, edgecolor="white", label=labels[key])
               for key, colour in fills.items()]
    axes.legend(handles=handles, ncol=len(handles), loc="lower left", fontsize=8.5,
                bbox_to_anchor=(-0.01, 0.99), handlelength=1.2, columnspacing=1.2, borderpad=0.2)
