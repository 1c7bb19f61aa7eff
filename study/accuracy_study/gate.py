# The gate: which implementation agrees with the reference in which setting.
#
# Two checks of `mbs check`, "exact" and "convergence-order", do not compare with the reference but judge the
# discretization: a loose tolerance fails them in the reference too. What that costs in accuracy is what this
# study measures, so that a setting which fails these alone takes part.
from study.pipeline import child, runs
from study.pipeline.layout import read_json, write_json

SCENES = ("four-bar:10", "four-bar:2")  # at larger ones rounding, grown at singular positions, decides
OF_ACCURACY = {"exact", "convergence-order"}
SECONDS = 120  # a scene and implementation


def check(bench, setting, contenders):
    """The rows of gate.csv of one setting."""
    rows = []
    for environment in dict.fromkeys(one.environment for one in contenders):
        group = [one for one in contenders if one.environment == environment]
        path = bench.raw / "gate" / f"{setting.file_name}-{environment.replace('|', '.')}.json"
        record = _run(path, setting, group, bench.contexts[environment])
        if record is None:  # it died: find out with whom
            for one in group:
                path = bench.raw / "gate" / f"{setting.file_name}-{one.file_name}.json"
                rows += _rows(bench, setting, path, _run(path, setting, [one],
                                                         bench.contexts[environment], final=True))
        else:
            rows += _rows(bench, setting, path, record)
    return rows


def refused(rows):
    """{(implementation, setting): why} of those that do not agree on every scene."""
    return {(row["implementation"], row["setting"]):
            f"gate, {row['scene']}: {row['reason'] or row['verdict']}"
            for row in reversed(rows) if not row["takes_part"]}


def _run(path, setting, group, context, final=False):
    if path.exists():
        return read_json(path)
    partial = path.with_name(path.name + ".partial")
    partial.parent.mkdir(parents=True, exist_ok=True)
    names = [word for one in group for word in ("--implementation", one.variant)]
    command = group[0].call("check", *SCENES, *setting.words(), "--time-limit", str(SECONDS), *names)
    ended = child.run([*command, "--json", str(partial)], SECONDS * (len(group) + 1), runs.MEMORY_MB,
                      partial)
    ended_well = ended.status == "exited" and ended.code in (0, 1) and partial.exists()
    if not ended_well and not final:
        partial.unlink(missing_ok=True)
        return None
    record = read_json(partial) if ended_well else _dead(ended, group[0], context)
    partial.unlink(missing_ok=True)
    write_json(path, record | {"command": command})
    return record | {"command": command}


def _dead(ended, contender, context):
    """The record of a check that died, in the shape of one that did not."""
    status = "crashed" if ended.status == "exited" else ended.status
    return {"context": context, "rows": [
        {"scene": scene, "implementation": contender.variant, "verdict": status,
         "reason": f"the check: {ended.reason}", "checks": []} for scene in SCENES]}


def _rows(bench, setting, path, record):
    found = []
    for row in record["rows"]:
        failed = {check["name"] for check in row["checks"] if check["passed"] is False}
        inaccurate = bool(failed) and failed <= OF_ACCURACY
        found.append({"setting": setting.name, "scene": row["scene"],
                      "implementation": row["implementation"], "verdict": row["verdict"],
                      "reason": row["reason"], "takes_part": row["verdict"] == "agrees" or inaccurate,
                      "only_inaccurate": inaccurate, "raw_file": bench.layout.relative(path),
                      "command": runs.typed(record)})
    return found
