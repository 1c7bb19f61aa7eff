# study/advise --validate: the advice against an exhaustive search, on scenes whose exact motion is known.
from argparse import Namespace

import pandas

from analysis.core.files import write
from analysis.core.outcomes import FINISHED
from study.core import locks
from study.core.studyset import listed, select
from study.tools.advise import timing
from study.tools.advise.advice import PROBE_FACTOR, probe
from study.tools.advise.runner import EXACT, REPEATS
from study.tools.advise.settings import catalogue, serving

LOOPS, ERRORS, DURATION = (1, 2, 10, 40), (1e-1, 1e-2, 1e-3, 1e-4), 5.0
BEGUN = {".lock", "searched.csv", "validation.csv", *(f"n{count}" for count in LOOPS)}  # its folder
LONGEST, SHORTEST, RATIO = 0.08, 5e-5, 2**-0.5  # steps of the search, s
NEAR = 2.0        # settings this times the fastest one's time, by one implementation each, are timed with all
MOST = 1.5        # times the best found that an advised run may take
ROUNDS_AT_MOST = 600.0  # s of timing a question


def validate(options, ask, runner_of, results, loops=LOOPS, errors=ERRORS, duration=DURATION):
    """`ask` and `runner_of` are those of main.py, which calls this."""
    known = listed()
    names = select(known, options.only)
    rows, searched = [], []
    with locks.only_one(results):
        for count in loops:
            scene = f"four-bar:{count}"
            folder = results / f"n{count}"
            with locks.only_one_study(options.wait):
                variants, run = runner_of(folder, {"scene": scene, "duration": duration, "repeats": REPEATS}, names, known)
                found, speeds = search(run, variants, duration, errors, scene)
            searched += [{"scene": scene} | row for row in found]
            for error in errors:
                asked = Namespace(scene=scene, error=error, duration=duration, deadline_us=None, only=options.only,
                                  budget=None, step=None, results=None, wait=options.wait, json=False)
                answer, advice = ask(asked, folder=folder / f"error-{error:g}")
                with locks.only_one_study(options.wait):
                    rows.append(_compare(scene, error, duration, answer, advice, run, variants, found, speeds))
            run.lab.progress.end()
    table = pandas.DataFrame(rows)
    for name, found in (("searched", pandas.DataFrame(searched)), ("validation", table)):
        write(results / f"{name}.csv", lambda partial, found=found: found.to_csv(partial, index=False))
    held, sentence = verdict(table, MOST)
    print(f"{sentence}\ntable: {results / 'validation.csv'}")
    return 0 if held else 1


def verdict(table, most):
    """(whether all held, a sentence)."""
    late = ~(table.ratio <= most)  # no ratio is too late as well
    named = [f"{row.scene} at {row.error:g} m" for row in table[~table.meets | late].itertuples()]
    return not named, (f"{int(table.meets.sum())} of {len(table)} advised runs are as accurate as asked; "
                       f"{int((~late).sum())} take at most {most:g} times the best found, the slowest "
                       f"{table.ratio.max():.2f}" + (f"; not so: {', '.join(named)}" if named else ""))


def search(run, variants, duration, errors, scene):
    """Rows of every setting at every step by its fastest implementation, and {implementation: us a step}.
    A setting's steps end where two in succession meet the smallest error or where they cost too much."""
    _, speeds = probe(variants, run, 1e-2, duration)
    rows, least = [], {}  # least time of a simulated second that meets the smallest error
    for setting in catalogue():
        served = [name for name in speeds if name in serving(setting, variants)]
        step, met = LONGEST, 0
        while served and met < 2 and step >= SHORTEST:
            run.lab.tell(f"search: {scene}, {setting.name}, step {step:.3g} s")
            row = run("search", setting, served[0], float(f"{step:.3g}"), duration, 120, checks=EXACT)
            row |= {"us_per_second": row["step_us"] / row["step"] if row["step_us"] else None, "pruned": ""}
            rows.append(row)
            met = met + 1 if meets(row, min(errors)) else 0
            if met:
                least[setting] = min(least.get(setting, row["us_per_second"]), row["us_per_second"])
            if row["status"] == "unsupported":
                break
            if least and row["us_per_second"] and row["us_per_second"] > 2 * NEAR * min(least.values()):
                row["pruned"] = "shorter steps are left out: far slower than a setting that meets all errors"
                break
            step *= RATIO
    return rows, speeds


