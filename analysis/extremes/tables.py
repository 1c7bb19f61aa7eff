# The tables of the part, a column's records each. Pivots: what KLU's ways of keeping them lose and cost on matrices that change violently.
import pandas

from analysis.core import timing
from analysis.core.gather import gather
from analysis.extremes import battery

PLAIN = ("refactor", "default")  # strategy and pivots that times are over
SAME = ("sequence", "form", "strategy", "pivoting", "matrices", "error_median", "repivotings")  # in all processes


def build(records, view):
    of = {column: [record for record in records if record.column == column] for column in ("battery", "pivots")}
    return {"battery": battery.table(of["battery"], view.registry), **_pivots(of["pivots"])}


def _pivots(records):
    """{"pivots": a row a sequence, strategy and choice of pivots, and a row a process that gave none; "claims": what the
    program says of its own claims}"""
    done = [record for record in records if record.done]
    names = " ".join(record.name for record in done)
    rows = [row | {"process": record.cell["number"]} for record in done for row in record.output["rows"]]
    claims = gather((one["claim"], one["holds"]) for record in done for one in record.output.get("claims", []))
    lost = [{"status": record.status, "reason": record.reason, "record": record.name} for record in records if not record.done]
    found = [row | {"status": "ok", "record": names} for row in _over_processes(pandas.DataFrame(rows))]
    return {"pivots": found + lost, "claims": [{"claim": claim, "holds": all(holds), "record": names} for claim, holds in claims.items()]}


def _over_processes(rows):
    for _, own in rows.groupby(["sequence", "form"], sort=False) if len(rows) else []:
        timed = timing.apart(own.assign(status="ok", implementation=list(zip(own.strategy, own.pivoting))), "time_us_median")
        for (strategy, pivoting), each in own.groupby(["strategy", "pivoting"], sort=False):
            yield each.iloc[0][[*SAME]].to_dict() | timing.ratio(timed, (strategy, pivoting), PLAIN).columns("time_ratio", "ratio_") | {
                "error_worst": each.error_worst.max(skipna=False), "time_us": each.time_us_median.median(), "processes": len(each)}
