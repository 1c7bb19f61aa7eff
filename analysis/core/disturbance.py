# Disturbance: in how many timed processes others ran, how much of its time a host took from the machine, frequencies.
from analysis.core.timing import disturbed


def disturbance(records):
    """{"processes", "disturbed", "steal", "mhz"} of timed records: how many tell whether others ran, in how many they did; the largest
    share of the processors that the host took; [least, largest] frequency. None where nothing tells it."""
    timed = [one for one in records if one.cell.get("timed") and one.done and (one.machine or one.cell["kind"] == "bench")]
    steal, mhz = ([one.machine[key] for one in timed if one.machine.get(key) is not None] for key in ("steal", "mhz"))
    return {"processes": len(timed), "disturbed": sum(map(disturbed, timed)), "steal": max(steal, default=None),
            "mhz": [min(mhz), max(mhz)] if mhz else None}


def told(one):
    """What `disturbance` found, in words; "" where nothing was timed, or nothing is known of it."""
    if not one or not one["processes"]:
        return ""
    return (f"others ran on the processor in {one['disturbed']} of {one['processes']} timed processes"
            + ("" if one["steal"] is None else f"; the host took up to {100 * one['steal']:.1f} % of its time")
            + ("" if one["mhz"] is None else f"; {' to '.join(dict.fromkeys(f'{mhz:.0f}' for mhz in one['mhz']))} MHz"))
