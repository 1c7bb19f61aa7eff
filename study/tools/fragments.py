# Numbers in texts: a README has places between marks that are filled from stored sets, and nowhere else a measured number.
import json
import re
from statistics import median

import numpy

from analysis.core import site
from analysis.core.files import ROOT, RULE, StudyError, as_json, read_json, write_text
from analysis.core.text import number
from analysis.core.view import Folder
from study.tools.merge import agreement, machine

SWEEPS = ROOT / "results" / "sweeps"  # records of study/limit/million
MARKED = re.compile(r"(<!-- from the stored sets: (\S+) -->\n)(.*?)(<!-- end -->)", re.S)


def main_set():
    """The stored set that the rule of `mbs describe` names: README and paper are of it, too."""
    name = read_json(RULE).get("set")
    if not name or not (ROOT / "results" / name / "set.json").exists():
        raise StudyError(f"{RULE.relative_to(ROOT)} names no stored set (set is {name!r}): name the one that rule, README and paper are of")
    return ROOT / "results" / name


def filled(text):
    """A text with its marked places as the stored sets say them now."""
    return MARKED.sub(lambda one: one[1] + fragment(one[2]) + one[4], text)


def fragment(what):
    """"cases": the table of the main set, with a row about the processors that are compared; a part's name: its answers as a list;
    "million": the records of large sweeps."""
    if what == "million":
        return million([read_json(path) for path in sorted(SWEEPS.glob("*.json"))])
    main = main_set()
    known = site.answers_of(main)
    if what == "cases":
        others = [Folder(path.parent) for path in sorted(main.parent.glob("*/set.json")) if path.parent != main]
        rows = [case for one in known.values() if one for case in one["cases"]] + _machines(Folder(main), others)
        return "".join(["| your case | take this |\n|---|---|\n", *(f"| {row['case']} | {row['take']} |\n" for row in rows)])
    if known.get(what) is None:
        raise StudyError(f"{main} has no answers of '{what}'")
    return "".join(f"- {one['text']}\n" for one in known[what]["answers"])


def million(records):
    """The records of large sweeps, a column each: what was run, and what is projected from a part of it."""
    if not records:
        return "No record is stored.\n"
    columns = [_large_sweep(record) for record in records]
    lines = ["| | " + " | ".join(f"`{record['scene']}`" for record in records) + " |", "|---" * (len(records) + 1) + "|",
             *(f"| {name} | {' | '.join(column[name] for column in columns)} |" for name in columns[0])]
    return "\n".join(lines) + "\n"


def gain(part):
    """Of the runs of a part, by one job and by two in turns: how many times as many lanes a second two jobs have, turn by turn."""
    one, two = ([row["wall_s"] for row in part if row["jobs"] == jobs] for jobs in (1, 2))
    ratios = [first / second for first, second in zip(one, two)]
    return {"turns": len(ratios), "median": median(ratios), "least": min(ratios), "most": max(ratios)}


def _large_sweep(record):
    lanes, nodes, part, whole = record["lanes"], record["nodes"], record["part"], record["whole"]
    mine, merge, context, ratio = part[0]["lanes"], record["merge"]["wall_s"], record["context"], gain(part)
    one, two = (median(row["wall_s"] for row in part if row["jobs"] == jobs) for jobs in (1, 2))
    return {"implementation": f"`{record['implementation']}`",
            "lanes": f"{lanes}",
            "lanes of the part of one node": f"{mine}",
            "lanes a second, the part by one job": number(mine / one),
            "the part by two jobs": number(mine / two),
            "two jobs over one, turn by turn: median (least to most)":
                f"{number(ratio['median'])} ({number(ratio['least'])} to {number(ratio['most'])}; turns: {ratio['turns']})",
            "all lanes by two jobs": number(lanes / whole["wall_s"]),
            "all lanes by two jobs, projected from the part, s": number(lanes / mine * two),
            "observed, s": number(whole["wall_s"]),
            "their table written (`merge-sweep`), s": number(merge),
            "projected: parts on as many nodes at once, then the table, s": f"{number(two + merge)} ({nodes} nodes)",
            "memory of the largest process, MB": number(max(row["memory_mb"] for row in (*part, whole, record["merge"]))),
            "outcomes": ", ".join(f"{count} {name}" for name, count in sorted(record["outcomes"].items())),
            "table, MB": number(record["bytes"] / 1e6),
            "its SHA-256 begins with": record["table"][:16],
            "commit, `mbs` (SHA-256)": f"{context['commit'][:10]}, {record['program'][:16]}",
            "processor": f"{context['cpu_model']}, {context['num_cpus']} cores",
            "command": f"`{whole['command']}`"}


def _machines(main, others):
    """The row that says what holds on several processors; none of one."""
    if not (sets := agreement.compared(main, others)):
        return []
    count = agreement.shares(agreement.mechanisms(sets))
    names = ", ".join(one.folder.name for one in sets)
    found = {one.folder.name: [*machine.carried(main, one).values()] for one in sets if one.folder != main.folder}
    rules = "".join(f"; the rule of {main.folder.name}, on what was measured for {name}: {100 * numpy.nanmean(losses):.1f} % slower than the "
                    f"fastest on average, {100 * numpy.nanmax(losses):.0f} % at worst" for name, losses in found.items())
    where = f" (sets {names}, commit {main.facts['context']['commit'][:10]})"
    return [{"case": "Your processor is another one",
             "take": f"what `build/mbs bench` names there; on {len(sets)} processors{where} the same library is fastest on {count['same']} of "
                     f"{count['all']} mechanisms at their own fill; on {count['common']} more, one library is nowhere shown to be over 5 % slower "
                     f"than the fastest; on {count['differ']} it depends on the processor{rules}"}]


def refresh():
    """Fills all texts of the repository anew, and the rule; the paths of those that changed."""
    return [path for path, made in ((RULE, of_set), *((text, filled) for text in texts())) if rewritten(path, made)]


def rewritten(path, made):
    """Whether a file has changed to what is made of its text."""
    before = path.read_text(encoding="utf-8")
    after = made(before)
    if after != before:
        write_text(path, after)
    return after != before


def of_set(rule):
    """The rule of the stored set that the text of one names; of none, {}, itself."""
    name = json.loads(rule).get("set")
    return as_json({"set": name} | read_json(ROOT / "results" / name / "families" / RULE.name)) if name else rule


def texts():
    """All READMEs and the like."""
    return sorted(path for path in ROOT.rglob("*.md") if not {".git", "local", "node_modules"} & set(path.parts)
                  and not path.relative_to(ROOT).parts[0].startswith("build"))
