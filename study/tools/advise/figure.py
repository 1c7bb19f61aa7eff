# The picture of an advice: error estimates of the pilots over time per simulated second, and the choice.
import matplotlib.pyplot as plt

from analysis.core.outcomes import FINISHED
from analysis.core.style import DASHES, DENSE, GREY, MARKERS, SPARSE, number_axis, save
from analysis.core.text import number

COLOURS = {"penalty": SPARSE[0], "saddle-point": SPARSE[1], "rattle": DENSE[1], "rattle4": SPARSE[2],
           "rattle6": DENSE[0], "multistep6": DENSE[4]}


def draw(answer):
    """The figure of an advice.json."""
    figure, axes = plt.subplots(figsize=(8.6, 5.2))
    seen = {}
    for entry in answer["settings"]:
        scheme, _, changes = entry["setting"].partition(", ")
        points = sorted((pilot["step_us"] / pilot["step"] / 1e3, pilot["estimate"], pilot["counts"])
                        for pilot in entry["pilots"]
                        if pilot["status"] in FINISHED and pilot["estimate"])
        if not points:
            continue
        place = seen[scheme] = seen.get(scheme, -1) + 1
        look = {"color": COLOURS[scheme], "marker": MARKERS[place % len(MARKERS)], "markersize": 5.5}
        axes.plot([x for x, _, _ in points], [y for _, y, _ in points], markeredgecolor="white",
                  markeredgewidth=0.5, linestyle=DASHES[0] if not changes else DASHES[place % 4 + 1],
                  linewidth=1.6 if not changes else 1.0, label=entry["setting"], **look)
        doubtful = [(x, y) for x, y, counted in points if not counted]
        axes.plot([x for x, _ in doubtful], [y for _, y in doubtful], linestyle="none",
                  markerfacecolor="white", markeredgecolor=COLOURS[scheme],
                  marker=look["marker"], markersize=5.5)
    axes.set_xscale("log")
    axes.set_yscale("log")
    _bounds(axes, answer)
    _choice(axes, answer)
    number_axis(axes.xaxis)
    axes.set_xlabel("time per simulated second, ms")
    axes.set_ylabel("estimated position error, m")
    axes.grid(True, which="major")
    axes.plot([], [], "o", markerfacecolor="white", markeredgecolor=GREY, label="estimate does not count")
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=8)
    asked = answer["question"]
    axes.set_title(f"{asked['scene'].rsplit('/', 1)[-1]}, {answer['pilot_duration']:g} s: error pilots")
    return figure


def _bounds(axes, answer):
    """The error that was asked for, and the deadline as the time of a second at the advised step."""
    asked = answer["question"]
    axes.axhline(asked["error"], color="black", linewidth=1.0)
    # Estimates must be lower, as they may be of a lower order than they assume.
    axes.axhline(asked["error"] / 1.5, color="black", linewidth=0.8, linestyle=(0, (1, 2)),
                 label="allowed estimate, 2nd order")
    axes.annotate(f"E = {number(asked['error'])} m", (0.005, asked["error"]), xytext=(0, 2),
                  xycoords=("axes fraction", "data"), textcoords="offset points", fontsize=8.5)
    if asked["deadline_us"] and answer["met"]:
        limit = asked["deadline_us"] / answer["advice"]["step"] / 1e3
        axes.axvline(limit, color="black", linewidth=1.0, linestyle=(0, (4, 2)))
        axes.annotate(f"D = {asked['deadline_us']:g} µs a step", (limit, 0.01), xytext=(3, 0),
                      xycoords=("data", "axes fraction"), textcoords="offset points", rotation=90,
                      fontsize=8.5)


def _choice(axes, answer):
    if not answer["met"]:
        axes.annotate("no setting meets this", (0.5, 0.96), xycoords="axes fraction", ha="center",
                      va="top", fontsize=10)
        return
    told = answer["advice"]
    times = told["us_per_second"]
    axes.errorbar([times["median"] / 1e3], [told["error"]["estimate"]],
                  xerr=[[(times["median"] - times["low"]) / 1e3],
                        [(times["high"] - times["median"]) / 1e3]],
                  yerr=[[max(0.0, told["error"]["estimate"] - told["error"]["low"])],
                        [max(0.0, told["error"]["high"] - told["error"]["estimate"])]],
                  color="black", marker="*", markersize=15, markeredgecolor="white", capsize=3,
                  linestyle="none", zorder=5, label=f"advised: {told['implementation']},\n"
                  f"{told['setting']}, step {told['step']:g} s")


def write(figure, path):
    save(figure, path)
    plt.close(figure)
