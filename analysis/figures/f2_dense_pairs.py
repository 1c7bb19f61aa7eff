# Figure 2: dense implementations on every BLAS + LAPACK pair against the starting dense version.
import matplotlib.pyplot as plt

from analysis import paper
from analysis.compare import ratio
from analysis.marks import draw_crosses, footnote, lost, reasons, rough
from analysis.statistics import median
from analysis.style import GREY, Look, figure_main, legend, missing, number_axis, size_ticks
from analysis.tables import BEFORE_SINGULAR, LAST_CENTRED


def with_pairs(results):
    """Dense variants that this run has on more than their usual pair, in the registry's order."""
    tidy = results.tidy
    others = tidy[tidy.implementation.str.contains("+", regex=False) & (tidy.build == "")]
    tried = set(others.folder + "/" + others.variant)
    return [name for name, entry in results.variants.items()
            if entry.get("dense") and name in tried]


def pair_of(results, name):
    """Name of the BLAS + LAPACK pair of an implementation or alternative; "" if unknown."""
    plain, _, pair = name.partition("+")
    known = results.tidy.blas[(results.tidy.implementation == plain) & (results.tidy.blas != "")]
    return pair or results.run.get("blas", {}).get(plain) or next(iter(known), "")


def pair_text(results, pair):
    """What the registry says of a pair, "BLAS\\n+ LAPACK"; its name if it says nothing."""
    entry = next((entry for entry in results.pairs if entry["name"] == pair), None)
    return f"{entry['blas']}\n  + {entry['lapack']}" if entry else pair or "unknown pair"


def dense_rows(results):
    """All natural timing rows of dense variants and of them on other pairs, whatever the status."""
    tidy = results.tidy
    dense = [name for name, entry in results.variants.items() if entry.get("dense")]
    return tidy[(tidy.kind == "timing") & tidy.fill_asked.isna() & (tidy.build == "")
                & (tidy.folder + "/" + tidy.variant).isin(dense)]


def series(rows):
    """{name: [(size, median, fastest, slowest, Ratio or None)]} of what was timed, by size, with
    the speed-up over the starting dense version, None where that was not timed."""
    found, samples = {}, rows[rows.status == "ok"]
    for size, of_size in samples.groupby("variables"):
        for name, cell in of_size.groupby("implementation", sort=False):
            found.setdefault(name, []).append(
                (size, median(cell.step_us), cell.step_us.min(), cell.step_us.max(),
                 ratio(of_size, paper.STARTING["dense"], name)))
    return found


def rough_times(rows):
    """{(name, size): (µs, whether it is a pilot's)} of every cell that has a time at all."""
    ok = rows[rows.status == "ok"].groupby(["implementation", "variables"]).step_us.median()
    times = {key: (value, False) for key, value in ok.items()}
    return {(row.implementation, row.variables): (row.pilot_step_us, True)
            for row in rough(lost(rows)).itertuples()} | times


def draw(results):
    look, chosen = Look(results), with_pairs(results)
    columns = max(1, len(chosen))
    figure, panels = plt.subplots(2, columns, figsize=(7.8 * columns - 0.4, 8.2), squeeze=False,
                                  sharex=True, gridspec_kw={"hspace": 0.08, "wspace": 1.0})
    panels[0, 0].set_title("Figure 2: dense implementations on every BLAS + LAPACK pair")
    if not chosen:
        missing(panels[0, 0], "no dense implementation was timed on more than one pair")
        missing(panels[1, 0], "")
        return figure
    rows = dense_rows(results)
    for variant, (above, below) in zip(chosen, panels.T):
        mine = (rows.folder + "/" + rows.variant == variant) | rows.implementation.isin(
            list(results.variants))
        _panels(above, below, results, variant, rows[mine], look)
    footnote(figure, _notes(results, rows), 0.03)
    return figure


def _panels(above, below, results, variant, rows, look):
    def line(name):
        if name.partition("+")[0] == variant:
            name = f"{variant}+{pair_of(results, name)}"
            return look.line(name) | {"markerfacecolor": look.colour(name),
                                      "markeredgecolor": "white", "markeredgewidth": 0.6}
        grey = GREY if paper.starting(name) else "black"
        return look.line(name) | {"color": grey, "markerfacecolor": grey}

    found = series(rows)
    for name, points in found.items():
        sizes, middle, low, high, faster = zip(*points)
        label = _label(results, variant, name)
        below.fill_between(sizes, low, high, color=line(name)["color"], alpha=0.2, linewidth=0)
        below.plot(sizes, middle, label=label, **line(name))
        known = [ratio for ratio in faster if ratio]
        above.plot([ratio.size for ratio in known], [ratio.value for ratio in known],
                   label=label, **line(name))
        above.vlines([ratio.size for ratio in known], [ratio.low for ratio in known],
                     [ratio.high for ratio in known], color=line(name)["color"], linewidth=3.5,
                     alpha=0.35)
    _rough(above, below, rows, line)
    for axes in (above, below):
        draw_crosses(axes, lost(rows), line)
        axes.set_yscale("log")
        axes.grid(True, which="major")
    _untimed(below, results, variant, rows, found, line)
    above.set_ylabel("speed-up over the starting version")
    number_axis(above.yaxis, "×")
    below.set_ylabel("time per step, µs")
    number_axis(below.yaxis)
    size_ticks(below, sorted(rows.variables.dropna().unique()))
    legend(below, loc="upper left", bbox_to_anchor=(1.01, 2.06), labelspacing=0.7,
           title=f"{variant} on …, and others", title_fontsize=9, alignment="left", fontsize=8)


def _rough(above, below, rows, line):
    """Hollow: times of pilots, and speed-ups of which at least one time is a pilot's."""
    times = rough_times(rows)
    for (name, size), (time, is_rough) in times.items():
        base, base_rough = times.get((paper.STARTING["dense"], size), (None, False))
        style = {"linestyle": "none", "marker": line(name)["marker"], "markersize": 6,
                 "markerfacecolor": "none", "markeredgecolor": line(name)["color"], "label": "_"}
        if is_rough:
            below.plot(size, time, **style)
        if base and (is_rough or base_rough):
            above.plot(size, base / time, **style)


def _label(results, variant, name):
    if name.partition("+")[0] == variant:
        usual = "" if "+" in name else "  (its usual pair)"
        return pair_text(results, pair_of(results, name)) + usual
    return name


def _untimed(axes, results, variant, rows, found, line):
    """Pairs without any time stand in the legend with the reason."""
    for name, cells in lost(rows).groupby("implementation", sort=False):
        if name not in found and not len(rough(cells)):
            axes.plot([], [], **line(name) | {"linestyle": "none", "marker": "x",
                                               "markeredgecolor": line(name)["color"],
                                               "markeredgewidth": 1.8},
                      label=f"{_label(results, variant, name)}\n  {cells.status.iloc[0]}: "
                            f"{cells.reason.iloc[0]}")


def _notes(results, rows):
    notes = ["lines: medians; bands: fastest to slowest sample; bars: 95 % interval of the "
             "speed-up", "hollow: at least one of the times is a pilot's, rough"]
    if rows.variables.max() > LAST_CENTRED:
        notes.append(BEFORE_SINGULAR)
    tried = {pair_of(results, name) for name in rows.implementation.unique()}
    for entry in results.pairs:
        if entry["name"] not in tried:
            why = "not part of this run" if entry["available"] else entry["reason"]
            notes.append(f"✕ {entry['name']} ({entry['blas']} + {entry['lapack']}): {why}")
    return notes + reasons(lost(rows), width=120)


if __name__ == "__main__":
    figure_main(draw)
