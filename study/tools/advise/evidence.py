# What a validation leaves: a row for each question and each run of the search, and a page of what that adds up to.
import datetime
import subprocess
from pathlib import Path

import pandas

from analysis.core.files import ROOT, write, write_text
from analysis.core.text import layout, number

QUESTIONS, SEARCHED, PAGE = "validation.csv", "searched.csv.xz", "README.md"
BEGUN = {".lock", "scenes", QUESTIONS, SEARCHED, PAGE}  # its folder
SHOWN = ["scene", "implementation", "setting", "step", "status", "exact", "us_per_second", "pruned"]  # of a run of the search
MOST, LATEST = 1.3, 60.0  # times the best found that an advised run may take; s, of an answer


def origin(context):
    """Where and when what is measured now comes from; "-dirty" where program and tools are not both of that commit."""
    def git(*words):
        return subprocess.run(["git", "-c", "safe.directory=*", *words], cwd=ROOT, capture_output=True, text=True).stdout.strip()
    clean = (str(context["dirty"]).lower() == "false" and git("rev-parse", "HEAD") == context["commit"]
             and not git("status", "--porcelain", "--", ".", ":(exclude)results"))
    return {"commit": context["commit"][:10] + "-dirty" * (not clean), "processor": context["cpu_model"],
            "date": f"{datetime.datetime.now(datetime.timezone.utc):%Y-%m-%d}"}


def keep(results, scene, rows, searched):
    """Writes what was found on a scene in place of what was known of it, and the page."""
    for name, found in ((QUESTIONS, rows), (SEARCHED, [{key: row[key] for key in SHOWN[1:]} for row in searched])):
        known = read(results, name).to_dict("records") if (results / name).exists() else []
        table = pandas.DataFrame([row for row in known if row["scene"] != scene] + [{"scene": scene} | row for row in found],
                                 columns=SHOWN if name == SEARCHED else None)
        table = table.sort_values([column for column in ("kind", "n", "scene", "error") if column in table], kind="stable")
        write(results / name, lambda partial, table=table: table.to_csv(partial, index=False, float_format="%.4g"))
    write_text(results / PAGE, page(read(results)))


def read(results, name=QUESTIONS):
    return pandas.read_csv(results / name, dtype={"commit": str})


def held(table):
    """Of each question that was asked: whether the advised run is accurate, fast and found in time."""
    return pandas.DataFrame({"accurate": table.meets.astype(bool), "fast": table.ratio <= MOST, "soon": table.seconds <= LATEST})


def sentence(table):
    asked = table[table.asked]
    ok = held(asked)
    return (f"{len(asked)} questions on {asked.scene.nunique()} mechanisms of {asked.kind.nunique()} kinds: "
            f"{ok.accurate.sum()} advised runs are as accurate as asked, {ok.fast.sum()} take at most {MOST:g} times the best found "
            f"(the slowest {number(asked.ratio.max())} times), {ok.soon.sum()} answers were there within {LATEST:g} s")


def page(table):
    asked = table[table.asked]
    ok = held(asked)
    kinds = [[kind, rows.scene.nunique(), ", ".join(map(str, sorted(set(rows.n)))), len(rows), good.accurate.sum(), good.fast.sum(),
              number(rows.ratio.max()), good.soon.sum(), number(rows.seconds.max(), 2), number(100 * rows.others.max(), 2),
              "; ".join(f"{name} ({times})" for name, times in rows.advised_setting.dropna().value_counts().items())]
             for kind, rows in asked.groupby("kind") for good in [ok.loc[rows.index]]]
    failed = [_failed(row) for row in asked[~ok.all(axis=1)].itertuples()]
    others = [(scene, ", ".join(map(number, rows.error))) for scene, rows in table[~table.asked].groupby("scene")]
    origins = [(*key, rows.scene.nunique()) for key, rows in table.groupby(["commit", "processor", "date"])]
    return layout(Path(__file__).with_name("page.md.j2")).render(
        sentence=sentence(table), kinds=kinds, failed=failed, others=others, origins=origins, most=MOST, latest=LATEST)


def _failed(row):
    def line(who, setting, step):
        return f"{who}, {setting}, {step:g} s" if isinstance(who, str) else "–"
    return [row.scene, number(row.error), number(row.exact), number(row.ratio), number(row.seconds, 2),
            line(row.advised_implementation, row.advised_setting, row.advised_step) if row.met else row.why_not,
            line(row.best_implementation, row.best_setting, row.best_step)]