def meets(row, error):
    return row["status"] in FINISHED and row["exact"] is not None and row["exact"] <= error


def sustained(found, error):
    """The rows that meet an error, if the next shorter step of their setting does too, or was left out: one
    that does so alone is luck, as an estimate of errors cannot find it."""
    return [row for row, shorter in zip(found, [*found[1:], {"setting": None}])
            if meets(row, error) and (shorter["setting"] != row["setting"] or meets(shorter, error))]


def luck(found, error, us_per_second):
    """The fastest row that meets an error by luck in less time than `us_per_second`, or {}."""
    good = sustained(found, error)
    return min((row for row in found if meets(row, error) and row not in good
                and row["us_per_second"] < us_per_second), key=lambda row: row["us_per_second"], default={})


def fastest(found, error):
    """The fastest row of each setting that meets an error, fastest first, as far as they are near the best."""
    best = {}
    for row in sustained(found, error):
        known = best.setdefault(row["setting"], row)
        if row["us_per_second"] < known["us_per_second"]:
            best[row["setting"]] = row
    rows = sorted(best.values(), key=lambda row: row["us_per_second"])
    return [row for row in rows if row["us_per_second"] <= NEAR * rows[0]["us_per_second"]]


def _compare(scene, error, duration, answer, advice, run, variants, found, speeds):
    """The row of validation.csv of one question."""
    settings = {setting.name: setting for setting in catalogue()}
    candidates = [timing.Candidate(settings[row["setting"]], name, row["step"])
                  for row in fastest(found, error) for name in speeds
                  if name in serving(settings[row["setting"]], variants)
                  and speeds[name] <= PROBE_FACTOR * min(speeds.values())]
    exact = {(row["setting"], row["step"]): row for row in found}
    advised = advice.chosen and timing.Candidate(advice.chosen.setting, advice.chosen.implementation,
                                                 advice.chosen.step, kept=True)
    lines = _time(run, [one for one in candidates if advised is None or _same(one) != _same(advised)]
                  + [advised] * bool(advised), duration, error)
    order = [one for one in timing.ranked(candidates) if _same(one) != (advised and _same(advised))]
    best = min([*order, *[one for one in [advised] if one and one.rows]], default=None,
               key=lambda one: one.us_per_second()[0])
    lucky = luck(found, error, best.us_per_second()[0]) if best else {}
    told = answer["advice"] or {"error": {}}
    return {"scene": scene, "error": error, "met": answer["met"], "estimate": told["error"].get("estimate"),
            "exact": told["error"].get("exact"),
            "meets": bool(answer["met"] and told["error"]["exact"] <= error),
            "seconds": answer["seconds"]} | _columns("advised", advised, lines) | _columns("best", best, lines) | {
            "best_exact": None if best is None else told["error"]["exact"] if best is advised
            else exact[best.setting.name, best.step]["exact"],
            "lucky_setting": lucky.get("setting"), "lucky_step": lucky.get("step"),
            "lucky_exact": lucky.get("exact"), "lucky_us_per_second": lucky.get("us_per_second"),
            "ratio": advised.us_per_second()[0] / best.us_per_second()[0] if advised and best else None}


def _time(run, candidates, duration, error):
    """{candidate: (its command, raw file)} after timing all in the same rounds."""
    lines = {}

    def timed(one, number):
        run.lab.tell(f"timing: error {error:g} m, round {number}, {one.implementation}, {one.setting.name}")
        row = run(f"timing-{error:g}/round{number}", one.setting, one.implementation, one.step, duration, 60)
        lines[_same(one)] = (row["command"], row["raw_file"])
        return row
    timing.race(candidates, timed, lambda: ROUNDS_AT_MOST)
    return lines


def _same(one):
    return one.setting, one.implementation, one.step


def _columns(prefix, one, lines):
    values = dict.fromkeys(("implementation", "setting", "step", "us_per_second", "low", "high", "command",
                            "raw_file"))
    if one:
        middle, low, high = one.us_per_second()
        command, raw_file = lines.get(_same(one), (None, None))
        values |= {"implementation": one.implementation, "setting": one.setting.name, "step": one.step,
                   "us_per_second": middle, "low": low, "high": high, "command": command,
                   "raw_file": raw_file}
    return {f"{prefix}_{key}": value for key, value in values.items()}
