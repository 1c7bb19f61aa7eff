#!/usr/bin/python3
"""What a step costs through the library and from Python, beside `mbs simulate`: speed.py PREFIX PROGRAMS [ROUNDS]

PREFIX is where mbs is installed, PROGRAMS where these examples are built. All take turns; times are the processor's. A step's is
that of a long run less a short one, over the steps between them: reading, setting up and judging the end fall out. The least of
all rounds counts, as what else runs on the machine only adds. `mbs simulate` reads the clock at every step, which shows where a step
is short. Exit status 1 if a bound does not hold.
"""
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

PREFIX, PROGRAMS = (Path(word).resolve() for word in sys.argv[1:3])
ROUNDS = int(sys.argv[3]) if len(sys.argv) > 3 else 15
sys.path[:0] = map(str, PREFIX.glob("lib/python3*/dist-packages"))
import mbs  # noqa: E402

SHORT, LONG, BLOCK = 4000, 20000, 100  # steps


def processor_time(*words):
    """Of a program and its set-up, s."""
    child = subprocess.Popen([str(word) for word in words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    said = child.stderr.read()
    _, status, used = os.wait4(child.pid, 0)
    if os.waitstatus_to_exitcode(status) != 0 and "not-converged" not in said:
        sys.exit(said)
    return used.ru_utime + used.ru_stime


def simulate(scene, step, variant):
    return lambda steps: processor_time(
        PREFIX / "bin/mbs", "simulate", scene, "--implementation", variant, "--step", step, "--duration", f"{steps * step:.9g}",
        "--judge-every", steps)


def loop(scene, step, variant):
    return lambda steps: processor_time(PROGRAMS / "speed", scene, step, steps, variant)


def blocks(scene, step, variant):
    stepper = mbs.Stepper(mbs.Scene(scene), variant, step=step)
    start = stepper.save()

    def run(steps):
        stepper.restore(start)
        begin = time.process_time()
        for _ in range(steps // BLOCK):
            stepper.step(BLOCK)
        return time.process_time() - begin
    return run


def measure(contenders):
    """{name: {steps: [s, one a round]}}"""
    times = {name: {SHORT: [], LONG: []} for name in contenders}
    for _ in range(ROUNDS):
        for name, run in contenders.items():
            for steps, found in times[name].items():
                found.append(run(steps))
    return times


def compare(scene, step, *others):
    """Whether the bounds hold. `others`: (name, of what, beside whom, bound of the ratio)."""
    variant = mbs.Stepper(mbs.Scene(scene), step=step).implementation
    times = measure({"mbs simulate": simulate(scene, step, variant)}
                    | {name: of(scene, step, variant) for name, of, _, _ in others})
    us = {name: [1e6 * (kind(found[LONG]) - kind(found[SHORT])) / (LONG - SHORT) for kind in (min, statistics.median)]
          for name, found in times.items()}
    print(f"{Path(scene).name}, {variant}: mbs simulate {us['mbs simulate'][0]:.2f} us a step")
    held = True
    for name, _, beside, bound in others:
        least, median = (one / other for one, other in zip(us[name], us[beside]))
        held &= least <= bound
        print(f"  {name}: {least:.3f} times {beside} (medians: {median:.3f}), bound {bound}: {'held' if least <= bound else 'NOT HELD'}")
    return held


car = compare(str(Path(__file__).resolve().parent / "car.json"), 1e-3, ("a loop that sets all inputs", loop, "mbs simulate", 1.05))
four_bar = compare("four-bar:10", 1.25e-3, ("a loop", loop, "mbs simulate", 1.05),
                   (f"Python, blocks of {BLOCK} steps", blocks, "a loop", 1.10))
sys.exit(0 if car and four_bar else 1)
