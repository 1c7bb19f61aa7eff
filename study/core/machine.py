# What else goes on where something is timed: other load, time that a host takes from this machine, its processor's frequency.
import os
import re
from pathlib import Path

# Of the processors, by the load's mean over a minute, from which the machine is busy, without what is timed: as `mbs bench` has it.
OTHERS = max(0.5, (os.cpu_count() or 1) / 2 - 1)


def busy():
    """That others are at work, said before a study begins; "" if they are not."""
    load = os.getloadavg()[0]
    return f"the machine is busy (load {load:.1f} over the last minute): times may be too long" if load > OTHERS else ""


def ticks():
    """(those that the host took, all) of this machine's processors since it was started."""
    found = [int(one) for one in Path("/proc/stat").read_text().split()[1:9]]  # user, …, steal
    return found[-1], sum(found)


def since(before):
    """{"steal", "mhz"}: the share that the host took since `ticks` were `before`; the frequency now, None where it cannot be read."""
    taken, total = (now - then for now, then in zip(ticks(), before))
    found = re.findall(r"^cpu MHz\s*: ([\d.]+)", Path("/proc/cpuinfo").read_text(), re.M)
    return {"steal": taken / total if total else 0.0, "mhz": max(map(float, found), default=None)}
