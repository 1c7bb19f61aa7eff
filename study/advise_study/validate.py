# study/advise --validate: the advice against an exhaustive search, on scenes whose exact motion is known.
from argparse import Namespace
from pathlib import Path

import pandas

from study.advise_study import timing
from study.advise_study.advice import PROBE_FACTOR, probe
from study.advise_study.main import DEFAULT, ask, runner_of
from study.advise_study.runner import EXACT, REPEATS
from study.advise_study.settings import catalogue, serving
from study.pipeline.layout import Layout, write_csv
from study.pipeline.prepare import only_one, only_one_measuring, registry, select, start_named, writable
from study.pipeline.progress import Teller
from study.pipeline.runs import FINISHED

LOOPS, ERRORS, DURATION = (1, 2, 10, 40), (1e-1, 1e-2, 1e-3, 1e-4), 5.0
LONGEST, SHORTEST, RATIO = 0.08, 5e-5, 2**-0.5  # steps of the search, s
NEAR = 2.0        # settings this times the fastest one's time, by one implementation each, are timed with all
MOST = 1.5        # times the best found that an advised run may take
ROUNDS_AT_MOST = 600.0  # s of timing a question


def validate(options, loops=LOOPS, errors=ERRORS, duration=DURATION):
    results = Path(options.results or DEFAULT / "validation").absolute()
    writable(results)
    known = registry()
    names = select(known, options.only)
    rows, searched = [], []
    with only_one(Layout(results)):
        for count in loops:
            scene = f"four-bar:{count}"
            layout = Layout(results / f"n{count}")
            writable(layout.results)
            start_named(layout, "advise", names, {"scene": scene, "duration": duration, "repeats": REPEATS})
            variants, runner = runner_of(layout, scene, known)
            with only_one_measuring():
                found, speeds = search(runner, variants, duration, errors, scene)
            searched += [{"scene": scene} | row for row in found]
            for error in errors:
                rows.append(_compare(scene, error, duration, options, layout, runner, variants,
                                     found, speeds))
        write_csv(results / "searched.csv", pandas.DataFrame(searched))
        table = pandas.DataFrame(rows)
        write_csv(results / "validation.csv", table)
        from analysis.advice.validation import draw, verdict, write
        for suffix in ("svg", "png"):
            write(draw(table, MOST), results / f"validation.{suffix}")
    held, sentence = verdict(table, MOST)
    print(f"{sentence}\ntable: {results / 'validation.csv'}\nfigure: {results / 'validation.svg'}")
    return 0 if held else 1


def search(run, variants, duration, errors, scene):
    """Rows of every setting at every step by its fastest implementation, and {implementation: us a step}.
    A setting's steps end where two in succession meet the smallest error or where they cost too much."""
    tell = Teller()
    _, speeds = probe(variants, run, 1e-2, duration)
    rows, least = [], {}  # least time of a simulated second that meets the smallest error
    for setting in catalogue():
        served = [name for name in speeds if name in serving(setting, variants)]
        step, met = LONGEST, 0
        while served and met < 2 and step >= SHORTEST:
            tell(f"search: {scene}, {setting.label}, step {step:.3g} s")
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
    tell.end()
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


def _compare(scene, error, duration, options, layout, run, variants, found, speeds):
    """The row of validation.csv of one question."""
    asked = Namespace(scene=scene, error=error, duration=duration, deadline_us=None, only=options.only,
                      budget=None, step=None, results=None)
    answer, advice = ask(asked, folder=layout.results / f"error-{error:g}")
    settings = {setting.label: setting for setting in catalogue()}
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
            else exact[best.setting.label, best.step]["exact"],
            "lucky_setting": lucky.get("setting"), "lucky_step": lucky.get("step"),
            "lucky_exact": lucky.get("exact"), "lucky_us_per_second": lucky.get("us_per_second"),
            "ratio": advised.us_per_second()[0] / best.us_per_second()[0] if advised and best else None}


def _time(run, candidates, duration, error):
    """{candidate: (its command, raw file)} after timing all in the same rounds."""
    tell, lines = Teller(), {}

    def timed(one, number):
        tell(f"timing: error {error:g} m, round {number}, {one.implementation}, {one.setting.label}")
        row = run(f"timing-{error:g}/round{number}", one.setting, one.implementation, one.step, duration, 60)
        lines[_same(one)] = (row["command"], row["raw_file"])
        return row
    with only_one_measuring():
        timing.race(candidates, timed, lambda: ROUNDS_AT_MOST)
    tell.end()
    return lines


def _same(one):
    return one.setting, one.implementation, one.step


def _columns(prefix, one, lines):
    values = dict.fromkeys(("implementation", "setting", "step", "us_per_second", "low", "high", "command",
                            "raw_file"))
    if one:
        middle, low, high = one.us_per_second()
        command, raw_file = lines.get(_same(one), (None, None))
        values |= {"implementation": one.implementation, "setting": one.setting.label, "step": one.step,
                   "us_per_second": middle, "low": low, "high": high, "command": command,
                   "raw_file": raw_file}
    return {f"{prefix}_{key}": value for key, value in values.items()}
