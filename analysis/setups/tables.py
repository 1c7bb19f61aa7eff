# Rows of set-up times.
from analysis.core.timing import processes


def build(records, view):
    rows = processes(records)
    return {"setups": rows.reindex(columns=["scene", "implementation", "status", "reason", "setup_us", "record"])}
