# What the advice is compared with: every setting at every step, until it meets the smallest error or costs too much.
from analysis.core.outcomes import FINISHED
from study.core.setting import Setting, read_settings
from study.tools.advise.probe import probe
from study.tools.advise.runner import EXACT
from study.tools.advise.settings import catalogue, fits, serving

LEAST_STEPS, MOST_STEPS, RATIO = 20, 2e5, 2**-0.5  # of a run; of a step to the next longer one
NEAR = 1.5        # times the fastest setting's time: others may be the fastest with another implementation
TOO_LONG = 20.0   # s, of a run


def everything():
    """All settings that advice considers, and all of study/settings.yaml whose tolerances suit any scene."""
    found = catalogue()
    stored = [Setting(one.scheme, one.changes) for one in read_settings() if not {"penalty", "tolerance"} & set(dict(one.changes))]
    return found + [one for one in stored if one not in found]


def search(run, variants, described, duration, errors):
    """Rows of every setting at every step by its fastest implementation, and {implementation: us a step}.
    A setting's steps end where two in succession meet the smallest error or where they cost too much."""
    longest = duration / LEAST_STEPS
    _, speeds = probe(variants, described, run, longest / 8, duration)
    rows, least = [], {}  # least time of a simulated second that meets the smallest error
    for setting in (one for one in everything() if not fits(one, described)):
        served = [name for name in speeds if name in serving(setting, variants)]
        step, ended = longest, 0
        while served and ended < 2 and step >= duration / MOST_STEPS:
            at = float(f"{step:.3g}")
            run.tell(f"search: {run.scene}, {setting.name}, step {at:g} s")
            row = run("search", setting, served[0], at, duration, 4 * TOO_LONG, checks=EXACT, repeats=1)
            if row["status"] in ("unsupported", "timeout", "crashed", "out-of-memory"):
                break
            timed = meets(row, max(errors)) and run("speed", setting, served[0], at, duration, 8 * TOO_LONG)
            row |= {"us_per_second": timed["step_us"] / at if timed and timed["step_us"] else None, "pruned": ""}
            rows.append(row)
            ended = ended + 1 if meets(row, min(errors)) else 0
            if ended and row["us_per_second"]:
                least[setting] = min(least.get(setting, row["us_per_second"]), row["us_per_second"])
            usual = row["us_per_second"] or (row["step_us_median"] or 0.0) / at
            if usual > (2 * NEAR * min(least.values()) if least else 1e6 * TOO_LONG / duration):
                row["pruned"] = "shorter steps are left out: " + (
                    "far slower than a setting that meets all errors" if least else f"they take more than {TOO_LONG:g} s")
                break
            step *= RATIO
    return rows, speeds


def fastest(found, error):
    """The fastest row of each setting that meets an error, fastest first, as far as they are near the best."""
    best = {}
    for row in _sustained(found, error):
        known = best.setdefault(row["setting"], row)
        if row["us_per_second"] < known["us_per_second"]:
            best[row["setting"]] = row
    rows = sorted(best.values(), key=lambda row: row["us_per_second"])
    return [row for row in rows if row["us_per_second"] <= NEAR * rows[0]["us_per_second"]]


def _sustained(found, error):
    """The rows that meet an error, if the two next shorter steps of their setting, down to half of theirs, do too, or were
    left out: else it is luck, which half the step cannot show."""
    return [row for at, row in enumerate(found) if row["us_per_second"] and all(
        meets(other, error) for other in found[at:at + 3] if other["setting"] == row["setting"])]


def meets(row, error):
    return row["status"] in FINISHED and row["exact"] is not None and row["exact"] <= error
