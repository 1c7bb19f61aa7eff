#!/usr/bin/python3
# Stands in for an engine's program: same command line and output, invented numbers, and the misbehaviour that the
# setting `does` asks for.
import json
import os
import signal
import sys
import time

words = dict(word.split("=", 1) for word in sys.argv[sys.argv.index("--setting") + 1:] if "=" in word)
does, step = words.get("does", "ok"), float(words["step"])
repeats = int(sys.argv[sys.argv.index("--repeats") + 1]) if "--repeats" in sys.argv else 1
duration = float(sys.argv[sys.argv.index("--duration") + 1])
if does == "crash":
    os.kill(os.getpid(), signal.SIGABRT)
if does == "hang":
    time.sleep(1000)
lost = does == "lose" and step > 4e-3
print(json.dumps({
    "engine": os.path.basename(sys.argv[0]).removeprefix("engine_"), "version": "1.0", "setting": words,
    "loops": int(sys.argv[sys.argv.index("--loops") + 1]), "duration": duration,
    "status": "wrong-branch" if lost else "ok", "status_reason": "rods differ" if lost else "",
    "failed_at": 0.7 if lost else None, "position_error_max": 0.3 if lost else 1e2 * step**2,
    "energy_drift_max": 1e-3, "joint_gap_max": 1e-6, "time": (1e9 if does == "slow" else 1e-4) / step,
    "repeats": repeats, "complaints": int(lost), "first_complaint": "the matrix is singular" if lost else ""}))
sys.exit(lost)
