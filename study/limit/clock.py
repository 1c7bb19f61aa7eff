# A command of `mbs` on many lanes by the clock. It is a program of its own, too, for those who hold much: what the process that starts a command
# holds counts as what the command has held.
import json
import os
import re
import subprocess
import sys
import time


def timed(*command):
    """{"lanes": how many it says; "wall_s", "cpu_s": by the clock and the processor, of all its processes; "memory_mb": of the largest of these}.
    Ends the program with its words where it does not work. Lanes may fail, but not all."""
    begin = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    said = child.stdout.read()
    _, status, used = os.wait4(child.pid, 0)
    seconds, child.returncode = time.monotonic() - begin, os.waitstatus_to_exitcode(status)
    lanes = re.search(r"(?:(\d+) of )?(\d+) lanes?\b", said)
    if child.returncode not in (0, 1) or not lanes or lanes[1] == lanes[2]:
        print(said.strip() or f"mbs {command[1]} ended with status {child.returncode}", file=sys.stderr)
        sys.exit(2)
    return {"lanes": int(lanes[2]), "wall_s": seconds, "cpu_s": used.ru_utime + used.ru_stime, "memory_mb": used.ru_maxrss / 1024}


if __name__ == "__main__":
    print(json.dumps(timed(*sys.argv[1:])))
