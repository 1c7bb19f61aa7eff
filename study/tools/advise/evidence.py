# What a validation leaves: a row for each question and each run of the search, and a page of what that adds up to.
import datetime
import subprocess

import pandas

from analysis.core.files import ROOT, write, write_text
from analysis.core.text import number

QUESTIONS, SEARCHED, PAGE = "validation.csv", "searched.csv.xz", "README.md"
BEGUN = {".lock", "scenes", QUESTIONS, SEARCHED, PAGE}  # its folder
SHOWN = ["scene", "implementation", "setting", "step", "status", "exact", "us_per_second", "pruned"]  # of a run of the search
MOST, LATEST = 1.3, 60.0  # times the best found that an advised run may take; s, of an answer
ABOUT = """`study/advise --validate` writes this page. A question is a mechanism and an error that no point may exceed: a hundredth, a
thousandth or a ten-thousandth of the length of its fastest part. The advised run is held to the motion on which two schemes agree, or
to the exact one. It is timed in the same rounds as the best of an exhaustive search over implementation, setting and step.
`validation.csv` has a row for each question, `searched.csv.xz` one for each run of the search. Answers are timed by the clock. *Others* is
the largest share of the processor that other programs had meanwhile. `study/tools/advise/README.md` says more."""


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
    shown = {
        f"# Is the advice right?\n\n{sentence(table)}.\n\n{ABOUT}": (
            ["kind", "mechanisms", "variables", "questions", "as accurate as asked", f"at most {MOST:g} times the best", "slowest, times the best",
             f"within {LATEST:g} s", "longest answer, s", "others, %", "settings advised"],
            [_kind(kind, rows, ok.loc[rows.index]) for kind, rows in asked.groupby("kind")]),
        "## What did not hold": (["mechanism", "error asked, m", "error, m", "times the best", "answer, s", "advised", "best found"],
                                 [_failed(row) for row in asked[~ok.all(axis=1)].itertuples()]),
        "## Not asked\n\nTwo schemes do not agree on the motion to a tenth of the error, so nobody knows what is right.": (
            ["mechanism", "errors, m"], [[scene, ", ".join(map(number, rows.error))] for scene, rows in table[~table.asked].groupby("scene")]),
        "## Measured": (["commit", "processor", "date", "mechanisms"],
                        [[*key, rows.scene.nunique()] for key, rows in table.groupby(["commit", "processor", "date"])])}
    return "\n\n".join(f"{head}\n\n{_table(*found)}" for head, found in shown.items()) + "\n"


def _kind(kind, rows, ok):
    settings = rows.advised_setting.dropna().value_counts()
    return [kind, rows.scene.nunique(), ", ".join(map(str, sorted(set(rows.n)))), len(rows), ok.accurate.sum(), ok.fast.sum(),
            number(rows.ratio.max()), ok.soon.sum(), number(rows.seconds.max(), 2), number(100 * rows.others.max(), 2),
            "; ".join(f"{name} ({times})" for name, times in settings.items())]


def _failed(row):
    def line(who, setting, step):
        return f"{who}, {setting}, {step:g} s" if isinstance(who, str) else "–"
    return [row.scene, number(row.error), number(row.exact), number(row.ratio), number(row.seconds, 2),
            line(row.advised_implementation, row.advised_setting, row.advised_step) if row.met else row.why_not,
            line(row.best_implementation, row.best_setting, row.best_step)]


def _table(names, rows):
    lines = [f"| {' | '.join(map(str, row))} |" for row in (names, *rows)]
    return "\n".join([lines[0], "|---" * len(names) + "|", *lines[1:]]) if rows else "Nothing."
